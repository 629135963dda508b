// Turn between: the least turn that takes one direction to another.
//
// Eigen's FromTwoVectors() asks a singular value decomposition where the two are opposite, which
// takes a file that calls it longer to compile than all the rest of it.
#pragma once

#include "throng/math.hpp"

namespace throng {

/// The least turn that takes the direction of one vector to that of another, to rounding; neither
/// is zero. Of opposite ones it is a half turn about an axis across them.
inline Quat turn_between(const Vec3& from, const Vec3& to)
{
    const Vec3 a = from.normalized(), b = to.normalized();
    const Vec3 sum = a + b;
    const double cosine = 0.5 * sum.norm(), sine = 0.5 * (a - b).norm();  // of half the angle
    // Across the sum rather than b: where they are nearly opposite, the sum has no rounding.
    const Vec3 across = cosine < 1e-15 ? a.unitOrthogonal() : a.cross(sum).normalized();
    const Vec3 axis = sine * across;
    return {cosine, axis.x(), axis.y(), axis.z()};
}

}  // namespace throng
