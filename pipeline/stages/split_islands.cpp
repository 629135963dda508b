// Split islands: contacts into islands.
#include "pipeline/stages.hpp"

namespace throng {

void split_islands(const ActiveContacts& contacts,
                   const BodyStates& states,
                   DisjointSets& sets,
                   Islands& islands)
{
    build_islands(contacts, states, sets, islands);
}

}  // namespace throng
