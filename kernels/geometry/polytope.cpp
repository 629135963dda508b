#include "kernels/geometry/polytope.hpp"

#include "kernels/check.hpp"
#include "kernels/geometry/hill_climbing.hpp"

#include <algorithm>

namespace throng {
namespace {

// Faces -x +x -y +y -z +z, each counter-clockwise seen from outside.
constexpr std::array<std::uint32_t, 7> kBoxFaceBegin = {0, 4, 8, 12, 16, 20, 24};
// clang-format off
constexpr std::array<std::uint16_t, 24> kBoxFaceVertices = {
    0, 4, 6, 2,  1, 3, 7, 5,
    0, 1, 5, 4,  2, 6, 7, 3,
    0, 2, 3, 1,  4, 5, 7, 6};
constexpr std::array<Hull::Edge, 12> kBoxEdges = {{
    {0, 4, 0, 2}, {4, 6, 0, 5}, {6, 2, 0, 3}, {2, 0, 0, 4},
    {1, 3, 1, 4}, {3, 7, 1, 3}, {7, 5, 1, 5}, {5, 1, 1, 2},
    {0, 1, 2, 4}, {5, 4, 2, 5}, {6, 7, 3, 5}, {3, 2, 3, 4}}};
constexpr std::array<std::uint32_t, 9> kBoxNeighborBegin = {0, 3, 6, 9, 12, 15, 18, 21, 24};
constexpr std::array<std::uint16_t, 24> kBoxNeighbors = {
    1, 2, 4,  0, 3, 5,  0, 3, 6,  1, 2, 7,
    0, 5, 6,  1, 4, 7,  2, 4, 7,  3, 5, 6};
// clang-format on

const std::array<Vec3, 6>& box_normals()
{
    static const std::array<Vec3, 6> normals = {-Vec3::UnitX(), Vec3::UnitX(),  -Vec3::UnitY(),
                                                Vec3::UnitY(),  -Vec3::UnitZ(), Vec3::UnitZ()};
    return normals;
}

constexpr std::array<std::uint32_t, 6> kTriangleFaceBegin = {0, 3, 6, 6, 6, 6};
constexpr std::array<std::uint16_t, 6> kTriangleFaceVertices = {0, 1, 2, 0, 2, 1};
constexpr std::array<Hull::Edge, 6> kTriangleEdges = {
    {{0, 1, 0, 2}, {0, 1, 2, 1}, {1, 2, 0, 3}, {1, 2, 3, 1}, {2, 0, 0, 4}, {2, 0, 4, 1}}};

}  // namespace

PolytopeView view_of(const Hull& hull)
{
    return {hull.vertices,      hull.normals,      hull.offsets,        hull.face_begin,
            hull.face_vertices, hull.edges,        hull.neighbor_begin, hull.neighbors,
            hull.center,        hull.inner_radius, hull.outer_radius,   &hull.guide};
}

BoxPolytope::BoxPolytope(const Vec3& half_extents)
    : inner_radius(half_extents.minCoeff()), outer_radius(half_extents.norm())
{
    for (std::size_t i = 0; i < 8; ++i) {
        vertices[i] = {i & 1 ? half_extents.x() : -half_extents.x(),
                       i & 2 ? half_extents.y() : -half_extents.y(),
                       i & 4 ? half_extents.z() : -half_extents.z()};
    }
    for (std::size_t i = 0; i < 6; ++i) offsets[i] = half_extents[static_cast<int>(i / 2)];
}

PolytopeView BoxPolytope::view() const
{
    return {vertices,         box_normals(), offsets,           kBoxFaceBegin,
            kBoxFaceVertices, kBoxEdges,     kBoxNeighborBegin, kBoxNeighbors,
            Vec3::Zero(),     inner_radius,  outer_radius};
}

TrianglePolytope::TrianglePolytope(const Vec3& v0,
                                   const Vec3& v1,
                                   const Vec3& v2,
                                   const Vec3& normal)
    : vertices{v0, v1, v2}, center((v0 + v1 + v2) / 3)
{
    normals[0] = normal;
    normals[1] = -normal;
    for (std::size_t e = 0; e < 3; ++e) {
        normals[2 + e] = (vertices[(e + 1) % 3] - vertices[e]).cross(normal).normalized();
        offsets[2 + e] = normals[2 + e].dot(vertices[e]);
        outer_radius = std::max(outer_radius, (vertices[e] - center).norm());
    }
    offsets[0] = normal.dot(v0);
    offsets[1] = -offsets[0];
}

PolytopeView TrianglePolytope::view() const
{
    return {
        vertices, normals, offsets, kTriangleFaceBegin, kTriangleFaceVertices, kTriangleEdges, {},
        {},       center,  0,       outer_radius};
}

std::uint16_t support_vertex(const PolytopeView& shape, const Vec3& direction, std::uint16_t start)
{
    HillClimbingCount count;
    return furthest_vertex_near(HillClimbingShape(shape), direction, start, count);
}

PolytopeShape::PolytopeShape(const Shapes& shapes, ShapeRef shape)
    : hull_(shape.kind == ShapeKind::hull ? &shapes.hulls[shape.index] : nullptr),
      box_(hull_ ? Vec3(Vec3::Zero()) : shapes.boxes[shape.index].half_extents)
{
    THRONG_CHECK(hull_ || shape.kind == ShapeKind::box, "boxes and hulls are polytopes");
}

}  // namespace throng
