// Leaning bodies: H22, thresholds of standing and falling.
//
// Three equal logs, two on the floor and one on top, stand when log on log mu is at least tan 15
// deg and log on floor a third of that. A ladder on a smooth wall holds when the foot's mu is at
// least (horizontal way from foot to center) / (height of the upper contact above the foot). Each
// threshold is tried 5 % either side; 3 % where it is solved exactly.
#include "cost/hard_cases/hard_cases.hpp"
#include "throng/rotation.hpp"
#include "throng/world.hpp"

#include <cmath>

namespace throng {

namespace {

constexpr double kTime = 10;     // s; at 5 % below a threshold things have moved far by then
constexpr double kMoved = 0.05;  // of the body's size: more is a fall

// How far the highest body sinks, as a share of `size`.
double sinks(CaseBench& bench, const Scene& scene, double size)
{
    double first = 0, last = 0;
    bool begun = false;
    bench.run(scene, kTime, [&](World& world, double) {
        last = world.pose(world.bodies().back()).position.z();
        if (!begun) first = last;
        begun = true;
        return first - last < 4 * kMoved * size;
    });
    return (first - last) / size;
}

void expect(CaseBench& bench, const std::string& setting, bool stands, double sunk)
{
    const bool right = stands ? sunk < kMoved : sunk >= kMoved;
    bench.report(setting, stands ? "stands: wrong outcomes" : "falls: wrong outcomes",
                 right ? 0 : 1, 0, "1");
}

Scene log_pile(const CaseBench& bench, double on_log, double on_floor)
{
    const double radius = 0.5, half_length = 1;
    SceneParts parts(bench.scene());
    const std::uint32_t log = parts.material(0), floor = parts.material(0);
    parts.pair_materials(log, log, on_log);
    parts.pair_materials(log, floor, on_floor);
    parts.plane(floor, Vec3::UnitZ(), 0);
    const Quat lying = exponential(Vec3(kPi / 2, 0, 0));  // axis along y
    const double up = radius * std::sqrt(3.0);
    for (const Vec3& at :
         {Vec3(-radius, 0, radius), Vec3(radius, 0, radius), Vec3(0, 0, radius + up)})
        parts.cylinder(log, 1, radius, half_length, Pose{at, lying});
    return parts.scene();
}

struct Ladder {
    double half_length = 2, half_thickness = 0.02, half_width = 0.3;
    double angle = 0;  // to the floor

    // The foot is the lower corner nearer the wall's far side, the head the upper one at the wall.
    Vec3 along() const { return Vec3(std::cos(angle), 0, std::sin(angle)); }
    Vec3 across() const { return Vec3(-std::sin(angle), 0, std::cos(angle)); }
    Vec3 foot() const { return -half_length * along() - half_thickness * across(); }
    Vec3 head() const { return half_length * along() - half_thickness * across(); }
    // The lowest and the outermost corner, whichever side of the ladder they are on.
    Vec3 lowest() const
    {
        const Vec3 other = -half_length * along() + half_thickness * across();
        return foot().z() < other.z() ? foot() : other;
    }
    Vec3 outermost() const
    {
        const Vec3 other = half_length * along() + half_thickness * across();
        return head().x() > other.x() ? head() : other;
    }
    double least_friction() const { return -lowest().x() / (outermost().z() - lowest().z()); }
};

Scene leaning_ladder(const CaseBench& bench, const Ladder& ladder, double friction)
{
    SceneParts parts(bench.scene());
    const std::uint32_t wood = parts.material(0), floor = parts.material(0),
                        wall = parts.material(0);
    parts.pair_materials(wood, floor, friction);
    parts.pair_materials(wood, wall, 0);
    parts.plane(floor, Vec3::UnitZ(), ladder.lowest().z());
    parts.plane(wall, Vec3(-1, 0, 0), -ladder.outermost().x());
    Pose pose;
    pose.orientation = exponential(Vec3(0, -ladder.angle, 0));
    parts.box(wood, 10, Vec3(ladder.half_length, ladder.half_width, ladder.half_thickness), pose);
    return parts.scene();
}

}  // namespace

namespace {

struct Side {
    std::string name;
    double share;
    bool exact;
};

void try_thresholds(CaseBench& bench, const Side& side)
{
    const double on_log = std::tan(kPi / 12), on_floor = on_log / 3;
    const auto exactly = [&](Scene scene) {
        if (side.exact) ask_exactly(scene.settings);
        return scene;
    };
    const bool stands = side.share > 1;
    expect(bench, "logs, log on log mu " + side.name, stands,
           sinks(bench, exactly(log_pile(bench, side.share * on_log, 0.5)), 0.5));
    expect(bench, "logs, log on floor mu " + side.name, stands,
           sinks(bench, exactly(log_pile(bench, 0.5, side.share * on_floor)), 0.5));
    for (const double friction : {0.3, 0.4, 0.5}) {
        Ladder ladder;
        ladder.angle = std::atan(1 / (2 * friction));
        const std::string angle = std::to_string(ladder.angle * 180 / kPi).substr(0, 5);
        const double mu = side.share * ladder.least_friction();
        expect(bench, "ladder at " + angle + " deg, mu " + side.name, stands,
               sinks(bench, exactly(leaning_ladder(bench, ladder, mu)), 1));
    }
}

}  // namespace

void case_leaning(CaseBench& bench)
{
    for (const Side& side : {Side{"+5 %", 1.05, false}, Side{"-5 %", 0.95, false},
                             Side{"+3 %, direct", 1.03, true}, Side{"-3 %, direct", 0.97, true}})
        try_thresholds(bench, side);
}

}  // namespace throng
