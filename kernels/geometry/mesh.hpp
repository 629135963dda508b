// Mesh: triangles that were made ready for contact, looked into down their tree.
#pragma once

#include "kernels/data/bounds.hpp"
#include "kernels/data/k_dop.hpp"
#include "kernels/data/shapes.hpp"

#include <array>
#include <span>

namespace throng {

/// In convex_edges, of a triangle from which a rim can be reached: it has two sides. What has none
/// encloses a volume, behind its triangles.
inline constexpr std::uint8_t kOpenPiece = 64;

/// Whether every edge has a triangle beyond it, so that the mesh encloses a volume.
bool is_closed(const Mesh& mesh);

Box3 triangle_box(const Mesh& mesh, std::uint32_t triangle);

/// Of a mesh with triangles: the box round it, and that box's longest side.
Box3 box_of(const Mesh& mesh);
double longest_side(const Mesh& mesh);

/// The triangles of a mesh or a solid; null for other kinds.
const Mesh* mesh_of(const Shapes& shapes, ShapeRef shape);

/// Nodes that wait while a tree is walked. A child holds at most three quarters of its parent's
/// triangles: 64 levels are 2^26 triangles.
inline constexpr std::size_t kMostWaiting = 96;

/// Visits all triangles of those nodes of the tree that are reached, as are all above them. The
/// order is that of the tree: sort where it matters.
template <class Reached, class Visitor>
void visit_nodes(const Mesh& mesh, Reached reached, Visitor visit)
{
    std::array<std::uint32_t, kMostWaiting> waiting;
    std::size_t count = 0;
    if (!mesh.tree.empty()) waiting[count++] = 0;
    while (count > 0) {
        const Mesh::Node& node = mesh.tree[waiting[--count]];
        if (!reached(node)) continue;
        if (node.count == 0) {
            waiting[count++] = node.first + 1;
            waiting[count++] = node.first;
        }
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) visit(mesh.order[i]);
    }
}

/// Visits the triangles whose boxes overlap the given one, in mesh axes, in the order of the tree.
template <class Visitor>
void visit_triangles(const Mesh& mesh, const Box3& box, Visitor visit)
{
    visit_nodes(
        mesh,
        [&](const Mesh::Node& node) {
            return box.overlaps({node.lower, node.upper});
        },
        [&](std::uint32_t triangle) {
            if (box.overlaps(triangle_box(mesh, triangle))) visit(triangle);
        });
}

/// Makes the small boxes of a mesh that has its tree.
void add_small_boxes(Mesh& mesh);

/// Appends the triangles whose boxes overlap the given one, in mesh axes, in ascending order.
void find_triangles(const Mesh& mesh, const Box3& box, std::vector<std::uint32_t>& found);

/// One of several searches.
///
///   mesh, box  as of find_triangles()
///   found      what it answers
///   waiting    nodes yet to look at, while it runs
struct TriangleSearch {
    const Mesh* mesh = nullptr;
    Box3 box;
    std::vector<std::uint32_t> found;
    Mesh::SmallBox small;
    std::array<std::uint32_t, kMostWaiting> waiting{};
    std::size_t count = 0;
};

/// Answers each as find_triangles() does, step by step in turn: while one waits for memory the
/// others go on.
void find_triangles(std::span<TriangleSearch> searches);

/// Puts k-DOPs round the nodes of the tree, besides their boxes. k of 14, 18 or 26.
void bound_by_k_dops(Mesh& mesh, int k);

/// Of the triangles that find_triangles() finds, those within `speculative_margin` m of the k-DOP
/// in each of its slabs. Needs the mesh's k-DOPs, and as many sides.
void find_triangles(const Mesh& mesh,
                    const Box3& box,
                    const KDop& k_dop,
                    double speculative_margin,
                    std::vector<std::uint32_t>& found);

}  // namespace throng
