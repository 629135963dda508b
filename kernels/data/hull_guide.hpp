// Hull guide: where to begin to look for a hull's furthest vertex, and how far from a highest one
// it is still worth looking.
#pragma once

#include "throng/math.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace throng {

/// Made once, with the hull; of no cells where there is none.
///
/// Directions are sorted into the cells of a cube's faces, `side` by `side` each.
///
///   toward         [6 side side] a vertex that is furthest, or nearly, in the middle of the cell
///   begin, links   as neighbor_begin and neighbors of Hull, with far corners of the same face
///                  added where faces have many; empty where none has
///   slack          m, by which a path over edges to the furthest vertex may have to descend first:
///                  corners of a face need not lie in one plane
struct HullGuide {
    std::uint32_t side = 0;
    std::vector<std::uint16_t> toward;
    std::vector<std::uint32_t> begin;
    std::vector<std::uint16_t> links;
    double slack = 0;

    /// The cell of a direction of any length; some cell for 0 and for what is not finite.
    std::size_t cell(const Vec3& direction) const
    {
        const double x = std::abs(direction.x()), y = std::abs(direction.y());
        const double z = std::abs(direction.z());
        const int axis = x >= y ? (x >= z ? 0 : 2) : (y >= z ? 1 : 2);
        const double scale = 0.5 * side / std::abs(direction[axis]);
        const double half = 0.5 * side, last = side - 1.0;
        // Written so that no number at all becomes 0.
        const auto place = [&](double part) {
            return static_cast<std::size_t>(std::min(std::max(0.0, part * scale + half), last));
        };
        const std::size_t face = 2 * static_cast<std::size_t>(axis) + (direction[axis] > 0 ? 1 : 0);
        return (face * side + place(direction[axis < 2 ? axis + 1 : 0])) * side
            + place(direction[axis > 0 ? axis - 1 : 2]);
    }
};

}  // namespace throng
