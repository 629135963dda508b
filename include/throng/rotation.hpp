// Rotation: turning by a vector or by an angular velocity, the same bits with every C library.
#pragma once

#include "throng/math.hpp"

namespace throng {

struct SinCos {
    double sin = 0, cos = 1;
};

/// Sine and cosine of an angle in radians, within 2.5 units in the last place for |angle| < 1e5
/// (next to a multiple of a quarter turn within 1e-16). Further out they are those of an angle
/// nearby, on the circle all the same. The same bits on every machine.
///
/// Source: quarter-turn reduction in three parts after Cody and Waite (1980); polynomials as in
///         Sun's fdlibm (1993).
SinCos sin_cos(double angle);

/// The rotation by a vector: its direction is the axis, its length the angle in radians.
Quat exponential(const Vec3& turn);

/// The orientation after turning at a constant angular velocity (world axes, rad/s) for a time.
/// Exact for a constant velocity, however fast; the result is of unit length.
Quat turned(const Quat& orientation, const Vec3& angular_velocity, double time);

}  // namespace throng
