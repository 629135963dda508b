// Sliding bounce: H77. A ball that slides over a floor while it bounces loses (1 + e) mu v of the
// speed along it, v the speed that it came down with: friction is within the cone of all that
// presses it, what throws it back included. Where that is more than it takes, it rolls away.
#include "cost/hard_cases/hard_cases.hpp"
#include "throng/rotation.hpp"
#include "throng/world.hpp"

#include <cmath>

namespace throng {

namespace {

constexpr double kDown = 4, kAlong = 10;  // m/s

struct Bounce {
    const char* setting;
    double friction = 0.2, restitution = 0.8;
    double dt = 1.0 / 60, separation = 0.3;  // s, m above the floor
    Vec3 off = Vec3::Zero();
    Quat turn = Quat::Identity();
    bool ball_first = false;
    double rolling = 0;  // m
    void (*choose)(Settings&) = [](Settings&) {};
};

void slide(CaseBench& bench, const Bounce& bounce)
{
    SceneParts parts(bench.scene());
    parts.scene().gravity = Vec3::Zero();
    parts.scene().settings.dt = bounce.dt;
    bounce.choose(parts.scene().settings);
    const double radius = 0.1;
    const std::uint32_t material = parts.material(bounce.friction, bounce.restitution);
    parts.scene().materials[material].rolling_friction = bounce.rolling;
    const auto add_floor = [&] {
        const std::uint32_t floor = parts.box(
            material, 1, Vec3(5, 5, 1), {bounce.off + bounce.turn * Vec3(0, 0, -1), bounce.turn});
        parts.hold(floor);
    };
    if (!bounce.ball_first) add_floor();
    const std::uint32_t ball = parts.ball(
        material, 1, radius, bounce.off + bounce.turn * Vec3(0, 0, radius + bounce.separation));
    parts.body(ball).velocity = bounce.turn * Vec3(kAlong, 0, -kDown);
    if (bounce.ball_first) add_floor();
    Vec3 velocity = Vec3::Zero();
    bench.run(parts.scene(), bounce.separation / kDown + 0.1, [&](World& world, double) {
        velocity = bounce.turn.conjugate() * world.velocity(world.bodies()[ball]);
        return true;
    });
    const double slides = (1 + bounce.restitution) * bounce.friction * kDown;
    const double lost = std::min(slides, kAlong * 2 / 7);  // grips: what rolls has 5/7 left
    bench.report(bounce.setting, "loss of speed, off (1 + e) mu v as a share",
                 std::abs((kAlong - velocity.x()) / lost - 1), 5e-3, "1");
    bench.report(bounce.setting, "speed that it leaves with, off e v as a share",
                 std::abs(velocity.z() / (bounce.restitution * kDown) - 1), 5e-3, "1");
}

}  // namespace

void case_sliding_bounce(CaseBench& bench)
{
    const auto plainly = [](Settings& settings) { settings.solver = Solver::pgs; };
    const auto finely = [](Settings& settings) { settings.precision = Precision::double_; };
    const auto exactly = [](Settings& settings) { ask_exactly(settings); };
    const auto at_points = [](Settings& settings) { settings.friction_at = FrictionAt::points; };
    // Its sides are along the way of the ball and across.
    const auto in_pyramid = [](Settings& settings) {
        settings.friction_cone = FrictionCone::pyramid;
    };
    const Bounce all[] = {
        {.setting = "default"},
        {.setting = "default, e 0.2", .restitution = 0.2},
        {.setting = "default, e 1", .restitution = 1},
        {.setting = "default, it grips", .friction = 0.7},
        {.setting = "default, dt=1/240", .dt = 1.0 / 240},
        {.setting = "default, dt=1e-3", .dt = 1e-3},
        {.setting = "default, touching at the start", .separation = 0},
        {.setting = "default, far off", .off = Vec3(1e6, -2e6, 3e6)},
        {.setting = "default, turned", .turn = exponential(Vec3(0.3, -0.5, 0.7))},
        {.setting = "default, ball made first", .ball_first = true},
        {.setting = "default, rolling friction", .rolling = 0.01},
        {.setting = "friction at points", .choose = at_points},
        {.setting = "friction in a pyramid", .choose = in_pyramid},
        {.setting = "pgs", .choose = plainly},
        {.setting = "double", .choose = finely},
        {.setting = "direct", .dt = 1e-3, .choose = exactly},
    };
    for (const Bounce& bounce : all) slide(bench, bounce);
}

}  // namespace throng
