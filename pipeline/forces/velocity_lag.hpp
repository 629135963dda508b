// Velocity lag: of which moment a body's velocity is.
//
// The solver of contacts gives gravity at once for a whole substep, before a body moves, so that
// the velocity it leaves, like that of what only falls by kicks, is half a substep behind. What an
// integrator of a higher order leaves is of the moment. Who goes from one to the other takes the
// half along: else who bounces would win g h v each time. So does who is solved by finer substeps,
// of which his velocity is half of one behind, while nothing presses him. Whom something presses,
// on the way there or back, keeps his: most rest, and what bears them would take it for a blow.
#pragma once

#include "kernels/data/bodies.hpp"
#include "kernels/data/contact_constraints.hpp"
#include "kernels/data/forces.hpp"
#include "pipeline/step/step_context.hpp"

#include <span>

namespace throng {

/// Before contacts are solved: velocities of bodies, where they are of the moment, to where the
/// solver has them.
void lag_velocities(const StepContext& context,
                    const Forces& forces,
                    const Masses& masses,
                    const Layout& layout,
                    Flights& flights,
                    Velocities& velocities);

/// What is solved together, by so many times the substeps that the settings say.
///
///   bodies   all that can be moved
///   pressed  [bodies] 1 where a contact has an impulse
struct SolvedBodies {
    int times = 1;
    std::span<const std::uint32_t> bodies;
    std::span<const std::uint8_t> pressed;
};

/// Before a solve by finer substeps: who comes there as one of the usual ones left him.
template <class Real>
void lag_by_finer(const StepContext& context,
                  const Forces& forces,
                  const SolvedBodies& solve,
                  const Flights& flights,
                  std::span<SolverBody<Real>> solver);

/// After any solve: who nothing presses, and was or is solved by finer ones; and how far all are
/// behind.
template <class Real>
void lag_by_usual(const StepContext& context,
                  const Forces& forces,
                  const SolvedBodies& solve,
                  Flights& flights,
                  std::span<SolverBody<Real>> solver);

/// Before these bodies fly by kicks: velocities of those that finer substeps left, half of a whole
/// one behind as the others' are.
void lag_as_kicked(const StepContext& context,
                   std::span<const std::uint32_t> bodies,
                   Flights& flights,
                   Velocities& velocities);

/// Before these bodies fly: velocities of those that contacts have left behind, to the moment.
void catch_up_velocities(const StepContext& context,
                         std::span<const std::uint32_t> bodies,
                         Flights& flights,
                         Velocities& velocities);

}  // namespace throng
