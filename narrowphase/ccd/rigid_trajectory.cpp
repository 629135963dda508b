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
    if (turn.isZero(0)) return {begin.position + time * shift, begin.orientation};
    return {begin.position + time * shift, exponential(time * turn) * begin.orientation};
}

RigidTrajectory trajectory_between(const Pose& from, const Pose& to, const Vec3& turn_near)
{
    RigidTrajectory trajectory{from, to.position - from.position, Vec3::Zero()};
    Quat change = to.orientation * from.orientation.conjugate();
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

}  // namespace throng
