// Closed meshes made ready: what the tests of solids are made of.
#pragma once

#include "cooking/sphere_trees/sphere_tree.hpp"
#include "tests/support/closed.hpp"
#include "tests/support/polyhedra.hpp"

namespace throng {

/// A ball whose corners are moved in and out at random.
inline TriangleSoup noisy_ball(std::uint64_t seed, double radius, double noise)
{
    RandomShapes random(seed);
    TriangleSoup soup = ball_mesh(radius, 16, 10);
    for (Vec3& vertex : soup.vertices) vertex *= 1 + random.number(-noise, noise);
    return soup;
}

/// A solid that goes by a tree of two thousand spheres or so.
inline Solid in_spheres(const TriangleSoup& soup)
{
    Solid solid;
    solid.representation = SolidRepresentation::spheres;
    solid.mesh = closed(soup);
    solid.spheres = build_sphere_tree(solid.mesh, {3, 64, 0, 50000});
    return solid;
}

inline double size_of(const Mesh& mesh)
{
    Vec3 lower = mesh.vertices[0], upper = lower;
    for (const Vec3& vertex : mesh.vertices) {
        lower = lower.cwiseMin(vertex);
        upper = upper.cwiseMax(vertex);
    }
    return (upper - lower).norm();
}

/// A place on the surface, each triangle as likely as another.
inline Vec3 place_on(const Mesh& mesh, RandomShapes& random)
{
    const double most = static_cast<double>(mesh.triangles.size()) - 0.5;
    const auto& [a, b, c] = mesh.triangles[static_cast<std::size_t>(random.number(0, most))];
    double u = random.number(0, 1), v = random.number(0, 1);
    if (u + v > 1) {
        u = 1 - u;
        v = 1 - v;
    }
    const Vec3& from = mesh.vertices[a];
    return from + u * (mesh.vertices[b] - from) + v * (mesh.vertices[c] - from);
}

}  // namespace throng
