// Hull faces: the triangles of a hull put together to polygons where they lie in one plane.
#pragma once

#include "cooking/hulls/exact_hull.hpp"

namespace throng {

/// A face: corners counter-clockwise seen from outside, and a plane that no corner of the hull is
/// above. It goes through the corner named by highest; its own are on it or below by the tolerance
/// at most.
struct HullFace {
    std::vector<std::uint32_t> corners;
    Vec3 normal;
    std::uint32_t highest;
};

/// Merges triangles, largest first, into faces that are convex polygons. A triangle that fits no
/// other is a face of its own. With a tolerance of 0 every triangle is.
///
///   points     of an extent of about 1
///   tolerance  how far a corner may be below its face's plane, or inside a straight edge
std::vector<HullFace>
merge_faces(std::span<const Vec3> points, const TriangleHull& hull, double tolerance);

}  // namespace throng
