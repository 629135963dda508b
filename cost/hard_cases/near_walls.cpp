// Near walls: H101, what tumbles beside a wall that it never touches keeps energy and momentum.
//
// Answer: without a force the energy of turning and the angular momentum stay what they were. The
// contacts that the step tells of, as the wall is near, bear nothing: but whoever has them is moved
// by the solver, not by the integrator of what flies.
#include "cost/hard_cases/hard_cases.hpp"
#include "throng/energy_ledger.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

constexpr double kTime = 10;  // s
// Of the angular momentum, 1/s: what is lost of its direction by each second of a substep.
constexpr double kTurned = 36;

struct Beside {
    const char* setting;
    double dt = 1.0 / 60;
    int substeps = 0;  // 0: the default
    Quat turn = Quat::Identity();
    Vec3 off = Vec3::Zero();
    bool on_pivot = false;  // by a corner
};

// Half extents, m: the first all but even in its plane, a needle, a plate, and one of three moments
// that are far apart.
const Vec3 kSizes[] = {{0.5, 0.51, 0.2}, {0.5, 0.52, 0.6}, {0.5, 0.53, 1.5},
                       {0.1, 0.05, 1},   {0.04, 0.02, 1},  {0.2, 0.5, 0.7}};
const Vec3 kSpins[] = {{3, 0.1, 0.2}, {5, 4, 3}, {0.1, 8, 0.1}};  // rad/s

// Of all that tumbled, the worst.
struct Seen {
    double gained = 0, lost = 0;  // over the energy at the start
    double momentum = 0;          // its change, over what it was
    int steps = 0, beside = 0;    // of all, and those that told of a contact
};

// m, between the wall and the sphere that the body turns in: a corner that goes straight on for a
// step must not get to the wall, or it would be held.
double distance_to_wall(double radius, double spin, double dt)
{
    const double way = spin * radius * dt;
    return 0.005 + 0.6 * way * way / radius;
}

Vec3 momentum_about(const Measures& measures, const Vec3& center)
{
    return measures.angular_momentum - center.cross(measures.momentum);
}

void tumble(CaseBench& bench, const Beside& how, const Vec3& half, const Vec3& spin, Seen& worst)
{
    SceneParts parts(bench.scene());
    Scene& scene = parts.scene();
    scene.settings.dt = how.dt;
    if (how.substeps > 0) scene.settings.substeps = how.substeps;
    scene.settings.sleep = false;
    scene.gravity = Vec3::Zero();
    const std::uint32_t material = parts.material(0.5);
    const double radius = (how.on_pivot ? 2 : 1) * half.norm();
    const Vec3 normal = how.turn * Vec3::UnitZ();
    const double distance = distance_to_wall(radius, spin.norm(), how.dt);
    parts.plane(material, normal, normal.dot(how.off) - radius - distance);
    const Vec3 arm = how.on_pivot ? half : Vec3(Vec3::Zero());
    const std::uint32_t body =
        parts.box(material, 1000 * 8 * half.prod(), half, {how.off - how.turn * arm, how.turn});
    if (how.on_pivot) parts.body(body).pivot = arm;
    parts.body(body).angular_velocity = how.turn * spin;

    Measures start, end;
    bench.inspect(scene, [&](const World& world) { start = world.measure(); });
    EnergyLedger ledger;
    Vec3 center = how.off;
    const auto watch = [&](World& world, double now) {
        ++worst.steps;
        worst.beside += world.report().manifolds > 0 ? 1 : 0;
        if (now < kTime - 1.5 * how.dt) return true;
        end = world.measure();
        if (!how.on_pivot) center = world.pose(world.bodies()[body]).position;
        return true;
    };
    bench.run(scene, kTime, watch, &ledger);
    const Vec3 before = momentum_about(start, how.off), after = momentum_about(end, center);
    worst.gained = std::max(worst.gained, ledger.gained() / start.kinetic_energy);
    worst.lost = std::max(worst.lost, 1 - end.kinetic_energy / start.kinetic_energy);
    worst.momentum = std::max(worst.momentum, (after - before).norm() / before.norm());
}

}  // namespace

void case_near_walls(CaseBench& bench)
{
    const Beside all[] = {
        {.setting = "default"},
        {.setting = "default, on a pivot", .on_pivot = true},
        {.setting = "default, turned", .turn = Quat(0.8, 0.2, -0.4, 0.4).normalized()},
        {.setting = "default, far off", .off = Vec3(3e4, -1e4, 2e4)},
        {.setting = "default, dt 1/240", .dt = 1.0 / 240},
        {.setting = "default, dt 1/1000", .dt = 1e-3},
        {.setting = "16 substeps", .substeps = 16},
    };
    for (const Beside& how : all) {
        Seen worst;
        for (const Vec3& half : kSizes)
            for (const Vec3& spin : kSpins) tumble(bench, how, half, spin, worst);
        bench.report(how.setting, "energy gained over that of the start", worst.gained, 1e-4, "1");
        bench.report(how.setting, "energy lost over that of the start", worst.lost, 1e-3, "1");
        const int substeps = how.substeps > 0 ? how.substeps : Settings{}.substeps;
        bench.report(how.setting, "change of angular momentum over what it was", worst.momentum,
                     kTurned * how.dt / substeps, "1");
        bench.show(how.setting, "share of steps that tell of a contact",
                   static_cast<double>(worst.beside) / worst.steps, "1");
        if (bench.brief()) return;
    }
}

}  // namespace throng
