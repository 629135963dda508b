#include "pipeline/stages/solve_direct.hpp"

#include "pipeline/stages/direct_island.hpp"

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
}

template <class Real>
double solve_direct(const DirectScene<Real>& scene, const Batch& batch, Rows<Real>& rows)
{
    DirectIsland island(scene, batch);
    for (int step = 0; step < scene.conditions.settings.substeps; ++step)
        island.substep(scene.conditions);
    island.finish(scene, batch, rows);
    return island.residual();
}

void finish_direct(const Conditions& conditions, const Layout& layout, Trouble& trouble)
{
    trouble.direct_residual = 0;
    trouble.direct_left = 0;
    for (const double residual : trouble.residual_of)
        trouble.direct_residual = std::max(trouble.direct_residual, residual);
    if (conditions.settings.solver != Solver::direct) return;
    for (const Batch& batch : layout.batches) trouble.direct_left += batch.direct ? 0 : 1;
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template void start_direct<Real>(const Layout&, Rows<Real>&, Trouble&);                        \
    template double solve_direct<Real>(const DirectScene<Real>&, const Batch&, Rows<Real>&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
