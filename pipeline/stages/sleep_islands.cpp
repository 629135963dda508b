// Sleep islands: an island whose every body has been quiet long enough falls asleep as a whole.
#include "pipeline/step/stages.hpp"

#include <algorithm>
#include <limits>

namespace throng {

namespace {

double speed_of(const Velocities& velocities, const BodyStates& states, std::uint32_t body)
{
    return velocities.linear[body].norm() + velocities.angular[body].norm() * states.radius[body];
}

void sleep(std::span<const std::uint32_t> bodies,
           BodyStates& states,
           SleepingIslands& sleeping_islands,
           Velocities& velocities,
           SleepEvents& sleep_events)
{
    std::uint32_t sleeping_island = 0;
    if (sleeping_islands.free.empty()) {
        sleeping_island = static_cast<std::uint32_t>(sleeping_islands.bodies.size());
        sleeping_islands.bodies.emplace_back();
    } else {
        sleeping_island = sleeping_islands.free.back();
        sleeping_islands.free.pop_back();
    }
    sleeping_islands.bodies[sleeping_island].assign(bodies.begin(), bodies.end());
    for (const std::uint32_t body : bodies) {
        states.awake[body] = 0;
        states.sleeping_island[body] = sleeping_island;
        velocities.linear[body].setZero();
        velocities.angular[body].setZero();
        sleep_events.fell_asleep.push_back(body);
    }
}

}  // namespace

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
    const auto quiet_for = [&](std::uint32_t body) {
        // Who is driven wants to move, even where something holds it up; what a spring or a field
        // will do to it nobody here knows; and who is moved apart has no speed for it.
        const bool quiet = states.moves(body)  // not put to rest in this very step
            && speed_of(velocities, states, body) < parameters.speed && !prescribed.drives(body)
            && !forces.keeps_awake(body) && !split_impulse.parts(body);
        states.sleep_time[body] = quiet ? states.sleep_time[body] + context.dt : 0.0;
        return states.sleep_time[body];
    };
    for (std::size_t island = 0; island < islands.size(); ++island) {
        const auto bodies = islands.bodies_of(island);
        double least = std::numeric_limits<double>::infinity();
        for (const std::uint32_t body : bodies) least = std::min(least, quiet_for(body));
        if (least >= parameters.time)
            sleep(bodies, states, sleeping_islands, velocities, sleep_events);
    }
    // What nothing holds is at rest only where it stands: a slow one drifts, or turns back to fall.
    for (const std::uint32_t body : islands.lone)
        if (states.moves(body) && quiet_for(body) >= parameters.time
            && speed_of(velocities, states, body) == 0)
            sleep({&body, 1}, states, sleeping_islands, velocities, sleep_events);
    std::sort(sleep_events.fell_asleep.begin(), sleep_events.fell_asleep.end());
}

}  // namespace throng
