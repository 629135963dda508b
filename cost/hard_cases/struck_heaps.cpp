// Struck heaps: H104, what is struck so hard that it spins far round in a step makes no energy.
//
// Answer: contacts that bounce nothing take energy of motion, and those of e = 1 keep it.
//
// Sticks and discs fall one upon another, from 3 to 50 m; balls of two sizes are wedged as they
// fall into a shaft; and a small box tumbles as it bounces, each corner that strikes faster than a
// step can follow. All drops are drawn with seeds.
#include "cost/hard_cases/hard_cases.hpp"
#include "scene/catalog/parts.hpp"
#include "throng/energy_ledger.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <functional>

namespace throng {

namespace {

struct Struck {
    const char* setting;
    double dt = 1.0 / 60;
    int substeps = 0;  // 0: the default
    Quat turn = Quat::Identity();
    bool last_first = false;  // order of creation
};

// Where a body of a drop begins, before all of it is turned.
Pose placed(const Struck& how, Random& random, const Vec3& at)
{
    const Vec3 tilt = random_vector(random, -0.004, 0.004);
    return {how.turn * at, how.turn * Quat(1, tilt.x(), tilt.y(), tilt.z()).normalized()};
}

void in_order(int count, bool last_first, const std::function<void(int)>& make)
{
    for (int i = 0; i < count; ++i) make(last_first ? count - 1 - i : i);
}

void drop_sticks(const Struck& how, std::uint64_t seed, SceneParts& parts)
{
    const std::uint32_t material = parts.material(1);
    parts.plane(material, how.turn * Vec3::UnitZ(), 0);
    Random random(seed);
    in_order(16, how.last_first, [&](int i) {
        const bool disc = i % 6 == 2;
        const double radius = disc ? 1.36 : 0.06, half = disc ? 0.053 : 1.47;
        parts.cylinder(material, disc ? 150 : 8.1, radius, half,
                       placed(how, random, Vec3(0, 0, 1.6 + 3 * i)));
    });
}

void drop_balls(const Struck& how, std::uint64_t seed, SceneParts& parts)
{
    const std::uint32_t material = parts.material(0.86);
    for (const Vec3& normal : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0)})
        parts.plane(material, how.turn * normal, -1.65);
    parts.plane(material, how.turn * Vec3::UnitZ(), 0);
    Random random(seed);
    in_order(6, how.last_first, [&](int i) {
        const bool small = i % 3 == 0;
        const Vec3 aside = random_vector(random, -0.002, 0.002);
        const std::uint32_t ball = parts.ball(material, small ? 1000 : 4200, small ? 0.62 : 1,
                                              how.turn * Vec3(aside.x(), aside.y(), 3 + 2.3 * i));
        parts.body(ball).angular_velocity = how.turn * random_vector(random, -0.01, 0.01);
    });
}

void drop_die(const Struck& how, std::uint64_t seed, SceneParts& parts)
{
    const std::uint32_t material = parts.material(0, 1);
    parts.plane(material, how.turn * Vec3::UnitZ(), 0);
    Random random(seed);
    const std::uint32_t box =
        parts.box(material, 0.023, Vec3(0.02, 0.012, 0.012), placed(how, random, Vec3(0, 0, 0.2)));
    parts.body(box).velocity = how.turn * Vec3(1, 0, -2);
    parts.body(box).angular_velocity = how.turn * random_vector(random, -80, 80);
}

struct Drop {
    const char* quantity;
    void (*make)(const Struck&, std::uint64_t, SceneParts&);
    int seeds;
    double time;           // s
    bool by_default_also;  // the bound holds at any step
};

constexpr double kBound = 1e-3;  // of the greatest energy of motion
constexpr double kMetAt = 1e-3;  // s, the step at which all meet it

constexpr Drop kDrops[] = {
    {"energy that sticks and discs make, over the greatest of motion", drop_sticks, 16, 8, true},
    {"energy that wedged balls make, over the greatest of motion", drop_balls, 10, 8, false},
    {"energy that a die makes as it bounces, over the greatest of motion", drop_die, 40, 10, false},
};

// The most that any seed makes.
double made(CaseBench& bench, const Struck& how, const Drop& drop, int seeds)
{
    double most = 0;
    for (int seed = 1; seed <= seeds; ++seed) {
        SceneParts parts(bench.scene());
        Scene& scene = parts.scene();
        scene.settings.dt = how.dt;
        if (how.substeps > 0) scene.settings.substeps = how.substeps;
        scene.gravity = how.turn * Vec3(0, 0, -9.81);
        drop.make(how, static_cast<std::uint64_t>(seed), parts);
        EnergyLedger ledger;
        bench.run(
            scene, drop.time, [](World&, double) { return true; }, &ledger);
        most = std::max(most, ledger.gained() / ledger.greatest_kinetic());
    }
    return most;
}

}  // namespace

void case_struck_heaps(CaseBench& bench)
{
    const Struck all[] = {
        {.setting = "default"},
        {.setting = "16 substeps", .substeps = 16},
        {.setting = "64 substeps", .substeps = 64},
        {.setting = "default, dt 1/240", .dt = 1.0 / 240},
        {.setting = "default, dt 1/1000", .dt = 1e-3},
        {.setting = "default, turned", .turn = Quat(0.8, 0.2, -0.4, 0.4).normalized()},
        {.setting = "default, last first", .last_first = true},
    };
    for (const Struck& how : all) {
        for (const Drop& drop : kDrops) {
            const double most = made(bench, how, drop, bench.brief() ? 1 : drop.seeds);
            const bool is_met = drop.by_default_also || how.dt <= kMetAt;
            bench.report_default(how.setting, drop.quantity, most, kBound, "1",
                                 is_met ? "" : "dt=1/1000");
        }
        if (bench.brief()) return;
    }
}

}  // namespace throng
