// Velocity lag: of which moment a body's velocity is.
//
// The solver of contacts gives gravity at once for a whole substep, before a body moves, so that
// the velocity it leaves, like that of what only falls by kicks, is half a substep behind. What an
// integrator of a higher order leaves is of the moment. Who goes from one to the other takes the
// half along: else who bounces would win g h v each time.
#pragma once

#include "kernels/data/bodies.hpp"
#include "kernels/data/forces.hpp"
#include "pipeline/step/step_context.hpp"

#include <span>

namespace throng {

/// Before contacts are solved: velocities of these bodies, where they are of the moment, to where
/// the solver has them.
void lag_velocities(const StepContext& context,
                    const Forces& forces,
                    const Masses& masses,
                    std::span<const std::uint32_t> bodies,
                    Flights& flights,
                    Velocities& velocities);

/// Before these bodies fly: velocities of those that contacts have left behind, to the moment.
void catch_up_velocities(const StepContext& context,
                         std::span<const std::uint32_t> bodies,
                         Flights& flights,
                         Velocities& velocities);

}  // namespace throng
