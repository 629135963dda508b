// Sliding to rest: H12.
//
// Answers: from speed v a box slides v^2 / (2 mu g), straight on whatever the direction. Up a slope
// of angle s it slides v^2 / (2 g (sin s + mu cos s)), then comes back. With a pyramid for a cone
// it slides that way along each of its sides by itself, which bends the path.
#include "cost/hard_cases/hard_cases.hpp"
#include "kernels/math/rotation.hpp"
#include "pipeline/world.hpp"

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

void slide(CaseBench& bench, const char* name, double friction, const Vec3& velocity)
{
    const double wanted = velocity.squaredNorm() / (2 * friction * kGravity);
    const Vec3 along = velocity.normalized();
    Vec3 end = Vec3::Zero();
    double sideways = 0;
    bench.run(sliding_box(bench, friction, velocity), 4, [&](World& world, double) {
        end = world.pose(box_of(world)).position;
        const Vec3 flat(end.x(), end.y(), 0);
        sideways = std::max(sideways, (flat - along * along.dot(flat)).norm());
        return true;
    });
    const double way = along.dot(end);
    bench.report(name, "error of the way to rest", std::abs(way - wanted) / wanted, 3e-3, "1");
    bench.report(name, "way off the line over the way", sideways / wanted, 1e-5, "1");
}

// Friction at each corner by itself: the same way, with the corners' different loads.
void slide_on_points(CaseBench& bench)
{
    const double friction = 0.3;
    const Vec3 velocity(3, 4, 0), wanted = velocity * (5 / (2 * friction * kGravity));
    Scene scene = sliding_box(bench, friction, velocity);
    scene.settings.friction_at = FrictionAt::points;
    Vec3 end = Vec3::Zero();
    bench.run(scene, 4, [&](World& world, double) {
        end = world.pose(box_of(world)).position;
        return true;
    });
    const double error = (Vec3(end.x(), end.y(), 0) - wanted).norm() / wanted.norm();
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
    Vec3 end = Vec3::Zero();
    bench.run(scene, 4, [&](World& world, double) {
        end = world.pose(box_of(world)).position;
        return true;
    });
    const Vec3 flat(end.x(), end.y(), 0), along = velocity.normalized();
    const char* const name = "v=(6, 8), mu=0.3, friction within a pyramid";
    bench.report(name, "error of the place of rest that such a path has",
                 (flat - wanted).norm() / wanted.norm(), 3e-3, "1");
    bench.skip(name, "way off the line over the way of a cone",
               "for comparison, what a pyramid bends the path by: "
                   + std::to_string((flat - along * along.dot(flat)).norm() * twice / 100));
}

// Exactly, at a step of a thousandth of a second.
void slide_exactly(CaseBench& bench, const char* name, double friction, const Vec3& velocity)
{
    const double wanted = velocity.squaredNorm() / (2 * friction * kGravity);
    const Vec3 along = velocity.normalized();
    Scene scene = sliding_box(bench, friction, velocity);
    ask_exactly(scene.settings);
    scene.settings.dt = 1e-3;
    Vec3 end = Vec3::Zero();
    double sideways = 0;
    bench.run(scene, 2.5, [&](World& world, double) {
        end = world.pose(box_of(world)).position;
        const Vec3 flat(end.x(), end.y(), 0);
        sideways = std::max(sideways, (flat - along * along.dot(flat)).norm());
        return true;
    });
    const double way = along.dot(end);
    bench.report(name, "error of the way to rest", std::abs(way - wanted) / wanted, 1e-3, "1");
    bench.report(name, "way off the line over the way", sideways / wanted, 1e-6, "1");
}

// Up a slope of 20 degrees and back down.
void slide_up(CaseBench& bench)
{
    const double angle = 20 * 3.14159265358979323846 / 180, friction = 0.3, speed = 4;
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
    parts.scene().settings.substeps = 4;  // a single one passes the top by a step's way
    double highest = 0, passing = 0;
    bench.run(parts.scene(), 4, [&](World& world, double) {
        const double way = uphill.dot(world.pose(box_of(world)).position);
        highest = std::max(highest, way);
        if (highest > 0.1 && way < 0) passing = world.velocity(box_of(world)).norm();
        return passing == 0;
    });
    const char* const name = "up a slope, direct, dt 1e-3";
    bench.report(name, "error of the way up", std::abs(highest / 1.3070330 - 1), 1e-3, "1");
    bench.report(name, "error of the speed at the start again", std::abs(passing / 1.2415799 - 1),
                 1e-3, "1");
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
