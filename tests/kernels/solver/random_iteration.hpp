// Random iterations: what the solver may be asked of a block, for tests that run all of it.
#pragma once

#include "tests/kernels/solver/random_contacts.hpp"

namespace throng::given {

template <class Real>
SolverIteration<Real> random_iteration(std::mt19937& random, const BlockWish& wish)
{
    SolverIteration<Real> iteration;
    iteration.inverse_substep = 240;
    iteration.push_limit = 3;
    iteration.use_bias = random() % 2 == 0;
    iteration.turns = wish.turns;
    iteration.has_friction = random() % 4 != 0 || wish.friction_at_points_or_pyramid();
    iteration.friction_at_points = wish.friction_at_points;
    iteration.friction_pyramid = wish.pyramid;
    iteration.has_rolling_friction = wish.rolls;
    iteration.restitution_threshold = Real(0.5);
    for (Real& number : iteration.gravity_step)
        number = static_cast<Real>(random_number(random, -0.05, 0.05));
    iteration.normal_iterations = 1 + static_cast<int>(random() % 3);
    return iteration;
}

/// A substep's worth of iterations: impacts, a warm start, one that pushes and one that relaxes in
/// either order.
template <class Real>
void run_all(const SolveKernels<Real>& kernels,
             BlockCase<Real>& made,
             const SolverIteration<Real>& iteration)
{
    if (!made.constraints.restitutions.empty()) made.apply_restitution(kernels, iteration);
    made.warm_start(kernels, iteration);
    made.solve(kernels, iteration);
    SolverIteration<Real> other = iteration;
    other.use_bias = !iteration.use_bias;
    made.solve(kernels, other);
}

}  // namespace throng::given
