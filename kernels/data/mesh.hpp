// Mesh: triangles that know their neighbors, in a tree.
#pragma once

#include "kernels/data/k_dop.hpp"

#include <array>
#include <vector>

namespace throng {

/// Triangles (counter-clockwise seen from outside): what they enclose is solid, and pieces with a
/// rim have two sides.
///
/// beyond/convex_edges say of each edge (0: v0-v1, 1: v1-v2, 2: v2-v0) what lies over it, so that
/// contacts on internal edges take the normal of the surface and not of the triangle's rim.
struct Mesh {
    struct Node {  // binary tree over triangles, boxes in mesh axes
        Vec3 lower, upper;
        std::uint32_t first = 0;  // leaf: first in `order`; inner: left child; right is left + 1
        std::uint32_t count = 0;  // leaf: triangles; inner: 0
    };
    /// A box in single precision, rounded outward, in half a line of memory.
    ///
    ///   first, count  of a node as above; of a triangle its number, and 1
    struct SmallBox {
        std::array<float, 3> lower{};
        std::uint32_t first = 0;
        std::array<float, 3> upper{};
        std::uint32_t count = 0;
    };
    std::vector<Vec3> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<Vec3> normals;         // [triangles] unit
    std::vector<Vec3> vertex_normals;  // [vertices] unit; of solids alone: see mesh_distance.hpp
    std::vector<std::array<std::int32_t, 3>> adjacent;  // triangle over each edge, -1 at a rim
    std::vector<std::uint8_t> convex_edges;             // bit e set: edge e sticks out, or is a rim
    std::vector<Node> tree;                             // [0] is the root
    std::vector<std::uint32_t> order;
    std::vector<SmallBox> small_tree;   // [tree] the same
    std::vector<SmallBox> small_boxes;  // [order] of the triangles
    std::vector<KDop> k_dops;  // [tree] round the nodes, with `sides` each; empty: boxes alone
    int sides = 6;
};

}  // namespace throng
