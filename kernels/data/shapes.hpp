// Shapes: what bodies are made of. One closed set of kinds; one array a kind.
//
// A ShapeRef names a shape by kind and place in its array, so that a million boxes of different
// sizes cost 24 bytes each. Hulls and meshes are shared by all bodies that use them.
#pragma once

#include "kernels/data/hull_guide.hpp"
#include "kernels/data/solids.hpp"
#include "kernels/data/wide_hull.hpp"
#include "throng/math.hpp"

#include <array>
#include <vector>

namespace throng {

enum class ShapeKind : std::uint8_t {
    sphere,
    capsule,
    cylinder,
    box,
    hull,
    plane,
    mesh,
    triangle,
    solid
};
inline constexpr int kShapeKinds = 9;

struct ShapeRef {
    ShapeKind kind = ShapeKind::sphere;
    std::uint32_t index = 0;
    bool operator==(const ShapeRef&) const = default;
};

struct Sphere {
    double radius = 0;
};

/// A segment along z of twice half_length, thickened by radius.
struct Capsule {
    double radius = 0, half_length = 0;
};

/// Axis z, flat ends at -half_length and +half_length.
struct Cylinder {
    double radius = 0, half_length = 0;
};

struct Box {
    Vec3 half_extents = Vec3::Zero();
};

/// The points with normal . x <= offset are solid. The normal is of unit length.
struct Plane {
    Vec3 normal = Vec3::UnitZ();
    double offset = 0;
};

/// A convex polyhedron with polygons for faces. Vertices, faces and edges are in an order that
/// depends on the input points alone.
///
///   face_begin  [faces + 1]  where a face's corners begin in face_vertices
///   face_vertices            corners of all faces, counter-clockwise seen from outside
///   edges                    each edge once, as (from, to, left face, right face): seen from
///                            outside the left face runs from -> to, the right face to -> from
///   neighbor_begin, neighbors  vertices joined to a vertex by an edge (for hill climbing)
struct Hull {
    struct Edge {
        std::uint16_t from, to, left, right;
    };
    std::vector<Vec3> vertices;
    std::vector<Vec3> normals;    // [faces] unit, outward
    std::vector<double> offsets;  // [faces] normal . x of the face's plane
    std::vector<std::uint32_t> face_begin;
    std::vector<std::uint16_t> face_vertices;
    std::vector<Edge> edges;
    std::vector<std::uint32_t> neighbor_begin;
    std::vector<std::uint16_t> neighbors;
    Vec3 center = Vec3::Zero();  // a point well inside (the centroid)
    double inner_radius = 0;     // of a ball about center inside the hull
    double outer_radius = 0;     // of a ball about center round the hull
    WideHull wide;               // the same in float; made by widen()
    HullGuide guide;             // to where its furthest vertices are; made by make_guide()
};

/// All shapes of a world.
struct Shapes {
    std::vector<Sphere> spheres;
    std::vector<Capsule> capsules;
    std::vector<Cylinder> cylinders;
    std::vector<Box> boxes;
    std::vector<Hull> hulls;
    std::vector<Plane> planes;
    std::vector<Mesh> meshes;
    std::vector<Solid> solids;
};

}  // namespace throng
