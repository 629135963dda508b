#include "kernels/geometry/nearest_point.hpp"

#include "kernels/geometry/closest_points.hpp"
#include "kernels/geometry/mesh_distance.hpp"

#include <algorithm>
#include <cmath>

namespace throng {
namespace {

// The point of a ball; with the ball's center moved along a segment, of a capsule.
NearestPoint of_ball(const Vec3& point, const Vec3& center, double radius)
{
    const Vec3 away = point - center;
    const double distance = away.norm();
    if (distance <= radius) return {0, point};
    return {distance - radius, center + away * (radius / distance)};
}

NearestPoint at(const Vec3& nearest, const Vec3& point)
{
    return {(point - nearest).norm(), nearest};
}

NearestPoint of_capsule(const Vec3& point, const Capsule& capsule)
{
    const double z = std::clamp(point.z(), -capsule.half_length, capsule.half_length);
    return of_ball(point, Vec3(0, 0, z), capsule.radius);
}

NearestPoint of_cylinder(const Vec3& point, const Cylinder& cylinder)
{
    Vec3 nearest = point;
    nearest.z() = std::clamp(point.z(), -cylinder.half_length, cylinder.half_length);
    const double across = std::sqrt(point.x() * point.x() + point.y() * point.y());
    if (across > cylinder.radius) nearest.head<2>() *= cylinder.radius / across;
    return at(nearest, point);
}

NearestPoint of_box(const Vec3& point, const Box& box)
{
    return at(point.cwiseMax(-box.half_extents).cwiseMin(box.half_extents), point);
}

NearestPoint of_plane(const Vec3& point, const Plane& plane)
{
    const double above = plane.normal.dot(point) - plane.offset;
    if (above <= 0) return {0, point};
    return {above, point - plane.normal * above};
}

// The nearest point lies on a face that the point looks down on.
NearestPoint of_hull(const Vec3& point, const Hull& hull, double limit)
{
    NearestPoint nearest;
    bool outside = false;
    for (std::size_t face = 0; face < hull.normals.size(); ++face) {
        const double above = hull.normals[face].dot(point) - hull.offsets[face];
        if (!(above > 0)) continue;
        outside = true;
        // A face's plane is never further than the hull.
        if (above > limit) return {};
        if (above > nearest.distance) continue;
        const std::uint32_t begin = hull.face_begin[face], end = hull.face_begin[face + 1];
        for (std::uint32_t i = begin + 1; i + 1 < end; ++i) {
            const NearestPoint now =
                at(closest_on_triangle<double>(point, hull.vertices[hull.face_vertices[begin]],
                                               hull.vertices[hull.face_vertices[i]],
                                               hull.vertices[hull.face_vertices[i + 1]])
                       .point,
                   point);
            if (now.distance < nearest.distance) nearest = now;
        }
    }
    return outside ? nearest : NearestPoint{0, point};
}

NearestPoint of_mesh(const Vec3& point, const Mesh& mesh, double limit)
{
    const MeshPoint nearest = nearest_on_mesh(mesh, point, limit);
    return {nearest.distance, nearest.point};
}

NearestPoint of_solid(const Vec3& point, const Solid& solid)
{
    // Without a limit: a point deep inside is near, however far the surface is.
    const MeshPoint nearest = nearest_on_mesh(solid.mesh, point);
    if (signed_distance(solid.mesh, point, nearest) <= 0) return {0, point};
    return {nearest.distance, nearest.point};
}

}  // namespace

NearestPoint nearest_point(const Shapes& shapes, ShapeRef shape, const Vec3& point, double limit)
{
    const std::size_t i = shape.index;
    switch (shape.kind) {
    case ShapeKind::sphere:
        return of_ball(point, Vec3::Zero(), shapes.spheres[i].radius);
    case ShapeKind::capsule:
        return of_capsule(point, shapes.capsules[i]);
    case ShapeKind::cylinder:
        return of_cylinder(point, shapes.cylinders[i]);
    case ShapeKind::box:
        return of_box(point, shapes.boxes[i]);
    case ShapeKind::hull:
        return of_hull(point, shapes.hulls[i], limit);
    case ShapeKind::plane:
        return of_plane(point, shapes.planes[i]);
    case ShapeKind::mesh:
        return of_mesh(point, shapes.meshes[i], limit);
    case ShapeKind::solid:
        return of_solid(point, shapes.solids[i]);
    case ShapeKind::triangle:
        break;
    }
    return {};
}

}  // namespace throng
