// Forced bounces: H89, balls and boxes that bounce while something besides gravity acts on them.
//
// Answer: what acts makes no energy where it is as good as nothing, and takes some where it brakes;
// so who loses nothing comes up as high for ever, by any integrator but explicit Euler, which makes
// energy of any fall.
#include "cost/hard_cases/hard_cases.hpp"
#include "throng/energy_ledger.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

constexpr double kHalf = 0.05, kDrop = 0.5;  // m

enum class Acts : std::uint8_t { nothing, faint_drag, drag, wind, push, attractor, spring };

struct Bounce {
    const char* setting;
    Acts acts = Acts::faint_drag;
    double restitution = 1;
    bool box = false, two = false;  // two: a heavier one lies on it
    double dt = 1.0 / 60;           // s
    double scale = 1;
    Vec3 off = Vec3::Zero();
    Integrator integrator = Integrator::auto_;
    void (*choose)(Settings&) = [](Settings&) {};
};

// What is faint stays far below what rounding does to the energy.
void act(Scene& scene, std::uint32_t id, const Bounce& bounce)
{
    BodyDescription& body = scene.bodies[id];
    switch (bounce.acts) {
    case Acts::nothing:
        return;
    case Acts::faint_drag:
        body.linear_drag = 1e-12;
        return;
    case Acts::drag:
        body.linear_drag = 0.05;
        return;
    case Acts::wind:
        body.linear_drag = 1e-12;
        scene.wind = Vec3(5, 0, 0);
        return;
    case Acts::push:
        body.force = Vec3(1e-12, 0, 0);
        return;
    case Acts::attractor:
        scene.attractors.push_back({bounce.off + Vec3(0, 0, 100), 1e-12});
        return;
    case Acts::spring: {
        Spring spring;
        spring.a = id;
        spring.at_b = bounce.off + Vec3(0, 0, 3);
        spring.stiffness = 1e-9;
        scene.springs.push_back(spring);
        return;
    }
    }
}

void let_bounce(CaseBench& bench, const Bounce& bounce)
{
    SceneParts parts(bench.scene());
    parts.scene().settings.dt = bounce.dt;
    parts.scene().settings.integrator = bounce.integrator;
    bounce.choose(parts.scene().settings);
    const std::uint32_t stuff = parts.material(0, bounce.restitution);
    parts.plane(stuff, Vec3::UnitZ(), bounce.off.z());
    const double half = kHalf * bounce.scale, drop = kDrop * bounce.scale;
    const Vec3 at = bounce.off + Vec3(0, 0, half + drop);
    const std::uint32_t id = bounce.box
        ? parts.box(stuff, 1, Vec3::Constant(half), {at, Quat::Identity()})
        : parts.ball(stuff, 1, half, at);
    act(parts.scene(), id, bounce);
    if (bounce.two)
        act(parts.scene(), parts.ball(stuff, 3, half, at + Vec3(0, 0, 2.02 * half)), bounce);

    EnergyLedger ledger;
    const double span = bench.brief() ? 5 : 20;
    double highest = 0;
    const auto watch = [&](World& world, double time) {
        const double height = world.pose(world.bodies()[id]).position.z() - at.z();
        if (time > span - 2.2) highest = std::max(highest, (height + drop) / drop);
        return true;
    };
    bench.run(parts.scene(), span, watch, &ledger);
    bench.report(bounce.setting, "energy gained over the greatest of motion",
                 ledger.gained() / ledger.greatest_kinetic(), 1e-3, "1");
    if (bounce.restitution < 1 || bounce.acts == Acts::drag || bounce.two)
        bench.show(bounce.setting, "height of the last bounces over that of the first", highest,
                   "1");
    else
        bench.report(bounce.setting, "height of the last bounces, off that of the first, of it",
                     std::abs(highest - 1), 2e-3, "1");
}

}  // namespace

void case_forced_bounces(CaseBench& bench)
{
    const auto plainly = [](Settings& settings) { settings.solver = Solver::pgs; };
    const auto finely = [](Settings& settings) { settings.precision = Precision::double_; };
    const auto more = [](Settings& settings) { settings.substeps = 16; };
    const auto exactly = [](Settings& settings) { settings.solver = Solver::direct; };
    const auto wait = [](Settings& settings) { settings.overlap = Overlap::back_up; };
    using enum Acts;
    const Bounce all[] = {
        {.setting = "default, nothing acts", .acts = nothing},
        {.setting = "default, faint drag"},
        {.setting = "default, drag", .acts = drag},
        {.setting = "default, wind", .acts = wind},
        {.setting = "default, a faint push", .acts = push},
        {.setting = "default, a faint attractor", .acts = attractor},
        {.setting = "default, a faint spring", .acts = spring},
        {.setting = "default, faint drag, a box", .box = true},
        {.setting = "default, nothing acts, two balls", .acts = nothing, .two = true},
        {.setting = "default, faint drag, two balls", .two = true},
        {.setting = "default, drag, two balls", .acts = drag, .two = true},
        {.setting = "default, a faint attractor, two balls", .acts = attractor, .two = true},
        {.setting = "default, a faint attractor, a box", .acts = attractor, .box = true},
        {.setting = "default, a faint spring, a box", .acts = spring, .box = true},
        {.setting = "default, faint drag, e 0.5", .restitution = 0.5},
        {.setting = "default, a faint attractor, e 0.5", .acts = attractor, .restitution = 0.5},
        {.setting = "default, faint drag, dt=1/240", .dt = 1.0 / 240},
        {.setting = "default, faint drag, dt=1e-3", .dt = 1e-3},
        {.setting = "default, a faint attractor, dt=1/240", .acts = attractor, .dt = 1.0 / 240},
        {.setting = "default, a faint attractor, dt=1e-3", .acts = attractor, .dt = 1e-3},
        {.setting = "default, faint drag, 16 substeps", .choose = more},
        {.setting = "default, faint drag, ten times as large", .scale = 10},
        {.setting = "default, faint drag, far off", .off = Vec3(1e4, -2e4, 3e4)},
        {.setting = "midpoint, nothing acts", .acts = nothing, .integrator = Integrator::midpoint},
        {.setting = "splitting, nothing acts",
         .acts = nothing,
         .integrator = Integrator::splitting},
        {.setting = "rk4, nothing acts", .acts = nothing, .integrator = Integrator::rk4},
        {.setting = "rk4, a box", .acts = nothing, .box = true, .integrator = Integrator::rk4},
        {.setting = "rk4, faint drag", .integrator = Integrator::rk4},
        {.setting = "midpoint, a faint spring", .acts = spring, .integrator = Integrator::midpoint},
        {.setting = "semi_implicit, faint drag", .integrator = Integrator::semi_implicit},
        {.setting = "semi_implicit, a faint attractor",
         .acts = attractor,
         .integrator = Integrator::semi_implicit},
        {.setting = "pgs, faint drag", .choose = plainly},
        {.setting = "double, faint drag", .choose = finely},
        {.setting = "direct, nothing acts", .acts = nothing, .choose = exactly},
        {.setting = "direct, a box", .acts = nothing, .box = true, .choose = exactly},
        {.setting = "direct, faint drag", .choose = exactly},
        {.setting = "direct, a faint attractor", .acts = attractor, .choose = exactly},
        {.setting = "direct, nothing acts, dt=1e-3",
         .acts = nothing,
         .dt = 1e-3,
         .choose = exactly},
        {.setting = "back_up, faint drag", .choose = wait},
    };
    for (const Bounce& bounce : all) let_bounce(bench, bounce);
}

}  // namespace throng
