// Orientation: the ways to write down how a body is turned, and to turn it on.
//
// Three take a change of rotation by the exponential map, which is exact for a constant angular
// velocity. Three are the textbook's: they add rates to the numbers themselves, and are here to
// show what that costs.
#pragma once

#include "throng/math.hpp"
#include "throng/settings.hpp"

#include <array>
#include <cstdint>

namespace throng {

/// A quaternion x, y, z, w; a rotation vector, rad; or a matrix, column after column.
using OrientationNumbers = std::array<double, 9>;

/// How many of them count.
int numbers_of(Rotation rotation);

/// True where the numbers themselves are integrated, false where a change of rotation is.
bool adds_rates(Rotation rotation);

OrientationNumbers write_orientation(Rotation rotation, const Quat& orientation);

/// The unit quaternion next to what is written.
Quat read_orientation(Rotation rotation, const double* numbers);

/// What turns body axes into world axes by the numbers as they are: no rotation where they have
/// strayed from one.
Mat3 matrix_of(Rotation rotation, const double* numbers);

/// Turns on by a vector in body axes, rad: the exponential map. A rotation vector is brought back
/// below half a turn, numbers that strayed by rounding are put right.
void turn_on(Rotation rotation, const Vec3& turn, double* numbers);

/// How fast the numbers change at an angular velocity in body axes, rad/s; for those that add
/// rates.
void rates_of(Rotation rotation, const double* numbers, const Vec3& velocity, double* rates);

/// After a step of adding rates: a quaternion is brought to unit length, a matrix that is repaired
/// to the nearest rotation; the other stays as it came out.
void repair(Rotation rotation, double* numbers);

/// The rate of the coordinates `turn` of a rotation exp(turn) that is turned on at an angular
/// velocity in body axes: the inverse of the exponential map's derivative, up to terms that an
/// integrator of fourth order needs.
///
/// Source: Iserles, Munthe-Kaas, Norsett & Zanna, Lie-group methods (2000), section 3.1.
Vec3 rate_of_turn(const Vec3& turn, const Vec3& velocity);

}  // namespace throng
