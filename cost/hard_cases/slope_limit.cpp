// Slope at the limit: H13.
//
// A box on a slope of angle arctan(0.5) sticks when mu is above 0.5, and slides with
// g (sin - mu cos) below. g is 9.8 here, as in the published setting.
#include "cost/hard_cases/hard_cases.hpp"
#include "kernels/math/rotation.hpp"
#include "pipeline/world.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

constexpr double kRoundGravity = 9.8;

Scene box_on_slope(const CaseBench& bench, double friction)
{
    SceneParts parts(bench.scene());
    parts.scene().gravity = Vec3(0, 0, -kRoundGravity);
    const double angle = std::atan(0.5);
    const Quat turn = exponential(Vec3(0, angle, 0));  // downhill is +x
    const std::uint32_t material = parts.material(friction);
    parts.plane(material, turn * Vec3::UnitZ(), 0);
    parts.box(material, 1, Vec3(0.5, 0.5, 0.25), Pose{turn * Vec3(0, 0, 0.25), turn});
    return parts.scene();
}

Vec3 place_of_box(const World& world) { return world.pose(world.bodies().back()).position; }

void stick(CaseBench& bench)
{
    Vec3 settled = Vec3::Zero();
    double creep = 0;
    Scene scene = box_on_slope(bench, 0.505);
    scene.settings.sleep = false;  // asleep it could not creep
    bench.run(scene, 11, [&](World& world, double now) {
        if (now < 1 + 1e-9) settled = place_of_box(world);
        creep = std::max(creep, (place_of_box(world) - settled).norm());
        if (now < 1 + 1e-9) creep = 0;
        return true;
    });
    bench.report("mu=0.505, sleep=off", "creep in 10 s after the first", creep, 1e-5, "m");
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
    stick(bench);
    stick_at_the_limit(bench);
    slip(bench, false);
    slip(bench, true);
}

}  // namespace throng
