// Gone loads: H129, a load many times as heavy as what bears it goes from one step to the next.
//
// Answer: what bore it stays where it is, on the ground and on what goes along at a constant speed,
// by whatever way the load went. Rigid bodies store nothing that could throw them: all they do is
// come up by what they had been pressed in.
#include "cost/hard_cases/hard_cases.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace throng {

namespace {

constexpr double kHalf = 0.5;                  // m
constexpr double kMass = 1000;                 // kg, of a box
constexpr double kSettle = 6, kAfter = 3;      // s
constexpr double kFastest = 0.5, kFar = 0.02;  // m/s; m
const Vec3 kHalfPlatform{60, 20, 1};           // m

struct Piles {
    const char* name;
    int columns, rows;
};

constexpr Piles kTower{"tower of ten", 1, 10}, kTallTower{"tower of thirty", 1, 30},
    kWall{"wall of 20 by 10", 20, 10};

// How a load goes, a body of the world.
struct Going {
    const char* name;
    std::function<void(World&, BodyId)> act;
    bool pushed = false;  // the load is a force on a box like the others
};

const Going kRemoved{"is removed",
                     [](World& world, BodyId load) { world.remove(std::span(&load, 1)); }};
const Going kGoings[] = {
    kRemoved,
    {"becomes as light as what bears it",
     [](World& world, BodyId load) { world.set_mass(load, world.mass(world.bodies()[1])); }},
    {"is put elsewhere",
     [](World& world, BodyId load) {
         world.set_pose(load, {Vec3(30, 10, 40), Quat::Identity()});
     }},
    {"is lifted off by twice its weight",
     [](World& world, BodyId load) {
         world.set_force(load, 2 * kGravity * world.mass(load) * Vec3::UnitZ(), Vec3::Zero());
     }},
    {"is led off at 5 m/s",
     [](World& world, BodyId load) {
         world.set_motion(load, Motion::kinematic);
         world.set_velocity(load, 5 * Vec3::UnitZ(), Vec3::Zero());
     }},
    {"is held where it is",
     [](World& world, BodyId load) { world.set_motion(load, Motion::static_); }},
    {"was a force",
     [](World& world, BodyId load) { world.set_force(load, Vec3::Zero(), Vec3::Zero()); }, true},
};

struct Way {
    const char* name;
    void (*choose)(Settings&) = [](Settings&) {};
    const char* met_by = nullptr;  // the setting that meets a bound where this one does not
};

struct Bearing {
    double before = 0, fastest = 0, gone = 0;  // m/s, as it bears and after; m
};

// The ground, what bears, and the load, in this order.
Scene loaded(const CaseBench& bench,
             const Way& way,
             const Piles& piles,
             double times,
             bool by_force,
             const Vec3& velocity)
{
    SceneParts parts(bench.scene());
    const std::uint32_t material = parts.material(0.6);
    Scene& scene = parts.scene();
    way.choose(scene.settings);
    BodyDescription& ground = scene.bodies[parts.box(
        material, 1, kHalfPlatform, {Vec3(0, 0, -kHalfPlatform.z()), Quat::Identity()})];
    ground.motion = velocity.isZero(0) ? Motion::static_ : Motion::kinematic;
    const Vec3 half = Vec3::Constant(kHalf);
    const auto put = [&](double x, double z) {
        return parts.box(material, kMass, half, {Vec3(x, 0, z), Quat::Identity()});
    };
    // Of a wall every other row is shorter by one, so that nobody hangs over.
    constexpr double kPitch = 1.001;  // m
    const bool wall = piles.columns > 1;
    for (int row = 0; row < piles.rows; ++row)
        for (int column = 0; column < piles.columns - (wall ? row % 2 : 0); ++column)
            put(kPitch * column + (wall ? kPitch / 2 : 0.01) * (row % 2), kHalf * (2 * row + 1));
    const std::uint32_t load =
        put(kPitch * (piles.columns - 1) / 2 + 0.005, kHalf * (2 * piles.rows + 1));
    BodyDescription& loading = scene.bodies[load];
    if (by_force)
        loading.force = -kGravity * kMass * (times - 1) * Vec3::UnitZ();
    else
        loading.mass = times * kMass;
    for (BodyDescription& body : scene.bodies) body.velocity = velocity;
    return scene;
}

Bearing let_go(CaseBench& bench, const Scene& scene, const Going& going)
{
    const Vec3 velocity = scene.bodies.front().velocity;
    const std::size_t load = scene.bodies.size() - 1;
    Bearing bearing;
    std::vector<Vec3> from;
    double left = 0;  // s, when it went
    bench.run(scene, kSettle + kAfter, [&](World& world, double now) {
        const std::vector<BodyId> bodies = world.bodies();
        const bool gone = !from.empty();
        if (now > kSettle / 2)
            for (std::size_t i = 1; i < load; ++i) {
                const double speed = (world.velocity(bodies[i]) - velocity).norm();
                double& of = gone ? bearing.fastest : bearing.before;
                of = std::max(of, speed);
                if (gone)
                    bearing.gone = std::max(
                        bearing.gone,
                        (world.pose(bodies[i]).position - from[i] - (now - left) * velocity)
                            .norm());
            }
        if (gone || now < kSettle) return true;
        for (const BodyId body : bodies) from.push_back(world.pose(body).position);
        left = now;
        going.act(world, bodies[load]);
        return true;
    });
    return bearing;
}

std::string as_text(double times) { return std::to_string(static_cast<int>(times)); }

void report(CaseBench& bench,
            const Way& way,
            const Piles& piles,
            double times,
            const Going& going,
            const Vec3& velocity,
            const std::string& beside = {})
{
    const Bearing bearing =
        let_go(bench, loaded(bench, way, piles, times, going.pushed, velocity), going);
    bench.forgive_residual();
    const std::string setting = std::string(way.name) + ", " + piles.name + beside + ", a load of "
        + as_text(times) + " of its boxes " + going.name;
    const auto line = [&](const char* what, double figure, double bound, const char* unit) {
        if (way.met_by == nullptr) return bench.report(setting, what, figure, bound, unit);
        bench.report_default(setting, what, figure, bound, unit, way.met_by);
    };
    line("greatest speed as it bears", bearing.before, kFastest, "m/s");
    line("greatest speed once it is gone", bearing.fastest, kFastest, "m/s");
    line("how far any box has gone", bearing.gone, kFar, "m");
}

}  // namespace

void case_gone_loads(CaseBench& bench)
{
    const Way plain{"default"};
    const Way ways[] = {
        plain,
        {"sleep=off", [](Settings& settings) { settings.sleep = false; }},
        {"double", [](Settings& settings) { settings.precision = Precision::double_; }},
        {"dt=1/30", [](Settings& settings) { settings.dt = 1.0 / 30; }},
        {"dt=1/240", [](Settings& settings) { settings.dt = 1.0 / 240; }},
        {"pgs", [](Settings& settings) { settings.solver = Solver::pgs; }, "solver=soft_step"},
        {"direct", ask_exactly},
    };
    const double loads[] = {2, 10, 100, 1000};
    if (bench.brief()) {
        report(bench, plain, kTower, 1000, kRemoved, Vec3::Zero());
        return report(bench, plain, kTower, 100, kGoings[3], Vec3::Zero());
    }
    for (const double times : loads)
        for (const Going& going : kGoings) report(bench, plain, kTower, times, going, Vec3::Zero());
    for (const Way& way : ways)
        for (const double times : loads) {
            if (&way != &ways[0]) report(bench, way, kTower, times, kRemoved, Vec3::Zero());
            if (way.choose == ask_exactly) continue;
            report(bench, way, kTallTower, times, kRemoved, Vec3::Zero());
            report(bench, way, kWall, times, kRemoved, Vec3::Zero());
        }
    for (const double times : loads) {
        report(bench, plain, kTower, times, kRemoved, Vec3(5, 0, 0), " on what goes on at 5 m/s");
        report(bench, plain, kTower, times, kRemoved, Vec3(0, 0, 5), " on what goes up at 5 m/s");
        report(bench, plain, kTower, times, kRemoved, Vec3(0, 0, -5),
               " on what goes down at 5 m/s");
    }
}

}  // namespace throng
