#include "kernels/geometry/ray_passage.hpp"

#include <algorithm>
#include <cmath>

namespace throng {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

void clear(RayPassage& passage)
{
    passage.enter = kInfinity;
    passage.leave = -kInfinity;
}

// Keeps what lies in a half-space whose plane the line's start is `above`, and which the line
// climbs away from at `speed`.
void keep_below(RayPassage& passage, double above, double speed, const Vec3& normal)
{
    if (speed == 0) {
        if (above > 0) clear(passage);
        return;
    }
    const double at = -above / speed;
    if (speed > 0) {
        if (!(at < passage.leave)) return;
        passage.leave = at;
        passage.leave_normal = normal;
    } else if (at > passage.enter) {
        passage.enter = at;
        passage.enter_normal = normal;
    }
}

void keep_between(RayPassage& passage, const LocalRay& ray, int axis, double half)
{
    Vec3 normal = Vec3::Zero();
    normal[axis] = 1;
    keep_below(passage, ray.from[axis] - half, ray.along[axis], normal);
    keep_below(passage, -ray.from[axis] - half, -ray.along[axis], -normal);
}

// Both work from where the line comes closest, so that a start far away costs no digits.
RayPassage through_sphere(const LocalRay& ray, const Vec3& center, double radius)
{
    const Vec3 from = ray.from - center;
    const double closest = -from.dot(ray.along);
    const Vec3 offset = from + ray.along * closest;
    const double distance = offset.norm();
    RayPassage passage;
    if (!(distance <= radius)) {
        clear(passage);
        return passage;
    }
    const double half = std::sqrt((radius - distance) * (radius + distance));
    passage.enter = closest - half;
    passage.leave = closest + half;
    passage.enter_normal = offset - ray.along * half;
    passage.leave_normal = offset + ray.along * half;
    return passage;
}

RayPassage through_endless_cylinder(const LocalRay& ray, double radius)
{
    const double x = ray.from.x(), y = ray.from.y();
    const double speed = std::sqrt(ray.along.x() * ray.along.x() + ray.along.y() * ray.along.y());
    RayPassage passage;
    if (!(speed > 1e-150)) {
        if (std::sqrt(x * x + y * y) > radius) clear(passage);
        return passage;
    }
    const double ux = ray.along.x() / speed, uy = ray.along.y() / speed;
    const double side = x * uy - y * ux;
    if (!(std::abs(side) <= radius)) {
        clear(passage);
        return passage;
    }
    const double half = std::sqrt((radius - side) * (radius + side));
    const double closest = -(x * ux + y * uy);
    passage.enter = (closest - half) / speed;
    passage.leave = (closest + half) / speed;
    passage.enter_normal = Vec3(side * uy - half * ux, -side * ux - half * uy, 0);
    passage.leave_normal = Vec3(side * uy + half * ux, -side * ux + half * uy, 0);
    return passage;
}

RayPassage through_cylinder(const LocalRay& ray, const Cylinder& cylinder)
{
    RayPassage passage = through_endless_cylinder(ray, cylinder.radius);
    keep_between(passage, ray, 2, cylinder.half_length);
    return passage;
}

// A cylinder and two balls. Together they are convex, so their parts of the line join to one.
RayPassage through_capsule(const LocalRay& ray, const Capsule& capsule)
{
    const Vec3 end = Vec3::UnitZ() * capsule.half_length;
    RayPassage whole = through_cylinder(ray, {capsule.radius, capsule.half_length});
    if (whole.empty()) clear(whole);
    for (const Vec3& center : {Vec3(-end), end}) {
        const RayPassage ball = through_sphere(ray, center, capsule.radius);
        if (ball.empty()) continue;
        // Where a cap of the cylinder ties with the ball, the ball is the surface.
        if (ball.enter <= whole.enter) {
            whole.enter = ball.enter;
            whole.enter_normal = ball.enter_normal;
        }
        if (ball.leave >= whole.leave) {
            whole.leave = ball.leave;
            whole.leave_normal = ball.leave_normal;
        }
    }
    return whole;
}

RayPassage through_box(const LocalRay& ray, const Box& box)
{
    RayPassage passage;
    for (int axis = 0; axis < 3; ++axis) keep_between(passage, ray, axis, box.half_extents[axis]);
    return passage;
}

RayPassage through_hull(const LocalRay& ray, const Hull& hull)
{
    RayPassage passage;
    for (std::size_t face = 0; face < hull.normals.size(); ++face) {
        const Vec3& normal = hull.normals[face];
        keep_below(passage, normal.dot(ray.from) - hull.offsets[face], normal.dot(ray.along),
                   normal);
    }
    return passage;
}

RayPassage through_plane(const LocalRay& ray, const Plane& plane)
{
    RayPassage passage;
    keep_below(passage, plane.normal.dot(ray.from) - plane.offset, plane.normal.dot(ray.along),
               plane.normal);
    return passage;
}

}  // namespace

RayPassage pass_through(const Shapes& shapes, ShapeRef shape, const LocalRay& ray)
{
    const std::size_t i = shape.index;
    switch (shape.kind) {
    case ShapeKind::sphere:
        return through_sphere(ray, Vec3::Zero(), shapes.spheres[i].radius);
    case ShapeKind::capsule:
        return through_capsule(ray, shapes.capsules[i]);
    case ShapeKind::cylinder:
        return through_cylinder(ray, shapes.cylinders[i]);
    case ShapeKind::box:
        return through_box(ray, shapes.boxes[i]);
    case ShapeKind::hull:
        return through_hull(ray, shapes.hulls[i]);
    case ShapeKind::plane:
        return through_plane(ray, shapes.planes[i]);
    case ShapeKind::mesh:
    case ShapeKind::solid:
    case ShapeKind::triangle:
        break;
    }
    RayPassage none;
    clear(none);
    return none;
}

}  // namespace throng
