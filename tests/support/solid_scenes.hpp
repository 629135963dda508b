// Solid scenes: a few bodies of every kind on ground that is a level set, made in no time.
#pragma once

#include "scene/catalog/closed_meshes.hpp"
#include "scene/shapes/level_set.hpp"
#include "tests/support/small_scenes.hpp"
#include "throng/settings.hpp"

#include <stdexcept>

namespace throng::given {

/// A block whose top is z = height(x, y), 1 m thick at the least; a square of so many cells of
/// `cell` m about the origin.
template <class Height>
TriangleSoup block_under(Height height, int cells, double cell)
{
    TriangleSoup mesh;
    const auto corner = [&](int i, int k, bool top) {
        return static_cast<std::uint32_t>(2 * (k * (cells + 1) + i) + (top ? 1 : 0));
    };
    for (int k = 0; k <= cells; ++k)
        for (int i = 0; i <= cells; ++i) {
            const double x = (i - 0.5 * cells) * cell, y = (k - 0.5 * cells) * cell;
            mesh.vertices.emplace_back(x, y, -1.5);
            mesh.vertices.emplace_back(x, y, height(x, y));
        }
    const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({a, c, d});
    };
    for (int k = 0; k < cells; ++k)
        for (int i = 0; i < cells; ++i)
            for (const bool top : {true, false}) {
                const int j = top ? i : i + 1, l = top ? i + 1 : i;
                quad(corner(j, k, top), corner(l, k, top), corner(l, k + 1, top),
                     corner(j, k + 1, top));
            }
    for (int i = 0; i < cells; ++i) {
        const auto side = [&](int i0, int k0, int i1, int k1) {
            quad(corner(i0, k0, false), corner(i1, k1, false), corner(i1, k1, true),
                 corner(i0, k0, true));
        };
        side(i, 0, i + 1, 0);
        side(cells, i, cells, i + 1);
        side(i + 1, cells, i, cells);
        side(0, i + 1, 0, i);
    }
    return mesh;
}

inline MeshShape tetrahedron(double size)
{
    MeshShape mesh;
    mesh.vertices = {Vec3(size, 0, -size), Vec3(-size, size, -size), Vec3(-size, -size, -size),
                     Vec3(0, 0, size)};
    mesh.triangles = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
    return mesh;
}

inline VoxelsShape voxels_of(const TriangleSoup& mesh, double voxel, double band = 0)
{
    LevelSetResult made = make_level_set(mesh.vertices, mesh.triangles, voxel, band);
    if (!made.trouble.empty()) throw std::runtime_error(made.trouble);
    return {"", std::move(made.level_set)};
}

inline MeshShape mesh_of(const TriangleSoup& soup)
{
    MeshShape mesh;
    mesh.vertices = soup.vertices;
    mesh.triangles = soup.triangles;
    return mesh;
}

/// Rings, a box, a ball, a pill and a ring that is a level set itself, dropped on ground with a
/// hollow in it; some fall on one another. Coarse, so that every way of taking the rings is quick.
inline Scene solids_on_voxels(NonConvex way)
{
    SceneOf made;
    const auto hollow = [](double x, double y) { return 0.15 * (x * x + y * y); };
    static const VoxelsShape ground = voxels_of(block_under(hollow, 12, 0.25), 0.15, 0.6);
    static const TriangleSoup ring = torus_mesh(0.3, 0.12, 16, 8);
    static const VoxelsShape voxel_ring = voxels_of(ring, 0.06);
    made.body(made.shape(ground), Vec3::Zero()).motion = Motion::static_;
    const std::uint32_t rings = made.shape(mesh_of(ring));
    for (int i = 0; i < 3; ++i) {
        const double lean = 0.3 * i;
        made.body(rings, Vec3(0.1 * i, -0.05 * i, 0.35 + 0.4 * i)).orientation =
            Quat(std::cos(lean), std::sin(lean), 0, 0);
    }
    made.body(made.shape(voxel_ring), Vec3(0.8, 0.1, 0.6)).angular_velocity = Vec3(1, 2, 0);
    made.box(Vec3(0.2, 0.15, 0.1), Vec3(-0.7, 0.2, 0.5));
    made.ball(0.2, Vec3(0, 0.8, 0.7));
    made.body(made.shape(CapsuleShape{0.12, 0.2}), Vec3(0, -0.8, 0.7));
    made.scene.settings.nonconvex = way;
    made.scene.settings.voxel_size = 0.06;
    made.scene.settings.image_resolution = 16;
    made.scene.settings.sphere_levels = 3;
    made.scene.settings.max_parts = 8;
    return made.scene;
}

}  // namespace throng::given
