// Mesh pairs: a convex shape against the triangles of a mesh that are near it.
//
// The arithmetic is double for either number type, as for hulls. A cylinder is seen as a prism of
// sixteen sides that keeps one of its edges turned to the triangle: what lies flat, stands or rolls
// is exact, and only an edge of the mesh under the curved side sees the prism's sides, two
// hundredths of the radius inside the cylinder.
#include "narrowphase/mesh/mesh_pairs.hpp"

#include "kernels/check.hpp"
#include "kernels/geometry/k_dop.hpp"
#include "kernels/geometry/mesh.hpp"
#include "kernels/geometry/shape_bounds.hpp"
#include "narrowphase/mesh/concave_edges.hpp"
#include "narrowphase/mesh/mesh_sides.hpp"
#include "narrowphase/mesh/triangle_contacts.hpp"

#include <algorithm>
#include <cmath>

namespace throng {
namespace {

constexpr std::size_t kSides = 16;

// Corners this part of the inner radius above the lowest are as low.
constexpr double kAsLow = 1e-3;

double length(double x, double y) { return std::sqrt(x * x + y * y); }

// Cosine and sine of the angles of a circle cut in 2 * kSides, by halving and adding angles.
std::array<Eigen::Vector2d, 2 * kSides> circle()
{
    const double cos8 = std::sqrt((1 + std::sqrt(0.5)) / 2), cos16 = std::sqrt((1 + cos8) / 2);
    const double sin16 = std::sqrt((1 - cos8) / 2);
    std::array<Eigen::Vector2d, 2 * kSides> points;
    points[0] = {1, 0};
    for (std::size_t i = 1; i < 2 * kSides; ++i) {
        const Eigen::Vector2d& last = points[i - 1];
        points[i] = {last.x() * cos16 - last.y() * sin16, last.x() * sin16 + last.y() * cos16};
    }
    return points;
}

// Sides 0-15, then the cap below and the cap above; vertices 0-15 below and 16-31 above.
struct PrismTopology {
    std::array<std::uint32_t, kSides + 3> face_begin{};
    std::array<std::uint16_t, 6 * kSides> face_vertices{};
    std::array<Hull::Edge, 3 * kSides> edges{};

    PrismTopology()
    {
        std::size_t at = 0;
        for (std::size_t i = 0; i < kSides; ++i) {
            const std::size_t next = (i + 1) % kSides;
            face_begin[i] = static_cast<std::uint32_t>(at);
            for (const std::size_t corner : {i, next, next + kSides, i + kSides}) {
                face_vertices[at++] = static_cast<std::uint16_t>(corner);
            }
            edges[3 * i] = edge(i, next, i, kSides);
            edges[3 * i + 1] = edge(next + kSides, i + kSides, i, kSides + 1);
            edges[3 * i + 2] = edge(next, next + kSides, i, next);
        }
        for (std::size_t cap = 0; cap < 2; ++cap) {
            face_begin[kSides + cap] = static_cast<std::uint32_t>(at);
            for (std::size_t i = 0; i < kSides; ++i) {
                const std::size_t corner = cap == 0 ? kSides - 1 - i : kSides + i;
                face_vertices[at++] = static_cast<std::uint16_t>(corner);
            }
        }
        face_begin[kSides + 2] = static_cast<std::uint32_t>(at);
    }

private:
    static Hull::Edge edge(std::size_t from, std::size_t to, std::size_t left, std::size_t right)
    {
        return {static_cast<std::uint16_t>(from), static_cast<std::uint16_t>(to),
                static_cast<std::uint16_t>(left), static_cast<std::uint16_t>(right)};
    }
};

struct Prism {
    std::array<Vec3, 2 * kSides> vertices;
    std::array<Vec3, kSides + 2> normals;
    std::array<double, kSides + 2> offsets;
    double inner_radius, outer_radius;

    // `towards` is a direction in the cylinder's frame that an edge of the prism is to look to.
    Prism(const Cylinder& cylinder, const Vec3& towards)
        : inner_radius(std::min(cylinder.radius, cylinder.half_length) * 0.98),
          outer_radius(length(cylinder.radius, cylinder.half_length))
    {
        static const std::array<Eigen::Vector2d, 2 * kSides> points = circle();
        // Standing upright, the way to turn would be noise: stay with the body then. A hundredth
        // keeps the rim's depth to 2e-4 of the radius.
        const double across = length(towards.x(), towards.y());
        const bool upright = across < 0.01;
        const double c = upright ? 1 : towards.x() / across, s = upright ? 0 : towards.y() / across;
        for (std::size_t i = 0; i < kSides; ++i) {
            const auto turned = [&](const Eigen::Vector2d& p) {
                return Vec3(c * p.x() - s * p.y(), s * p.x() + c * p.y(), 0);
            };
            const Vec3 corner = cylinder.radius * turned(points[2 * i]);
            vertices[i] = corner - Vec3(0, 0, cylinder.half_length);
            vertices[kSides + i] = corner + Vec3(0, 0, cylinder.half_length);
            normals[i] = turned(points[2 * i + 1]);
            offsets[i] = cylinder.radius * points[1].x();
        }
        normals[kSides] = -Vec3::UnitZ();
        normals[kSides + 1] = Vec3::UnitZ();
        offsets[kSides] = offsets[kSides + 1] = cylinder.half_length;
    }
    PolytopeView view() const
    {
        static const PrismTopology topology;
        return {vertices,       normals, offsets, topology.face_begin, topology.face_vertices,
                topology.edges, {},      {},      Vec3::Zero(),        inner_radius,
                outer_radius,   nullptr, true};
    }
};

void collide(const Shapes& shapes,
             ShapeRef shape,
             const MeshTriangle& triangle,
             const Pose& pose,
             double speculative_margin,
             bool through,
             LocalManifold<double>& out)
{
    out.count = 0;
    switch (shape.kind) {
    case ShapeKind::sphere:
        collide_triangle_ball(triangle, pose.position, shapes.spheres[shape.index].radius,
                              speculative_margin, out, through);
        return;
    case ShapeKind::capsule: {
        const Capsule& capsule = shapes.capsules[shape.index];
        const Vec3 half(0, 0, capsule.half_length);
        collide_triangle_capsule(triangle, pose * Vec3(-half), pose * half, capsule.radius,
                                 speculative_margin, out, through);
        return;
    }
    case ShapeKind::cylinder: {
        const Vec3 towards = pose.orientation.conjugate() * -triangle.normal;
        const Prism prism(shapes.cylinders[shape.index], towards);
        collide_triangle_polytope(triangle, prism.view(), pose, speculative_margin, out, through);
        return;
    }
    case ShapeKind::box:
    case ShapeKind::hull:
        collide_triangle_polytope(triangle, PolytopeShape(shapes, shape).view(), pose,
                                  speculative_margin, out, through);
        return;
    default:
        THRONG_CHECK(false, "a mesh collides with convex shapes of some volume");
    }
}

// The corners that are lowest over the triangle, four at most.
std::size_t lowest_corners(const PolytopeView& shape,
                           const MeshTriangle& triangle,
                           const Pose& pose,
                           std::array<Vec3, 4>& lowest)
{
    const Vec3 down = pose.orientation.conjugate() * -triangle.normal;
    double furthest = -std::numeric_limits<double>::infinity();
    for (const Vec3& vertex : shape.vertices) furthest = std::max(furthest, down.dot(vertex));
    std::size_t count = 0;
    for (const Vec3& vertex : shape.vertices)
        if (count < 4 && down.dot(vertex) > furthest - kAsLow * shape.inner_radius)
            lowest[count++] = pose * vertex;
    return count;
}

// Of a shape that has nothing over the triangle.
void collide_ahead(const Shapes& shapes,
                   ShapeRef shape,
                   const MeshTriangle& triangle,
                   const Pose& pose,
                   double speculative_margin,
                   LocalManifold<double>& out)
{
    if (!triangle.has_concave_edge()) return;
    std::array<Vec3, 4> points;
    std::size_t count = 0;
    double radius = 0;
    switch (shape.kind) {
    case ShapeKind::sphere:
        radius = shapes.spheres[shape.index].radius;
        points[count++] = pose.position;
        break;
    case ShapeKind::capsule: {
        const Capsule& capsule = shapes.capsules[shape.index];
        const Vec3 half(0, 0, capsule.half_length);
        radius = capsule.radius;
        points[count++] = pose * Vec3(-half);
        points[count++] = pose * half;
        break;
    }
    case ShapeKind::cylinder: {
        const Vec3 towards = pose.orientation.conjugate() * -triangle.normal;
        const Prism prism(shapes.cylinders[shape.index], towards);
        count = lowest_corners(prism.view(), triangle, pose, points);
        break;
    }
    default:
        count = lowest_corners(PolytopeShape(shapes, shape).view(), triangle, pose, points);
    }
    add_points_ahead(triangle, {points.data(), count}, radius, speculative_margin, out);
}

// What the side of a shape is told by.
Vec3 center_of(const Shapes& shapes, ShapeRef shape, const Pose& pose)
{
    if (shape.kind != ShapeKind::hull) return pose.position;
    return pose * shapes.hulls[shape.index].center;
}

// The point of a manifold that is nearest or deepest, on the triangle.
Vec3 nearest_of(const LocalManifold<double>& found)
{
    const auto* const end = found.points.data() + found.count;
    const auto* const least =
        std::min_element(found.points.data(), end,
                         [](const auto& x, const auto& y) { return x.separation < y.separation; });
    return least->position - found.normal * (least->separation / 2);
}

// A solid tells inside from outside by other means: its triangles have their fronts alone.
void collide_triangles(const PairInput<double>& in,
                       std::span<const std::uint32_t> near,
                       std::span<const std::uint32_t> held,
                       const auto& take)
{
    const auto& [shapes, mesh, b, pose, speculative_margin] = in;
    const Mesh& surface = *mesh_of(shapes, mesh);
    const MeshSides sides(surface, near, held, center_of(shapes, b, pose), inner_extent(shapes, b));
    const bool sided = mesh.kind == ShapeKind::mesh;
    LocalManifold<double> found;
    for (const std::uint32_t index : near) {
        const MeshSides::Approach from = sided ? sides.approach(index) : MeshSides::Approach{};
        if (!from.any) continue;
        const MeshTriangle triangle(surface, index, from.behind);
        collide(shapes, b, triangle, pose, speculative_margin, from.through, found);
        if (found.count == 0 && !from.through)
            collide_ahead(shapes, b, triangle, pose, speculative_margin, found);
        if (found.count == 0) continue;
        if (from.behind && !from.known && sides.is_hidden(nearest_of(found), index)) continue;
        take(from.behind ? index | kBehind : index, found);
    }
}

// What was pressed all the way through is beyond what it touched, and is pushed back all the same.
void keep_held(std::span<const std::uint32_t> held, std::vector<std::uint32_t>& near)
{
    for (const std::uint32_t one : held) {
        const std::uint32_t triangle = one & ~kBehind;
        const auto place = std::lower_bound(near.begin(), near.end(), triangle);
        if (place == near.end() || *place != triangle) near.insert(place, triangle);
    }
}

}  // namespace

template <class Real>
void collide_mesh(const PairInput<Real>& in,
                  std::span<const std::uint32_t> held,
                  TriangleManifolds<Real>& out)
{
    const auto& [shapes, mesh, b, b_in_a, speculative_margin] = in;
    thread_local std::vector<std::uint32_t> near;
    const Pose pose{b_in_a.position.template cast<double>(),
                    b_in_a.orientation.template cast<double>().normalized()};
    Box3 box = shape_bounds(shapes, b, pose);
    box.lower.array() -= double{speculative_margin};
    box.upper.array() += double{speculative_margin};
    near.clear();
    const Mesh& surface = *mesh_of(shapes, mesh);
    if (surface.k_dops.empty()) {
        find_triangles(surface, box, near);
    } else {
        const KDop k_dop =
            k_dop_of(convex_core_of<double>(shapes, b), pose.orientation.toRotationMatrix(),
                     pose.position, surface.sides);
        find_triangles(surface, box, k_dop, double{speculative_margin}, near);
    }
    keep_held(held, near);
    collide_triangles({shapes, mesh, b, pose, double{speculative_margin}}, near, held,
                      [&](std::uint32_t triangle, const LocalManifold<double>& found) {
                          out.push_back({triangle, found.cast<Real>()});
                      });
}

template <class Real>
void collide_mesh(const PairInput<Real>& in, TriangleManifolds<Real>& out)
{
    collide_mesh(in, {}, out);
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template void collide_mesh<Real>(const PairInput<Real>&, TriangleManifolds<Real>&);            \
    template void collide_mesh<Real>(const PairInput<Real>&, std::span<const std::uint32_t>,       \
                                     TriangleManifolds<Real>&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
