// Edges and cracks: H43's spike in a hole, wedge in a groove, cube on a cliff's edge, seams and
// cracks, as scenes; the queries that were published of them are H42's.
//
// Answers: what fits into its hole comes to lie at its bottom; a cube stands whose middle is over
// the cliff and falls whose middle is not; what slides without friction meets no seam and no crack.
#include "cost/hard_cases/hard_cases.hpp"
#include "scene/catalog/closed_meshes.hpp"
#include "scene/catalog/parts.hpp"
#include "throng/rotation.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

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

// Flat but for a funnel of four sides, 4 m deep from an edge of 4 m by 4 m; with `long_by` a groove
// that is longer by twice as much, and whose point is an edge.
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
        // A point has no edge to stand triangles on.
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
void fall_into_funnel(CaseBench& bench, const std::string& name, double long_by, double dt)
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
    // A wedge may lie anywhere along its groove.
    const double along = long_by == 0 ? point.y() : 0;
    bench.report(name, "point off the bottom", std::hypot(point.x(), along, point.z() + 4), 5e-3,
                 "m");
    bench.report(name, "speed at the end", speed, 1e-3, "m/s");
}

// m, how far a cube sinks whose middle is so far over the edge of a cliff.
double sunk_on_cliff(CaseBench& bench, double over, double dt)
{
    SceneParts parts(bench.scene());
    parts.scene().settings.dt = dt;
    const std::uint32_t material = parts.material(0.5);
    add_still(parts, material, mesh_shape(box_mesh(Vec3(2.5, 5, 1.5))), Vec3(-2.5, 0, -1.5));
    const std::uint32_t id = parts.box(material, kMass, Vec3::Constant(0.5),
                                       Pose{Vec3(over, 0.3, 0.5), Quat::Identity()});
    double height = 0;
    bench.run(parts.scene(), 5, [&](World& world, double) {
        height = world.pose(world.bodies()[id]).position.z();
        return true;
    });
    return 0.5 - height;
}

constexpr int kCells = 24;  // of 1 m, one after another along x

void add_blocks(SceneParts& parts, std::uint32_t material, double crack)
{
    for (int i = 0; i < kCells; ++i)
        add_still(parts, material, mesh_shape(box_mesh(Vec3(0.5, 2, 0.5))),
                  Vec3(i * (1 + crack) + 0.5, 0, -0.5));
}

void add_sheet(SceneParts& parts, std::uint32_t material)
{
    MeshShape sheet;
    for (std::uint32_t i = 0; i <= kCells; ++i) {
        sheet.vertices.emplace_back(i, -2, 0);
        sheet.vertices.emplace_back(i, 2, 0);
        if (i == kCells) break;
        sheet.triangles.push_back({2 * i, 2 * i + 2, 2 * i + 3});
        sheet.triangles.push_back({2 * i, 2 * i + 3, 2 * i + 1});
    }
    add_still(parts, material, std::move(sheet));
}

// The share of its speed that a box loses as it slides over a floor without friction.
double lost_over(CaseBench& bench,
                 double dt,
                 const std::function<void(SceneParts& parts, std::uint32_t material)>& add_floor)
{
    SceneParts parts(bench.scene());
    parts.scene().settings.dt = dt;
    const std::uint32_t material = parts.material(0);
    add_floor(parts, material);
    const std::uint32_t id = parts.box(material, kMass, Vec3(0.3, 0.25, 0.2),
                                       Pose{Vec3(0.5, 0.1, 0.2), exponential(Vec3(0, 0, 0.3))});
    parts.body(id).velocity = Vec3(8, 0, 0);
    double speed = 0;
    bench.run(parts.scene(), bench.brief() ? 0.5 : 2.5, [&](World& world, double) {
        speed = world.velocity(world.bodies()[id]).x();
        return true;
    });
    return std::abs(1 - speed / 8);
}

}  // namespace

void edges_and_cracks(CaseBench& bench)
{
    for (const auto& [dt, step] : {std::pair{1.0 / 60, ""}, {1.0 / 240, ", dt 1/240"}}) {
        if (bench.brief() && dt < 0.01) break;
        const std::string at = step;
        fall_into_funnel(bench, "spike in a hole" + at, 0, dt);
        fall_into_funnel(bench, "wedge in a groove" + at, 0.5, dt);
        bench.report("cube 1 cm short of a cliff's edge" + at, "sunk after 5 s",
                     std::abs(sunk_on_cliff(bench, -0.01, dt)), 2e-3, "m");
        bench.report("cube 1 cm over a cliff's edge" + at, "short of a fall by its height",
                     std::max(0.0, 1 - sunk_on_cliff(bench, 0.01, dt)), 0, "m");
        bench.report("cells of one mesh" + at, "speed lost", lost_over(bench, dt, add_sheet), 1e-2,
                     "1");
        for (const auto& [crack, name] : {std::pair{0.0, "blocks side by side"},
                                          {1e-3, "cracks of 1 mm"},
                                          {5e-3, "cracks of 5 mm"}})
            bench.report(name + at, "speed lost",
                         lost_over(bench, dt,
                                   [crack = crack](SceneParts& parts, std::uint32_t material) {
                                       add_blocks(parts, material, crack);
                                   }),
                         1e-2, "1");
    }
}

}  // namespace throng
