// Sleep islands: an island whose every body has been quiet long enough falls asleep as a whole.
#include "pipeline/contacts/fall_asleep.hpp"

#include <algorithm>
#include <limits>

namespace throng {

void sleep_islands(const StepContext& context,
                   const SleepParameters& parameters,
                   const PrescribedVelocities& prescribed,
                   const Forces& forces,
                   const Islands& islands,
                   const SplitImpulse& split_impulse,
                   BodyStates& states,
                   SleepingIslands& sleeping_islands,
                   Velocities& velocities,
                   SleepEvents& sleep_events)
{
    sleep_events.fell_asleep.clear();
    const Quiet quiet{context, parameters, prescribed, forces, split_impulse, velocities};
    for (std::size_t island = 0; island < islands.size(); ++island) {
        const auto bodies = islands.bodies_of(island);
        double least = std::numeric_limits<double>::infinity();
        for (const std::uint32_t body : bodies) least = std::min(least, quiet.count(body, states));
        if (least >= parameters.time)
            fall_asleep(bodies, states, sleeping_islands, velocities, sleep_events);
    }
    // What nothing holds is at rest only where it stands: a slow one drifts, or turns back to fall.
    for (const std::uint32_t body : islands.lone)
        if (states.moves(body) && quiet.count(body, states) >= parameters.time
            && speed_of(velocities, states, body) == 0)
            fall_asleep({&body, 1}, states, sleeping_islands, velocities, sleep_events);
    std::sort(sleep_events.fell_asleep.begin(), sleep_events.fell_asleep.end());
}

}  // namespace throng
