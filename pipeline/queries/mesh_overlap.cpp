#include "pipeline/queries/mesh_overlap.hpp"

#include "cooking/repair/build_mesh.hpp"
#include "kernels/geometry/mesh.hpp"
#include "kernels/geometry/mesh_distance.hpp"

#include <algorithm>
#include <stdexcept>

namespace throng {

MeshOverlap::MeshOverlap(const MeshShape& a, const MeshShape& b)
    : a_(side_of(a)), b_(side_of(b)) { }

MeshOverlap::Side MeshOverlap::side_of(const MeshShape& shape)
{
    MeshResult built = build_mesh(shape.vertices, shape.triangles);
    if (!built.trouble.empty()) throw std::invalid_argument(built.trouble);
    Side side{std::move(built.mesh), {}};
    find_vertex_normals(side.mesh);
    side.points = side.mesh.vertices;
    for (const auto& triangle : side.mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t from = triangle[k], to = triangle[(k + 1) % 3];
            if (from > to) continue;  // the other triangle's turn
            const Vec3 start = side.mesh.vertices[from], way = side.mesh.vertices[to] - start;
            for (const double share : {0.25, 0.5, 0.75})
                side.points.emplace_back(start + share * way);
        }
    return side;
}

double MeshOverlap::depth_in(const Side& side, const Side& other, const Pose& other_in_side)
{
    const Box3 box = box_of(side.mesh);
    double depth = 0;
    for (const Vec3& point : other.points) {
        const Vec3 at = other_in_side.position + other_in_side.orientation * point;
        const bool near =
            (at.array() > box.lower.array()).all() && (at.array() < box.upper.array()).all();
        if (near) depth = std::max(depth, -signed_distance(side.mesh, at));
    }
    return depth;
}

double MeshOverlap::greatest(const Pose& b_in_a) const
{
    Pose a_in_b;
    a_in_b.orientation = b_in_a.orientation.conjugate();
    a_in_b.position = -(a_in_b.orientation * b_in_a.position);
    return std::max(depth_in(a_, b_, b_in_a), depth_in(b_, a_, a_in_b));
}

}  // namespace throng
