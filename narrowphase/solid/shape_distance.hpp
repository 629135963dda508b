// Shape distance: how far a point is from a convex shape or a plane, on either side, and the way
// out.
#pragma once

#include "kernels/data/shapes.hpp"

namespace throng {

/// distance: m, below 0 inside. outward: unit, along which it grows fastest; where several
/// directions tie (on an axis, at a center), one of them, the same on every run.
struct SurfaceDistance {
    double distance = 0;
    Vec3 outward = Vec3::UnitZ();
};

/// Of a point in the frame of a sphere, capsule, cylinder, box, hull or plane. Exact but for
/// rounding: outside to the nearest point of the surface, inside to the nearest face.
SurfaceDistance distance_to(const Shapes& shapes, ShapeRef shape, const Vec3& point);

}  // namespace throng
