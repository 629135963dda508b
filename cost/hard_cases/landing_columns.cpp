// Landing columns: H90, a tall column falls on a floor and bounces off nothing.
//
// Answer: it stays there. A blow goes up a column faster than iterations follow, and what contacts
// gave to stop it must not come a second time.
#include "cost/hard_cases/hard_cases.hpp"
#include "throng/energy_ledger.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

struct Column {
    const char* setting;
    int count = 30;
    Vec3 half{0.5, 0.11, 0.5};  // m, of a slab that stands on its edge
    bool balls = false;
    double drop = 0.35;    // m
    double dt = 1.0 / 60;  // s
    double scale = 1;
    Vec3 off = Vec3::Zero();
    bool top_first = false;
    bool weightless = false;  // has the speed of its fall from the start, and no gravity
    double turn = 0;          // rad, about what is upright
    double heavier = 1;       // each than the one below
    void (*choose)(Settings&) = [](Settings&) {};
    const char* met_by = "";  // setting that meets a bound which the default misses
};

void drop(CaseBench& bench, const Column& column)
{
    SceneParts parts(bench.scene());
    parts.scene().settings.dt = column.dt;
    column.choose(parts.scene().settings);
    parts.plane(parts.material(0.5), Vec3::UnitZ(), column.off.z());
    const Vec3 half = column.half * column.scale;
    const double fall = column.drop * column.scale, speed = std::sqrt(2 * kGravity * fall);
    if (column.weightless) parts.scene().gravity = Vec3::Zero();
    const Quat turn(std::cos(column.turn / 2), 0, 0, std::sin(column.turn / 2));
    for (int i = 0; i < column.count; ++i) {
        const int place = column.top_first ? column.count - 1 - i : i;
        const Vec3 at = column.off + Vec3(0, 0, fall + half.z() * (2 * place + 1));
        const double mass = std::pow(column.heavier, place);
        const std::uint32_t body =
            column.balls ? parts.ball(0, mass, half.z(), at) : parts.box(0, mass, half, {at, turn});
        if (column.weightless) parts.body(body).velocity = Vec3(0, 0, -speed);
    }

    EnergyLedger ledger;
    double thrown = 0;
    const auto watch = [&](World& world, double) {
        for (const BodyId id : world.bodies()) thrown = std::max(thrown, world.velocity(id).z());
        return true;
    };
    bench.run(parts.scene(), speed / kGravity + (bench.brief() ? 0.3 : 2), watch, &ledger);
    const char* const upward = "greatest speed upward, of that of the fall";
    bench.report(column.setting, upward, thrown / speed, 0.5, "1");
    const char* const gained = "energy gained over the greatest kinetic energy";
    const double share = ledger.gained() / ledger.greatest_kinetic();
    bench.report_default(column.setting, gained, share, 0.01, "1", column.met_by);
}

}  // namespace

void case_landing_columns(CaseBench& bench)
{
    const auto plainly = [](Settings& settings) { settings.solver = Solver::pgs; };
    const auto plainly_finely = [](Settings& settings) {
        settings.solver = Solver::pgs;
        settings.precision = Precision::double_;
    };
    const auto plainly_in_more = [](Settings& settings) {
        settings.solver = Solver::pgs;
        settings.substeps = 16;
    };
    const auto plainly_at_points = [](Settings& settings) {
        settings.solver = Solver::pgs;
        settings.friction_at = FrictionAt::points;
    };
    const auto more = [](Settings& settings) { settings.substeps = 16; };
    const auto finely = [](Settings& settings) { settings.precision = Precision::double_; };
    const auto wait = [](Settings& settings) { settings.overlap = Overlap::back_up; };
    const Vec3 cube = Vec3::Constant(0.25);
    const Column all[] = {
        {.setting = "default"},
        {.setting = "default, 2 slabs", .count = 2},
        {.setting = "default, 3 slabs", .count = 3},
        {.setting = "default, 10 slabs", .count = 10},
        {.setting = "default, 60 slabs", .count = 60, .met_by = "solver=direct"},
        {.setting = "default, cubes", .half = cube},
        {.setting = "default, balls", .count = 10, .half = cube, .balls = true},
        {.setting = "default, from 3 m", .drop = 3},
        {.setting = "default, dt=1/240", .dt = 1.0 / 240},
        {.setting = "default, dt=1e-3", .dt = 1e-3},
        {.setting = "default, a hundred times as large", .scale = 100},
        {.setting = "default, a tenth as large", .scale = 0.1},
        {.setting = "default, turned", .turn = 0.7},
        {.setting = "default, far off", .off = Vec3(1e5, -2e5, 3e5)},
        {.setting = "default, the top first", .top_first = true},
        {.setting = "default, each half as heavy again as the one below",
         .count = 10,
         .heavier = 1.5},
        {.setting = "default, 16 substeps", .choose = more},
        {.setting = "default, no gravity", .weightless = true},
        {.setting = "default, no gravity, 10 slabs", .count = 10, .weightless = true},
        {.setting = "double", .choose = finely},
        {.setting = "pgs", .choose = plainly},
        {.setting = "pgs, 3 slabs", .count = 3, .choose = plainly},
        {.setting = "pgs, 10 slabs", .count = 10, .choose = plainly},
        {.setting = "pgs, cubes", .half = cube, .choose = plainly},
        {.setting = "pgs, balls", .count = 10, .half = cube, .balls = true, .choose = plainly},
        {.setting = "pgs, from 3 m", .drop = 3, .choose = plainly},
        {.setting = "pgs, dt=1/240", .dt = 1.0 / 240, .choose = plainly},
        {.setting = "pgs, dt=1e-3", .dt = 1e-3, .choose = plainly},
        {.setting = "pgs, a hundred times as large", .scale = 100, .choose = plainly},
        {.setting = "pgs, turned", .turn = 0.7, .choose = plainly},
        {.setting = "pgs, the top first", .top_first = true, .choose = plainly},
        {.setting = "pgs, each half as heavy again as the one below",
         .count = 10,
         .heavier = 1.5,
         .choose = plainly},
        {.setting = "pgs, no gravity", .weightless = true, .choose = plainly},
        {.setting = "pgs, 16 substeps", .choose = plainly_in_more},
        {.setting = "pgs, friction at points", .choose = plainly_at_points},
        {.setting = "pgs, double", .choose = plainly_finely},
        {.setting = "direct", .choose = ask_exactly},
        {.setting = "direct, 60 slabs", .count = 60, .choose = ask_exactly},
        {.setting = "back_up", .count = 10, .choose = wait},
    };
    for (const Column& column : all)
        if (!bench.brief() || column.count < 60) drop(bench, column);
}

}  // namespace throng
