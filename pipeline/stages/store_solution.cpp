// Store solution: what solver bodies came to since the step began, onto poses and velocities.
#include "kernels/parallel/blocks.hpp"
#include "kernels/solver/solver_bodies.hpp"
#include "pipeline/step/stages.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

constexpr std::size_t kBodies = 512;  // a block

// Gives one body its new state. False, and the body as it was, when that is not sound.
template <class Real>
bool take_back(const SolverBody<Real>& solver_body,
               const GyroscopicInertia<Real>* inertia,
               std::uint32_t body,
               Poses& poses,
               Velocities& velocities)
{
    if (ran_away(solver_body)) return false;
    const Vec3 moved = vector_at(solver_body.delta_pose);
    const Vec3 v = vector_at(solver_body.motion), spin = vector_at(solver_body.motion + 4);
    const Vec3 w = inertia != nullptr ? spin_frame(solver_body, inertia) * spin : spin;
    const Vec3 position = poses.position[body] + moved;
    Quat orientation = poses.orientation[body];
    // Who has not turned keeps its very bits.
    if (solver_body.delta_pose[4] != 0 || solver_body.delta_pose[5] != 0
        || solver_body.delta_pose[6] != 0) {
        orientation = turn_of(solver_body) * orientation;
        orientation.coeffs() /= std::sqrt(orientation.squaredNorm());
    }
    return give_motion({position, orientation, v, w}, body, poses, velocities);
}

}  // namespace

template <class Real>
void store_solution(const Layout& layout,
                    const ContactConstraints<Real>& constraints,
                    Poses& poses,
                    Velocities& velocities,
                    StepDiagnostics& diagnostics)
{
    diagnostics.quarantined.clear();
    const SolverBodyBlocks bodies(layout, kBodies);
    diagnostics.scratch.of_block.start(bodies.blocks());
    bodies.for_each([&](std::uint32_t body, std::uint32_t solver_index, std::size_t block) {
        using Settled = typename ContactConstraints<Real>::Settled;
        const Settled settled =
            constraints.settled.empty() ? Settled::no : constraints.settled[solver_index];
        if (settled == Settled::yes) return;
        const GyroscopicInertia<Real>* const inertia =
            constraints.precesses.empty() || constraints.precesses[solver_index] == 0
            ? nullptr
            : &constraints.inertias[solver_index];
        if (settled == Settled::lost
            || !take_back(constraints.bodies[solver_index], inertia, body, poses, velocities))
            diagnostics.scratch.of_block[block].push_back(body);
    });
    diagnostics.scratch.of_block.append_to(diagnostics.quarantined);
    std::sort(diagnostics.quarantined.begin(), diagnostics.quarantined.end());
}

template void store_solution<float>(
    const Layout&, const ContactConstraints<float>&, Poses&, Velocities&, StepDiagnostics&);
template void store_solution<double>(
    const Layout&, const ContactConstraints<double>&, Poses&, Velocities&, StepDiagnostics&);

}  // namespace throng
