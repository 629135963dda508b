// Split islands: contacts into islands, with those that springs join to who is in one.
#include "pipeline/step/stages.hpp"

#include <algorithm>

namespace throng {

void split_islands(const StepContext& context,
                   const ActiveContacts& contacts,
                   const BodyStates& states,
                   const SleepEvents& sleep_events,
                   const Forces& forces,
                   IslandFinder& finder,
                   Islands& islands)
{
    const std::vector<std::uint32_t>& awake = states.active_bodies.dynamic;
    if (!context.has(Effect::sleeping) || sleep_events.woke.empty()) {
        finder.find(contacts, states, awake, forces.groups, islands);
        return;
    }
    std::vector<std::uint32_t> movable(awake.size() + sleep_events.woke.size());
    std::merge(awake.begin(), awake.end(), sleep_events.woke.begin(), sleep_events.woke.end(),
               movable.begin());
    finder.find(contacts, states, movable, forces.groups, islands);
}

}  // namespace throng
