// Polygon cut: the triangles of a polygon that need not be convex.
#pragma once

#include "throng/math.hpp"

#include <array>
#include <span>

namespace throng {

/// Polygons of more corners are cut as fans whatever their form: the time of the cut grows with the
/// third power of their number.
inline constexpr std::size_t kMostCutCorners = 256;

/// Cuts a polygon into triangles that turn as it does and do not overlap. Where a fan about the
/// first corner does that it is a fan; else ears are cut off, the first in order each time. One
/// that has no ear (it cuts itself, or has no area) ends as a fan.
///
///   vertices   m
///   corners    places of at least 3 vertices, in order round the polygon
///   triangles  two fewer than corners
///
/// Source: Meisters, Polygons have ears (1975).
void cut_polygon(std::span<const Vec3> vertices,
                 std::span<const std::uint32_t> corners,
                 std::span<std::array<std::uint32_t, 3>> triangles);

}  // namespace throng
