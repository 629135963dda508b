// Solve island: all substeps of one island by the direct solver, by penalty forces or by kinematic
// pushes, in double whatever the precision.
//
// By the direct solver each substep asks up to three times: how fast the bodies may go on without
// coming closer than to touch; where some bounce, how fast they are after it; where some overlap,
// how fast to move them apart in this substep, which changes places and no velocity. Friction holds
// in each.
#pragma once

#include "kernels/dynamics/rigid_motion.hpp"
#include "kernels/solver/direct/direct.hpp"
#include "pipeline/solvers/constraint_builder.hpp"

namespace throng {

/// What the settings ask of a solve.
inline DirectEffort asked_effort(const SolverParameters& parameters)
{
    if (parameters.iterations > 0) return {.steps = parameters.iterations};
    return {};
}

/// What an island is solved from, and its answer given to.
template <class Real>
struct IslandScene {
    const StepContext& context;
    const SolverParameters& parameters;
    const DirectEffort& effort;  // a solve
    const Layout& layout;
    const ActiveContacts& active;
    const RigidFacts& facts;  // as the step began, of the bodies of any batch not yet solved
    const ExternalAcceleration& accelerations;
    const PrescribedVelocities& prescribed;
    const ConstraintBuilder<Real>& builder;
    Poses& poses;
    Velocities& velocities;
};

/// Makes room for what direct batches will tell, if there are any.
template <class Real>
void start_islands(const Layout& layout,
                   ContactConstraints<Real>& constraints,
                   StepDiagnostics& diagnostics);

/// Solves a direct batch, moves its bodies, and gives the contacts their impulses; the solver
/// bodies stay as they were, and are marked settled. Fills in the diagnostics of the batch: the
/// greatest residual, and how often a substep was cut. Many batches may be solved at the same time.
template <class Real>
void solve_island(const IslandScene<Real>& scene,
                  const Batch& batch,
                  ContactConstraints<Real>& constraints,
                  StepDiagnostics& diagnostics);

/// Sums up what direct batches told.
void finish_islands(const StepContext& context,
                    const SolverParameters& parameters,
                    const Layout& layout,
                    StepDiagnostics& diagnostics);

}  // namespace throng
