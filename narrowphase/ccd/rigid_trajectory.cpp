#include "narrowphase/ccd/rigid_trajectory.hpp"

#include "kernels/math/rotation.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

constexpr double kWholeTurn = 6.28318530717958647692;

// The angle from 0 to half a turn whose half has this sine and cosine, both at least 0.
double angle_of(double sine, double cosine)
{
    // Off by at most a tenth of a radian; each round leaves a sixth of the error's cube.
    const double smaller = std::min(sine, cosine), greater = std::max(sine, cosine);
    const double guess = smaller / greater * (1 - 0.25 * smaller / greater);
    double half = sine <= cosine ? guess : kWholeTurn / 4 - guess;
    for (int round = 0; round < 4; ++round) {
        const SinCos at = sin_cos(half);
        half += sine * at.cos - cosine * at.sin;
    }
    return 2 * half;
}

}  // namespace

Pose RigidTrajectory::at(double time) const
{
    Quat orientation = begin.orientation;
    if (!spin.isZero(0)) orientation = orientation * exponential(time * spin);
    if (!turn.isZero(0)) orientation = exponential(time * turn) * orientation;
    return {begin.position + time * shift, orientation};
}

Vec3 RigidTrajectory::angular_velocity(double time) const
{
    // A spin leaves its own axis where it is.
    return spin.isZero(0) ? turn
                          : Vec3(turn + exponential(time * turn) * (begin.orientation * spin));
}

RigidTrajectory
trajectory_between(const Pose& from, const Pose& to, const Vec3& turn_near, const Vec3& spin)
{
    RigidTrajectory trajectory{from, to.position - from.position, Vec3::Zero(), spin};
    const Quat spun =
        spin.isZero(0) ? from.orientation : Quat(from.orientation * exponential(spin));
    Quat change = to.orientation * spun.conjugate();
    if (change.w() < 0) change.coeffs() = -change.coeffs();
    const double sine = change.vec().norm();
    // Below this an angle and its sine are the same, and there is no axis to turn further about.
    if (!(sine > 1e-8)) {
        trajectory.turn = 2 * change.vec();
        return trajectory;
    }
    const Vec3 axis = change.vec() / sine;
    const double angle = angle_of(sine, change.w());
    const double turns = std::nearbyint((axis.dot(turn_near) - angle) / kWholeTurn);
    trajectory.turn = (angle + turns * kWholeTurn) * axis;
    return trajectory;
}

// About where its momentum points and, at another rate, about its axis of symmetry: so a free top
// goes. Without such an axis: about what it spins about in the end, and by what is left besides.
RigidTrajectory trajectory_of(
    const Masses& masses, std::size_t body, const Pose& from, const Pose& to, const Vec3& turn)
{
    if (masses.gyroscopic_kind[body] == 0 || turn.squaredNorm() <= kSteadily * kSteadily)
        return trajectory_between(from, to, turn);
    const Vec3 own = to.orientation.conjugate() * turn;
    const Vec3& axis = masses.symmetry_axis[body];
    if (axis.isZero(0)) return trajectory_between(from, to, Vec3::Zero(), own);
    const Mat3 inertia = masses.inertia[body].matrix();
    const double along = axis.dot(inertia * axis), across = (inertia.trace() - along) / 2;
    const Vec3 spin = (1 - along / across) * own.dot(axis) * axis;
    return trajectory_between(from, to, turn - to.orientation * spin, spin);
}

}  // namespace throng
