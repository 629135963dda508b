// Walkers: H86, bodies that are driven along what bears them.
//
// Answer: they have the speed that they are driven at; a wall is pressed by the drive, m v / dt at
// most, and by what friction bears, and nobody climbs.
#include "cost/hard_cases/hard_cases.hpp"
#include "scene/catalog/parts.hpp"
#include "scene/catalog/sheets.hpp"
#include "throng/rotation.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace throng {

namespace {

constexpr double kSpeed = 1.4, kMass = 80, kFriction = 0.5;  // m/s, kg
constexpr double kRadius = 0.3, kHalf = 0.6;                 // m
constexpr double kTime = 3, kBegun = 1;                      // s
constexpr double kOff = 1e-2, kRise = 5e-3;                  // of the speed; m

enum class Ground : std::uint8_t { plane, mesh, box, crate, slope };
enum class Against : std::uint8_t { nobody, wall, other };

struct Walk {
    std::string setting;
    Ground ground = Ground::plane;
    Against against = Against::nobody;
    Quat turn = Quat::Identity();  // takes up to an axis
    Vec3 off = Vec3::Zero();
    bool ground_last = false;
    Settings settings = {};

    Pose place(const Vec3& at) const { return {off + turn * at, turn}; }
    double rises() const { return ground == Ground::slope ? 10 * std::numbers::pi / 180 : 0; }
};

MeshShape sheet(double half, int cells)
{
    const auto along = [&](int i) { return half * (2.0 * i / cells - 1); };
    return mesh_shape(sheet_mesh(cells, [&](int i, int k) { return Vec3(along(i), along(k), 0); }));
}

std::uint32_t put_static_box(SceneParts& parts, const Vec3& half, const Pose& pose)
{
    const std::uint32_t id = parts.box(0, 1, half, pose);
    parts.hold(id);
    return id;
}

std::uint32_t put_ground(SceneParts& parts, const Walk& walk)
{
    const Vec3 up = walk.turn * Vec3(-std::sin(walk.rises()), 0, std::cos(walk.rises()));
    switch (walk.ground) {
    case Ground::plane:
    case Ground::slope:
        return parts.plane(0, up, up.dot(walk.off));
    case Ground::mesh: {
        const std::uint32_t id = put_static_box(parts, Vec3::Ones(), walk.place(Vec3::Zero()));
        parts.scene().shapes[parts.body(id).shape].shape = sheet(10, 16);
        return id;
    }
    case Ground::box:
        return put_static_box(parts, Vec3(10, 10, 1), walk.place(Vec3(0, 0, -1)));
    case Ground::crate:
        break;
    }
    // It floats on ice, so that whatever would drag it along does.
    const std::uint32_t ice = parts.material(0);
    parts.plane(ice, up, up.dot(walk.off) - 1);
    return parts.box(0, 200, Vec3(10, 2, 0.5), walk.place(Vec3(0, 0, -0.5)));
}

std::uint32_t put_walker(SceneParts& parts, const Walk& walk, double x, double speed)
{
    const double high = kHalf + kRadius / std::cos(walk.rises());
    const std::uint32_t id = parts.cylinder(0, kMass, kRadius, kHalf, walk.place(Vec3(x, 0, high)));
    BodyDescription& body = parts.body(id);
    parts.scene().shapes[body.shape].shape = CapsuleShape{kRadius, kHalf};
    body.lock_rotation = true;
    const Vec3 wanted = walk.turn * Vec3(speed, 0, 0), up = walk.turn * Vec3::UnitZ();
    for (int k = 0; k < 3; ++k)
        if (std::abs(up[k]) < 0.5) body.drive_velocity[static_cast<std::size_t>(k)] = wanted[k];
    return id;
}

struct Walkers {
    Scene scene;
    std::uint32_t ground = 0, walker = 0, wall = 0;
};

Walkers scene_of(CaseBench& bench, const Walk& walk)
{
    SceneParts parts(bench.scene());
    parts.scene().settings = walk.settings;
    parts.scene().gravity = walk.turn * Vec3(0, 0, -kGravity);
    parts.material(kFriction);
    Walkers made;
    if (!walk.ground_last) made.ground = put_ground(parts, walk);
    made.walker = put_walker(parts, walk, 0, kSpeed);
    if (walk.against == Against::other) put_walker(parts, walk, 1, -kSpeed);
    if (walk.against == Against::wall)
        made.wall = put_static_box(parts, Vec3(0.5, 2, 2), walk.place(Vec3(1.5, 0, 2)));
    if (walk.ground_last) made.ground = put_ground(parts, walk);
    made.scene = parts.scene();
    return made;
}

void walk_freely(CaseBench& bench, const Walk& walk)
{
    const Walkers made = scene_of(bench, walk);
    const Vec3 wanted(kSpeed, 0, kSpeed * std::tan(walk.rises()));
    double off = 0;
    bench.run(made.scene, kTime, [&](World& world, double now) {
        if (now < kBegun) return true;
        const Vec3 velocity = world.velocity(world.bodies()[made.walker]);
        off = std::max(off, (walk.turn.conjugate() * velocity - wanted).norm() / kSpeed);
        return true;
    });
    bench.report(walk.setting, "off its speed", off, kOff, "1");
}

void walk_against(CaseBench& bench, const Walk& walk)
{
    const Walkers made = scene_of(bench, walk);
    const double drive = kMass * kSpeed / walk.settings.dt, begun = kHalf + kRadius;
    double pressed = 0, rises = 0, fast = 0;
    bench.run(made.scene, kTime, [&](World& world, double now) {
        const std::vector<BodyId> ids = world.bodies();
        const auto seen = [&](const Vec3& v) { return Vec3(walk.turn.conjugate() * v); };
        const Vec3 at = seen(world.pose(ids[made.walker]).position - walk.off);
        rises = std::max(rises, at.z() - begun);
        if (now < kBegun) return true;
        fast = std::max(fast, world.velocity(ids[made.walker]).norm());
        if (walk.against != Against::wall) return true;
        const double borne = -seen(world.contact_force(ids[made.ground])).z();
        const double force = seen(world.contact_force(ids[made.wall])).x();
        pressed = std::max(pressed, force / (drive + kFriction * borne));
        return true;
    });
    bench.report(walk.setting, "rises", rises, kRise, "m");
    bench.report(walk.setting, "speed", fast, kOff * kSpeed, "m/s");
    if (walk.against == Against::wall)
        bench.report(walk.setting, "presses, over drive and friction", pressed, 1.01, "1");
}

void walk_all(CaseBench& bench, const std::string& how, const Settings& settings)
{
    const auto freely = [&](const char* what, auto set) {
        Walk walk;
        walk.setting = how + what;
        walk.settings = settings;
        set(walk);
        walk.against == Against::nobody ? walk_freely(bench, walk) : walk_against(bench, walk);
    };
    const Quat about = exponential(Vec3(0, 0, 0.7));
    const Quat lying = exponential(Vec3::Constant(2 * std::numbers::pi / std::sqrt(27.0)));
    freely(", plane", [](Walk&) {});
    freely(", mesh", [](Walk& w) { w.ground = Ground::mesh; });
    freely(", box", [](Walk& w) { w.ground = Ground::box; });
    freely(", crate on ice", [](Walk& w) { w.ground = Ground::crate; });
    freely(", up 10 degrees", [](Walk& w) { w.ground = Ground::slope; });
    freely(", turned", [&](Walk& w) { w.turn = about, w.ground = Ground::box; });
    freely(", lying", [&](Walk& w) { w.turn = lying, w.ground = Ground::slope; });
    freely(", far off", [](Walk& w) { w.off = Vec3(2e5, -1e5, 3e5), w.ground = Ground::mesh; });
    freely(", made first", [](Walk& w) { w.ground_last = true, w.ground = Ground::box; });
    freely(", against a wall", [](Walk& w) { w.against = Against::wall; });
    freely(", against a wall, turned",
           [&](Walk& w) { w.against = Against::wall, w.turn = lying * about; });
    freely(", head on", [](Walk& w) { w.against = Against::other; });
    freely(", head on, far off",
           [](Walk& w) { w.against = Against::other, w.off = Vec3(2e5, -1e5, 3e5); });
}

}  // namespace

void case_walkers(CaseBench& bench)
{
    const Settings usual = bench.settings();
    walk_all(bench, "default", usual);
    const auto with = [&](auto choose) {
        Settings settings = usual;
        choose(settings);
        return settings;
    };
    const Settings plain = with([](Settings& s) { s.solver = Solver::pgs; });
    const Settings direct = with([](Settings& s) { s.solver = Solver::direct; });
    if (bench.brief()) {
        walk_freely(bench, {.setting = "pgs, plane", .settings = plain});
        walk_freely(bench, {.setting = "direct, plane", .settings = direct});
        return;
    }
    walk_all(bench, "pgs", plain);
    walk_all(bench, "direct", direct);
    for (const double rate : {240.0, 1000.0})
        walk_all(bench, "dt 1/" + std::to_string(std::lround(rate)),
                 with([&](Settings& s) { s.dt = 1 / rate; }));
    for (const int substeps : {1, 16})
        walk_all(bench, "substeps=" + std::to_string(substeps),
                 with([&](Settings& s) { s.substeps = substeps; }));
    Settings exact = usual;
    ask_exactly(exact);
    walk_all(bench, "most exact", exact);
}

}  // namespace throng
