// Clip: a convex polygon cut by half-spaces, corner by corner.
//
// Each corner knows the line that its outgoing edge lies on: an edge of the polygon as it was
// given, or the plane of a cut. A corner is where two such lines meet, so the pair of them names it
// for as long as the same features touch, however the corner moves.
#pragma once

#include "throng/math.hpp"

#include <array>

namespace throng {

inline constexpr int kMaxCorners = 64;

/// A flat convex polygon in space. Lines have ids below 4096, unique within the polygon.
template <class Real>
struct Polygon {
    std::array<Vec3T<Real>, kMaxCorners> corners;
    std::array<std::uint16_t, kMaxCorners> lines;  // [count] of the edge that leaves the corner
    int count = 0;

    void add(const Vec3T<Real>& corner, std::uint16_t line)
    {
        corners[static_cast<std::size_t>(count)] = corner;
        lines[static_cast<std::size_t>(count)] = line;
        ++count;
    }
    /// Names the corner by the lines that meet in it; 24 bits.
    std::uint32_t corner_id(int corner) const
    {
        const int before = corner == 0 ? count - 1 : corner - 1;
        return std::uint32_t{lines[static_cast<std::size_t>(before)]} << 12
            | lines[static_cast<std::size_t>(corner)];
    }
};

/// Keeps the part of the polygon with normal . x <= offset.
///
///   slack   corners up to slack beyond the plane stay as they are, so that a corner on the plane
///           does not come and go with rounding; in units of normal . x
///   line    id of the plane, for the edge that the cut makes
///
/// A polygon that is full gives up the corner that bounds the least area.
template <class Real>
void cut(
    Polygon<Real>& polygon, const Vec3T<Real>& normal, Real offset, Real slack, std::uint16_t line);

}  // namespace throng
