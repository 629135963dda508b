// Split islands: contacts into islands.
#include "pipeline/stages.hpp"

namespace throng {

void split_islands(const ActiveContacts& contacts,
                   const BodyStates& states,
                   IslandFinder& finder,
                   Islands& islands)
{
    finder.find(contacts, states, islands);
}

}  // namespace throng
