// Hits and rest: H83, what two bodies leave one another with, and that heaps of balls lie still.
//
// Answer: a pair of balls leaves as the line of their centers at the touch has it, however late the
// touch was seen; friction takes energy in a hit and never gives any; a pyramid of four balls
// stands where friction bears it, and what resists rolling brings heaps of balls to rest.
#include "cost/hard_cases/hard_cases.hpp"
#include "throng/rotation.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

struct Way {
    std::string name;
    Settings settings;
    Quat turn = Quat::Identity();
    Vec3 off = Vec3::Zero();
    bool backwards = false;  // order of creation

    Vec3 place(const Vec3& at) const { return off + turn * at; }
};

// Two balls, one of them heavier, at `speed` each, their ways that far apart.
struct Hit {
    double restitution = 1, speed = 30, aside = 0.03, ratio = 1;
};

// Nothing yet, by the dials of the way; gravity as it is before that turns it.
SceneParts begun(const CaseBench& bench, const Way& way, const Vec3& gravity)
{
    SceneParts parts(bench.scene());
    parts.scene().settings = way.settings;
    parts.scene().gravity = way.turn * gravity;
    return parts;
}

void put_wall(
    SceneParts& parts, std::uint32_t material, const Way& way, const Vec3& at, const Vec3& half)
{
    const std::uint32_t wall = parts.box(material, 1, half, {way.place(at), way.turn});
    parts.hold(wall);
}

// How far the velocities after it are off, over the speed.
double hit(CaseBench& bench, const Way& way, const Hit& of)
{
    constexpr double kRadius = 0.1, kFrom = 1;
    SceneParts parts = begun(bench, way, Vec3::Zero());
    Scene& scene = parts.scene();
    const std::uint32_t material = parts.material(0, of.restitution);
    const auto put = [&](double side) {
        const Vec3 at(side * kFrom, side > 0 ? of.aside : 0, 0);
        const std::uint32_t id =
            parts.ball(material, side > 0 ? of.ratio : 1, kRadius, way.place(at));
        parts.body(id).velocity = way.turn * Vec3(-side * of.speed, 0, 0);
        return id;
    };
    const std::uint32_t first = put(way.backwards ? 1 : -1), second = put(way.backwards ? -1 : 1);
    const std::uint32_t a = way.backwards ? second : first, b = way.backwards ? first : second;
    const double along = of.aside / (2 * kRadius);
    const Vec3 normal = way.turn * Vec3(std::sqrt(1 - along * along), along, 0);
    const Vec3 before_a = scene.bodies[a].velocity, before_b = scene.bodies[b].velocity;
    const double impulse =
        (1 + of.restitution) * normal.dot(before_a - before_b) / (1 + 1 / of.ratio);
    double error = 0;
    bench.run(scene, 2.5 * kFrom / of.speed, [&](World& world, double) {
        const std::vector<BodyId> ids = world.bodies();
        error =
            std::max((world.velocity(ids[a]) - (before_a - normal * impulse)).norm(),
                     (world.velocity(ids[b]) - (before_b + normal * (impulse / of.ratio))).norm());
        return true;
    });
    return error / of.speed;
}

void hit_all(CaseBench& bench, const Way& way)
{
    for (const double restitution : {1.0, 0.5, 0.0}) {
        double worst = 0;
        for (const double speed : {5.0, 30.0, 100.0})
            for (const double aside : {0.0, 0.03, 0.15})
                for (const double ratio : {1.0, 1000.0}) {
                    if (bench.brief() && (speed != 30 || aside == 0)) continue;
                    worst = std::max(worst, hit(bench, way, {restitution, speed, aside, ratio}));
                }
        bench.report(way.name + ", two balls, e " + std::to_string(restitution).substr(0, 3),
                     "velocities off over the speed", worst, 1e-6, "1");
    }
}

// A box that tumbles through a closed room of rough walls that give all back.
void tumble(CaseBench& bench, const Way& way)
{
    constexpr double kWide = 2;
    SceneParts parts = begun(bench, way, Vec3::Zero());
    Scene& scene = parts.scene();
    const std::uint32_t material = parts.material(0.95, 1);
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0}) {
            Vec3 at = Vec3::Zero(), half = Vec3::Constant(kWide + 1);
            at[axis] = side * (kWide + 0.5);
            half[axis] = 0.5;
            put_wall(parts, material, way, at, half);
        }
    const std::uint32_t box =
        parts.box(material, 1, Vec3(0.2, 0.3, 0.6), {way.place(Vec3::Zero()), way.turn});
    parts.body(box).velocity = way.turn * Vec3(5, 3, 1);
    parts.body(box).angular_velocity = way.turn * Vec3(1, 2, 3);
    double first = 0, least = 0, won = 0;
    bench.run(scene, bench.brief() ? 2 : 20, [&](World& world, double) {
        const double energy = world.measure().kinetic_energy;
        if (first == 0) first = least = energy;
        least = std::min(least, energy);
        won = std::max(won, energy - least);
        return std::isfinite(energy);
    });
    bench.report(way.name + ", rough box in a room, e 1", "energy won over that of the start",
                 won / first, 1e-3, "1");
}

// A fourth ball on three.
void pile_up(CaseBench& bench, const Way& way)
{
    constexpr double kRadius = 0.1, kSide = 2 * kRadius;
    SceneParts parts = begun(bench, way, Vec3(0, 0, -kGravity));
    Scene& scene = parts.scene();
    scene.settings.sleep = false;
    const std::uint32_t material = parts.material(1);
    const Vec3 up = way.turn * Vec3::UnitZ();
    parts.plane(material, up, up.dot(way.off));
    const double out = kSide / std::sqrt(3), high = kRadius + kSide * std::sqrt(2.0 / 3);
    std::vector<Vec3> places = {Vec3(0, 0, high)};
    for (int k = 0; k < 3; ++k)
        places.emplace_back(out * std::cos(2 * kPi * k / 3), out * std::sin(2 * kPi * k / 3),
                            kRadius);
    if (way.backwards) std::reverse(places.begin(), places.end());
    std::uint32_t top = 0;
    for (const Vec3& at : places) {
        const std::uint32_t id = parts.ball(material, 1, kRadius, way.place(at));
        if (at.z() > kRadius) top = id;
    }
    double sunk = 0, speed = 0;
    bench.run(scene, bench.brief() ? 3 : 10, [&](World& world, double) {
        const std::vector<BodyId> ids = world.bodies();
        sunk = high - up.dot(world.pose(ids[top]).position - way.off);
        speed = 0;
        for (const BodyId id : ids) speed = std::max(speed, world.velocity(id).norm());
        return sunk < kRadius;
    });
    bench.report(way.name + ", pyramid of four balls", "top sinks, over the radius",
                 std::abs(sunk) / kRadius, 0.05, "1");
    bench.report(way.name + ", pyramid of four balls", "speed at the end", speed, 1e-4, "m/s");
}

// Balls let fall into a tray.
void settle(CaseBench& bench, const Way& way)
{
    constexpr double kRadius = 0.1;
    SceneParts parts = begun(bench, way, Vec3(0, 0, -kGravity));
    Scene& scene = parts.scene();
    scene.settings.sleep = false;
    const std::uint32_t material = parts.material(0.5);
    scene.materials[material].rolling_friction = 2e-3;
    put_wall(parts, material, way, Vec3(0, 0, -0.1), Vec3(0.6, 0.6, 0.1));
    for (const double side : {-0.4, 0.4}) {
        put_wall(parts, material, way, Vec3(side, 0, 0.5), Vec3(0.1, 0.6, 0.5));
        put_wall(parts, material, way, Vec3(0, side, 0.5), Vec3(0.6, 0.1, 0.5));
    }
    const int count = 5;
    for (int i = 0; i < count; ++i) {
        const int k = way.backwards ? count - 1 - i : i;
        const Vec3 at(0.1 * std::cos(2.4 * k), 0.1 * std::sin(2.4 * k), kRadius + 0.22 * k);
        parts.ball(material, 1, kRadius, way.place(at));
    }
    double speed = 0;
    bench.run(scene, bench.brief() ? 3 : 10, [&](World& world, double) {
        speed = 0;
        for (const BodyId id : world.bodies()) speed = std::max(speed, world.velocity(id).norm());
        return true;
    });
    bench.report(way.name + ", five balls in a tray", "speed at the end", speed, 1e-4, "m/s");
}

// The same way turned, far off, in another order and by other steps.
std::vector<Way> relatives(const Way& way, bool brief)
{
    std::vector<Way> all = {way};
    if (brief) return all;
    const auto add = [&](const char* what) -> Way& {
        all.push_back(way);
        all.back().name += what;
        return all.back();
    };
    add(", turned").turn = exponential(Vec3(0.3, -0.5, 0.7));
    add(", far off").off = Vec3(3e4, -1e4, 2e4);
    add(", made backwards").backwards = true;
    add(", dt 1/240").settings.dt = 1.0 / 240;
    add(", dt 1e-3").settings.dt = 1e-3;
    return all;
}

}  // namespace

void case_hits_and_rest(CaseBench& bench)
{
    const Settings usual = bench.settings();
    const auto with = [&](const char* name, auto choose) {
        Settings settings = usual;
        choose(settings);
        return Way{name, settings};
    };
    const Way plain = {"default", usual};
    const Way direct = with("direct", [](Settings& s) { s.solver = Solver::direct; });
    const Way penalty = with("penalty", [](Settings& s) { s.response = Response::penalty; });
    const Way apart = with("back_up", [](Settings& s) { s.overlap = Overlap::back_up; });
    const Way halved = with("subdivide", [](Settings& s) { s.overlap = Overlap::subdivide; });
    for (const Way& way : relatives(halved, bench.brief())) hit_all(bench, way);
    for (const Way& of : {plain, direct, apart, halved})
        for (const Way& way : relatives(of, bench.brief())) tumble(bench, way);
    for (const Way& of : {plain, direct, penalty, apart, halved})
        for (const Way& way : relatives(of, bench.brief())) pile_up(bench, way);
    for (const Way& of : {plain, apart, halved})
        for (const Way& way : relatives(of, bench.brief())) settle(bench, way);
}

}  // namespace throng
