// Surface separations: how near the surface of a solid is to another shape, triangle by triangle.
//
// Whatever way a solid is taken in contact, it keeps its triangles. Bodies that may not overlap are
// held by these: fields and images know a depth to within a voxel or a pixel, which is far more
// than how near to one another such bodies come.
#pragma once

#include "kernels/data/bounds.hpp"
#include "kernels/data/manifolds.hpp"
#include "kernels/data/shapes.hpp"
#include "kernels/geometry/mesh.hpp"
#include "narrowphase/convex/pair_input.hpp"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

namespace throng {

/// The most places that are told of a pair: those spread furthest over all that are within the
/// margin, the nearest among them.
inline constexpr std::size_t kMostSurfaceSeparations = 32;

/// Appends a manifold of one point for each place where the two come as near as anywhere about it,
/// out to the margin: of corners and faces, edges and edges, and whatever else sticks out to the
/// other. The corners of a face that leans by less than the margin all do. In the solid's frame,
/// normals from it to the other. Where the surfaces cross, places of separations below 0: by what
/// is behind what, and where that is more than the two solids' errors twice over, what
/// collide_solid() has of them. Returns how many pairs of triangles it held against one another; of
/// a plane, how many corners touch. Never throws.
///
///   in  a: solid, and what it is in contact is left aside, but for that; b: solid, or mesh (its
///       front), taken by triangles; or a plane
std::size_t find_surface_separations(const PairInput<double>& in,
                                     std::vector<LocalManifold<double>>& out);

/// Whether one of two triangles lies further than `wide` to one side of the other's plane: the two
/// are as far apart then. Normals of unit length.
inline bool beside_plane(const Vec3& normal,
                         const std::array<Vec3, 3>& corners,
                         const std::array<Vec3, 3>& others,
                         double wide)
{
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (const Vec3& other : others) {
        const double height = normal.dot(other - corners[0]);
        least = std::min(least, height);
        most = std::max(most, height);
    }
    return least > wide || most < -wide;
}

/// Visits the pairs of triangles of two meshes whose boxes are reached, as are those of all that
/// holds them. Always in the same order.
///
///   reached  (box in a's axes, box in b's axes) -> bool
///   visit    (triangle of a, triangle of b)
template <class Reached, class Visitor>
void visit_triangle_pairs(const Mesh& a, const Mesh& b, Reached reached, Visitor visit)
{
    std::vector<std::pair<std::uint32_t, std::uint32_t>> waiting;
    if (!a.tree.empty() && !b.tree.empty()) waiting.emplace_back(0, 0);
    const auto box = [](const Mesh::Node& node) { return Box3{node.lower, node.upper}; };
    const auto size = [](const Mesh::Node& node) {
        return (node.upper - node.lower).squaredNorm();
    };
    while (!waiting.empty()) {
        const auto [at_a, at_b] = waiting.back();
        waiting.pop_back();
        const Mesh::Node &p = a.tree[at_a], &q = b.tree[at_b];
        if (!reached(box(p), box(q))) continue;
        const bool leaf_p = p.count > 0, leaf_q = q.count > 0;
        if (leaf_p && leaf_q) {
            for (std::uint32_t i = p.first; i < p.first + p.count; ++i)
                for (std::uint32_t k = q.first; k < q.first + q.count; ++k)
                    if (reached(triangle_box(a, a.order[i]), triangle_box(b, b.order[k])))
                        visit(a.order[i], b.order[k]);
        } else if (leaf_q || (!leaf_p && size(p) >= size(q))) {
            waiting.emplace_back(p.first + 1, at_b);
            waiting.emplace_back(p.first, at_b);
        } else {
            waiting.emplace_back(at_a, q.first + 1);
            waiting.emplace_back(at_a, q.first);
        }
    }
}

}  // namespace throng
