// Turntable and tower: H24 and H25.
//
// A block at radius r on a disc that turns at w stays with it when w^2 r is at most mu g. A tower
// of planks laid crosswise stands as long as one cares to look.
#include "cost/hard_cases/hard_cases.hpp"
#include "throng/catalog.hpp"
#include "throng/rotation.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

constexpr double kRadius = 1;  // m, at which the block lies

// A disc that turns at a rate, and a block on it with a velocity and spin.
Scene on_disc(
    const CaseBench& bench, double friction, double rate, double speed, double spin, bool exactly)
{
    SceneParts parts(bench.scene());
    const std::uint32_t material = parts.material(friction);
    const std::uint32_t disc =
        parts.cylinder(material, 1, 2, 0.05, {Vec3(0, 0, -0.05), Quat::Identity()});
    parts.hold(disc, Motion::kinematic);
    parts.body(disc).angular_velocity = Vec3(0, 0, rate);
    const std::uint32_t block =
        parts.box(material, 1, Vec3::Constant(0.02), {Vec3(kRadius, 0, 0.02), Quat::Identity()});
    parts.body(block).velocity = Vec3(0, speed, 0);
    parts.body(block).angular_velocity = Vec3(0, 0, spin);
    if (exactly) ask_exactly(parts.scene().settings);
    parts.scene().settings.dt = 1e-3;
    return parts.scene();
}

// How far the block moves on the disc in a turn, as a share of its radius.
double slides(CaseBench& bench, double friction, double share, bool exactly)
{
    const double rate = std::sqrt(share * friction * kGravity / kRadius);
    const Scene scene = on_disc(bench, friction, rate, rate * kRadius, rate, exactly);
    double moved = 0;
    bench.run(scene, 2 * kPi / rate, [&](World& world, double) {
        const Vec3 at = world.pose(world.bodies().back()).position;
        moved = std::max(moved, std::abs(std::hypot(at.x(), at.y()) / kRadius - 1));
        return moved < 0.2;
    });
    return moved;
}

// Without friction it goes straight on, by whatever turns below it: m off that line.
double carried_off(CaseBench& bench, bool exactly)
{
    const double rate = 2, speed = 0.2;
    double off = 0;
    bench.run(on_disc(bench, 0, rate, speed, 0, exactly), kPi / rate,
              [&](World& world, double now) {
                  const Vec3 at = world.pose(world.bodies().back()).position;
                  off = std::max(off, std::hypot(at.x() - kRadius, at.y() - speed * now));
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
        for (const bool exactly : {true, false}) {
            const char* const how = exactly ? ", direct" : "";
            bench.report(mu + "2 % below" + how, "way out over the radius",
                         slides(bench, friction, 0.98, exactly), 0.01, "1");
            bench.report(mu + "2 % above" + how, "stays: wrong outcomes",
                         slides(bench, friction, 1.02, exactly) < 0.02 ? 1 : 0, 0, "1");
        }
    }
}

namespace {

// A tower of planks, and what of it is to be seen.
struct Tower {
    Scene scene;
    double weight = 0;  // N
    double falls = 0;   // m, below which the last plank tells that it has come down
};

// 102 planks of 15 : 3 : 1, 51 layers of two.
Tower crosswise(const CaseBench& bench)
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
    return {parts.scene(), 2 * layers * mass * kGravity, (2 * layers - 2) * half.z()};
}

// The tower that engines were compared by. It has come down once its last plank is below the bottom
// of that floor.
Tower published()
{
    Tower tower{make_scene("kapla", 102)};
    for (const BodyDescription& body : tower.scene.bodies)
        tower.weight += body.mass.value_or(0) * kGravity;
    tower.falls = tower.scene.bodies.back().position.z() - 0.15;
    return tower;
}

// How it stood: for so many steps, m of the plank that moved most, and by how much the floor's
// force is off its weight.
struct Stood {
    int steps = 0;
    double drift = 0, force_error = 0;
};

Stood stand(CaseBench& bench, const Tower& tower, int steps)
{
    Stood stood;
    Vec3 force = Vec3::Zero();
    bench.run(tower.scene, steps * tower.scene.settings.dt, [&](World& world, double) {
        const std::vector<BodyId> ids = world.bodies();
        for (std::size_t i = 1; i < ids.size(); ++i)
            stood.drift = std::max(
                stood.drift, (world.pose(ids[i]).position - tower.scene.bodies[i].position).norm());
        force = world.contact_force(ids.front());
        if (!(world.pose(ids.back()).position.z() > tower.falls)) return false;
        ++stood.steps;
        return true;
    });
    stood.force_error = (force + Vec3(0, 0, tower.weight)).norm() / tower.weight;
    return stood;
}

}  // namespace

// Nothing sleeps: what sleeps stands for ever.
void case_planks(CaseBench& bench)
{
    const auto by_direct = [&](const std::string& name, Tower tower, int steps) {
        ask_exactly(tower.scene.settings);
        const Stood stood = stand(bench, tower, steps);
        bench.report(name, "steps short of " + std::to_string(steps), steps - stood.steps, 0, "1");
        bench.report(name, "greatest drift of any", stood.drift, 1e-6, "m");
        bench.report(name, "error of the base force", stood.force_error, 1e-3, "1");
        bench.report_time(name, "time a step", bench.time_a_step());
    };
    const auto awake = [&](Tower tower) {
        tower.scene.settings = bench.settings();
        tower.scene.settings.dt = 0.01;
        tower.scene.settings.sleep = false;
        return tower;
    };
    by_direct("102 planks crosswise, direct", awake(crosswise(bench)), bench.brief() ? 100 : 2000);
    const int steps = bench.brief() ? 50 : 60000;
    const Tower tower = awake(published());
    by_direct("the published tower, direct", tower, std::min(steps, 2000));
    const Stood soft = stand(bench, tower, steps);
    const char* const name = "the published tower, default";
    bench.report(name, "steps short of " + std::to_string(steps), steps - soft.steps, 0, "1");
    bench.show(name, "greatest drift of any", soft.drift, "m");
    // At first soft contacts still give under it.
    if (!bench.brief()) bench.report(name, "error of the base force", soft.force_error, 1e-3, "1");
    bench.report_time(name, "time a step", bench.time_a_step());
}

}  // namespace throng
