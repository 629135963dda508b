// Slender bars: H75, bars that only turn, on a pivot or with a locked position, and what stops
// them.
//
// Answer: a bar that swings down on something that stands still comes to lie on it, however slender
// it is: where it touches it is never deeper than half its radius.
#include "cost/hard_cases/hard_cases.hpp"
#include "throng/rotation.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

constexpr double kLength = 2;    // m
constexpr double kRaised = 0.7;  // rad, from which it swings down

enum class Bar : std::uint8_t { capsule, cylinder, beam };
enum class Obstacle : std::uint8_t { box, ball, bar };
constexpr const char* kBarNames[] = {"capsule", "cylinder", "beam"};
constexpr const char* kObstacleNames[] = {"box", "ball", "bar"};

struct Swing {
    Bar bar = Bar::capsule;
    Obstacle obstacle = Obstacle::box;
    double slender = 100;                            // length over radius
    bool pivots = true;                              // else its position is locked
    bool turned = false, far = false, last = false;  // the obstacle is made after the bar

    double radius() const { return kLength / slender; }
    // From the axis of turning to the middle of the obstacle.
    double arm() const { return pivots ? 0.75 * kLength : 0.35 * kLength; }
    Pose frame() const
    {
        return {far ? Vec3(3e6, -1e6, 2e6 + 0.3) : Vec3(Vec3::Zero()),
                turned ? exponential(Vec3(0.3, -0.5, 0.8)) : Quat(Quat::Identity())};
    }
    std::string name() const
    {
        return std::string(kBarNames[static_cast<int>(bar)])
            + " 1:" + std::to_string(std::lround(slender)) + (pivots ? " on a pivot" : " locked")
            + ", on a " + kObstacleNames[static_cast<int>(obstacle)] + (turned ? ", turned" : "")
            + (far ? ", far off" : "") + (last ? ", made last" : "");
    }
};

void put_obstacle(SceneParts& parts, std::uint32_t material, const Swing& swing)
{
    const double size = 0.2;
    const Pose at = {Vec3(swing.arm(), 0, -size - swing.radius()),
                     exponential(Vec3(kPi / 2, 0, 0))};
    const Pose placed = swing.frame() * at;
    std::uint32_t id = 0;
    if (swing.obstacle == Obstacle::box)
        id = parts.box(material, 1, Vec3(size / 2, size, 2 * size), placed);
    else if (swing.obstacle == Obstacle::ball)
        id = parts.ball(material, 1, size, placed.position);
    else
        id = parts.cylinder(material, 1, size, 2 * size, placed);
    parts.hold(id);
}

std::uint32_t put_bar(SceneParts& parts, std::uint32_t material, const Swing& swing)
{
    const double half = kLength / 2, thin = swing.radius();
    const Quat raised = exponential(Vec3(0, kPi / 2 - kRaised, 0));
    const Vec3 middle = swing.pivots ? Vec3(raised * Vec3(0, 0, half)) : Vec3(Vec3::Zero());
    const Pose placed = swing.frame() * Pose{middle, raised};
    std::uint32_t id = 0;
    if (swing.bar == Bar::beam)
        id = parts.box(material, 1, Vec3(thin, thin, half), placed);
    else
        id = parts.cylinder(material, 1, thin, half, placed);
    if (swing.bar == Bar::capsule)
        parts.scene().shapes[parts.body(id).shape].shape = CapsuleShape{thin, half};
    if (swing.pivots) {
        parts.body(id).pivot = Vec3(0, 0, -half);
    } else {
        parts.body(id).lock_position = true;
        parts.body(id).angular_velocity = swing.frame().orientation * Vec3(0, 3, 0);
    }
    return id;
}

struct Swung {
    double deepest = 0;  // of its radius, below where it would lie
    double moved = 0;    // m, the place that it turns about
};

Swung swung(CaseBench& bench, const Swing& swing, const Settings& settings)
{
    SceneParts parts(bench.scene());
    parts.scene().settings = settings;
    parts.scene().settings.sleep = false;
    parts.scene().gravity = swing.frame().orientation * Vec3(0, 0, -kGravity);
    const std::uint32_t material = parts.material(0.5);
    if (!swing.last) put_obstacle(parts, material, swing);
    const std::uint32_t bar = put_bar(parts, material, swing);
    if (swing.last) put_obstacle(parts, material, swing);
    const Vec3 up = swing.frame().orientation * Vec3::UnitZ();
    Swung most;
    bench.run(parts.scene(), bench.brief() ? 1.0 : 3.0, [&](World& world, double) {
        const Pose pose = world.pose(world.bodies()[bar]);
        const Vec3 along = pose.orientation * Vec3::UnitZ();
        const Vec3 from = swing.pivots ? Vec3(pose * Vec3(0, 0, -kLength / 2)) : pose.position;
        const Vec3 off = from - swing.frame().position;
        const double below = -up.dot(off) - swing.arm() * up.dot(along);
        most.deepest = std::max(most.deepest, below / swing.radius());
        most.moved = std::max(most.moved, off.norm());
        return true;
    });
    return most;
}

void judge(CaseBench& bench, const Swing& swing, const std::string& how, const Settings& settings)
{
    const Swung most = swung(bench, swing, settings);
    bench.report(swing.name() + how, "greatest depth over the radius", most.deepest, 0.5, "1");
    bench.report(swing.name() + how, "what it turns about moved by", most.moved, 1e-6, "m");
}

void swing_all(CaseBench& bench, const std::string& how, const Settings& settings)
{
    for (const bool pivots : {true, false})
        for (const double slender : {10.0, 100.0, 1e3, 1e4}) {
            if (bench.brief() && slender > 1e3) continue;
            for (const Bar bar : {Bar::capsule, Bar::cylinder, Bar::beam})
                for (const Obstacle on : {Obstacle::box, Obstacle::ball, Obstacle::bar}) {
                    // A few of all, another for each where time is short.
                    if (bench.brief() && static_cast<int>(bar) != static_cast<int>(on)) continue;
                    judge(bench, {.bar = bar, .obstacle = on, .slender = slender, .pivots = pivots},
                          how, settings);
                }
        }
}

}  // namespace

void case_slender_bars(CaseBench& bench)
{
    Settings settings = bench.settings();
    swing_all(bench, "", settings);
    for (Swing swing : {Swing{.turned = true}, Swing{.far = true}, Swing{.last = true}})
        for (const bool pivots : {true, false}) {
            swing.pivots = pivots;
            judge(bench, swing, "", settings);
        }
    settings.solver = Solver::pgs;
    swing_all(bench, ", pgs", settings);
    ask_exactly(settings);
    swing_all(bench, ", direct", settings);
    if (bench.brief()) return;
    for (const double rate : {240.0, 1000.0}) {
        settings = bench.settings();
        settings.dt = 1 / rate;
        swing_all(bench, ", dt 1/" + std::to_string(std::lround(rate)), settings);
    }
}

}  // namespace throng
