// Rotation: inertia in world axes and the gyroscopic torque, beside the turning that is public.
#pragma once

#include "throng/rotation.hpp"

namespace throng {

/// The furthest that a shift and a turn about the origin can take a point within a radius of it:
/// one at radius r is turned by 2 r sin(angle / 2).
template <class Real>
Real furthest_moved(const Vec3T<Real>& shift, const QuatT<Real>& turn, Real radius)
{
    return shift.norm() + 2 * turn.vec().norm() * radius;
}

/// An inertia tensor (or its inverse) given in body axes, in world axes. One that is the same about
/// every axis stays as it is, to the last bit.
Sym3 in_world_axes(const Sym3& local, const Quat& orientation);

/// Angular velocity after the gyroscopic torque has acted for a time: one Newton step of Euler's
/// equation in body axes, which takes the torque of gyroscopic_theta() of the time, brought back to
/// the length that the angular momentum had or, where that is less, to the energy. So it gains
/// neither and, but where it turns by radians in that time, loses one of them at most, by third
/// order in time.
///
/// Source: Catto, Numerical Methods (GDC 2015), for a Newton step of implicit Euler, which this is
///         for fast spins.
Vec3 after_gyroscopic_torque(const Vec3& angular_velocity,
                             const Sym3& inertia_local,
                             const Quat& orientation,
                             double time);

/// The same for an angular velocity w in body axes, which it stays in.
Vec3 after_gyroscopic_torque_local(const Vec3& w, const Sym3& inertia, double time);

/// The same by explicit Euler: cheaper, and unstable when spinning fast.
Vec3 after_explicit_gyroscopic_torque(const Vec3& angular_velocity,
                                      const Sym3& inertia_local,
                                      const Quat& orientation,
                                      double time);

/// Likewise in body axes.
Vec3 after_explicit_gyroscopic_torque_local(const Vec3& w, const Sym3& inertia, double time);

}  // namespace throng
