// Sliding to rest: H12.
//
// Answers: from speed v a box slides v^2 / (2 mu g), straight on whatever the direction. Up a slope
// of angle s it slides v^2 / (2 g (sin s + mu cos s)), then comes back. With a pyramid for a cone
// it slides that way along each of its sides by itself, which bends the path.
#include "cost/hard_cases/hard_cases.hpp"
#include "throng/rotation.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

Scene sliding_box(const CaseBench& bench, double friction, const Vec3& velocity)
{
    SceneParts parts(bench.scene());
    const std::uint32_t material = parts.material(friction);
    parts.plane(material, Vec3::UnitZ(), 0);
    Pose pose;
    pose.position = Vec3(0, 0, 0.25);
    const std::uint32_t box = parts.box(material, 1, Vec3(0.5, 0.5, 0.25), pose);
    parts.body(box).velocity = velocity;
    return parts.scene();
}

BodyId box_of(const World& world) { return world.bodies().back(); }

// How a box has slid by the end: along the way it was pushed, and furthest off that at any time.
struct Slid {
    Vec3 place = Vec3::Zero();  // on the floor
    double way = 0, sideways = 0;
};

Slid slid(CaseBench& bench, const Scene& scene, double seconds)
{
    const Vec3 along = scene.bodies.back().velocity.normalized();
    Slid seen;
    bench.run(scene, seconds, [&](World& world, double) {
        seen.place = world.pose(box_of(world)).position;
        seen.place.z() = 0;
        seen.way = along.dot(seen.place);
        seen.sideways = std::max(seen.sideways, (seen.place - along * seen.way).norm());
        return true;
    });
    return seen;
}

double way_to_rest(double friction, const Vec3& velocity)
{
    return velocity.squaredNorm() / (2 * friction * kGravity);
}

void slide(CaseBench& bench, const char* name, double friction, const Vec3& velocity)
{
    const double wanted = way_to_rest(friction, velocity);
    const Slid seen = slid(bench, sliding_box(bench, friction, velocity), 4);
    bench.report(name, "error of the way to rest", std::abs(seen.way - wanted) / wanted, 3e-3, "1");
    bench.report(name, "way off the line over the way", seen.sideways / wanted, 1e-5, "1");
}

// Friction at each corner by itself: the same way, with the corners' different loads.
void slide_on_points(CaseBench& bench)
{
    const double friction = 0.3;
    const Vec3 velocity(3, 4, 0);
    const Vec3 wanted = velocity.normalized() * way_to_rest(friction, velocity);
    Scene scene = sliding_box(bench, friction, velocity);
    scene.settings.friction_at = FrictionAt::points;
    const double error = (slid(bench, scene, 4).place - wanted).norm() / wanted.norm();
    bench.report("v=(3, 4), mu=0.3, friction at points", "error of the place of rest", error, 3e-3,
                 "1");
}

// On a level floor the sides of the pyramid are the axes x and y.
void slide_in_a_pyramid(CaseBench& bench)
{
    const double friction = 0.3, twice = 2 * friction * kGravity;
    const Vec3 velocity(6, 8, 0), wanted(36 / twice, 64 / twice, 0);
    Scene scene = sliding_box(bench, friction, velocity);
    scene.settings.friction_cone = FrictionCone::pyramid;
    const Slid seen = slid(bench, scene, 4);
    const char* const name = "v=(6, 8), mu=0.3, friction within a pyramid";
    bench.report(name, "error of the place of rest that such a path has",
                 (seen.place - wanted).norm() / wanted.norm(), 3e-3, "1");
    bench.show(name, "way that a pyramid bends the path off the line, over the way",
               seen.sideways / way_to_rest(friction, velocity), "1");
}

// Exactly, at a step of a thousandth of a second.
void slide_exactly(CaseBench& bench, const char* name, double friction, const Vec3& velocity)
{
    const double wanted = way_to_rest(friction, velocity);
    Scene scene = sliding_box(bench, friction, velocity);
    ask_exactly(scene.settings);
    scene.settings.dt = 1e-3;
    const Slid seen = slid(bench, scene, 2.5);
    bench.report(name, "error of the way to rest", std::abs(seen.way - wanted) / wanted, 1e-3, "1");
    bench.report(name, "way off the line over the way", seen.sideways / wanted, 1e-6, "1");
}

// How far up a slope of 20 degrees, and how fast back at the start: errors, as shares.
std::pair<double, double> slide_up(CaseBench& bench, int substeps)
{
    const double angle = 20 * kPi / 180, friction = 0.3, speed = 4;
    const Quat turn = exponential(Vec3(0, -angle, 0));  // uphill is +x
    SceneParts parts(bench.scene());
    const std::uint32_t material = parts.material(friction);
    parts.plane(material, turn * Vec3::UnitZ(), 0);
    const std::uint32_t box =
        parts.box(material, 1, Vec3(0.5, 0.5, 0.25), Pose{turn * Vec3(0, 0, 0.25), turn});
    const Vec3 uphill = turn * Vec3::UnitX();
    parts.body(box).velocity = speed * uphill;
    ask_exactly(parts.scene().settings);
    parts.scene().settings.dt = 1e-3;
    parts.scene().settings.substeps = substeps;
    double highest = 0, passing = 0;
    bench.run(parts.scene(), 4, [&](World& world, double) {
        const double way = uphill.dot(world.pose(box_of(world)).position);
        highest = std::max(highest, way);
        if (highest > 0.1 && way < 0) passing = world.velocity(box_of(world)).norm();
        return passing == 0;
    });
    return {std::abs(highest / 1.3070330 - 1), std::abs(passing / 1.2415799 - 1)};
}

void slide_up(CaseBench& bench)
{
    const char *const name = "up a slope, direct, dt 1e-3", *const way = "error of the way up",
                      *const speed = "error of the speed at the start again";
    const auto [finer_way, finer_speed] = slide_up(bench, 4);
    bench.report(name + std::string(", 4 substeps"), way, finer_way, 1e-3, "1");
    bench.report(name + std::string(", 4 substeps"), speed, finer_speed, 1e-3, "1");
    // A single one passes the top by a step's way.
    const auto [single_way, single_speed] = slide_up(bench, 1);
    bench.report_default(name, way, single_way, 1e-3, "1", "4 substeps");
    bench.report_default(name, speed, single_speed, 1e-3, "1", "4 substeps");
}

}  // namespace

void case_sliding(CaseBench& bench)
{
    slide(bench, "v=(10, 0), mu=0.5", 0.5, Vec3(10, 0, 0));
    slide(bench, "v=(3, 4), mu=0.3", 0.3, Vec3(3, 4, 0));
    slide_on_points(bench);
    slide_in_a_pyramid(bench);
    slide_exactly(bench, "v=(10, 0), mu=0.5, direct, dt 1e-3", 0.5, Vec3(10, 0, 0));
    slide_exactly(bench, "v=(3, 4), mu=0.3, direct, dt 1e-3", 0.3, Vec3(3, 4, 0));
    slide_up(bench);
}

}  // namespace throng
