#include "narrowphase/solid/shape_distance.hpp"

#include "kernels/check.hpp"
#include "kernels/geometry/nearest_point.hpp"

#include <algorithm>
#include <cmath>

namespace throng {
namespace {

SurfaceDistance to_ball(const Vec3& away, double radius)
{
    const double length = away.norm();
    return {length - radius, length > 0 ? Vec3(away / length) : Vec3::UnitX()};
}

SurfaceDistance to_capsule(const Vec3& point, const Capsule& capsule)
{
    const double z = std::clamp(point.z(), -capsule.half_length, capsule.half_length);
    return to_ball(point - Vec3(0, 0, z), capsule.radius);
}

SurfaceDistance to_cylinder(const Vec3& point, const Cylinder& cylinder)
{
    const double across = std::sqrt(point.x() * point.x() + point.y() * point.y());
    const Vec3 side = across > 0 ? Vec3(point.x() / across, point.y() / across, 0) : Vec3::UnitX();
    const Vec3 cap(0, 0, point.z() < 0 ? -1 : 1);
    const double past_side = across - cylinder.radius;
    const double past_cap = std::abs(point.z()) - cylinder.half_length;
    if (past_side > 0 && past_cap > 0) return to_ball(past_side * side + past_cap * cap, 0);
    if (past_side > past_cap) return {past_side, side};
    return {past_cap, cap};
}

SurfaceDistance to_box(const Vec3& point, const Box& box)
{
    const Vec3 past = point.cwiseAbs() - box.half_extents;
    const auto sign = [&](Eigen::Index k) { return point[k] < 0 ? -1.0 : 1.0; };
    if ((past.array() > 0).count() > 1) {
        Vec3 away = past.cwiseMax(0);
        for (Eigen::Index k = 0; k < 3; ++k) away[k] *= sign(k);
        return to_ball(away, 0);
    }
    Eigen::Index face = 0;
    const double most = past.maxCoeff(&face);
    return {most, Vec3(Vec3::Unit(face) * sign(face))};
}

SurfaceDistance to_hull(const Shapes& shapes, ShapeRef shape, const Vec3& point)
{
    const Hull& hull = shapes.hulls[shape.index];
    SurfaceDistance face{-std::numeric_limits<double>::infinity(), Vec3::UnitZ()};
    for (std::size_t i = 0; i < hull.normals.size(); ++i) {
        const double above = hull.normals[i].dot(point) - hull.offsets[i];
        if (above > face.distance) face = {above, hull.normals[i]};
    }
    if (face.distance <= 0) return face;
    const NearestPoint nearest =
        nearest_point(shapes, shape, point, std::numeric_limits<double>::infinity());
    // So near that only rounding says where the point lies from it.
    if (!(nearest.distance > 1e-12 * hull.outer_radius)) return face;
    return to_ball(point - nearest.point, 0);
}

}  // namespace

SurfaceDistance distance_to(const Shapes& shapes, ShapeRef shape, const Vec3& point)
{
    const std::size_t i = shape.index;
    switch (shape.kind) {
    case ShapeKind::sphere:
        return to_ball(point, shapes.spheres[i].radius);
    case ShapeKind::capsule:
        return to_capsule(point, shapes.capsules[i]);
    case ShapeKind::cylinder:
        return to_cylinder(point, shapes.cylinders[i]);
    case ShapeKind::box:
        return to_box(point, shapes.boxes[i]);
    case ShapeKind::hull:
        return to_hull(shapes, shape, point);
    case ShapeKind::plane:
        return {shapes.planes[i].normal.dot(point) - shapes.planes[i].offset,
                shapes.planes[i].normal};
    default:
        THRONG_CHECK(false, "convex shapes and planes have a distance in closed form");
        return {std::numeric_limits<double>::infinity(), Vec3::UnitZ()};
    }
}

}  // namespace throng
