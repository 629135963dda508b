// Exact hull: the hull of points as triangles, with every decision made in integers.
//
// The points are rounded to a grid of 2^40 steps, fine enough that nobody will miss the rest and
// coarse enough that the side of a plane a grid point is on comes out exactly in 128 bits. What is
// built is therefore convex, closed and of one piece, whatever the points.
#pragma once

#include "throng/math.hpp"

#include <array>
#include <span>
#include <vector>

namespace throng {

/// Triangles counter-clockwise seen from outside. Edge k runs from corner k to corner k + 1;
/// beyond[t][k] is the triangle on its other side.
struct TriangleHull {
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<std::array<std::uint32_t, 3>> adjacent;
};

/// A point on the grid; coordinates in [0, 2^40].
using GridPoint = std::array<std::int64_t, 3>;

/// Rounds points to a grid that spans their box, each axis on its own: flattening and stretching
/// change no hull.
std::vector<GridPoint> to_grid(std::span<const Vec3> points);

/// The hull of the points named in chosen. The first four of them must not lie in one plane.
/// Points on faces or edges are left out, unless they were corners before the face grew round them.
TriangleHull exact_hull(std::span<const GridPoint> points, std::span<const std::uint32_t> chosen);

}  // namespace throng
