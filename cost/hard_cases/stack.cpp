// Stacks: H8, equal cubes; H33, the same far from the origin.
//
// Answer: the contact under the k-th cube from the top carries k m g. A soft contact under j cubes
// gives way by 2 j g / (2 pi rate)^2, which sets the bound on the overlap. Solved exactly it does
// not give way.
#include "cost/hard_cases/hard_cases.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace throng {

namespace {

constexpr int kHigh = 10;

// Where H33 has what stands at the origin elsewhere.
const std::pair<const char*, Vec3> kAway[] = {{"at (1e5, 0, -8e4) m", {1e5, 0, -8e4}},
                                              {"at (1e7, 0, -8e6) m", {1e7, 0, -8e6}}};

Scene stack(const CaseBench& bench, int high, double edge, double separation, const Vec3& at)
{
    SceneParts parts(bench.scene());
    const std::uint32_t material = parts.material(0.5);
    parts.plane(material, Vec3::UnitZ(), at.z());
    for (int k = 0; k < high; ++k) {
        Pose pose;
        pose.position = at + Vec3(0, 0, edge / 2 + k * (edge + separation) + separation);
        parts.box(material, 1, Vec3::Constant(edge / 2), pose);
    }
    return parts.scene();
}

double greatest_speed(const World& world)
{
    double speed = 0;
    for (const BodyId body : world.bodies()) speed = std::max(speed, world.velocity(body).norm());
    return speed;
}

struct Resting {
    double overlap = 0, speed = 0, force_error = 0;
    double load_error = 0;  // of the loads under the boxes, the greatest
    std::vector<Vec3> places;
};

// Contacts under a box carry what they do for those above as well, and it alone what it weighs: the
// k-th from the top and all above it bear k m g together.
double greatest_load_error(const World& world)
{
    const std::vector<BodyId> ids = world.bodies();
    double error = 0, weight = 0;
    Vec3 load = Vec3::Zero();
    for (std::size_t i = ids.size(); --i > 0;) {
        load += world.contact_force(ids[i]);
        weight += kGravity;
        error = std::max(error, (load - Vec3(0, 0, weight)).norm() / weight);
    }
    return error;
}

// Overlap is looked at every second, since it may not even pass through the bound.
Resting watch_stack(CaseBench& bench, const Scene& scene, double time = 10)
{
    const auto high = static_cast<double>(scene.bodies.size() - 1);
    Resting rest;
    double next_look = 1;
    bench.run(scene, time, [&](World& world, double now) {
        if (now + 1e-9 < next_look) return true;
        next_look += 1;
        rest.overlap = std::max(rest.overlap, world.measure().greatest_overlap);
        if (now > 10 - 1e-9) rest.speed = std::max(rest.speed, greatest_speed(world));
        const double weight = high * kGravity;
        const Vec3 force = world.contact_force(world.bodies().front());
        rest.force_error = (force - Vec3(0, 0, -weight)).norm() / weight;
        rest.load_error = greatest_load_error(world);
        rest.places.clear();
        for (const BodyId body : world.bodies()) rest.places.push_back(world.pose(body).position);
        return true;
    });
    return rest;
}

constexpr const char* kSleepless = "away from where it is with sleep";

// m, between the ends of a stack solved exactly that may sleep and of one that may not.
void exact_sleep(CaseBench& bench)
{
    Scene scene = stack(bench, kHigh, 1, 0, Vec3::Zero());
    ask_exactly(scene.settings);
    const Resting asleep = watch_stack(bench, scene);
    scene.settings.sleep = false;
    const Resting awake = watch_stack(bench, scene);
    double apart = 0;
    for (std::size_t i = 0; i < awake.places.size(); ++i)
        apart = std::max(apart, (awake.places[i] - asleep.places[i]).norm());
    bench.report("n=10, direct", kSleepless, apart, 1e-4, "m");
}

// The same solved exactly, asleep or not.
void exact_stacks(CaseBench& bench)
{
    struct Setting {
        const char* name;
        int high;
        double edge, separation, overlap;
    };
    for (const Setting& setting :
         {Setting{"n=10, direct", 10, 1, 0, 5e-5}, Setting{"n=10, 0.1 m, direct", 10, 0.1, 0, 5e-5},
          Setting{"n=10, from 1 mm gaps, direct", 10, 1, 1e-3, 5e-5},
          Setting{"n=40, direct", 40, 1, 0, 5e-5}, Setting{"n=100, direct", 100, 1, 0, 1e-3}}) {
        if (bench.brief() && setting.high > 10) continue;
        Scene scene = stack(bench, setting.high, setting.edge, setting.separation, Vec3::Zero());
        ask_exactly(scene.settings);
        scene.settings.sleep = false;
        const Resting rest = watch_stack(bench, scene, bench.brief() ? 10 : 30);
        bench.report(setting.name, "greatest overlap", rest.overlap, setting.overlap, "m");
        bench.report(setting.name, "speed after 10 s", rest.speed, 1e-4, "m/s");
        bench.report(setting.name, "error of the base force", rest.force_error, 1e-3, "1");
        bench.report(setting.name, "error of the load under any", rest.load_error, 1e-3, "1");
    }
}

// A bullet of 5 mm that flies at a wall of 0.1 m and is stopped by it: the furthest that its middle
// came and where that was in the end, m from the wall's near face.
struct Flight {
    double furthest = -1e30;
    Vec3 end = Vec3::Zero();
};

Flight shoot(CaseBench& bench, const Vec3& at)
{
    constexpr double kTime = 0.25;
    const Vec3 wall(0.05, 1, 1), face = at - Vec3(wall.x(), 0, 0);
    SceneParts parts(bench.scene());
    const std::uint32_t material = parts.material(0.5);
    Pose pose;
    pose.position = at;
    parts.hold(parts.box(material, 1, wall, pose));
    BodyDescription& bullet =
        parts.body(parts.ball(material, 0.01, 0.005, face - Vec3(10, 0.1, 0.2)));
    bullet.velocity = Vec3(200, 0, 0);
    bullet.fast = true;
    parts.scene().gravity = Vec3::Zero();
    Flight flight;
    bench.run(parts.scene(), kTime, [&](World& world, double) {
        flight.end = world.pose(world.bodies().back()).position - face;
        flight.furthest = std::max(flight.furthest, flight.end.x());
        return true;
    });
    return flight;
}

void far_away_bullets(CaseBench& bench)
{
    const Vec3 home = shoot(bench, Vec3::Zero()).end;
    for (const auto& [name, at] : kAway) {
        const Flight flight = shoot(bench, at);
        // As in H38: what contacts may give while they stop it.
        bench.report(name, "bullet past the wall's face over its radius",
                     std::max(0.0, flight.furthest + 0.005) / 0.005, 1e-2, "1");
        bench.report(name, "bullet's distance from where it stops at the origin",
                     (flight.end - home).norm(), 1e-3, "m");
    }
}

// Where boxes of a stack lie after 5 s, and the step after which none was awake: none where one
// still is, which is no step like any other.
struct Settled {
    std::vector<Vec3> places;  // m, from where the stack was set down
    double asleep = std::numeric_limits<double>::quiet_NaN();
    double time_a_step = 0;  // ns
};

Settled settle(CaseBench& bench, const Vec3& at)
{
    Settled settled;
    double step = 0;
    bench.run(stack(bench, kHigh, 1, 0, at), 5, [&](World& world, double now) {
        ++step;
        if (world.report().bodies_awake > 0)
            settled.asleep = std::numeric_limits<double>::quiet_NaN();
        else if (std::isnan(settled.asleep))
            settled.asleep = step;
        if (now < 5 - 1e-9) return true;
        for (const BodyId body : world.bodies())
            if (world.motion(body) == Motion::dynamic)
                settled.places.emplace_back(world.pose(body).position - at);
        return true;
    });
    settled.time_a_step = bench.time_a_step();
    return settled;
}

void show_settled(CaseBench& bench, const char* name, const Settled& settled)
{
    bench.show(name, "step after which it sleeps", settled.asleep, "1");
    bench.report_time(name, "time a step", settled.time_a_step);
}

}  // namespace

void case_stack(CaseBench& bench)
{
    struct Setting {
        const char* name;
        int high;
        double edge, separation;
        bool sleep;
    };
    std::vector<Vec3> places;
    for (const Setting& setting :
         {Setting{"n=10", kHigh, 1, 0, true}, Setting{"n=10, sleep=off", kHigh, 1, 0, false},
          Setting{"n=10, 0.1 m", kHigh, 0.1, 0, true},
          Setting{"n=10, from 1 mm gaps", kHigh, 1, 1e-3, true}, Setting{"n=40", 40, 1, 0, true},
          Setting{"n=100", 100, 1, 0, true}, Setting{"n=100, sleep=off", 100, 1, 0, false}}) {
        if (bench.brief() && setting.high > kHigh) continue;
        Scene scene = stack(bench, setting.high, setting.edge, setting.separation, Vec3::Zero());
        scene.settings.sleep = scene.settings.sleep && setting.sleep;
        const Resting rest = watch_stack(bench, scene, bench.brief() ? 10 : 30);
        const auto judge = [&](const char* quantity, double figure, double bound,
                               const char* unit) {
            if (setting.high > kHigh)
                bench.report_default(setting.name, quantity, figure, bound, unit, "solver=direct");
            else
                bench.report(setting.name, quantity, figure, bound, unit);
        };
        judge("greatest overlap", rest.overlap, setting.high > 40 ? 1e-3 : 3e-3, "m");
        judge("speed after 10 s", rest.speed, 1e-4, "m/s");
        judge("error of the base force", rest.force_error, 1e-3, "1");
        // What falls asleep is still sinking by a thousandth of its weight.
        bench.report_default(setting.name, "error of the load under any", rest.load_error, 1e-3,
                             "1", "solver=direct");
        double apart = 0;
        for (std::size_t i = 0; i < std::min(places.size(), rest.places.size()); ++i)
            apart = std::max(apart, (places[i] - rest.places[i]).norm());
        if (!setting.sleep)
            bench.report_default(setting.name, kSleepless, apart, 1e-4, "m", "solver=direct");
        places = rest.places;
    }
    exact_sleep(bench);
    exact_stacks(bench);
}

void case_far_away(CaseBench& bench)
{
    const Settled home = settle(bench, Vec3::Zero());
    for (const auto& [name, at] : kAway) {
        const Settled away = settle(bench, at);
        double error = 0;
        for (std::size_t i = 0; i < home.places.size(); ++i)
            error = std::max(error, (home.places[i] - away.places[i]).norm());
        bench.report(name, "distance from where it rests at the origin", error, 1e-3, "m");
        bench.report(name, "steps from when it falls asleep at the origin",
                     std::abs(away.asleep - home.asleep), 0, "1");
        show_settled(bench, name, away);
    }
    show_settled(bench, "at the origin", home);
    far_away_bullets(bench);
    far_away_pairs(bench);
}

}  // namespace throng
