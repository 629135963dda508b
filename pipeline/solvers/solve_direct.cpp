#include "pipeline/solvers/solve_direct.hpp"

#include "pipeline/solvers/whole_island.hpp"

#include <algorithm>

namespace throng {

template <class Real>
void start_direct(const Layout& layout, Rows<Real>& rows, Trouble& trouble)
{
    const bool any = std::any_of(layout.batches.begin(), layout.batches.end(),
                                 [](const Batch& batch) { return batch.direct; });
    using Settled = typename Rows<Real>::Settled;
    rows.settled.assign(any ? rows.bodies.size() : 0, Settled::no);
    trouble.residual_of.assign(any ? layout.batches.size() : 0, 0);
    trouble.cuts_of.assign(trouble.residual_of.size(), 1);
}

template <class Real>
void solve_direct(const DirectScene<Real>& scene,
                  const Batch& batch,
                  Rows<Real>& rows,
                  Trouble& trouble)
{
    WholeIsland island(scene, batch);
    for (int step = 0; step < scene.conditions.settings.substeps; ++step)
        island.substep(scene.conditions);
    island.finish(scene, batch, rows);
    const auto place = static_cast<std::size_t>(&batch - scene.layout.batches.data());
    trouble.residual_of[place] = island.residual();
    trouble.cuts_of[place] = island.cuts();
}

void finish_direct(const Conditions& conditions, const Layout& layout, Trouble& trouble)
{
    trouble.direct_residual = 0;
    trouble.direct_left = 0;
    trouble.penalty_cuts = 1;
    for (const int cuts : trouble.cuts_of)
        trouble.penalty_cuts = std::max(trouble.penalty_cuts, cuts);
    const Settings& settings = conditions.settings;
    // Of islands that are escalated nothing is promised but that they stand.
    if (settings.solver != Solver::direct || settings.response != Response::impulse) return;
    for (const double residual : trouble.residual_of)
        trouble.direct_residual = std::max(trouble.direct_residual, residual);
    for (const Batch& batch : layout.batches) trouble.direct_left += batch.direct ? 0 : 1;
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template void start_direct<Real>(const Layout&, Rows<Real>&, Trouble&);                        \
    template void solve_direct<Real>(const DirectScene<Real>&, const Batch&, Rows<Real>&, Trouble&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
