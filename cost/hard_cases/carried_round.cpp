// Carried round: H84, bodies on plates that turn.
//
// Answer: who needs less than friction bears stays where he is on the plate, by any step; a ball
// that rolls on it goes round a circle at two sevenths of its rate.
#include "cost/hard_cases/hard_cases.hpp"
#include "throng/rotation.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

constexpr double kRadius = 1, kTime = 5;  // m from the middle, s
constexpr double kAway = 1e-2;            // of the radius

enum class Rider : std::uint8_t { box, slab, can, pair, table };
enum class Plate : std::uint8_t { driven, axle, afloat };

struct Ride {
    std::string setting;
    double rate = 2, friction = 0.5;  // rad/s
    Rider rider = Rider::box;
    Plate plate = Plate::driven;
    double weight = 1000;  // kg, of a plate that nothing drives
    Quat turn = Quat::Identity();
    Vec3 off = Vec3::Zero();
    bool plate_last = false;
    double most = kAway;
    Settings settings = {};

    Pose place(const Vec3& at) const { return {off + turn * at, turn}; }
};

std::uint32_t put_plate(SceneParts& parts, std::uint32_t material, const Ride& ride)
{
    const std::uint32_t id =
        parts.cylinder(material, ride.weight, 2, 0.1, ride.place(Vec3(0, 0, -0.1)));
    parts.body(id).angular_velocity = ride.turn * Vec3(0, 0, ride.rate);
    if (ride.plate == Plate::axle) parts.body(id).lock_position = true;
    if (ride.plate != Plate::driven) return id;
    parts.hold(id, Motion::kinematic);
    return id;
}

// A top on four legs, as wide as they stand apart.
CompoundShape table_of(SceneParts& parts, std::uint32_t material)
{
    const std::uint32_t leg = parts.box(material, 1, Vec3(0.05, 0.05, 0.1), {});
    const std::uint32_t top = parts.box(material, 1, Vec3(0.5, 0.2, 0.05), {});
    CompoundShape table;
    table.parts.push_back({parts.body(top).shape, {Vec3(0, 0, 0.15), Quat::Identity()}});
    for (const double x : {-0.45, 0.45})
        for (const double y : {-0.15, 0.15})
            table.parts.push_back({parts.body(leg).shape, {Vec3(x, y, 0), Quat::Identity()}});
    parts.scene().bodies.resize(parts.scene().bodies.size() - 2);
    return table;
}

std::uint32_t put_rider(SceneParts& parts, std::uint32_t material, const Ride& ride)
{
    const double high = ride.rider == Rider::slab ? 0.02 : 0.1;
    const Pose at = ride.place(Vec3(kRadius, 0, high));
    std::uint32_t id = 0;
    if (ride.rider == Rider::can) {
        id = parts.cylinder(material, 1, 0.1, 0.1, at);
    } else if (ride.rider == Rider::table) {
        const CompoundShape table = table_of(parts, material);
        id = parts.box(material, 1, Vec3::Ones(), at);
        parts.scene().shapes[parts.body(id).shape].shape = table;
    } else {
        id = parts.box(material, 1, Vec3(0.1, 0.1, high), at);
    }
    const std::uint32_t first = id;
    if (ride.rider == Rider::pair)
        id = parts.box(material, 1, Vec3::Constant(0.1), ride.place(Vec3(kRadius, 0, 0.3)));
    for (std::uint32_t k = first; k <= id; ++k) {
        parts.body(k).velocity = ride.turn * Vec3(0, ride.rate * kRadius, 0);
        parts.body(k).angular_velocity = ride.turn * Vec3(0, 0, ride.rate);
    }
    return id;
}

Scene scene_of(CaseBench& bench, const Ride& ride, std::uint32_t& plate, std::uint32_t& rider)
{
    SceneParts parts(bench.scene());
    Scene& scene = parts.scene();
    scene.settings = ride.settings;
    scene.gravity = ride.turn * Vec3(0, 0, -kGravity);
    const std::uint32_t material = parts.material(ride.friction);
    if (ride.plate == Plate::afloat) {
        const std::uint32_t smooth = parts.material(0);
        parts.plane(smooth, ride.turn * Vec3::UnitZ(),
                    ride.turn.toRotationMatrix().col(2).dot(ride.off) - 0.2);
    }
    if (!ride.plate_last) plate = put_plate(parts, material, ride);
    rider = put_rider(parts, material, ride);
    if (ride.plate_last) plate = put_plate(parts, material, ride);
    return scene;
}

// How far the rider, the upper one of two, is in or out at most, over the radius.
double goes_astray(CaseBench& bench, const Ride& ride)
{
    std::uint32_t plate = 0, rider = 0;
    const Scene scene = scene_of(bench, ride, plate, rider);
    double astray = 0;
    bench.run(scene, kTime, [&](World& world, double) {
        const std::vector<BodyId> ids = world.bodies();
        const Vec3 at = ride.turn.conjugate()
            * (world.pose(ids[rider]).position - world.pose(ids[plate]).position);
        astray = std::max(astray, std::abs(std::hypot(at.x(), at.y()) / kRadius - 1));
        return astray < 1;
    });
    return astray;
}

void judge(CaseBench& bench, const Ride& ride)
{
    bench.report(ride.setting, "way out or in over the radius", goes_astray(bench, ride), ride.most,
                 "1");
}

// A ball that rolls: dv/dt = 2/7 w x v, by the plate's spin w.
void roll(CaseBench& bench, const std::string& setting, const Settings& settings)
{
    const double rate = 2, radius = 0.1, speed = 0.5, turns = 2.0 / 7 * rate;
    SceneParts parts(bench.scene());
    parts.scene().settings = settings;
    const std::uint32_t material = parts.material(0.5);
    put_plate(parts, material, {.setting = setting, .rate = rate});
    const std::uint32_t ball = parts.ball(material, 1, radius, Vec3(kRadius, 0, radius));
    parts.body(ball).velocity = Vec3(0, speed, 0);
    parts.body(ball).angular_velocity = Vec3((rate * kRadius - speed) / radius, 0, 0);
    double off = 0;
    bench.run(parts.scene(), kTime, [&](World& world, double now) {
        const double angle = turns * now, circle = speed / turns;
        const Vec3 exact =
            Vec3(kRadius - circle * (1 - std::cos(angle)), circle * std::sin(angle), radius);
        const Vec3 at = world.pose(world.bodies()[ball]).position;
        off = std::max(off, std::hypot(at.x() - exact.x(), at.y() - exact.y()));
        return off < 1;
    });
    bench.report(setting + ", a ball rolls", "off its circle", off, kAway, "m");
}

void ride_all(CaseBench& bench, const std::string& how, const Settings& settings)
{
    const auto named = [&](const char* what) { return how + what; };
    judge(bench, {.setting = named(", box"), .settings = settings});
    judge(bench, {.setting = named(", cylinder"), .rider = Rider::can, .settings = settings});
    judge(bench,
          {.setting = named(", one box on another"),
           .friction = 0.6,
           .rider = Rider::pair,
           .settings = settings});
    judge(bench,
          {.setting = named(", table"),
           .friction = 0.6,
           .rider = Rider::table,
           .settings = settings});
    judge(bench,
          {.setting = named(", 2 % below what friction bears"),
           .rate = std::sqrt(0.98 * 0.5 * kGravity / kRadius),
           .rider = Rider::can,
           .settings = settings});
    judge(bench,
          {.setting = named(", plate of 1 t on an axle"),
           .plate = Plate::axle,
           .settings = settings});
    judge(bench,
          {.setting = named(", free plate of 100 kg"),
           .plate = Plate::afloat,
           .weight = 100,
           .settings = settings});
    judge(bench,
          {.setting = named(", turned"),
           .turn = exponential(Vec3(0.3, -0.5, 0.7)),
           .settings = settings});
    judge(bench,
          {.setting = named(", far off"), .off = Vec3(1e6, -2e6, 3e6), .settings = settings});
    judge(bench, {.setting = named(", plate made last"), .plate_last = true, .settings = settings});
    roll(bench, how, settings);
}

}  // namespace

void case_carried_round(CaseBench& bench)
{
    const Settings usual = bench.settings();
    ride_all(bench, "default", usual);
    const auto with = [&](auto choose) {
        Settings settings = usual;
        choose(settings);
        return settings;
    };
    const Settings fine = with([](Settings& s) { s.substeps = 16; });
    const Settings plain = with([](Settings& s) { s.solver = Solver::pgs; });
    const Settings direct = with([](Settings& s) { s.solver = Solver::direct; });
    const Settings penalty = with([](Settings& s) { s.response = Response::penalty; });
    const Settings apart = with([](Settings& s) { s.overlap = Overlap::back_up; });
    const Settings halved = with([](Settings& s) { s.overlap = Overlap::subdivide; });
    judge(bench, {.setting = "substeps=16, box", .most = 1e-4, .settings = fine});
    judge(bench, {.setting = "direct, box", .settings = direct});
    judge(bench, {.setting = "penalty, box", .settings = penalty});
    judge(bench, {.setting = "back_up, box", .settings = apart});
    judge(bench, {.setting = "subdivide, box", .settings = halved});
    judge(bench,
          {.setting = "default, slab at 6 rad/s",
           .rate = 6,
           .friction = 5,
           .rider = Rider::slab,
           .settings = usual});
    Settings exact = usual;
    ask_exactly(exact);
    if (bench.brief()) {
        judge(bench, {.setting = "pgs, box", .settings = plain});
        judge(bench, {.setting = "most exact, box", .settings = exact});
        return;
    }
    for (const double rate : {240.0, 1000.0})
        ride_all(bench, "dt 1/" + std::to_string(std::lround(rate)),
                 with([&](Settings& s) { s.dt = 1 / rate; }));
    ride_all(bench, "most exact", exact);
    ride_all(bench, "pgs", plain);
}

}  // namespace throng
