// Build mesh: triangles made ready for contact: welded, joined to their neighbors, sorted into a
// tree.
#pragma once

#include "kernels/data/mesh.hpp"

#include <string>

namespace throng {

struct MeshResult {
    Mesh mesh;            // every field filled; empty where there is trouble
    std::string trouble;  // empty, or what is wrong and what is wanted
};

/// Welds vertices that are identical, leaves out those that no triangle uses and triangles of no
/// area, and fills in the rest. Vertices and triangles that remain keep their order.
///
///   beyond        the other triangle at an edge that exactly two share, run through in opposite
///                 directions; else -1
///   convex_edges  an edge that sticks out by more than a thousandth of a radian, or has no
///                 triangle beyond it; bit 3 + e, the same as seen from behind; kOpenPiece
MeshResult build_mesh(const std::vector<Vec3>& vertices,
                      std::vector<std::array<std::uint32_t, 3>> triangles);

}  // namespace throng
