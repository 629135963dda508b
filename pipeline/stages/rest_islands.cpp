// Rest islands: an island whose every body has been quiet long enough falls asleep as a whole.
#include "pipeline/step/stages.hpp"

#include <algorithm>
#include <limits>

namespace throng {

namespace {

double speed_of(const Velocities& velocities, const BodyStates& states, std::uint32_t body)
{
    return velocities.linear[body].norm() + velocities.angular[body].norm() * states.radius[body];
}

void put_to_bed(std::span<const std::uint32_t> bodies,
                BodyStates& states,
                Beds& beds,
                Velocities& velocities,
                Rest& rest)
{
    std::uint32_t bed = 0;
    if (beds.free.empty()) {
        bed = static_cast<std::uint32_t>(beds.sleepers.size());
        beds.sleepers.emplace_back();
    } else {
        bed = beds.free.back();
        beds.free.pop_back();
    }
    beds.sleepers[bed].assign(bodies.begin(), bodies.end());
    for (const std::uint32_t body : bodies) {
        states.awake[body] = 0;
        states.bed[body] = bed;
        velocities.linear[body].setZero();
        velocities.angular[body].setZero();
        rest.rested.push_back(body);
    }
}

}  // namespace

void rest_islands(const Conditions& conditions,
                  const Drives& drives,
                  const Forces& forces,
                  const Islands& islands,
                  const Parting& parting,
                  BodyStates& states,
                  Beds& beds,
                  Velocities& velocities,
                  Rest& rest)
{
    rest.rested.clear();
    const Settings& settings = conditions.settings;
    const auto quiet_for = [&](std::uint32_t body) {
        // Who is driven wants to move, even where something holds it up; what a spring or a field
        // will do to it nobody here knows; and who is moved apart has no speed for it.
        const bool quiet = states.moves(body)  // not put to rest in this very step
            && speed_of(velocities, states, body) < settings.sleep_speed
            && !std::binary_search(drives.body.begin(), drives.body.end(), body)
            && !forces.stirs(body) && !parting.parts(body);
        states.quiet_time[body] = quiet ? states.quiet_time[body] + settings.dt : 0.0;
        return states.quiet_time[body];
    };
    for (std::size_t island = 0; island < islands.size(); ++island) {
        const auto bodies =
            std::span(islands.bodies)
                .subspan(islands.body_begin[island],
                         islands.body_begin[island + 1] - islands.body_begin[island]);
        double least = std::numeric_limits<double>::infinity();
        for (const std::uint32_t body : bodies) least = std::min(least, quiet_for(body));
        if (least >= settings.sleep_time) put_to_bed(bodies, states, beds, velocities, rest);
    }
    // What nothing holds is at rest only where it stands: a slow one drifts, or turns back to fall.
    for (const std::uint32_t body : islands.lone)
        if (states.moves(body) && quiet_for(body) >= settings.sleep_time
            && speed_of(velocities, states, body) == 0)
            put_to_bed({&body, 1}, states, beds, velocities, rest);
    std::sort(rest.rested.begin(), rest.rested.end());
}

}  // namespace throng
