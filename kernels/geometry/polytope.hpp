// Polytope: boxes, hulls and triangles seen alike, as vertices, faces and edges.
//
// What is looked at here is double whatever the number type of the pair: hulls are stored so.
#pragma once

#include "kernels/data/shapes.hpp"

#include <array>
#include <span>

namespace throng {

/// A convex polyhedron, owned by somebody else; the arrays are those of Hull.
struct PolytopeView {
    std::span<const Vec3> vertices;
    std::span<const Vec3> normals;
    std::span<const double> offsets;
    std::span<const std::uint32_t> face_begin;
    std::span<const std::uint16_t> face_vertices;
    std::span<const Hull::Edge> edges;
    std::span<const std::uint32_t> neighbor_begin;  // may be empty: every vertex is then looked at
    std::span<const std::uint16_t> neighbors;
    Vec3 center = Vec3::Zero();
    double inner_radius = 0;
    double outer_radius = 0;
    const HullGuide* guide = nullptr;  // of a hull
    // A prism that stands for a cylinder about z: its sides are one round side, which shows no more
    // than a line.
    bool round = false;

    bool is_round_side(std::size_t index) const { return round && normals[index].z() == 0; }
    std::span<const std::uint16_t> face(std::size_t index) const
    {
        return face_vertices.subspan(face_begin[index], face_begin[index + 1] - face_begin[index]);
    }
};

PolytopeView view_of(const Hull& hull);

/// The numbers of a box as a polytope; the topology is the same for all. Keep it while the view
/// lives.
struct BoxPolytope {
    explicit BoxPolytope(const Vec3& half_extents);
    PolytopeView view() const;

    std::array<Vec3, 8> vertices;  // bit i of the index: coordinate i is positive
    std::array<double, 6> offsets;
    double inner_radius = 0, outer_radius = 0;
};

/// A triangle as a prism of no height, counter-clockwise seen from outside.
///
/// Faces: 0 front, 1 back, 2 + e the rim at edge e (no corners: a normal alone). Edges: 2e between
/// the front and rim e, 2e + 1 between the rim and the back; e counts 0-1, 1-2, 2-0.
struct TrianglePolytope {
    TrianglePolytope(const Vec3& v0, const Vec3& v1, const Vec3& v2, const Vec3& normal);
    PolytopeView view() const;

    std::array<Vec3, 3> vertices;
    std::array<Vec3, 5> normals;
    std::array<double, 5> offsets;
    Vec3 center;
    double outer_radius = 0;
};

/// Index of the vertex furthest along `direction`, the first of those that tie.
///
///   start   where to begin climbing; changes the time, not the distance found
std::uint16_t support_vertex(const PolytopeView& shape, const Vec3& direction, std::uint16_t start);

/// A box or a hull of the world, as a polytope. Keep it while the view is in use.
class PolytopeShape {
public:
    PolytopeShape(const Shapes& shapes, ShapeRef shape);
    PolytopeView view() const { return hull_ ? view_of(*hull_) : box_.view(); }

private:
    const Hull* hull_;
    BoxPolytope box_;
};

}  // namespace throng
