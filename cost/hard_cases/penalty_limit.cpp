// The stiffest contact of a step: H46, for penalty forces.
//
// A ball of mass m that rests on a spring of stiffness k swings at w = sqrt(k / m); moved by a
// semi-implicit step beyond 2 / w it would swing wider and wider. Beyond that the substep is cut,
// which is told. What rests on n points overlaps by m g / (n k).
#include "cost/hard_cases/hard_cases.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

constexpr double kStiffness = 1e6, kMass = 1, kFrequency = 1000;  // N/m, kg, rad/s
constexpr double kRests = kMass * kGravity / kStiffness;          // m, overlap at rest
constexpr double kFirst = 0.1 * kRests;                           // m, the first swing

struct Swing {
    double widest = 0;  // m
    bool warned = false;
};

// So little off where it rests that it never leaves the floor, however wide it may swing within.
Swing swing(CaseBench& bench, double dt)
{
    constexpr double kRadius = 0.5;
    constexpr int kSteps = 2000;
    SceneParts parts(bench.scene());
    const std::uint32_t material = parts.material(0);
    parts.plane(material, Vec3::UnitZ(), 0);
    parts.ball(material, kMass, kRadius, Vec3(0, 0, kRadius - kRests + kFirst));
    Settings& settings = parts.scene().settings;
    settings.response = Response::penalty;
    settings.penalty_stiffness = kStiffness;
    settings.penalty_damping = 0;
    settings.precision = Precision::double_;
    settings.substeps = 1;
    settings.sleep = false;
    settings.dt = dt;
    Swing result;
    bench.run(parts.scene(), kSteps * dt, [&](World& world, double) {
        const double off = world.pose(world.bodies().back()).position.z() - (kRadius - kRests);
        result.widest = std::max(result.widest, std::abs(off));
        result.warned = !world.warnings().empty();
        return result.widest < 1;
    });
    return result;
}

// Of a cube on its four corners, once it is at rest.
double overlap_at_rest(CaseBench& bench)
{
    SceneParts parts(bench.scene());
    const std::uint32_t material = parts.material(0.5);
    parts.plane(material, Vec3::UnitZ(), 0);
    parts.box(material, kMass, Vec3::Constant(0.5), {Vec3(0, 0, 0.5), Quat::Identity()});
    Settings& settings = parts.scene().settings;
    settings.response = Response::penalty;
    settings.penalty_stiffness = 1e5;
    settings.precision = Precision::double_;
    settings.sleep = false;
    double overlap = 0;
    bench.run(parts.scene(), 3, [&](World& world, double) {
        overlap = 0.5 - world.pose(world.bodies().back()).position.z();
        return true;
    });
    return overlap;
}

}  // namespace

void penalty_limit(CaseBench& bench)
{
    // Next to the limit a swing is 1 / sqrt(1 - 0.98^2) as wide as it is far from it.
    constexpr double kWider = 6;
    const double limit = 2 / kFrequency;
    const Swing within = swing(bench, 0.98 * limit);
    const char* const below = "penalty, ball, no damping, 0.98 of the limit";
    bench.report(below, "widest swing, of the first", within.widest / kFirst, kWider, "1");
    bench.report(below, "warnings", within.warned ? 1 : 0, 0, "1");
    const Swing beyond = swing(bench, 1.02 * limit);
    const char* const above = "penalty, ball, no damping, 1.02 of the limit, cut";
    bench.report(above, "widest swing, of the first", beyond.widest / kFirst, kWider, "1");
    bench.report(above, "warnings that are missing", beyond.warned ? 0 : 1, 0, "1");
    const double wanted = kMass * kGravity / (4 * 1e5);
    bench.report("penalty, cube at rest", "error of the overlap, from mg / 4k",
                 std::abs(overlap_at_rest(bench) / wanted - 1), 0.01, "1");
}

}  // namespace throng
