// Triangle contacts: one triangle of a mesh against a convex shape.
//
// A triangle pushes along directions that the mesh as a whole sticks out to: its own normal always,
// others only at edges and corners that are really there. A shape that slides over a seam between
// triangles therefore never meets the rim of the next one.
#pragma once

#include "kernels/data/manifolds.hpp"
#include "kernels/geometry/polytope.hpp"

namespace throng {

/// A triangle as seen from in front, or from behind: wound the other way then, and so are all round
/// it. Corners and edges are numbered as they are seen.
struct MeshTriangle {
    MeshTriangle(const Mesh& of, std::uint32_t triangle, bool from_behind = false);

    const Mesh& mesh;
    std::uint32_t index;
    bool behind;
    std::array<Vec3, 3> corners;
    Vec3 normal;

    double height(const Vec3& point) const { return normal.dot(point - corners[0]); }
    /// Whether the segment between two points goes through it.
    bool is_crossed(const Vec3& from, const Vec3& to) const;
    /// The place in the mesh's own arrays.
    std::size_t own_corner(std::size_t corner) const { return behind ? (3 - corner) % 3 : corner; }
    std::size_t own_edge(std::size_t edge) const { return behind ? 2 - edge : edge; }
    /// Over an edge; -1 at a rim.
    std::int32_t adjacent(std::size_t edge) const { return mesh.adjacent[index][own_edge(edge)]; }
    bool is_convex(std::size_t edge) const
    {
        return (mesh.convex_edges[index] >> (own_edge(edge) + (behind ? 3 : 0)) & 1) != 0;
    }
    /// Whether the mesh bends up there.
    bool is_concave(std::size_t edge) const
    {
        return (mesh.convex_edges[index] >> (own_edge(edge) + (behind ? 0 : 3)) & 1) != 0
            && adjacent(edge) >= 0;
    }
    bool has_concave_edge() const { return is_concave(0) || is_concave(1) || is_concave(2); }
    Vec3 normal_of(std::int32_t other) const
    {
        const Vec3& own = mesh.normals[static_cast<std::size_t>(other)];
        return behind ? Vec3(-own) : own;
    }
};

/// Whether no point of the triangles round this corner lies further along `direction` (unit) than
/// the corner does; where they are as good as level with it, by more than `slack` (m).
bool corner_sticks_out(const MeshTriangle& triangle,
                       std::size_t corner,
                       const Vec3& direction,
                       double slack = 0);

/// The same for an edge, and the edge is one that sticks out at all. Edges as in Mesh.
bool edge_sticks_out(const MeshTriangle& triangle,
                     std::size_t edge,
                     const Vec3& direction,
                     double slack = 0);

/// Where the triangle touches a ball, or a segment thickened by radius, or a polytope, out to
/// `speculative_margin`; in the mesh's frame, normals from the triangle to the shape. Nothing while
/// the shape's center is behind the triangle, unless it is known to have come `through`.
void collide_triangle_ball(const MeshTriangle& triangle,
                           const Vec3& center,
                           double radius,
                           double speculative_margin,
                           LocalManifold<double>& out,
                           bool through = false);
void collide_triangle_capsule(const MeshTriangle& triangle,
                              const Vec3& from,
                              const Vec3& to,
                              double radius,
                              double speculative_margin,
                              LocalManifold<double>& out,
                              bool through = false);
void collide_triangle_polytope(const MeshTriangle& triangle,
                               const PolytopeView& shape,
                               const Pose& pose,
                               double speculative_margin,
                               LocalManifold<double>& out,
                               bool through = false);

}  // namespace throng
