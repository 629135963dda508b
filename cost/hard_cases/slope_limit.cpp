// Slope at the limit: H13.
//
// A box on a slope of angle arctan(0.5) sticks when mu is above 0.5, and slides with
// g (sin - mu cos) below. g is 9.8 here, as in the published setting. Within a pyramid whose side
// is at an angle s to the way down, it is above 0.5 cos s that it sticks.
#include "cost/hard_cases/hard_cases.hpp"
#include "throng/rotation.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace throng {

namespace {

constexpr double kRoundGravity = 9.8;

// Downhill is +x, turned about the vertical.
Scene box_on_slope(const CaseBench& bench, double friction, double heading = 0)
{
    SceneParts parts(bench.scene());
    parts.scene().gravity = Vec3(0, 0, -kRoundGravity);
    const double angle = std::atan(0.5);
    const Quat turn = exponential(Vec3(0, 0, heading)) * exponential(Vec3(0, angle, 0));
    const std::uint32_t material = parts.material(friction);
    parts.plane(material, turn * Vec3::UnitZ(), 0);
    parts.box(material, 1, Vec3(0.5, 0.5, 0.25), Pose{turn * Vec3(0, 0, 0.25), turn});
    return parts.scene();
}

Vec3 place_of_box(const World& world) { return world.pose(world.bodies().back()).position; }

void stick(CaseBench& bench, const std::string& name, Scene scene)
{
    Vec3 settled = Vec3::Zero();
    double creep = 0;
    scene.settings.sleep = false;  // asleep it could not creep
    bench.run(scene, 11, [&](World& world, double now) {
        if (now < 1 + 1e-9) settled = place_of_box(world);
        creep = std::max(creep, (place_of_box(world) - settled).norm());
        if (now < 1 + 1e-9) creep = 0;
        return true;
    });
    bench.report(name + ", sleep=off", "creep in 10 s after the first", creep, 1e-5, "m");
}

// Down the diagonal between x and y, 0.745 of it along a side of the pyramid: there a cone would
// need a friction of 0.5.
void in_a_pyramid(CaseBench& bench)
{
    const double heading = std::atan(1.0), cos = std::sqrt(5.0) / 3;
    const double slope = std::sqrt(0.2), level = 2 * slope;  // sine and cosine
    Scene held = box_on_slope(bench, 0.375, heading);
    held.settings.friction_cone = FrictionCone::pyramid;
    stick(bench, "mu=0.375 aslant, friction within a pyramid", held);
    const double friction = 0.36;
    Scene slips = box_on_slope(bench, friction, heading);
    slips.settings.friction_cone = FrictionCone::pyramid;
    Vec3 early = Vec3::Zero(), late = Vec3::Zero();
    bench.run(slips, 5, [&](World& world, double now) {
        const Vec3 velocity = world.velocity(world.bodies().back());
        if (now < 1 + 1e-9) early = velocity;
        late = velocity;
        return true;
    });
    const double wanted = kRoundGravity * (slope * cos - friction * level);
    bench.report("mu=0.36 aslant, friction within a pyramid", "error of the acceleration",
                 std::abs((late - early).norm() / 4 / wanted - 1), 1e-2, "1");
}

// At the very limit, solved exactly.
void stick_at_the_limit(CaseBench& bench)
{
    Scene scene = box_on_slope(bench, 0.5);
    ask_exactly(scene.settings);
    scene.settings.sleep = false;
    const Vec3 start = scene.bodies.back().position;
    double creep = 0;
    bench.run(scene, 10, [&](World& world, double) {
        creep = std::max(creep, (place_of_box(world) - start).norm());
        return true;
    });
    bench.report("mu=0.5, sleep=off, direct", "creep in 10 s", creep, 1e-6, "m");
}

void slip(CaseBench& bench, bool exact)
{
    const double friction = 0.49;
    const double angle = std::atan(0.5);
    const double wanted = kRoundGravity * (std::sin(angle) - friction * std::cos(angle));
    const Vec3 downhill = exponential(Vec3(0, angle, 0)) * Vec3::UnitX();
    double early = 0, late = 0;
    Scene scene = box_on_slope(bench, friction);
    if (exact) ask_exactly(scene.settings);
    bench.run(scene, 5, [&](World& world, double now) {
        const double speed = downhill.dot(world.velocity(world.bodies().back()));
        if (now < 1 + 1e-9) early = speed;
        late = speed;
        return true;
    });
    const double acceleration = (late - early) / 4;
    bench.report(exact ? "mu=0.49, direct" : "mu=0.49", "error of the acceleration",
                 std::abs(acceleration - wanted) / wanted, exact ? 1e-6 : 1e-2, "1");
}

}  // namespace

void case_slope_limit(CaseBench& bench)
{
    stick(bench, "mu=0.505", box_on_slope(bench, 0.505));
    Scene on_points = box_on_slope(bench, 0.505);
    on_points.settings.friction_at = FrictionAt::points;
    stick(bench, "mu=0.505, friction at points", on_points);
    in_a_pyramid(bench);
    stick_at_the_limit(bench);
    slip(bench, false);
    slip(bench, true);
}

}  // namespace throng
