// Edges and cracks: H43's spike in a hole, wedge in a groove, cube on a cliff's edge, seams and
// cracks, as scenes; the queries that were published of them are H42's.
//
// Answers: what fits into its hole comes to lie at its bottom; a cube stands whose middle is over
// the cliff and falls whose middle is not; what slides without friction meets no seam and no crack.
#include "cost/hard_cases/hard_cases.hpp"
#include "kernels/math/rotation.hpp"
#include "pipeline/world.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

constexpr double kMass = 10;  // kg

void add_still(SceneParts& parts,
               std::uint32_t material,
               MeshShape mesh,
               const Vec3& at = Vec3::Zero())
{
    Scene& scene = parts.scene();
    scene.shapes.push_back({"mesh" + std::to_string(scene.shapes.size()), std::move(mesh)});
    BodyDescription& body = scene.bodies.emplace_back();
    body.shape = static_cast<std::uint32_t>(scene.shapes.size() - 1);
    body.material = material;
    body.motion = Motion::static_;
    body.position = at;
}

// Flat but for a funnel of four sides, as wide as it is deep: its edge a square of 4 m, or with
// `long_by` a groove.
MeshShape funnel(double long_by)
{
    MeshShape mesh;
    for (const double out : {6.0, 2.0})
        for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
            mesh.vertices.emplace_back(out * x, out * y + long_by * y, 0);
    mesh.vertices.emplace_back(0, -long_by, -4);
    mesh.vertices.emplace_back(0, long_by, -4);
    for (std::uint32_t i = 0; i < 4; ++i) {
        const std::uint32_t next = (i + 1) % 4;
        mesh.triangles.push_back({i, next, next + 4});
        mesh.triangles.push_back({i, next + 4, i + 4});
    }
    mesh.triangles.push_back({4, 5, 8});
    mesh.triangles.push_back({6, 7, 9});
    for (const auto& [a, b, c] :
         {std::array<std::uint32_t, 3>{5, 6, 8}, {6, 9, 8}, {7, 4, 8}, {7, 8, 9}})
        if (long_by > 0 || (c != 9 && b != 9)) mesh.triangles.push_back({a, b, c});
    return mesh;
}

// Points downward, with the funnel's slopes: half a meter to each side over one of height.
HullShape spike(double long_by)
{
    HullShape hull;
    for (const double x : {-0.5, 0.5})
        for (const double y : {-0.5, 0.5})
            hull.points.emplace_back(x, y + std::copysign(long_by, y), 0.25);
    for (const double y : {-long_by, long_by}) hull.points.emplace_back(0, y, -0.75);
    if (long_by == 0) hull.points.pop_back();
    return hull;
}

// Falls askew beside the middle, and is to lie with its point or edge at the bottom.
void fall_into_funnel(CaseBench& bench, const char* name, double long_by, double dt)
{
    SceneParts parts(bench.scene());
    parts.scene().settings.dt = dt;
    const std::uint32_t material = parts.material(0.2);
    add_still(parts, material, funnel(4 * long_by));
    const Pose askew{Vec3(0.3, 0.2, 1.5), exponential(Vec3(0.15, -0.1, 0.05))};
    const std::uint32_t id = parts.hull(material, kMass, spike(long_by), askew);
    Pose pose;
    double speed = 0;
    bench.run(parts.scene(), bench.brief() ? 4 : 8, [&](World& world, double) {
        const BodyId body = world.bodies()[id];
        pose = world.pose(body);
        speed = world.velocity(body).norm() + 0.5 * world.angular_velocity(body).norm();
        return true;
    });
    const Vec3 point = pose * Vec3(0, 0, -0.75);
    bench.report(name, "point off the bottom", std::hypot(point.x(), point.z() + 4), 5e-3, "m");
    bench.report(name, "speed at the end", speed, 1e-3, "m/s");
}

MeshShape block(const Vec3& low, const Vec3& high)
{
    MeshShape mesh;
    for (const double z : {low.z(), high.z()})
        for (const double y : {low.y(), high.y()})
            for (const double x : {low.x(), high.x()}) mesh.vertices.emplace_back(x, y, z);
    mesh.triangles = {{4, 5, 7}, {4, 7, 6}, {0, 3, 1}, {0, 2, 3}, {0, 1, 5}, {0, 5, 4},
                      {2, 7, 3}, {2, 6, 7}, {0, 6, 2}, {0, 4, 6}, {1, 3, 7}, {1, 7, 5}};
    return mesh;
}

// m, how far a cube sinks whose middle is so far over the edge of a cliff.
double sunk_on_cliff(CaseBench& bench, double over, double dt)
{
    SceneParts parts(bench.scene());
    parts.scene().settings.dt = dt;
    const std::uint32_t material = parts.material(0.5);
    add_still(parts, material, block(Vec3(-5, -5, -3), Vec3(0, 5, 0)));
    const std::uint32_t id = parts.box(material, kMass, Vec3::Constant(0.5),
                                       Pose{Vec3(over, 0.3, 0.5), Quat::Identity()});
    double height = 0;
    bench.run(parts.scene(), 5, [&](World& world, double) {
        height = world.pose(world.bodies()[id]).position.z();
        return true;
    });
    return 0.5 - height;
}

// Share of its speed that a box keeps over blocks, 1 m long and `crack` apart, or one mesh of such
// cells where that is below 0.
double kept_over_cracks(CaseBench& bench, double crack, double dt)
{
    constexpr int kBlocks = 24;
    SceneParts parts(bench.scene());
    parts.scene().settings.dt = dt;
    const std::uint32_t material = parts.material(0);
    MeshShape cells;
    for (int i = 0; i < kBlocks; ++i) {
        const double from = i * (1 + std::max(crack, 0.0));
        MeshShape one = block(Vec3(from, -2, -1), Vec3(from + 1, 2, 0));
        if (crack >= 0) {
            add_still(parts, material, std::move(one));
            continue;
        }
        // The upper face alone; corners that meet are the same.
        for (const auto& corner : {4, 5, 7, 6})
            cells.vertices.push_back(one.vertices[static_cast<std::size_t>(corner)]);
        const auto at = static_cast<std::uint32_t>(4 * i);
        cells.triangles.push_back({at, at + 1, at + 2});
        cells.triangles.push_back({at, at + 2, at + 3});
    }
    if (crack < 0) add_still(parts, material, std::move(cells));
    const std::uint32_t id = parts.box(material, kMass, Vec3(0.3, 0.25, 0.2),
                                       Pose{Vec3(0.5, 0.1, 0.2), exponential(Vec3(0, 0, 0.3))});
    parts.body(id).velocity = Vec3(8, 0, 0);
    double speed = 0;
    bench.run(parts.scene(), bench.brief() ? 0.5 : 2.5, [&](World& world, double) {
        speed = world.velocity(world.bodies()[id]).x();
        return true;
    });
    return speed / 8;
}

}  // namespace

void edges_and_cracks(CaseBench& bench)
{
    for (const auto& [dt, step] : {std::pair{1.0 / 60, ""}, {1.0 / 240, ", dt 1/240"}}) {
        if (bench.brief() && dt < 0.01) break;
        const std::string at = step;
        fall_into_funnel(bench, ("spike in a hole" + at).c_str(), 0, dt);
        fall_into_funnel(bench, ("wedge in a groove" + at).c_str(), 0.5, dt);
        bench.report("cube 1 cm short of a cliff's edge" + at, "sunk after 5 s",
                     std::abs(sunk_on_cliff(bench, -0.01, dt)), 2e-3, "m");
        bench.report("cube 1 cm over a cliff's edge" + at, "short of a fall by its height",
                     std::max(0.0, 1 - sunk_on_cliff(bench, 0.01, dt)), 0, "m");
        for (const double crack : {-1.0, 0.0, 1e-3, 5e-3})
            bench.report((crack < 0           ? "cells of one mesh"
                              : crack == 0    ? "blocks side by side"
                              : crack == 1e-3 ? "cracks of 1 mm"
                                              : "cracks of 5 mm")
                             + at,
                         "speed lost", std::abs(1 - kept_over_cracks(bench, crack, dt)), 1e-2, "1");
    }
}

}  // namespace throng
