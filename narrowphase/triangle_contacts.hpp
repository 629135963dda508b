// Triangle contacts: one triangle of a mesh against a convex shape.
//
// A triangle pushes along directions that the mesh as a whole sticks out to: its own normal always,
// others only at edges and corners that are really there. A shape that slides over a seam between
// triangles therefore never meets the rim of the next one.
#pragma once

#include "kernels/data/manifolds.hpp"
#include "narrowphase/polytope.hpp"

namespace throng {

struct MeshTriangle {
    MeshTriangle(const Mesh& of, std::uint32_t triangle);

    const Mesh& mesh;
    std::uint32_t index;
    std::array<Vec3, 3> corners;
    Vec3 normal;

    double height(const Vec3& point) const { return normal.dot(point - corners[0]); }
};

/// Whether no point of the triangles round this corner lies further along `direction` (unit) than
/// the corner does.
bool corner_sticks_out(const MeshTriangle& triangle, std::size_t corner, const Vec3& direction);

/// The same for an edge, and the edge is one that sticks out at all. Edges as in Mesh.
bool edge_sticks_out(const MeshTriangle& triangle, std::size_t edge, const Vec3& direction);

/// Where the triangle touches a ball, or a segment thickened by radius, or a polytope, out to
/// `reach`; in the mesh's frame, normals from the triangle to the shape. Nothing while the shape's
/// center is behind the triangle.
void touch_ball(const MeshTriangle& triangle,
                const Vec3& center,
                double radius,
                double reach,
                LocalManifold<double>& out);
void touch_rod(const MeshTriangle& triangle,
               const Vec3& from,
               const Vec3& to,
               double radius,
               double reach,
               LocalManifold<double>& out);
void touch_polytope(const MeshTriangle& triangle,
                    const PolytopeView& shape,
                    const Pose& pose,
                    double reach,
                    LocalManifold<double>& out);

}  // namespace throng
