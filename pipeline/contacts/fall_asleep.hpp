// Fall asleep: who is quiet, and how bodies are put to sleep.
#pragma once

#include "pipeline/step/stages.hpp"

namespace throng {

/// m/s, of its fastest point.
inline double speed_of(const Velocities& velocities, const BodyStates& states, std::uint32_t body)
{
    return velocities.linear[body].norm() + velocities.angular[body].norm() * states.radius[body];
}

/// Tells how long bodies have been quiet.
struct Quiet {
    const StepContext& context;
    const SleepParameters& parameters;
    const PrescribedVelocities& prescribed;
    const Forces& forces;
    const SplitImpulse& split_impulse;
    const Velocities& velocities;

    /// s, this step included; to be asked once a step.
    double count(std::uint32_t body, BodyStates& states) const
    {
        // Who is driven wants to move, even where something holds it up; what a spring or a field
        // will do to it nobody here knows; and who is moved apart has no speed for it.
        const bool quiet = states.moves(body)  // not put to rest in this very step
            && speed_of(velocities, states, body) < parameters.speed && !prescribed.drives(body)
            && !forces.keeps_awake(body) && !split_impulse.parts(body);
        states.sleep_time[body] = quiet ? states.sleep_time[body] + context.dt : 0.0;
        return states.sleep_time[body];
    }
};

/// Puts bodies to sleep that will wake together.
void fall_asleep(std::span<const std::uint32_t> bodies,
                 BodyStates& states,
                 SleepingIslands& sleeping_islands,
                 Velocities& velocities,
                 SleepEvents& sleep_events);

}  // namespace throng
