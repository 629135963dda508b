// Rigid trajectory: a body's way through a step, at constant velocity and constant angular
// velocity.
#pragma once

#include "throng/math.hpp"

namespace throng {

/// Where a body is at each time from 0 to 1.
///
///   begin  its pose at time 0, of the point that it turns about
///   shift  m, the way of that point until time 1
///   turn   the rotation vector of its turn until time 1, world axes; of any length
struct RigidTrajectory {
    Pose begin;
    Vec3 shift = Vec3::Zero(), turn = Vec3::Zero();

    Pose at(double time) const;
    bool still() const { return shift.isZero(0) && turn.isZero(0); }
};

/// The sweep that takes a body from one pose to another: of the turns that do so the one nearest to
/// a rotation vector, which is that of the body's angular velocity. Both orientations of unit
/// length. Without functions of the C library, so that it is the same bits everywhere.
RigidTrajectory trajectory_between(const Pose& from, const Pose& to, const Vec3& turn_near);

}  // namespace throng
