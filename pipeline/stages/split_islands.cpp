// Split islands: contacts into islands, with those that springs join to who is in one.
#include "pipeline/step/stages.hpp"

namespace throng {

void split_islands(const ActiveContacts& contacts,
                   const BodyStates& states,
                   const Forces& forces,
                   IslandFinder& finder,
                   Islands& islands)
{
    finder.find(contacts, states, forces.groups, islands);
}

}  // namespace throng
