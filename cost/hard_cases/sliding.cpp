// Sliding to rest: H12.
//
// Answers: from speed v a box slides v^2 / (2 mu g), straight on whatever the direction. Up a slope
// of angle s it slides v^2 / (2 g (sin s + mu cos s)), then comes back.
#include "cost/hard_cases/hard_cases.hpp"
#include "pipeline/world.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

constexpr double kGravity = 9.81;

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

}  // namespace

void case_sliding(CaseBench& bench)
{
    slide(bench, "v=(10, 0), mu=0.5", 0.5, Vec3(10, 0, 0));
    slide(bench, "v=(3, 4), mu=0.3", 0.3, Vec3(3, 4, 0));
}

}  // namespace throng
