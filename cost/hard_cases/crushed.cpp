// Crushed: H88, somebody heavy falls on somebody light that lies on a floor, and nothing bounces.
//
// Answer: the heavy one is stopped by the floor, through the light one, and stays there: what gives
// nothing back throws nobody, whatever it weighs.
#include "cost/hard_cases/hard_cases.hpp"
#include "throng/energy_ledger.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

constexpr double kLight = 0.1, kWide = 1;  // m, half of either

enum class Under : std::uint8_t { ball, box, three_balls, two_boxes };

struct Blow {
    const char* setting;
    double ratio = 1000, speed = 27;  // of the masses; m/s
    Under under = Under::ball;
    bool falls_box = false;
    double dt = 1.0 / 60;  // s
    double scale = 1;
    Vec3 off = Vec3::Zero();
    bool heavy_first = false;
    void (*choose)(Settings&) = [](Settings&) {};
};

void put_light(SceneParts& parts, const Blow& blow)
{
    const double half = kLight * blow.scale;
    const auto ball = [&](double x, double y) {
        parts.ball(0, 1, half, blow.off + Vec3(x, y, half));
    };
    const auto box = [&](double z) {
        parts.box(0, 1, Vec3::Constant(half), {blow.off + Vec3(0, 0, z), Quat::Identity()});
    };
    switch (blow.under) {
    case Under::ball:
        return ball(0, 0);
    case Under::box:
        return box(half);
    case Under::three_balls:
        for (int i = 0; i < 3; ++i)
            ball(3 * half * std::cos(2 * kPi * i / 3), 3 * half * std::sin(2 * kPi * i / 3));
        return;
    case Under::two_boxes:
        box(half);
        return box(3 * half);
    }
}

std::uint32_t put_heavy(SceneParts& parts, const Blow& blow)
{
    const double half = kWide * blow.scale, mass = blow.ratio;
    const double above = (blow.under == Under::two_boxes ? 4 : 2) * kLight * blow.scale;
    const Vec3 at = blow.off + Vec3(0, 0, above + half + 0.3 * blow.scale);
    const std::uint32_t heavy = blow.falls_box
        ? parts.box(0, mass, Vec3::Constant(half), {at, Quat::Identity()})
        : parts.ball(0, mass, half, at);
    parts.body(heavy).velocity = Vec3(0, 0, -blow.speed);
    return heavy;
}

void hit(CaseBench& bench, const Blow& blow)
{
    SceneParts parts(bench.scene());
    parts.scene().settings.dt = blow.dt;
    blow.choose(parts.scene().settings);
    parts.plane(parts.material(0.5), Vec3::UnitZ(), blow.off.z());
    std::uint32_t heavy = 0;
    if (blow.heavy_first) heavy = put_heavy(parts, blow);
    put_light(parts, blow);
    if (!blow.heavy_first) heavy = put_heavy(parts, blow);

    EnergyLedger ledger;
    double thrown = 0, lowest = 0;
    const auto watch = [&](World& world, double) {
        const std::vector<BodyId> ids = world.bodies();
        thrown = std::max(thrown, world.velocity(ids[heavy]).z());
        for (std::size_t i = 1; i < ids.size(); ++i) {
            const double height = world.pose(ids[i]).position.z() - blow.off.z();
            lowest = std::max(lowest, 1 - height / (kLight * blow.scale));
        }
        return true;
    };
    bench.run(parts.scene(), bench.brief() ? 0.5 : 3, watch, &ledger);
    bench.report(blow.setting, "speed that the heavy one is thrown back with, of its own",
                 thrown / blow.speed, 0.05, "1");
    bench.report(blow.setting, "energy gained over that of the blow",
                 ledger.gained() / (blow.ratio * blow.speed * blow.speed / 2), 1e-3, "1");
    bench.show(blow.setting, "way of the light one into the floor, of its half height", lowest,
               "1");
}

}  // namespace

void case_crushed(CaseBench& bench)
{
    const auto plainly = [](Settings& settings) { settings.solver = Solver::pgs; };
    const auto finely = [](Settings& settings) { settings.precision = Precision::double_; };
    const auto more = [](Settings& settings) { settings.substeps = 16; };
    const Blow all[] = {
        {.setting = "default"},
        {.setting = "default, 1:10", .ratio = 10},
        {.setting = "default, 1:30", .ratio = 30},
        {.setting = "default, 1:100", .ratio = 100},
        {.setting = "default, 1:10000", .ratio = 1e4},
        {.setting = "default, 5 m/s", .speed = 5},
        {.setting = "default, 1:30, 5 m/s", .ratio = 30, .speed = 5},
        {.setting = "default, dt=1/240", .dt = 1.0 / 240},
        {.setting = "default, dt=1e-3", .dt = 1e-3},
        {.setting = "default, 1:30, dt=1/240", .ratio = 30, .dt = 1.0 / 240},
        {.setting = "default, 16 substeps", .choose = more},
        {.setting = "default, on a box", .under = Under::box},
        {.setting = "default, on two boxes", .under = Under::two_boxes},
        {.setting = "default, on three balls", .under = Under::three_balls},
        {.setting = "default, a box on a box", .under = Under::box, .falls_box = true},
        {.setting = "default, a box on three balls, 1:100",
         .ratio = 100,
         .under = Under::three_balls,
         .falls_box = true},
        {.setting = "default, ten times as large", .scale = 10},
        {.setting = "default, far off", .off = Vec3(1e5, -2e5, 3e5)},
        {.setting = "default, the heavy one first", .heavy_first = true},
        {.setting = "double", .choose = finely},
        {.setting = "pgs", .choose = plainly},
        {.setting = "pgs, 1:10", .ratio = 10, .choose = plainly},
        {.setting = "pgs, 1:30", .ratio = 30, .choose = plainly},
        {.setting = "pgs, 1:100", .ratio = 100, .choose = plainly},
        {.setting = "direct", .choose = ask_exactly},
    };
    for (const Blow& blow : all) hit(bench, blow);
}

}  // namespace throng
