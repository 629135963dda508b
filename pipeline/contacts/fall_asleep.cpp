#include "pipeline/contacts/fall_asleep.hpp"

namespace throng {

void fall_asleep(std::span<const std::uint32_t> bodies,
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

}  // namespace throng
