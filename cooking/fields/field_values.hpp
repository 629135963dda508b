// Field values: a signed distance spread from values near a surface to all that a solid needs.
//
// What is known to begin with are the values within about two voxels of the surface; from there
// each finds its nearest triangle by way of its neighbors. All is throng's own arithmetic, and no
// value depends on threads.
#pragma once

#include "kernels/data/solids.hpp"

#include <span>

namespace throng {

/// A value near the surface, by its place on the grid.
///
///   guess  m, no less than how far it is, but for a hundredth of a voxel; below 0 inside where the
///          sign is given
struct FieldSeed {
    std::array<std::int32_t, 3> at{};
    float guess = 0;
};

/// What of a seed is kept.
enum class SeedRule : std::uint8_t {
    distance,  // neither: distance and sign are worked out; the mesh is closed and cuts itself not
    sign,      // the sign; the distance is worked out
    sheet,     // neither: the distance is worked out, and nothing is inside
    value      // the guess as it is
};

/// How deep values are worked out by search. Deeper ones take the nearest of the triangles that
/// their neighbors are nearest to: never less than the true depth, and hardly more.
inline constexpr double kSearchedVoxels = 4;

/// Fills laid bricks: seeds first, then outward to the band and inward all the way.
///
///   laid   see lay_bricks()
///   seeds  every value of the grid within a voxel of the surface, each once; inside the grid
VoxelBricks fill_bricks(const Mesh& mesh,
                        const VoxelBricks& laid,
                        std::span<const FieldSeed> seeds,
                        SeedRule rule);

/// How many of the stored values are inside.
std::size_t count_inside(const VoxelBricks& bricks);

/// The greatest distance that two values of opposite sign next to each other have between them, m:
/// about a voxel at the most where a surface parts them, more where the inside leaks out of a hole.
/// Infinite where the inside reaches the end of the grid.
double widest_separation(const VoxelBricks& bricks);

}  // namespace throng
