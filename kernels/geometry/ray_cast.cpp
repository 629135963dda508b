#include "kernels/geometry/ray_cast.hpp"

#include "kernels/geometry/mesh_distance.hpp"
#include "kernels/geometry/support.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace throng {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The part of a ray's line that lies in a convex solid, and the surface's normal where it enters.
struct Passage {
    double enter = -kInfinity, leave = kInfinity;
    Vec3 normal = Vec3::Zero();

    bool empty() const { return !(enter <= leave); }
    void clear()
    {
        enter = kInfinity;
        leave = -kInfinity;
    }
};

// Keeps what lies in a half-space whose plane the line's start is `above`, and which the line
// climbs away from at `speed`.
void keep_below(Passage& passage, double above, double speed, const Vec3& normal)
{
    if (speed == 0) {
        if (above > 0) passage.clear();
        return;
    }
    const double at = -above / speed;
    if (speed > 0) {
        passage.leave = std::min(passage.leave, at);
    } else if (at > passage.enter) {
        passage.enter = at;
        passage.normal = normal;
    }
}

void keep_between(Passage& passage, const LocalRay& ray, int axis, double half)
{
    Vec3 normal = Vec3::Zero();
    normal[axis] = 1;
    keep_below(passage, ray.from[axis] - half, ray.along[axis], normal);
    keep_below(passage, -ray.from[axis] - half, -ray.along[axis], -normal);
}

// Both work from where the line comes closest, so that a start far away costs no digits.
Passage through_sphere(const LocalRay& ray, const Vec3& center, double radius)
{
    const Vec3 from = ray.from - center;
    const double closest = -from.dot(ray.along);
    const Vec3 offset = from + ray.along * closest;
    const double distance = offset.norm();
    Passage passage;
    if (!(distance <= radius)) {
        passage.clear();
        return passage;
    }
    const double half = std::sqrt((radius - distance) * (radius + distance));
    passage.enter = closest - half;
    passage.leave = closest + half;
    passage.normal = offset - ray.along * half;
    return passage;
}

Passage through_endless_cylinder(const LocalRay& ray, double radius)
{
    const double x = ray.from.x(), y = ray.from.y();
    const double speed = std::sqrt(ray.along.x() * ray.along.x() + ray.along.y() * ray.along.y());
    Passage passage;
    if (!(speed > 1e-150)) {
        if (std::sqrt(x * x + y * y) > radius) passage.clear();
        return passage;
    }
    const double ux = ray.along.x() / speed, uy = ray.along.y() / speed;
    const double side = x * uy - y * ux;
    if (!(std::abs(side) <= radius)) {
        passage.clear();
        return passage;
    }
    const double half = std::sqrt((radius - side) * (radius + side));
    const double closest = -(x * ux + y * uy);
    passage.enter = (closest - half) / speed;
    passage.leave = (closest + half) / speed;
    passage.normal = Vec3(side * uy - half * ux, -side * ux - half * uy, 0);
    return passage;
}

Passage through_cylinder(const LocalRay& ray, const Cylinder& cylinder)
{
    Passage passage = through_endless_cylinder(ray, cylinder.radius);
    keep_between(passage, ray, 2, cylinder.half_length);
    return passage;
}

// A cylinder and two balls. Together they are convex, so their parts of the line join to one.
Passage through_capsule(const LocalRay& ray, const Capsule& capsule)
{
    const Vec3 end = Vec3::UnitZ() * capsule.half_length;
    Passage whole = through_cylinder(ray, {capsule.radius, capsule.half_length});
    if (whole.empty()) whole.clear();
    for (const Vec3& center : {Vec3(-end), end}) {
        const Passage ball = through_sphere(ray, center, capsule.radius);
        if (ball.empty()) continue;
        // Where a cap of the cylinder ties with the ball, the ball is the surface.
        if (ball.enter <= whole.enter) {
            whole.enter = ball.enter;
            whole.normal = ball.normal;
        }
        whole.leave = std::max(whole.leave, ball.leave);
    }
    return whole;
}

Passage through_box(const LocalRay& ray, const Box& box)
{
    Passage passage;
    for (int axis = 0; axis < 3; ++axis) keep_between(passage, ray, axis, box.half_extents[axis]);
    return passage;
}

Passage through_hull(const LocalRay& ray, const Hull& hull)
{
    Passage passage;
    for (std::size_t face = 0; face < hull.normals.size(); ++face) {
        const Vec3& normal = hull.normals[face];
        keep_below(passage, normal.dot(ray.from) - hull.offsets[face], normal.dot(ray.along),
                   normal);
    }
    return passage;
}

Passage through_plane(const LocalRay& ray, const Plane& plane)
{
    Passage passage;
    keep_below(passage, plane.normal.dot(ray.from) - plane.offset, plane.normal.dot(ray.along),
               plane.normal);
    return passage;
}

RayMeeting first_of(const Passage& passage, const LocalRay& ray)
{
    const bool meets = !passage.empty() && passage.leave >= 0 && passage.enter <= ray.longest
        && passage.enter < kInfinity;
    if (!meets) return {};
    if (passage.enter < 0) return {0, -ray.along};
    return {passage.enter + 0.0, unit_or(passage.normal, Vec3(-ray.along))};
}

// A ray against triangles, sheared so that it runs along one axis: whether it passes left or right
// of an edge then comes out the same for both triangles that share the edge.
//
// Source: Woop, Benthin, Wald, Watertight Ray/Triangle Intersection (2013).
class MeshRay {
public:
    MeshRay(const Mesh& mesh, const LocalRay& ray) : mesh_(mesh), ray_(ray)
    {
        ray.along.cwiseAbs().maxCoeff(&forward_);
        across_ = (forward_ + 1) % 3;
        up_ = (forward_ + 2) % 3;
        shear_ = Vec3(ray.along[across_], ray.along[up_], 1) / ray.along[forward_];
    }

    // Where the line meets a triangle, from the ray's start on; infinite where it does not.
    double meet(std::uint32_t triangle) const
    {
        const Vec3 a = sheared(triangle, 0), b = sheared(triangle, 1), c = sheared(triangle, 2);
        const double u = c.x() * b.y() - c.y() * b.x();
        const double v = a.x() * c.y() - a.y() * c.x();
        const double w = b.x() * a.y() - b.y() * a.x();
        const double sum = u + v + w;
        if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return kInfinity;
        if (sum == 0) return kInfinity;
        return (u / sum) * a.z() + (v / sum) * b.z() + (w / sum) * c.z();
    }

    // Where the line enters a node's box, or infinite; never later than it meets a triangle within.
    double enter(const Mesh::Node& node) const
    {
        constexpr double kWiden = 8 * std::numeric_limits<double>::epsilon();
        double first = -kInfinity, last = kInfinity;
        for (int axis = 0; axis < 3; ++axis) {
            const double along = ray_.along[axis];
            double low = node.lower[axis] - ray_.from[axis];
            double high = node.upper[axis] - ray_.from[axis];
            if (along == 0) {
                if (low > 0 || high < 0) return kInfinity;
                continue;
            }
            if (along < 0) std::swap(low, high);
            low /= along;
            high /= along;
            first = std::max(first, low - std::abs(low) * kWiden);
            last = std::min(last, high + std::abs(high) * kWiden);
        }
        return first <= last && last >= 0 ? first : kInfinity;
    }

private:
    Vec3 sheared(std::uint32_t triangle, std::size_t corner) const
    {
        const Vec3 to = mesh_.vertices[mesh_.triangles[triangle][corner]] - ray_.from;
        const double forward = to[forward_];
        return {to[across_] - shear_.x() * forward, to[up_] - shear_.y() * forward,
                shear_.z() * forward};
    }

    const Mesh& mesh_;
    const LocalRay& ray_;
    int forward_ = 0, across_ = 1, up_ = 2;
    Vec3 shear_;
};

struct Nearest {
    double distance;
    std::uint32_t triangle;
};

// Down the tree, the nearer child first.
Nearest nearest_triangle(const Mesh& mesh, const LocalRay& ray, double earliest)
{
    struct Visit {
        std::uint32_t node;
        double enter;
    };
    const MeshRay mesh_ray(mesh, ray);
    // As deep as visit_triangles() in mesh.hpp, which says why.
    std::array<Visit, 96> waiting;
    std::size_t count = 0;
    waiting[count++] = {0, mesh_ray.enter(mesh.tree.front())};
    Nearest nearest{kInfinity, 0};
    while (count > 0) {
        const Visit visit = waiting[--count];
        if (!(visit.enter <= std::min(nearest.distance, ray.longest)) || visit.enter == kInfinity)
            continue;
        const Mesh::Node& node = mesh.tree[visit.node];
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
            const std::uint32_t triangle = mesh.order[i];
            const double at = mesh_ray.meet(triangle);
            if (!(at >= earliest && at <= ray.longest)) continue;
            if (at < nearest.distance || (at == nearest.distance && triangle < nearest.triangle))
                nearest = {at, triangle};
        }
        if (node.count > 0) continue;
        Visit near{node.first, mesh_ray.enter(mesh.tree[node.first])};
        Visit far{node.first + 1, mesh_ray.enter(mesh.tree[node.first + 1])};
        if (far.enter < near.enter) std::swap(near, far);
        waiting[count++] = far;
        waiting[count++] = near;
    }
    return nearest;
}

RayMeeting cast_at_mesh(const Mesh& mesh, const LocalRay& ray)
{
    if (mesh.tree.empty()) return {};
    // A ray from far away sets out again close by, where its numbers have digits to spare.
    const Mesh::Node& root = mesh.tree.front();
    const double enter = MeshRay(mesh, ray).enter(root);
    if (!(enter <= ray.longest) || enter == kInfinity) return {};
    const double skipped = std::max(0.0, enter - (root.upper - root.lower).norm());
    const LocalRay near{ray.from + ray.along * skipped, ray.along, ray.longest - skipped};
    const Nearest nearest = nearest_triangle(mesh, near, skipped > 0 ? -skipped : 0.0);
    if (nearest.distance == kInfinity) return {};
    const Vec3& normal = mesh.normals[nearest.triangle];
    return {skipped + nearest.distance, normal.dot(ray.along) > 0 ? Vec3(-normal) : normal};
}

}  // namespace

RayMeeting cast_ray(const Shapes& shapes, ShapeRef shape, const LocalRay& ray)
{
    const std::size_t i = shape.index;
    switch (shape.kind) {
    case ShapeKind::sphere:
        return first_of(through_sphere(ray, Vec3::Zero(), shapes.spheres[i].radius), ray);
    case ShapeKind::capsule:
        return first_of(through_capsule(ray, shapes.capsules[i]), ray);
    case ShapeKind::cylinder:
        return first_of(through_cylinder(ray, shapes.cylinders[i]), ray);
    case ShapeKind::box:
        return first_of(through_box(ray, shapes.boxes[i]), ray);
    case ShapeKind::hull:
        return first_of(through_hull(ray, shapes.hulls[i]), ray);
    case ShapeKind::plane:
        return first_of(through_plane(ray, shapes.planes[i]), ray);
    case ShapeKind::mesh:
        return cast_at_mesh(shapes.meshes[i], ray);
    case ShapeKind::solid:
        if (signed_distance(shapes.solids[i].mesh, ray.from) <= 0) return {0, -ray.along};
        return cast_at_mesh(shapes.solids[i].mesh, ray);
    case ShapeKind::triangle:
        break;
    }
    return {};
}

}  // namespace throng
