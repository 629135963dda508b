// Subdivide: a step that would end in overlap is done again as two halves, for those concerned.
//
// Groups of bodies that may meet (carry_groups.cpp) fly piece by piece (group_halves.cpp): late to
// every touch by a piece of the step, where back_up.cpp seeks the moment itself.
#include "pipeline/stages.hpp"
#include "pipeline/stages/group_flight.hpp"

namespace throng {

void subdivide(const Conditions& conditions,
               const Shapes& shapes,
               const Surfaces& surfaces,
               const PairFilter& filter,
               const Colliders& colliders,
               const BodyStates& states,
               const Masses& masses,
               const Forces& forces,
               Poses& poses,
               Velocities& velocities,
               Flights& flights,
               Islands& islands,
               CarriedContacts& contacts,
               Trouble& trouble)
{
    GroupScene scene{conditions, shapes, surfaces,   filter,  colliders, states, masses,
                     forces,     poses,  velocities, flights, {},        {}};
    carry_groups(scene, &GroupFlight::subdivide, islands, contacts, trouble);
}

}  // namespace throng
