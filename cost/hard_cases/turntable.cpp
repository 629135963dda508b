// Turntable and tower: H24 and H25.
//
// A block at radius r on a disc that turns at w stays with it when w^2 r is at most mu g. A tower
// of planks laid crosswise stands as long as one cares to look.
#include "cost/hard_cases/hard_cases.hpp"
#include "kernels/math/rotation.hpp"
#include "pipeline/world.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

// How far the block moves on the disc in a time, as a share of its radius.
double slides(CaseBench& bench, double friction, double share, bool exactly)
{
    const double radius = 1;
    const double rate = std::sqrt(share * friction * kGravity / radius);
    SceneParts parts(bench.scene());
    const std::uint32_t material = parts.material(friction);
    const std::uint32_t disc =
        parts.cylinder(material, 1, 2, 0.05, {Vec3(0, 0, -0.05), Quat::Identity()});
    parts.body(disc).motion = Motion::kinematic;
    parts.body(disc).mass.reset();
    parts.body(disc).angular_velocity = Vec3(0, 0, rate);
    const std::uint32_t block =
        parts.box(material, 1, Vec3::Constant(0.02), {Vec3(radius, 0, 0.02), Quat::Identity()});
    parts.body(block).velocity = Vec3(0, rate * radius, 0);
    parts.body(block).angular_velocity = Vec3(0, 0, rate);
    if (exactly) ask_exactly(parts.scene().settings);
    parts.scene().settings.dt = 1e-3;
    double moved = 0;
    bench.run(parts.scene(), 2 * kPi / rate, [&](World& world, double) {
        const Vec3 at = world.pose(world.bodies().back()).position;
        moved = std::max(moved, std::abs(std::hypot(at.x(), at.y()) / radius - 1));
        return moved < 0.2;
    });
    return moved;
}

// Without friction it goes straight on, by whatever turns below it: m off that line.
double carried_off(CaseBench& bench, bool exactly)
{
    const double rate = 2, speed = 0.2;
    SceneParts parts(bench.scene());
    const std::uint32_t material = parts.material(0);
    const std::uint32_t disc =
        parts.cylinder(material, 1, 2, 0.05, {Vec3(0, 0, -0.05), Quat::Identity()});
    parts.body(disc).motion = Motion::kinematic;
    parts.body(disc).mass.reset();
    parts.body(disc).angular_velocity = Vec3(0, 0, rate);
    const std::uint32_t block =
        parts.box(material, 1, Vec3::Constant(0.02), {Vec3(1, 0, 0.02), Quat::Identity()});
    parts.body(block).velocity = Vec3(0, speed, 0);
    if (exactly) ask_exactly(parts.scene().settings);
    parts.scene().settings.dt = 1e-3;
    double off = 0;
    bench.run(parts.scene(), kPi / rate, [&](World& world, double now) {
        const Vec3 at = world.pose(world.bodies().back()).position;
        off = std::max(off, std::hypot(at.x() - 1, at.y() - speed * now));
        return off < 1;
    });
    return off;
}

}  // namespace

void case_turntable(CaseBench& bench)
{
    for (const bool exactly : {false, true})
        bench.report(exactly ? "mu 0, direct" : "mu 0", "off its straight way",
                     carried_off(bench, exactly), 1e-6, "m");
    for (const double friction : {0.1, 0.5, 1.0}) {
        const std::string mu = "mu " + std::to_string(friction).substr(0, 3) + ", w^2 r ";
        const char *const way = "way out over the radius", *const stays = "stays: wrong outcomes";
        bench.report(mu + "2 % below, direct", way, slides(bench, friction, 0.98, true), 0.01, "1");
        bench.report(mu + "2 % above, direct", stays,
                     slides(bench, friction, 1.02, true) < 0.02 ? 1 : 0, 0, "1");
        bench.report(mu + "2 % below", way, slides(bench, friction, 0.98, false), 0.01, "1");
        bench.report(mu + "2 % above", stays, slides(bench, friction, 1.02, false) < 0.02 ? 1 : 0,
                     0, "1");
    }
}

// 102 planks of 15 : 3 : 1, 51 layers of two. The published tower of six floors is not described to
// the last plank; this one is as many and as thin.
void case_planks(CaseBench& bench)
{
    SceneParts parts(bench.scene());
    const std::uint32_t material = parts.material(0.5);
    parts.plane(material, Vec3::UnitZ(), 0);
    const Vec3 half(0.0585, 0.0117, 0.0039);
    const Quat across = exponential(Vec3(0, 0, kPi / 2));
    const int layers = bench.brief() ? 8 : 51;
    const double mass = 0.01;
    for (int layer = 0; layer < layers; ++layer)
        for (const double side : {-1.0, 1.0}) {
            const Quat turn = layer % 2 == 0 ? Quat(Quat::Identity()) : across;
            const Vec3 off = turn * Vec3(0, side * 0.045, 0);
            parts.box(material, mass, half, {off + Vec3(0, 0, (2 * layer + 1) * half.z()), turn});
        }
    Scene scene = parts.scene();
    scene.settings.dt = 0.01;
    scene.settings.sleep = false;
    ask_exactly(scene.settings);
    double drift = 0, force = 0;
    // 2000 steps, a thirtieth of the published run: what rests to rounding goes on to.
    bench.run(scene, bench.brief() ? 1 : 20, [&](World& world, double) {
        const std::vector<BodyId> ids = world.bodies();
        drift = std::max(drift,
                         (world.pose(ids.back()).position - scene.bodies.back().position).norm());
        force = world.contact_force(ids.front()).z();
        return drift < 0.01;
    });
    const double weight = 2 * layers * mass * kGravity;
    bench.report("102 planks crosswise, direct", "drift of the top one", drift, 1e-6, "m");
    bench.report("102 planks crosswise, direct", "error of the base force",
                 std::abs(force + weight) / weight, 1e-3, "1");
}

}  // namespace throng
