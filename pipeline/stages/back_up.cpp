// Back up: the step is cut where bodies first touch, as often as it takes, for those concerned.
//
// Groups of bodies that may meet (carry_groups.cpp) fly from touch to touch (group_flight.cpp).
#include "pipeline/stages.hpp"
#include "pipeline/stages/group_flight.hpp"

namespace throng {

void back_up(const Conditions& conditions,
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
    carry_groups(scene, &GroupFlight::back_up, islands, contacts, trouble);
}

}  // namespace throng
