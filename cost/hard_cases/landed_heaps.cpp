// Landed heaps: H100, heaps that fall into a pit lie still, and by little more than usual work.
//
// Answer: what a heap bears goes down by many ways, none of which is a column: finer substeps and
// exact solves are for as long as it lands, and little of them is left once it lies. It makes no
// energy on its way there, nor as it is let go.
#include "cost/hard_cases/certified_pairs.hpp"
#include "cost/hard_cases/hard_cases.hpp"
#include "throng/energy_ledger.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

constexpr double kLanded = 6, kTime = 10;  // s

struct Heap {
    const char* setting;
    Quat turn = Quat::Identity();
    Vec3 off = Vec3::Zero();
    bool backwards = false;  // order of creation
    double dt = 1.0 / 60;
    bool is_small_alone = false;  // bodies of 40 mm and no others
};

struct Kind {
    int count;
    double size;       // m, the longest half extent
    double thickness;  // least half extent over that
};

constexpr Kind kKinds[] = {{50, 0.5, 1},     {100, 0.5, 1},    {200, 0.5, 1},   {30, 0.3, 0.6},
                           {30, 0.02, 0.6},  {80, 0.02, 0.6},  {30, 0.3, 0.33}, {80, 0.3, 0.33},
                           {30, 0.02, 0.33}, {160, 0.3, 0.33}, {80, 0.3, 0.6}};

// Of bodies as small as this escalation is for good: they bear too much for a step of 1/60 s.
constexpr double kSmall = 0.1;  // m

// What was seen of some heaps, the worst of it.
struct Seen {
    double work = 0;  // of escalation once they lie, over that of the usual substeps; of no small
    double overlap = 0;  // over the least extent, at the end
    double gained = 0;   // over the greatest kinetic energy; of no small
    double gained_by_small = 0;
    double speed = 0;  // m/s, rms over bodies, at the end
};

Scene heap(const CaseBench& bench, const Heap& how, const Kind& kind, std::uint64_t seed)
{
    Random random(seed);
    SceneParts parts(bench.scene());
    Scene& scene = parts.scene();
    scene.settings.dt = how.dt;
    scene.settings.sleep = false;
    scene.gravity = how.turn * Vec3(0, 0, -kGravity);
    const std::uint32_t material = parts.material(0.5);
    const int side = std::max(2, static_cast<int>(std::lround(std::sqrt(kind.count / 6.0))));
    const Vec3 half(kind.size, kind.size * std::sqrt(kind.thickness), kind.size * kind.thickness);
    const double pitch = 2.02 * half.norm();  // none overlaps another, however it is turned
    const auto wall = [&](const Vec3& normal, double distance) {
        const Vec3 turned = how.turn * normal;
        parts.plane(material, turned, turned.dot(how.off) - distance);
    };
    wall(Vec3::UnitZ(), 0);
    for (const Vec3& normal : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0)})
        wall(normal, pitch * side / 2);
    for (int i = 0; i < kind.count; ++i) {
        const int at = how.backwards ? kind.count - 1 - i : i;
        const Vec3 place(at % side - 0.5 * (side - 1), at / side % side - 0.5 * (side - 1),
                         0.6 + at / (side * side));
        parts.box(material, 1000 * 8 * half.prod(), half,
                  {how.off + how.turn * Vec3(pitch * place), how.turn * random_turn(random)});
    }
    return scene;
}

Seen land(CaseBench& bench, const Heap& how, const Kind& kind, std::uint64_t seed)
{
    Seen seen;
    std::uint64_t before = 0;
    double usual = 0;
    EnergyLedger ledger;
    const Scene scene = heap(bench, how, kind, seed);
    const auto watch = [&](World& world, double now) {
        const StepReport report = world.report();
        if (now <= kLanded)
            before = report.escalation_work;
        else
            usual += static_cast<double>(report.manifolds * std::size_t(scene.settings.substeps));
        seen.work = static_cast<double>(report.escalation_work - before) / std::max(usual, 1.0);
        if (now < kTime - 1.5 * scene.settings.dt) return true;
        const Measures measures = world.measure();
        const double mass = 1000 * 8 * std::pow(kind.size, 3) * std::pow(kind.thickness, 1.5);
        seen.overlap = measures.greatest_overlap / (2 * kind.size * kind.thickness);
        seen.speed = std::sqrt(2 * measures.kinetic_energy / (mass * kind.count));
        return true;
    };
    bench.run(scene, kTime, watch, &ledger);
    (kind.size > kSmall ? seen.gained : seen.gained_by_small) =
        ledger.gained() / ledger.greatest_kinetic();
    return seen;
}

void land_all(CaseBench& bench, const Heap& how)
{
    Seen worst;
    for (const Kind& kind : kKinds)
        for (std::uint64_t seed = 1; seed <= (bench.brief() ? 1 : 3); ++seed) {
            if (bench.brief() && (kind.count > 30 || kind.size < kSmall)) continue;
            if (how.is_small_alone && kind.size > kSmall) continue;
            const Seen seen = land(bench, how, kind, seed);
            if (kind.size > kSmall) worst.work = std::max(worst.work, seen.work);
            worst.overlap = std::max(worst.overlap, seen.overlap);
            worst.gained = std::max(worst.gained, seen.gained);
            worst.gained_by_small = std::max(worst.gained_by_small, seen.gained_by_small);
            worst.speed = std::max(worst.speed, seen.speed);
        }
    const std::string setting = how.setting;
    // By default what a shorter step meets.
    const auto report = [&](const char* quantity, double figure, double bound, const char* unit,
                            double met_at, const char* met_by) {
        bench.report_default(setting, quantity, figure, bound, unit,
                             how.dt <= met_at ? "" : met_by);
    };
    if (!how.is_small_alone) {
        bench.report(setting, "work of escalation over that of the usual substeps, landed",
                     worst.work, 4, "1");
        report("energy gained over the greatest kinetic energy", worst.gained, 1e-3, "1", 1.0 / 240,
               "dt=1/240");
    }
    bench.report(setting, "greatest overlap over the least extent", worst.overlap, 0.05, "1");
    if (!bench.brief())
        report("energy gained by bodies of 40 mm over the greatest kinetic energy",
               worst.gained_by_small, 1e-3, "1", 1.0 / 480, "dt=1/480");
    report("rms of speeds after 10 s", worst.speed, 0.01, "m/s", 1.0 / 480, "14 s");
}

}  // namespace

void case_landed_heaps(CaseBench& bench)
{
    const Heap all[] = {
        {.setting = "default, dt 1/240", .dt = 1.0 / 240},
        {.setting = "default, dt 1/480, 40 mm", .dt = 1.0 / 480, .is_small_alone = true},
        {.setting = "default"},
        {.setting = "default, turned", .turn = Quat(0.8, 0.2, -0.4, 0.4).normalized()},
        {.setting = "default, far off", .off = Vec3(3e4, -1e4, 2e4)},
        {.setting = "default, backwards", .backwards = true},
    };
    for (const Heap& how : all) {
        land_all(bench, how);
        if (bench.brief()) return;
    }
}

}  // namespace throng
