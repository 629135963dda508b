// Mesh holes: where triangles are missing from a surface that is otherwise closed.
#pragma once

#include "throng/math.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace throng {

/// Of the area of the surface that it is in, the most that a hole is closed over. A box without its
/// lid lacks a fifth and a bowl half: such shapes are meant to be open.
inline constexpr double kGreatestHole = 1.0 / 20;

/// How many holes were closed, and the edges round the longest of them.
struct ClosedHoles {
    std::size_t count = 0;
    std::size_t longest = 0;
};

/// Closes each hole whose rim is a simple loop, all run through the same way, that is small against
/// the surface about it: by triangles that fan out from the middle of the rim, or by one alone.
/// Other rims are left as they are. Triangles are appended, and vertices for the middles.
///
/// Needs: identical vertices welded, and windings that agree over edges that two triangles share.
ClosedHoles close_holes(std::vector<Vec3>& vertices,
                        std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace throng
