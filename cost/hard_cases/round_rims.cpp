// Round rims: H80, hulls of few corners and of thousands, on a plane, a box, a mesh and a hull.
//
// Answer: whatever a hull lies on, it comes to rest within seconds and sinks in by no more than a
// thousandth of its size. A finely rounded rim has many corners a hair above the lowest: a contact
// that spreads over those and leaves the lowest out bears the hull at one point.
#include "cost/hard_cases/floors.hpp"
#include "throng/rotation.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

constexpr double kSize = 1;  // m, as they are made
constexpr double kTime = 5;  // s
// m, a soft contact at rest gives way by up to that, whatever bears on it and however small.
constexpr double kGives = 1e-4;

struct RoundedHull {
    std::string name;
    std::vector<Vec3> points;
    double size = kSize;
};

// Turned about z: a ring of corners at each place of the outline.
RoundedHull lathe(std::string name, const std::vector<std::array<double, 2>>& outline, int around)
{
    RoundedHull hull{std::move(name), {}};
    for (const auto& [radius, height] : outline) {
        if (radius < 1e-9 * kSize) {
            hull.points.emplace_back(0, 0, height);
            continue;
        }
        for (int i = 0; i < around; ++i) {
            const double angle = 2 * kPi * i / around;
            hull.points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), height);
        }
    }
    hull.name += " of " + std::to_string(hull.points.size());
    return hull;
}

// A cylinder both of whose rims are quarters of a circle.
RoundedHull drum(double rim, int steps, int around)
{
    std::vector<std::array<double, 2>> outline;
    for (const int end : {-1, 1})
        for (int i = 0; i <= steps; ++i) {
            const double angle = kPi / 2 * i / steps;
            outline.push_back({kSize / 2 - rim * (1 - std::sin(angle)),
                               end * (kSize / 2 - rim * (1 - std::cos(angle)))});
        }
    return lathe("drum", outline, around);
}

RoundedHull dome(int rings, int around)
{
    std::vector<std::array<double, 2>> outline;
    for (int i = 0; i <= rings; ++i) {
        const double angle = kPi / 2 * i / rings;
        outline.push_back({kSize / 2 * std::cos(angle), kSize / 2 * std::sin(angle)});
    }
    return lathe("dome", outline, around);
}

RoundedHull cone(int around) { return lathe("cone", {{kSize / 2, 0}, {0, kSize / 2}}, around); }

// A box whose edges and corners are rounded off.
RoundedHull die(double rim, int steps)
{
    RoundedHull hull{"die", {}};
    std::vector<double> along;
    for (const int end : {-1, 1})
        for (int i = 0; i <= steps; ++i)
            along.push_back(end * std::tan(kPi / 4 * (end < 0 ? steps - i : i) / steps));
    // Directions of a cube's surface, each a point of the ball at the corner that it belongs to.
    for (const double x : along)
        for (const double y : along)
            for (int side = 0; side < 6; ++side) {
                Vec3 to;
                to[side % 3] = side < 3 ? 1 : -1;
                to[(side + 1) % 3] = x;
                to[(side + 2) % 3] = y;
                Vec3 at = to.normalized() * rim;
                for (int i = 0; i < 3; ++i) at[i] += std::copysign(kSize / 2 - rim, to[i]);
                hull.points.push_back(at);
            }
    hull.name += " of " + std::to_string(hull.points.size());
    return hull;
}

struct Fall {
    double lean = 0;  // rad, as it is let go a hundredth of its size above the floor
    Vec3 at = Vec3::Zero();
    bool last = false;  // the floor is made after the hull
};

FloorSize floor_for(const RoundedHull& hull) { return {4 * hull.size, hull.size / 2}; }

void let_fall(CaseBench& bench,
              const RoundedHull& hull,
              Floor floor,
              const Fall& fall,
              const std::string& how,
              const Settings& settings)
{
    SceneParts parts(bench.scene());
    parts.scene().settings = settings;
    parts.scene().settings.sleep = false;
    const std::uint32_t material = parts.material(0.5);
    const Pose ground{fall.at, Quat::Identity()};
    if (!fall.last) put_floor(parts, material, floor, ground, floor_for(hull));
    Pose pose{fall.at, exponential(fall.lean * Vec3(0.28, 0.96, 0))};
    pose.position.z() += fall.at.z() + 0.01 * hull.size - lowest_of(hull.points, pose);
    const std::uint32_t id = parts.hull(material, 100, HullShape{hull.points}, pose);
    if (fall.last) put_floor(parts, material, floor, ground, floor_for(hull));
    double speed = 0, sunk = 0;
    bench.run(parts.scene(), kTime, [&](World& world, double now) {
        const BodyId body = world.bodies()[id];
        // While it comes down it may sink in further.
        if (now > kTime / 2)
            sunk = std::max(sunk, fall.at.z() - lowest_of(hull.points, world.pose(body)));
        speed = std::max(world.velocity(body).norm(),
                         hull.size / 2 * world.angular_velocity(body).norm());
        return true;
    });
    const std::string setting = hull.name + " on a " + name_of(floor) + how;
    bench.report(setting, "sinks in", sunk, std::max(1e-3 * hull.size, kGives), "m");
    bench.report(setting, "speed after 5 s", speed, 1e-4, "m/s");
}

// Corners that are as far from one another as others must not take turns in bearing it.
void rest_on_slope(CaseBench& bench, Floor floor)
{
    RoundedHull prism = lathe("prism", {{kSize / 3, -0.2}, {kSize / 3, 0.2}}, 7);
    SceneParts parts(bench.scene());
    parts.scene().settings.sleep = false;
    const Quat slope = exponential(20 * kPi / 180 * Vec3(0.3, 0.95, 0).normalized());
    parts.scene().gravity = slope * Vec3(0, 0, -kGravity);
    const std::uint32_t material = parts.material(0.5);
    put_floor(parts, material, floor, {}, floor_for(prism));
    const Pose pose{Vec3(0.2, 0.1, 0.2), exponential(Vec3(0, 0, 0.2))};
    const std::uint32_t id = parts.hull(material, 100, HullShape{prism.points}, pose);
    double way = 0;
    bench.run(parts.scene(), 2 * kTime, [&](World& world, double) {
        way = (world.pose(world.bodies()[id]).position - pose.position).norm();
        return true;
    });
    bench.report(prism.name + " on a slope that is a " + name_of(floor), "creeps in 10 s", way,
                 1e-3 * kSize, "m");
}

RoundedHull scaled(RoundedHull hull, double by)
{
    for (Vec3& point : hull.points) point *= by;
    hull.size *= by;
    return hull;
}

std::vector<RoundedHull> solids(bool brief)
{
    if (brief) return {drum(0.05, 16, 32), die(0.1, 2)};
    return {cone(8),      die(0.1, 2),         drum(0.05, 1, 16), drum(0.002, 16, 32),
            dome(16, 64), drum(0.05, 16, 32),  die(0.05, 5),      drum(0.1, 24, 40),
            cone(1000),   drum(0.05, 19, 100), dome(39, 100)};
}

}  // namespace

void case_round_rims(CaseBench& bench)
{
    const Settings usual = bench.settings();
    for (const RoundedHull& hull : solids(bench.brief()))
        for (const Floor floor : kFloors) {
            let_fall(bench, hull, floor, {.lean = 0.02}, "", usual);
            if (bench.brief()) continue;
            for (const double rate : {240.0, 1000.0}) {
                Settings settings = usual;
                settings.dt = 1 / rate;
                let_fall(bench, hull, floor, {.lean = 0.02},
                         ", dt 1/" + std::to_string(std::lround(rate)), settings);
            }
        }
    for (const Floor floor : kFloors) rest_on_slope(bench, floor);
    const RoundedHull one = drum(0.05, 16, 32);
    let_fall(bench, one, Floor::plane, {}, ", level", usual);
    let_fall(bench, one, Floor::plane, {.lean = 0.02, .last = true}, ", made last", usual);
    let_fall(bench, one, Floor::plane, {.lean = 0.02, .at = Vec3(3e6, -1e6, 2e6 + 0.3)},
             ", far off", usual);
    let_fall(bench, scaled(one, 5e-3), Floor::plane, {.lean = 0.02}, ", of 5 mm", usual);
    let_fall(bench, scaled(one, 50), Floor::plane, {.lean = 0.02}, ", of 50 m", usual);
    let_fall(bench, one, Floor::plane, {.lean = 1.2}, ", falling on its side", usual);
    Settings exact = usual;
    ask_exactly(exact);
    for (const Floor floor : kFloors)
        let_fall(bench, one, floor, {.lean = 0.02}, ", direct", exact);
}

}  // namespace throng
