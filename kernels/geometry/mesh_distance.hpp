// Mesh distance: how far a point is from a mesh, and on which side of it.
#pragma once

#include "kernels/data/mesh.hpp"
#include "kernels/geometry/closest_points.hpp"

#include <limits>

namespace throng {

/// The point of a mesh nearest to another. Of several as near, on the first triangle that the tree
/// came upon: the same on every run.
struct MeshPoint {
    double distance = std::numeric_limits<double>::infinity();  // m, infinite where none was found
    Vec3 point = Vec3::Zero();
    std::uint32_t triangle = 0;
    TriangleRegion region = TriangleRegion::face;
};

inline constexpr std::uint32_t kNoTriangle = std::numeric_limits<std::uint32_t>::max();

/// The nearest point of a mesh.
///
///   limit   m, what lies further away need not be found
///   beside  a triangle that is likely near, looked at first: the search is then shorter
MeshPoint nearest_on_mesh(const Mesh& mesh,
                          const Vec3& point,
                          double limit = std::numeric_limits<double>::infinity(),
                          std::uint32_t beside = kNoTriangle);

/// Whether anything of a mesh is no further from a point than this, m.
bool comes_within(const Mesh& mesh, const Vec3& point, double distance);

/// Fills in the mesh's vertex_normals: what it turns outward at its corners, the sum of the normals
/// that meet there, each weighed by the angle that its triangle takes.
///
/// Source: Baerentzen and Aanaes, Signed distance computation using the angle weighted pseudonormal
///         (2005), section 3.
void find_vertex_normals(Mesh& mesh);

/// What the mesh turns outward at a point of it: unit; of an edge the mean of both sides. Another
/// point whose nearest it is lies outside exactly if it is on that side. Needs vertex normals.
Vec3 outward_at(const Mesh& mesh, const MeshPoint& where);

/// The distance of a point from the mesh, below 0 inside.
/// The sign is right for closed meshes that do not cut themselves. Needs vertex normals.
double signed_distance(const Mesh& mesh, const Vec3& point, const MeshPoint& nearest);
double signed_distance(const Mesh& mesh, const Vec3& point);

}  // namespace throng
