// Scene bodies: a scene's bodies one by one, whether listed or in groups, for tests to look at.
#pragma once

#include "kernels/data/bounds.hpp"
#include "scene/shapes/level_set.hpp"
#include "throng/catalog.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace throng {

/// What a test asks of a body. Size: half extents of a box; radius; radius and half length; the
/// first corner of a hull; zero for the rest.
struct Body {
    std::uint32_t shape = kNone;
    Motion motion = Motion::dynamic;
    Vec3 position, velocity, angular_velocity;
    Quat orientation;
    Vec3 size = Vec3::Zero();
};

inline Vec3 described_size(const ShapeDescription& description)
{
    const auto& shape = description.shape;
    if (const auto* box = std::get_if<BoxShape>(&shape)) return box->half_extents;
    if (const auto* ball = std::get_if<SphereShape>(&shape)) return {ball->radius, 0, 0};
    if (const auto* pill = std::get_if<CapsuleShape>(&shape))
        return {pill->radius, pill->half_length, 0};
    if (const auto* can = std::get_if<CylinderShape>(&shape))
        return {can->radius, can->half_length, 0};
    if (const auto* hull = std::get_if<HullShape>(&shape)) return hull->points.front();
    return Vec3::Zero();
}

/// The body of that id: those in Scene::bodies first, then the groups.
inline Body body_at(const Scene& scene, std::size_t id)
{
    if (id < scene.bodies.size()) {
        const BodyDescription& b = scene.bodies[id];
        return {b.shape,
                b.motion,
                b.position,
                b.velocity,
                b.angular_velocity,
                b.orientation,
                described_size(scene.shapes[b.shape])};
    }
    id -= scene.bodies.size();
    auto group = scene.instances.begin();
    for (; id >= group->count(); ++group) id -= group->count();
    const double* r = group->records.data() + id * group->stride();
    const Vec3 size = group->own_sizes ? Vec3(r[13], r[14], r[15])
                                       : described_size(scene.shapes[group->common.shape]);
    return {group->common.shape,
            group->common.motion,
            Vec3(r[0], r[1], r[2]),
            Vec3(r[7], r[8], r[9]),
            Vec3(r[10], r[11], r[12]),
            Quat(r[3], r[4], r[5], r[6]),
            size};
}

/// Points whose box, widened by a radius, is the box of a convex shape or holds it.
struct Outline {
    std::vector<Vec3> points;
    double radius = 0;
};

inline Outline outline_of(const ShapeDescription& description, const Vec3& size)
{
    const auto& shape = description.shape;
    Outline outline;
    if (const auto* hull = std::get_if<HullShape>(&shape)) {
        outline.points = hull->points;
    } else if (std::holds_alternative<SphereShape>(shape)) {
        outline = {{Vec3::Zero()}, size.x()};
    } else if (std::holds_alternative<CapsuleShape>(shape)) {
        outline = {{Vec3(0, 0, -size.y()), Vec3(0, 0, size.y())}, size.x()};
    } else {
        // A cylinder goes as the box round it.
        const bool can = std::holds_alternative<CylinderShape>(shape);
        const Vec3 half = can ? Vec3(size.x(), size.x(), size.y()) : size;
        for (int corner = 0; corner < 8; ++corner)
            outline.points.emplace_back(corner & 1 ? half.x() : -half.x(),
                                        corner & 2 ? half.y() : -half.y(),
                                        corner & 4 ? half.z() : -half.z());
    }
    return outline;
}

inline Box3 bounds_of(const Outline& outline, const Pose& pose)
{
    Box3 box;
    for (const Vec3& point : outline.points) {
        const Vec3 at = pose * point;
        box.lower = box.lower.cwiseMin(at - Vec3::Constant(outline.radius));
        box.upper = box.upper.cwiseMax(at + Vec3::Constant(outline.radius));
    }
    return box;
}

/// Boxes round the parts of a body; none for planes, meshes and level sets.
inline std::vector<Box3> part_bounds(const Scene& scene, std::size_t id)
{
    const Body body = body_at(scene, id);
    const Pose pose{body.position, body.orientation};
    const ShapeDescription& description = scene.shapes[body.shape];
    std::vector<Box3> boxes;
    if (const auto* compound = std::get_if<CompoundShape>(&description.shape)) {
        for (const CompoundShape::Part& part : compound->parts) {
            const ShapeDescription& inner = scene.shapes[part.shape];
            boxes.push_back(bounds_of(outline_of(inner, described_size(inner)), pose * part.pose));
        }
    } else if (!std::holds_alternative<PlaneShape>(description.shape)
               && !std::holds_alternative<MeshShape>(description.shape)
               && !std::holds_alternative<VoxelsShape>(description.shape)) {
        boxes.push_back(bounds_of(outline_of(description, body.size), pose));
    }
    return boxes;
}

/// Corners of the surface of a mesh or a level set; none of any other shape.
inline std::vector<Vec3> vertices_of(const ShapeDescription& shape)
{
    if (const auto* mesh = std::get_if<MeshShape>(&shape.shape)) return mesh->vertices;
    if (const auto* voxels = std::get_if<VoxelsShape>(&shape.shape))
        return voxels->level_set->surface.vertices;
    return {};
}

inline Box3 bounds_of(const Scene& scene, std::size_t id) { return part_bounds(scene, id).at(0); }

}  // namespace throng
