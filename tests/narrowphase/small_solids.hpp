// Small solids: closed meshes with fields and points, made ready in no time.
#pragma once

#include "cooking/fields/surface_points.hpp"
#include "kernels/data/shapes.hpp"
#include "kernels/geometry/voxel_bricks.hpp"
#include "tests/support/closed.hpp"
#include "tests/support/dice.hpp"

#include <cmath>
#include <functional>

namespace throng::test {

/// Points a voxel apart and a band of four. `distance` of the shape that the mesh is of, or that of
/// the mesh itself where none is given.
inline Solid small_solid(const TriangleSoup& soup,
                         double voxel,
                         std::function<double(const Vec3&)> distance = {})
{
    Solid solid;
    solid.mesh = closed(soup);
    if (!distance) distance = [&](const Vec3& at) { return signed_distance(solid.mesh, at); };
    const Mesh::Node& root = solid.mesh.tree.front();
    solid.field = bake_bricks({root.lower, root.upper}, voxel, 4 * voxel, distance);
    solid.points = build_surface_points(solid.mesh, voxel);
    return solid;
}

/// A ball whose corners are on the sphere; its faces are within 3e-4 of the radius.
inline Solid small_ball(double radius, double voxel)
{
    return small_solid(ball_mesh(radius, 192, 96), voxel,
                       [=](const Vec3& at) { return at.norm() - radius; });
}

inline Solid small_box(const Vec3& half, double voxel)
{
    return small_solid(box_mesh(half), voxel, [=](const Vec3& at) {
        const Vec3 past = at.cwiseAbs() - half;
        return past.cwiseMax(0).norm() + std::min(past.maxCoeff(), 0.0);
    });
}

inline Solid small_torus(double ring, double tube, double voxel)
{
    return small_solid(torus_mesh(ring, tube, 128, 64), voxel, [=](const Vec3& at) {
        const double across = std::sqrt(at.x() * at.x() + at.y() * at.y()) - ring;
        return std::sqrt(across * across + at.z() * at.z()) - tube;
    });
}

}  // namespace throng::test
