#include "kernels/geometry/shape_bounds.hpp"

#include "kernels/geometry/mesh.hpp"

#include <algorithm>
#include <cmath>

namespace throng {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Box3 box_round(const Vec3& center, const Vec3& half_extents)
{
    return {center - half_extents, center + half_extents};
}

// A box of these half-extents, turned, reaches this far along the world's axes.
Vec3 turned_margin(const Quat& orientation, const Vec3& half_extents)
{
    return orientation.toRotationMatrix().cwiseAbs() * half_extents;
}

Vec3 axis_z(const Pose& pose) { return pose.orientation.toRotationMatrix().col(2); }

// How far a disk of radius 1 across the axis reaches along the world's axes. The two other
// components say it without the cancellation of 1 - axis^2.
Vec3 disk_reach(const Vec3& axis)
{
    return {std::sqrt(axis.y() * axis.y() + axis.z() * axis.z()),
            std::sqrt(axis.x() * axis.x() + axis.z() * axis.z()),
            std::sqrt(axis.x() * axis.x() + axis.y() * axis.y())};
}

Box3 box_round_vertices(const std::vector<Vec3>& vertices, const Pose& pose)
{
    const Mat3 turn = pose.orientation.toRotationMatrix();
    Box3 box;
    for (const Vec3& vertex : vertices) {
        const Vec3 turned = turn * vertex;
        box.lower = box.lower.cwiseMin(turned);
        box.upper = box.upper.cwiseMax(turned);
    }
    return {box.lower + pose.position, box.upper + pose.position};
}

double farthest(const std::vector<Vec3>& vertices)
{
    double squared = 0;
    for (const Vec3& vertex : vertices) squared = std::max(squared, vertex.squaredNorm());
    return std::sqrt(squared);
}

// A mesh may have millions of vertices; its own box answers at once.
Box3 box_round_mesh(const Mesh& mesh, const Pose& pose)
{
    if (mesh.tree.empty()) return {};
    const Box3 own = box_of(mesh);
    return box_round(pose * Vec3(0.5 * (own.lower + own.upper)),
                     turned_margin(pose.orientation, 0.5 * (own.upper - own.lower)));
}

}  // namespace

Box3 shape_bounds(const Shapes& shapes, ShapeRef shape, const Pose& pose)
{
    const std::size_t i = shape.index;
    switch (shape.kind) {
    case ShapeKind::sphere:
        return box_round(pose.position, Vec3::Constant(shapes.spheres[i].radius));
    case ShapeKind::capsule: {
        const Capsule& capsule = shapes.capsules[i];
        const Vec3 along = axis_z(pose).cwiseAbs() * capsule.half_length;
        return box_round(pose.position, along + Vec3::Constant(capsule.radius));
    }
    case ShapeKind::cylinder: {
        const Cylinder& cylinder = shapes.cylinders[i];
        const Vec3 axis = axis_z(pose);
        return box_round(pose.position,
                         axis.cwiseAbs() * cylinder.half_length
                             + disk_reach(axis) * cylinder.radius);
    }
    case ShapeKind::box:
        return box_round(pose.position,
                         turned_margin(pose.orientation, shapes.boxes[i].half_extents));
    case ShapeKind::hull:
        return box_round_vertices(shapes.hulls[i].vertices, pose);
    case ShapeKind::mesh:
        return box_round_mesh(shapes.meshes[i], pose);
    case ShapeKind::solid:
        return box_round_mesh(shapes.solids[i].mesh, pose);
    case ShapeKind::plane:
    case ShapeKind::triangle:
        break;
    }
    return {Vec3::Constant(-kInfinity), Vec3::Constant(kInfinity)};
}

double outer_radius(const Shapes& shapes, ShapeRef shape)
{
    const std::size_t i = shape.index;
    switch (shape.kind) {
    case ShapeKind::sphere:
        return shapes.spheres[i].radius;
    case ShapeKind::capsule:
        return shapes.capsules[i].radius + shapes.capsules[i].half_length;
    case ShapeKind::cylinder: {
        const Cylinder& cylinder = shapes.cylinders[i];
        return std::sqrt(cylinder.radius * cylinder.radius
                         + cylinder.half_length * cylinder.half_length);
    }
    case ShapeKind::box:
        return shapes.boxes[i].half_extents.norm();
    case ShapeKind::hull:
        return farthest(shapes.hulls[i].vertices);
    case ShapeKind::mesh:
        return farthest(shapes.meshes[i].vertices);
    case ShapeKind::solid:
        return farthest(shapes.solids[i].mesh.vertices);
    case ShapeKind::plane:
    case ShapeKind::triangle:
        break;
    }
    return kInfinity;
}

double inner_extent(const Shapes& shapes, ShapeRef shape)
{
    const std::size_t i = shape.index;
    switch (shape.kind) {
    case ShapeKind::sphere:
        return shapes.spheres[i].radius;
    case ShapeKind::capsule:
        return shapes.capsules[i].radius;
    case ShapeKind::cylinder:
        return std::min(shapes.cylinders[i].radius, shapes.cylinders[i].half_length);
    case ShapeKind::box:
        return shapes.boxes[i].half_extents.minCoeff();
    case ShapeKind::hull:
        return shapes.hulls[i].inner_radius;
    case ShapeKind::mesh:
        return 0;
    case ShapeKind::solid: {
        // Of its thinnest part nothing is known; the box is no thinner than the whole.
        const Box3 box = box_of(shapes.solids[i].mesh);
        return 0.5 * (box.upper - box.lower).minCoeff();
    }
    case ShapeKind::plane:
    case ShapeKind::triangle:
        break;
    }
    return kInfinity;
}

}  // namespace throng
