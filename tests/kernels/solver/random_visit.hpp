// Random visits: what the solver may be asked of a block, for tests that run all of it.
#pragma once

#include "tests/kernels/solver/random_contacts.hpp"

namespace throng::given {

template <class Real>
Visit<Real> random_visit(std::mt19937& random, const BlockWish& wish)
{
    Visit<Real> visit;
    visit.inverse_substep = 240;
    visit.push_limit = 3;
    visit.push = random() % 2 == 0;
    visit.turns = wish.turns;
    visit.grips = random() % 4 != 0 || wish.grips_apart();
    visit.at_points = wish.at_points;
    visit.pyramid = wish.pyramid;
    visit.rolls = wish.rolls;
    visit.slow = Real(0.5);
    for (Real& number : visit.fall) number = static_cast<Real>(random_number(random, -0.05, 0.05));
    visit.normal_sweeps = 1 + static_cast<int>(random() % 3);
    return visit;
}

/// A substep's worth of visits: impacts, a warm start, one that pushes and one that relaxes in
/// either order.
template <class Real>
void run_all(const SolveKernels<Real>& kernels, BlockCase<Real>& made, const Visit<Real>& visit)
{
    if (!made.rows.bounces.empty()) made.bounce(kernels, visit);
    made.warm_start(kernels, visit);
    made.sweep(kernels, visit);
    Visit<Real> other = visit;
    other.push = !visit.push;
    made.sweep(kernels, other);
}

}  // namespace throng::given
