// Far on ground: H128, on a large slope it is the same in its middle and kilometers away.
//
// Answer: gravity is the same everywhere, and so is a slope of one piece. A box and a stack that
// friction holds stay where they are; what is round rolls down as fast as its inertia lets it, and
// neither leaves the ground nor sinks in.
#include "cost/hard_cases/floors.hpp"
#include "cost/hard_cases/hard_cases.hpp"
#include "throng/rotation.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

constexpr double kTilt = 0.22;             // rad, of the slope
constexpr FloorSize kSize{12000, 50, 48};  // m; cells of 500 m
constexpr double kRest = 8, kRolls = 4;    // s
constexpr double kRadius = 0.25;           // m
const Vec3 kHalf{0.3, 0.2, 0.25};          // m
constexpr double kSettled = 3, kRuns = 1;  // s, from when on it is measured

struct Place {
    const char* name;
    Vec3 at;  // in the slope's frame
};

const Place kPlaces[] = {{"in its middle", {0.37, 0.21, 0}},
                         {"9.8 km from its middle", {7321.37, 6543.21, 0}}};

// Down is along the slope's -x, turned a little from the sides of what lies on it.
Pose slope() { return {Vec3(40, -30, 12), exponential(Vec3(0, -kTilt, 0))}; }

void lay(SceneParts& parts, Floor floor, std::uint32_t material)
{
    put_floor(parts, material, floor, slope(), kSize);
}

// How fast what rests moves, and how far it has gone, the worst of all.
void rest(CaseBench& bench, Floor floor, const Place& place)
{
    SceneParts parts(bench.scene());
    const std::uint32_t material = parts.material(0.6);
    lay(parts, floor, material);
    parts.scene().settings.sleep = false;
    std::vector<std::uint32_t> ids;
    const auto put = [&](const Vec3& at, double turned) {
        const Pose own{place.at + at, exponential(Vec3(0, 0, turned))};
        ids.push_back(parts.box(material, 10, kHalf, slope() * own));
    };
    put({2, 1, kHalf.z()}, 0.4);
    for (int k = 0; k < 3; ++k) put({-2, 1, kHalf.z() * (2 * k + 1)}, 0.4);
    double fastest = 0, gone = 0;
    std::vector<Vec3> settled;
    bench.run(parts.scene(), kRest, [&](World& world, double time) {
        if (time < kSettled) return true;
        const std::vector<BodyId> bodies = world.bodies();
        for (std::size_t i = 0; i < ids.size(); ++i) {
            const Vec3 at = world.pose(bodies[ids[i]]).position;
            if (settled.size() < ids.size()) settled.push_back(at);
            fastest = std::max(fastest, world.velocity(bodies[ids[i]]).norm());
            gone = std::max(gone, (at - settled[i]).norm());
        }
        return true;
    });
    const std::string setting = std::string(name_of(floor)) + ", " + place.name;
    bench.report(setting, "greatest speed of a box and a stack at rest", fastest, 1e-4, "m/s");
    bench.report(setting, "how far they creep in five seconds", gone, 2e-5, "m");
}

struct Roller {
    const char* name;
    double inertia;  // about its axis, over its mass and the square of its radius
};

constexpr Roller kRollers[] = {{"ball", 0.4}, {"drum", 0.5}};

void roll(CaseBench& bench, Floor floor, const Place& place, const Roller& roller)
{
    SceneParts parts(bench.scene());
    const std::uint32_t material = parts.material(0.6);
    lay(parts, floor, material);
    const Pose start =
        slope() * Pose{place.at + Vec3(0, 0, kRadius), exponential(Vec3(kPi / 2, 0, 0))};
    const bool ball = roller.inertia == 0.4;
    const std::uint32_t id = ball ? parts.ball(material, 10, kRadius, start.position)
                                  : parts.cylinder(material, 10, kRadius, 0.3, start);
    const Vec3 up = slope().orientation * Vec3::UnitZ(),
               down = slope().orientation * -Vec3::UnitX();
    double off = 0, leaves = 0;
    bench.run(parts.scene(), kRolls, [&](World& world, double time) {
        const Vec3 velocity = world.velocity(world.bodies()[id]);
        const double wanted = kGravity * std::sin(kTilt) / (1 + roller.inertia) * time;
        if (time < kRuns) return true;
        off = std::max(off, std::abs(down.dot(velocity) / wanted - 1));
        leaves = std::max(leaves, std::abs(up.dot(velocity)));
        return true;
    });
    const std::string setting =
        std::string(roller.name) + " on a " + name_of(floor) + ", " + place.name;
    bench.report(setting, "error of its speed, a share of it", off, 2e-3, "1");
    bench.report(setting, "greatest speed from the slope or into it", leaves, 2e-4, "m/s");
}

}  // namespace

void case_far_on_ground(CaseBench& bench)
{
    for (const Floor floor : kFloorsAndGrid)
        for (const Place& place : kPlaces) {
            rest(bench, floor, place);
            for (const Roller& roller : kRollers) roll(bench, floor, place, roller);
        }
}

}  // namespace throng
