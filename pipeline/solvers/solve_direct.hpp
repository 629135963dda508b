// Solve direct: all substeps of one island by the direct solver, in double whatever the precision.
//
// Each substep asks up to three times: how fast the bodies may go on without coming closer than to
// touch; where some bounce, how fast they are after it; where some overlap, how fast to move them
// apart in this substep, which changes places and no velocity. Friction holds in each.
#pragma once

#include "kernels/dynamics/rigid_motion.hpp"
#include "kernels/solver/direct/direct.hpp"
#include "pipeline/solvers/row_maker.hpp"

namespace throng {

/// What the settings ask of a solve.
inline DirectEffort asked_effort(const Settings& settings)
{
    if (settings.iterations > 0) return {.steps = settings.iterations};
    return {};
}

/// What an island is solved from, and its answer given to.
template <class Real>
struct DirectScene {
    const Conditions& conditions;
    const DirectEffort& effort;  // a solve
    const Layout& layout;
    const ActiveContacts& active;
    const RigidFacts& facts;  // as the step began, of the bodies of any batch not yet solved
    const Pulls& pulls;
    const Drives& drives;
    const RowMaker<Real>& maker;
    Poses& poses;
    Velocities& velocities;
};

/// Makes room for what direct batches will tell, if there are any.
template <class Real>
void start_direct(const Layout& layout, Rows<Real>& rows, Trouble& trouble);

/// Solves a direct batch, moves its bodies, and gives the contacts their impulses; the bodies'
/// seats among the rows stay as they were, and are marked settled. Tells the trouble of the batch:
/// the greatest residual, and how often a substep was cut. Many batches may be solved at the same
/// time.
template <class Real>
void solve_direct(const DirectScene<Real>& scene,
                  const Batch& batch,
                  Rows<Real>& rows,
                  Trouble& trouble);

/// Sums up what direct batches told.
void finish_direct(const Conditions& conditions, const Layout& layout, Trouble& trouble);

}  // namespace throng
