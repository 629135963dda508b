// Rolling along: H93, what is round rolls along at the same speed on a floor of any kind.
//
// Answer: a ball, a capsule or a wheel that rolls without slip has nothing to lose, whatever the
// floor is made of and however far it goes in a step. A wheel of many corners loses a little with
// each: as much by long steps as by short ones.
#include "cost/hard_cases/floors.hpp"
#include "cost/hard_cases/hard_cases.hpp"
#include "throng/rotation.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

constexpr double kWay = 40, kLongest = 5;  // m, s
constexpr double kSpeeds[] = {1, 3, 10};   // m/s

struct Roller {
    const char* name;
    double radius = 0.3, half_length = 0;  // m
    bool capped = false;                   // a capsule
};

constexpr Roller kRollers[] = {
    {"ball"},           {"capsule", 0.3, 0.4, true}, {"thin wheel", 0.3, 0.02}, {"wheel", 0.3, 0.1},
    {"drum", 0.3, 0.8}, {"small wheel", 0.05, 0.02}};

struct Way {
    const char* how = "";
    Vec3 at = Vec3::Zero();
    double slant = 0;   // rad, of floor and gravity alike
    bool last = false;  // the floor is made after what rolls
    void (*choose)(Settings&) = [](Settings&) {};
};

std::uint32_t
put_roller(SceneParts& parts, std::uint32_t material, const Roller& roller, const Pose& pose)
{
    if (roller.half_length == 0) return parts.ball(material, 10, roller.radius, pose.position);
    const std::uint32_t id = parts.cylinder(material, 10, roller.radius, roller.half_length, pose);
    if (roller.capped)
        parts.scene().shapes[parts.body(id).shape].shape =
            CapsuleShape{roller.radius, roller.half_length};
    return id;
}

// Along a level x, from -kWay / 2, turned a little from the floor's own sides; what rolls has its
// own z to the left or, flipped, to the right.
struct Course {
    Pose floor, start;
    Vec3 ahead, axis;

    Course(const Way& way, double radius, bool flipped = false)
    {
        floor = {way.at, exponential(Vec3(0.28, 0.96, 0) * way.slant)};
        const Quat aside = floor.orientation * exponential(Vec3(0, 0, 0.3));
        ahead = aside * Vec3::UnitX();
        axis = aside * Vec3::UnitY();
        start = {floor * Vec3(0.1, 0.2, radius) - kWay / 2 * ahead,
                 aside * exponential(Vec3(flipped ? kPi / 2 : -kPi / 2, 0, 0))};
    }
};

void lay_out(SceneParts& parts,
             std::uint32_t material,
             Floor floor,
             const Way& way,
             const Course& course,
             const auto& put)
{
    parts.scene().gravity = course.floor.orientation * Vec3(0, 0, -kGravity);
    way.choose(parts.scene().settings);
    constexpr FloorSize kSize{60, 0.5, 240};
    if (!way.last) put_floor(parts, material, floor, course.floor, kSize);
    put();
    if (way.last) put_floor(parts, material, floor, course.floor, kSize);
}

struct Rolled {
    double speed = 0, height = 0;  // m/s along its way, m above the floor
};

Rolled
roll(CaseBench& bench, const Scene& scene, std::uint32_t id, const Course& course, double time)
{
    Rolled rolled;
    bench.run(scene, time, [&](World& world, double) {
        const BodyId body = world.bodies()[id];
        rolled.speed = course.ahead.dot(world.velocity(body));
        const Vec3 up = course.floor.orientation * Vec3::UnitZ();
        rolled.height = up.dot(world.pose(body).position - course.floor.position);
        return true;
    });
    return rolled;
}

void roll_along(CaseBench& bench, const Roller& roller, Floor floor, const Way& way)
{
    double lost = 0, lifted = 0;
    const auto roll_at = [&](double speed, bool flipped) {
        SceneParts parts(bench.scene());
        const std::uint32_t material = parts.material(0.5);
        const Course course(way, roller.radius, flipped);
        std::uint32_t id = 0;
        lay_out(parts, material, floor, way, course, [&] {
            id = put_roller(parts, material, roller, course.start);
            parts.body(id).velocity = speed * course.ahead;
            parts.body(id).angular_velocity = speed / roller.radius * course.axis;
        });
        const double time = std::min(kLongest, kWay / speed);
        const Rolled rolled = roll(bench, parts.scene(), id, course, time);
        lost = std::max(lost, std::abs(rolled.speed / speed - 1));
        lifted = std::max(lifted, std::abs(rolled.height / roller.radius - 1));
    };
    for (const double speed : kSpeeds)
        for (const bool flipped : {false, true}) roll_at(speed, flipped);
    const std::string setting = std::string(roller.name) + " on a " + name_of(floor) + way.how;
    bench.report(setting, "error of its speed, the worst of 1, 3 and 10 m/s", lost, 2e-3, "1");
    bench.report(setting, "error of its height over its radius", lifted, 2e-3, "1");
}

HullShape many_sided(int sides)
{
    HullShape hull;
    for (int i = 0; i < sides; ++i)
        for (const double z : {-0.05, 0.05}) {
            const double angle = 2 * kPi * i / sides;
            hull.points.emplace_back(0.3 * std::cos(angle), 0.3 * std::sin(angle), z);
        }
    return hull;
}

double roll_on_corners(CaseBench& bench, int sides, Floor floor, const Way& way)
{
    constexpr double kSpeed = 3;
    SceneParts parts(bench.scene());
    const std::uint32_t material = parts.material(0.5);
    const Course course(way, 0.3);
    std::uint32_t id = 0;
    lay_out(parts, material, floor, way, course, [&] {
        id = parts.hull(material, 10, many_sided(sides), course.start);
        parts.body(id).velocity = kSpeed * course.ahead;
        parts.body(id).angular_velocity = kSpeed / 0.3 * course.axis;
    });
    return roll(bench, parts.scene(), id, course, 1).speed / kSpeed;
}

void roll_on_corners(CaseBench& bench)
{
    const Way fine = {.how = ", direct, dt 5e-4", .choose = [](Settings& settings) {
                          ask_exactly(settings);
                          settings.dt = 5e-4;
                      }};
    for (const int sides : {64, 200}) {
        const double wanted = roll_on_corners(bench, sides, Floor::plane, fine);
        for (const Floor floor : kFloors) {
            const double kept = roll_on_corners(bench, sides, floor, {});
            bench.report("wheel of " + std::to_string(sides) + " sides on a " + name_of(floor),
                         "error of its speed after 1 s against short steps",
                         std::abs(kept / wanted - 1), 0.1, "1");
        }
    }
}

}  // namespace

void case_rolling_along(CaseBench& bench)
{
    if (bench.brief()) return roll_along(bench, kRollers[3], Floor::grid, {});
    for (const Roller& roller : kRollers)
        for (const Floor floor : kFloorsAndGrid) roll_along(bench, roller, floor, {});
    const Way ways[] = {
        {.how = ", dt 1/240", .choose = [](Settings& settings) { settings.dt = 1.0 / 240; }},
        {.how = ", dt 1e-3", .choose = [](Settings& settings) { settings.dt = 1e-3; }},
        {.how = ", 16 substeps", .choose = [](Settings& settings) { settings.substeps = 16; }},
        {.how = ", pgs", .choose = [](Settings& settings) { settings.solver = Solver::pgs; }},
        {.how = ", direct", .choose = ask_exactly},
        {.how = ", turned", .slant = 1.1},
        {.how = ", far off", .at = Vec3(3e4, -1e4, 2e4)},
        {.how = ", made last", .last = true},
    };
    for (const Roller& roller : {kRollers[3], kRollers[5]})
        for (const Way& way : ways)
            for (const Floor floor : {Floor::mesh, Floor::grid})
                roll_along(bench, roller, floor, way);
    roll_on_corners(bench);
}

}  // namespace throng
