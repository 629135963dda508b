#include "narrowphase/touching.hpp"

#include "kernels/geometry/gjk.hpp"
#include "kernels/geometry/mesh.hpp"
#include "kernels/geometry/nearest_point.hpp"
#include "kernels/geometry/shape_bounds.hpp"

namespace throng {
namespace {

bool cores_touch(const ConvexCorePair& pair)
{
    const double extent = pair.a.convex_radius + pair.b.convex_radius;
    const Distance distance = gjk(pair, extent);
    return !distance.apart || distance.distance <= extent;
}

bool reaches_plane(const Shapes& shapes, ShapeRef a, const Plane& plane, const Pose& plane_in_a)
{
    const ConvexCore<double> core = convex_core_of<double>(shapes, a);
    const Vec3 normal = plane_in_a.orientation * plane.normal;
    const double lowest = normal.dot(support<double>(core, -normal).position) - core.convex_radius;
    return lowest <= plane.offset + normal.dot(plane_in_a.position);
}

bool touches_mesh(const Shapes& shapes, ShapeRef a, const Mesh& mesh, const Pose& mesh_in_a)
{
    const Pose a_in_mesh = mesh_in_a.inverse();
    // A triangle is seen as a hull of three corners: a core needs no faces.
    Hull triangle;
    triangle.vertices.resize(3);
    ConvexCorePair pair(shapes, a, a, mesh_in_a);
    pair.b = ConvexCore<double>{};
    pair.b.kind = ShapeKind::hull;
    pair.b.hull = &triangle;
    bool found = false;
    visit_triangles(mesh, shape_bounds(shapes, a, a_in_mesh), [&](std::uint32_t at) {
        if (found) return;
        for (std::size_t k = 0; k < 3; ++k)
            triangle.vertices[k] = mesh.vertices[mesh.triangles[at][k]];
        const auto& v = triangle.vertices;
        pair.b.middle = (v[0] + v[1] + v[2]) / 3;
        pair.b.size = (v[0].cwiseAbs().cwiseMax(v[1].cwiseAbs()).cwiseMax(v[2].cwiseAbs())).sum();
        pair.size = pair.a.size + pair.b.size;
        found = cores_touch(pair);
    });
    return found;
}

}  // namespace

bool touching(
    const Shapes& shapes_a, ShapeRef a, const Shapes& shapes_b, ShapeRef b, const Pose& b_in_a)
{
    // A ball needs no more than the point nearest to its center, which has a closed form.
    if (a.kind == ShapeKind::sphere) {
        const double radius = shapes_a.spheres[a.index].radius;
        return nearest_point(shapes_b, b, b_in_a.to_local(Vec3::Zero()), radius).distance <= radius;
    }
    if (b.kind == ShapeKind::plane)
        return reaches_plane(shapes_a, a, shapes_b.planes[b.index], b_in_a);
    if (b.kind == ShapeKind::mesh)
        return touches_mesh(shapes_a, a, shapes_b.meshes[b.index], b_in_a);
    ConvexCorePair pair(shapes_a, a, a, b_in_a);
    pair.b = convex_core_of<double>(shapes_b, b);
    pair.size = pair.a.size + pair.b.size;
    return cores_touch(pair);
}

}  // namespace throng
