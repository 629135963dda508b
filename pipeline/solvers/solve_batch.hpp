// Solve batch: all passes of a step over the contacts and bodies of one batch.
//
// A batch of small islands is one task that goes through all substeps while its constraints stay in
// cache. A big island goes slice by slice, each pass a slice behind the one before it: what a pass
// has brought into cache serves the passes that follow, and threads work on slices that share no
// body. Either way the order within an island is that of its slices and their colors, which ids and
// positions alone decide.
#pragma once

#include "kernels/dynamics/rigid_motion.hpp"
#include "pipeline/solvers/constraint_builder.hpp"
#include "pipeline/step/step_data.hpp"

namespace throng {

/// Makes the constraints of a batch, solves them, moves its bodies, and gives the contacts their
/// impulses. A wide batch uses all threads of the pool; of others, many may be solved at the same
/// time.
///
///   facts  as the step began
template <class Real>
void solve_batch(const StepContext& context,
                 const SolverParameters& parameters,
                 const RigidFacts& facts,
                 const Layout& layout,
                 const Batch& batch,
                 const ConstraintBuilder<Real>& builder,
                 ContactConstraints<Real>& constraints,
                 SplitImpulse& split_impulse);

}  // namespace throng
