// Hull: the smallest convex polyhedron round some points, with polygons for faces.
//
// The same points in the same order give the same hull to the last bit. Everything is relative to
// the extent of the points: a hull of 1e-6 m and one of 1e6 m are built alike, and so are needles
// and plates a million times longer than thick.
#pragma once

#include "kernels/data/shapes.hpp"

#include <span>
#include <string>

namespace throng {

struct HullResult {
    Hull hull;            // every field filled; empty where there is trouble
    std::string trouble;  // empty, or what is wrong and what is wanted
};

/// Builds the hull of the points.
///
/// Points inside, repeated, on an edge or on a face are left out, and so are those that stick out
/// of the rest by less than a hundred-thousandth of the extent (a thousandth of the thickness,
/// where that is less). Faces that lie in one plane by the same measure become one polygon. The
/// plane of a face touches the vertex farthest along its normal: no vertex is above it by more than
/// rounding, 1e-14 of the extent or of the farthest coordinate, where that is more.
///
/// Trouble reads on from the name of what was asked for: "points lie in one plane; give points
/// that enclose a volume".
HullResult build_hull(std::span<const Vec3> points);

}  // namespace throng
