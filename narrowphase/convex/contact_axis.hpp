// Contact axis: the direction along which two convex cores are furthest apart, or least deep.
#pragma once

#include "kernels/geometry/gjk.hpp"

namespace throng {

/// The direction in which two cores are furthest apart, or least deep in one another.
///
///   normal      unit, from a to b, in a's frame
///   separation  m, of the cores along it
///   on_a, on_b  the points of the cores that are this near
struct ContactAxis {
    Vec3 normal = Vec3::UnitZ();
    double separation = 0;
    Vec3 on_a = Vec3::Zero(), on_b = Vec3::Zero();
};

/// Finds the axis by GJK, and by EPA where the cores touch or overlap; false where they are further
/// apart than the limit.
///
/// What comes of the search is then held against the exact directions that the shapes offer near
/// it: face normals, and the square sides of cylinders.
bool search_axis(const ConvexCorePair& pair, double limit, ContactAxis& axis);

/// The same, with the few likely directions tried first (likely_axes.hpp).
bool contact_axis(const ConvexCorePair& pair, double limit, ContactAxis& axis);

}  // namespace throng
