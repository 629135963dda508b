// Static meshes from both sides: H82.
//
// Answers: what meets an open sheet comes to rest on the side that it came from, its half height
// away, whichever way the triangles are wound; a closed mesh keeps out what comes from outside.
// What leans over a peak of a terrain is thrown by none of the triangles round it.
#include "cost/hard_cases/hard_cases.hpp"
#include "scene/catalog/parts.hpp"
#include "scene/catalog/random.hpp"
#include "scene/catalog/sheets.hpp"
#include "scene/names.hpp"
#include "throng/energy_ledger.hpp"
#include "throng/rotation.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

struct Guest {
    const char* name;
    decltype(ShapeDescription::shape) shape;
    double height;  // m, of its center at rest
};

std::vector<Guest> guests()
{
    HullShape stone;
    for (const double x : {-0.25, 0.25})
        for (const double y : {-0.25, 0.25})
            for (const double z : {-0.2, 0.2}) stone.points.emplace_back(x, y, z);
    return {{"ball", SphereShape{0.25}, 0.25},
            {"box", BoxShape{Vec3(0.25, 0.25, 0.2)}, 0.2},
            {"capsule", CapsuleShape{0.2, 0.3}, 0.5},
            {"cylinder", CylinderShape{0.25, 0.2}, 0.2},
            {"stone", stone, 0.2}};
}

// A square of 4 by 4 cells, 1 m above its origin, of 32 triangles.
MeshShape sheet(double cell = 1)
{
    return mesh_shape(
        sheet_mesh(4, [&](int i, int k) { return Vec3(cell * (i - 2), cell * (k - 2), 1); }));
}

// A block of 2 m by 2 m and as high as the sheet, its triangles turned inward.
MeshShape inward_block()
{
    MeshShape mesh;
    for (const double z : {0.0, 1.0})
        for (const double y : {-1.0, 1.0})
            for (const double x : {-1.0, 1.0}) mesh.vertices.emplace_back(x, y, z);
    mesh.triangles = {{4, 7, 5}, {4, 6, 7}, {0, 1, 3}, {0, 3, 2}, {0, 5, 1}, {0, 4, 5},
                      {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 7, 3}, {1, 5, 7}};
    return mesh;
}

struct Arrival {
    double side = 1, speed = 0, above = 0.05;  // 1 in front, -1 behind; m/s, m from the surface
    Pose at = {};
    bool mesh_last = false;
};

Scene met(const CaseBench& bench, const MeshShape& mesh, const Guest& guest, const Arrival& from)
{
    Scene scene = bench.scene();
    scene.shapes.push_back({"guest", guest.shape});
    scene.shapes.push_back({"mesh", mesh});
    BodyDescription body, still;
    body.shape = 0;
    still.shape = 1;
    still.motion = Motion::static_;
    still.position = from.at * Vec3(0, 0, -1);
    still.orientation = body.orientation = from.at.orientation;
    body.position = from.at * Vec3(0.21, 0.33, from.side * (guest.height + from.above));
    body.velocity = from.at.orientation * Vec3(0, 0, -from.side * from.speed);
    scene.gravity = from.at.orientation * Vec3(0, 0, -from.side * kGravity);
    scene.bodies = {still, body};
    if (from.mesh_last) std::swap(scene.bodies[0], scene.bodies[1]);
    return scene;
}

// m, how far from where it is to rest all guests come to be at most.
void rest_there(CaseBench& bench,
                const std::string& name,
                const MeshShape& mesh,
                const Arrival& from,
                const std::function<void(Settings&)>& set)
{
    double worst = 0;
    for (const Guest& guest : guests()) {
        Scene scene = met(bench, mesh, guest, from);
        set(scene.settings);
        double height = 0;
        bench.run(scene, bench.brief() ? 1.0 : 2.0, [&](World& world, double) {
            const auto ids = world.bodies();
            const Pose now = world.pose(from.mesh_last ? ids.front() : ids.back());
            height = from.side * from.at.to_local(now.position).z();
            return true;
        });
        worst = std::max(worst, std::abs(height - guest.height));
    }
    bench.report(name, "height at rest, error", worst, 2e-3, "m");
}

// Of those that come so fast that they are thrown about by the blow: how many come through.
void stay_there(CaseBench& bench,
                const std::string& name,
                const Arrival& from,
                const std::function<void(Settings&)>& set)
{
    int through = 0;
    for (const Guest& guest : guests()) {
        Scene scene = met(bench, sheet(), guest, from);
        set(scene.settings);
        bool held = true;
        bench.run(scene, bench.brief() ? 0.2 : 0.5, [&](World& world, double) {
            const Vec3 now = from.at.to_local(world.pose(world.bodies().back()).position);
            const bool over = std::max(std::abs(now.x()), std::abs(now.y())) < 2;
            held = held && (!over || from.side * now.z() > 0);
            return held;
        });
        through += held ? 0 : 1;
    }
    bench.report(name, "come through", through, 0, "1");
}

// A stick of 1:36 is let fall as it spins, by any of fifteen axes: how often it ends on the other
// side, or goes there as far as it reaches.
void stay_there_spinning(CaseBench& bench,
                         const std::string& name,
                         double side,
                         double spin,
                         const std::function<void(Settings&)>& set)
{
    constexpr double kCell = 20, kLength = 0.245;  // m
    const Guest sticks[] = {{"capsule", CapsuleShape{0.0068, kLength}, 0},
                            {"beam", BoxShape{Vec3(0.0068, 0.0068, kLength)}, 0}};
    std::vector<Vec3> axes = {Vec3(0.1, 1, 0.1), Vec3(1, 0.3, -0.4), Vec3(0.05, -0.1, 1)};
    Random random(82);
    while (axes.size() < 15 && !bench.brief()) axes.push_back(random_vector(random, -1, 1));
    int through = 0;
    for (const Guest& stick : sticks)
        for (const Vec3& axis : axes) {
            Scene scene = met(bench, sheet(kCell), stick, {.side = side, .above = 0.3});
            BodyDescription& body = scene.bodies.back();
            body.orientation = exponential(Vec3(axis.z(), axis.x(), axis.y()));
            body.angular_velocity = spin * axis.normalized();
            set(scene.settings);
            bool held = true;
            bench.run(scene, bench.brief() ? 1 : 4, [&](World& world, double) {
                const Vec3 now = world.pose(world.bodies().back()).position;
                const bool over = std::max(std::abs(now.x()), std::abs(now.y())) < 2 * kCell;
                if (!over) return false;
                held = side * now.z() > 0;
                return side * now.z() > -kLength;
            });
            through += held ? 0 : 1;
        }
    bench.report(name, "come through", through, 0, "1");
}

// Four large cells that come together in a peak; the ground about is as uneven as chance has it,
// and one of the ways down is a valley.
MeshShape peak()
{
    constexpr double kHeights[] = {0.33, 0.95, 1.71, 0.26, 2.15, 2.26, 1.15, 1.52, 0.37};  // m
    MeshShape mesh;
    for (int i = 0; i < 9; ++i)
        mesh.vertices.emplace_back(40 * (i / 3 - 1), 40 * (i % 3 - 1), kHeights[i]);
    for (const std::uint32_t a : {0, 1, 3, 4}) {
        mesh.triangles.push_back({a, a + 3, a + 4});
        mesh.triangles.push_back({a, a + 4, a + 1});
    }
    return mesh;
}

// A block is dropped flat on a peak, leans over to one side, and rocks until it lies.
void lean_over(CaseBench& bench, const std::string& name, const std::function<void(Settings&)>& set)
{
    double worst = 0;
    for (const double friction : {0.0, 0.1, 0.3, 0.5, 0.8})
        for (const Vec3& half : {Vec3(1.59, 3.36, 3.36), Vec3(2.5, 2.5, 0.8)}) {
            Scene scene = bench.scene();
            scene.materials.push_back({.name = "stone", .friction = friction, .restitution = 0});
            scene.shapes.push_back({"block", BoxShape{half}});
            scene.shapes.push_back({"peak", peak()});
            BodyDescription body, still;
            body.shape = 0;
            still.shape = 1;
            body.material = still.material = 0;
            still.motion = Motion::static_;
            body.position = Vec3(0.07, 0.03, 2.5 + half.z());
            scene.bodies = {still, body};
            set(scene.settings);
            EnergyLedger ledger;
            bench.run(
                scene, bench.brief() ? 1.5 : 4, [](World&, double) { return true; }, &ledger);
            worst = std::max(worst, ledger.gained() / ledger.greatest_kinetic());
        }
    bench.report(name, "energy gained, of the greatest in motion", worst, 5e-3, "1");
}

}  // namespace

void case_both_sides(CaseBench& bench)
{
    const Pose turned{Vec3::Zero(), exponential(Vec3(0.4, -0.9, 0.2))};
    const Pose far{Vec3(1e5, -2e5, 1e4), turned.orientation};
    for (const auto& [mode, name] : {std::pair{Overlap::allow, "allow"},
                                     {Overlap::back_up, "back_up"},
                                     {Overlap::subdivide, "subdivide"}}) {
        const auto set = [mode = mode](Settings& settings) { settings.overlap = mode; };
        for (const double side : {1.0, -1.0}) {
            const std::string who =
                std::string(name) + (side > 0 ? ", from in front" : ", from behind");
            rest_there(bench, who, sheet(), {.side = side}, set);
            rest_there(bench, who + ", 5 m/s", sheet(), {.side = side, .speed = 5}, set);
            stay_there(bench, who + ", 200 m/s", {.side = side, .speed = 200, .above = 2}, set);
        }
        rest_there(bench, std::string(name) + ", a block wound inward", inward_block(), {}, set);
    }
    const auto by_default = [](Settings&) {};
    rest_there(bench, "from behind, turned", sheet(), {.side = -1, .at = turned}, by_default);
    rest_there(bench, "from behind, far off", sheet(), {.side = -1, .at = far}, by_default);
    rest_there(bench, "from behind, mesh made last", sheet(), {.side = -1, .mesh_last = true},
               by_default);
    for (const auto& [dt, name] : {std::pair{1.0 / 240, "dt 1/240"}, {1e-3, "dt 1e-3"}})
        rest_there(bench, std::string("from behind, ") + name, sheet(), {.side = -1},
                   [dt = dt](Settings& settings) { settings.dt = dt; });
    rest_there(bench, "from behind, direct", sheet(), {.side = -1}, ask_exactly);
    for (const double spin : {50.0, 150.0, 440.0}) {
        const std::string who = "sticks at " + number_text(spin) + " rad/s";
        for (const int substeps : {1, 4, 16}) {
            if (bench.brief() && substeps != 4) continue;
            stay_there_spinning(bench, who + ", substeps=" + std::to_string(substeps), 1, spin,
                                [=](Settings& settings) { settings.substeps = substeps; });
        }
        stay_there_spinning(bench, who + ", from behind", -1, spin, by_default);
    }
    lean_over(bench, "over a peak", by_default);
    for (const int substeps : {1, 2, 16})
        lean_over(bench, "over a peak, substeps=" + std::to_string(substeps),
                  [=](Settings& settings) { settings.substeps = substeps; });
    lean_over(bench, "over a peak, pgs", [](Settings& settings) { settings.solver = Solver::pgs; });
    lean_over(bench, "over a peak, dt 1/240", [](Settings& settings) { settings.dt = 1.0 / 240; });
    lean_over(bench, "over a peak, exact", ask_exactly);
    // Its center on the back, all but through: it comes out there.
    rest_there(bench, "from behind, made half through", sheet(), {.side = -1, .above = -0.18},
               by_default);
}

}  // namespace throng
