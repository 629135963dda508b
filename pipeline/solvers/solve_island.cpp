#include "pipeline/solvers/solve_island.hpp"

#include "pipeline/solvers/island_solver.hpp"

#include <algorithm>

namespace throng {

template <class Real>
void start_islands(const Layout& layout,
                   ContactConstraints<Real>& constraints,
                   StepDiagnostics& diagnostics)
{
    const bool any = std::any_of(layout.batches.begin(), layout.batches.end(),
                                 [](const Batch& batch) { return batch.direct; });
    using Settled = typename ContactConstraints<Real>::Settled;
    constraints.settled.assign(any ? constraints.bodies.size() : 0, Settled::no);
    diagnostics.scratch.residual_of.assign(any ? layout.batches.size() : 0, 0);
    diagnostics.scratch.cuts_of.assign(diagnostics.scratch.residual_of.size(), 1);
}

template <class Real>
void solve_island(const IslandScene<Real>& scene,
                  const Batch& batch,
                  ContactConstraints<Real>& constraints,
                  StepDiagnostics& diagnostics)
{
    IslandSolver island(scene, batch);
    for (int step = 0; step < scene.context.substeps; ++step) island.substep(scene.context);
    island.finish(scene, batch, constraints);
    const auto place = static_cast<std::size_t>(&batch - scene.layout.batches.data());
    diagnostics.scratch.residual_of[place] = island.residual();
    diagnostics.scratch.cuts_of[place] = island.cuts();
}

void finish_islands(const StepContext& context,
                    const SolverParameters& parameters,
                    const Layout& layout,
                    StepDiagnostics& diagnostics)
{
    diagnostics.direct_residual = 0;
    diagnostics.direct_left = 0;
    diagnostics.penalty_cuts = 1;
    for (const int cuts : diagnostics.scratch.cuts_of)
        diagnostics.penalty_cuts = std::max(diagnostics.penalty_cuts, cuts);
    // Of islands that are escalated nothing is promised but that they stand.
    if (parameters.solver != Solver::direct || context.response != Response::impulse) return;
    for (const double residual : diagnostics.scratch.residual_of)
        diagnostics.direct_residual = std::max(diagnostics.direct_residual, residual);
    for (const Batch& batch : layout.batches) diagnostics.direct_left += batch.direct ? 0 : 1;
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template void start_islands<Real>(const Layout&, ContactConstraints<Real>&, StepDiagnostics&); \
    template void solve_island<Real>(const IslandScene<Real>&, const Batch&,                       \
                                     ContactConstraints<Real>&, StepDiagnostics&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
