#include "kernels/solver/solver_bodies.hpp"

#include "kernels/math/rotation.hpp"
#include "kernels/solver/solve_kernels.hpp"

#include <cmath>

namespace throng {

namespace {

// The shortest turn that takes one unit vector to another.
Quat shortest_turn(const Vec3& from, const Vec3& to)
{
    const Vec3 axis = from.cross(to);
    const double half = std::max(1 + from.dot(to), 1e-12);
    const Quat turn(half, axis.x(), axis.y(), axis.z());
    return Quat(turn.coeffs() / std::sqrt(turn.squaredNorm()));
}

// The turn since the step began from which on a body's spin is in axes that go with it.
template <class Real>
Quat axes_taken(const GyroscopicInertia<Real>& inertia)
{
    const Real* const turn = inertia.axis + 4;
    return {double{turn[3]}, double{turn[0]}, double{turn[1]}, double{turn[2]}};
}

template <class Real>
void turn_vector(const Quat& by, Real* vector)
{
    const Vec3 turned = by * vector_at(vector);
    for (int k = 0; k < 3; ++k) vector[k] = static_cast<Real>(turned[k]);
}

template <class Real>
void turn_tensor(const Quat& by, Real* six)
{
    const Sym3 turned = in_world_axes(tensor_at(six), by);
    const double numbers[6] = {turned.xx, turned.yy, turned.zz, turned.xy, turned.xz, turned.yz};
    for (int k = 0; k < 6; ++k) six[k] = static_cast<Real>(numbers[k]);
}

// A substep's turn of a body, split: what is applied before the turn so far, in world axes, and
// after it, in those that go with the body (see axes_taken).
struct SplitTurn {
    Vec3 before = Vec3::Zero(), after = Vec3::Zero();  // rad
};

template <class Real>
SplitTurn
split_turn(const SolverBody<Real>& body, const GyroscopicInertia<Real>* inertia, double time)
{
    const Vec3 turn = vector_at(body.motion + 4) * time;
    if (inertia == nullptr || !(inertia->share[6] > 0)) return {turn, Vec3::Zero()};
    if (!(inertia->axis[3] > 0)) return {Vec3::Zero(), turn};
    const Vec3 axis = vector_at(inertia->axis);
    const Vec3 about = axis * axis.dot(turn);
    return {spin_frame(body, inertia) * Vec3(turn - about), about};
}

}  // namespace

template <class Real>
Quat spin_frame(const SolverBody<Real>& body, const GyroscopicInertia<Real>* inertia)
{
    if (inertia == nullptr || !(inertia->share[6] > 0)) return Quat::Identity();
    const Quat turn = turn_of(body) * axes_taken(*inertia).conjugate();
    if (!(inertia->axis[3] > 0)) return turn;
    const Vec3 axis = vector_at(inertia->axis);
    return shortest_turn(axis, turn * axis);
}

template <class Real>
Quat take_axes_anew(SolverBody<Real>& body, GyroscopicInertia<Real>* inertia)
{
    const Quat frame = spin_frame(body, inertia);
    if (inertia == nullptr || !(inertia->share[6] > 0)) return frame;
    turn_vector(frame, body.motion + 4);
    turn_vector(frame, body.free + 4);
    turn_tensor(frame, body.inertia + 1);
    turn_tensor(frame, inertia->share);
    turn_vector(frame, inertia->axis);
    for (int k = 0; k < 4; ++k) inertia->axis[4 + k] = body.delta_pose[4 + k];
    return frame;
}

template <class Real>
void turn_fast(std::span<SolverBody<Real>> bodies,
               const GyroscopicInertia<Real>* inertias,
               Real time)
{
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        SolverBody<Real>& body = bodies[i];
        const Real turn[3] = {body.motion[4] * time, body.motion[5] * time, body.motion[6] * time};
        const Real squared = turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2];
        if (squared < static_cast<Real>(kFastTurn * kFastTurn)) continue;
        const SplitTurn split =
            split_turn(body, inertias == nullptr ? nullptr : inertias + i, double{time});
        const Quat taken = inertias == nullptr ? Quat(Quat::Identity()) : axes_taken(inertias[i]);
        Quat after = exponential(split.before) * turn_of(body) * taken.conjugate()
            * exponential(split.after) * taken;
        after.coeffs() /= std::sqrt(after.squaredNorm());
        for (int k = 0; k < 4; ++k) body.delta_pose[4 + k] = static_cast<Real>(after.coeffs()[k]);
    }
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template Quat spin_frame<Real>(const SolverBody<Real>&, const GyroscopicInertia<Real>*);       \
    template Quat take_axes_anew<Real>(SolverBody<Real>&, GyroscopicInertia<Real>*);               \
    template void turn_fast<Real>(std::span<SolverBody<Real>>, const GyroscopicInertia<Real>*,     \
                                  Real);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
