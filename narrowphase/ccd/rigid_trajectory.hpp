// Rigid trajectory: a body's way through a step, at constant velocity, as it spins at one constant
// rate about an axis of its own and turns at another about one of the world: as a free top does.
#pragma once

#include "kernels/data/bodies.hpp"

namespace throng {

/// Where a body is at each time from 0 to 1.
///
///   begin  its pose at time 0, of the point that it turns about
///   shift  m, the way of that point until time 1
///   turn   the rotation vector of its turn until time 1, world axes; of any length
///   spin   the same, body axes: what it turns first
struct RigidTrajectory {
    Pose begin;
    Vec3 shift = Vec3::Zero(), turn = Vec3::Zero(), spin = Vec3::Zero();

    Pose at(double time) const;
    /// rad a unit of time, world axes.
    Vec3 angular_velocity(double time) const;
    /// rad, that it turns by on all of its way at most, and no faster.
    double angle() const { return turn.norm() + spin.norm(); }
    /// rad / time^2, that its angular velocity changes by at most.
    double angular_acceleration() const { return turn.norm() * spin.norm(); }
    bool turns() const { return !turn.isZero(0) || !spin.isZero(0); }
    bool still() const { return shift.isZero(0) && !turns(); }
};

/// The sweep that takes a body from one pose to another: of the turns that do so the one nearest to
/// a rotation vector, which is that of the body's angular velocity. Both orientations of unit
/// length. Without functions of the C library, so that it is the same bits everywhere.
///
///   spin  of it, body axes: what the body is known to spin by besides
RigidTrajectory trajectory_between(const Pose& from,
                                   const Pose& to,
                                   const Vec3& turn_near,
                                   const Vec3& spin = Vec3::Zero());

/// rad, as far as a body may turn and is taken to do so about an axis that stays where it is.
inline constexpr double kSteadily = 1;

/// How far beyond its ends a body's way may take any point of it, of how far that is from where the
/// body turns about, where it turns by about this angle, rad.
inline double beyond_ends(double angle) { return angle > kSteadily ? 2 : angle; }

/// Of a body that went there by itself and turned by about `turn`, world axes.
/// What turns far in a step turns about an axis that goes itself: a needle about its own, which
/// tips over meanwhile as it would by itself.
RigidTrajectory trajectory_of(
    const Masses& masses, std::size_t body, const Pose& from, const Pose& to, const Vec3& turn);

}  // namespace throng
