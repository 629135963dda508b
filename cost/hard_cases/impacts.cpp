// Impacts: H15 (c), H17, H18 and H23, what bodies do that strike others.
//
// No gravity and no time to speak of: each answer is that of the impact alone. Both laws of impact
// keep momentum, and energy where e = 1; pair by pair in their order, or all that close together.
#include "cost/hard_cases/hard_cases.hpp"
#include "throng/rotation.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

constexpr double kExact = 1e-9;

SceneParts without_gravity(const CaseBench& bench, ImpactLaw law)
{
    SceneParts parts(bench.scene());
    parts.scene().gravity = Vec3::Zero();
    ask_exactly(parts.scene().settings);
    parts.scene().settings.dt = 1e-3;
    parts.scene().settings.sleep = false;
    parts.scene().settings.impact_law = law;
    return parts;
}

struct End {
    std::vector<Vec3> velocity, spin;
    Vec3 momentum = Vec3::Zero();
    double energy = 0;
};

End end_of(CaseBench& bench, const Scene& scene, double time)
{
    End end;
    bench.run(scene, time, [&](World& world, double) {
        end = {};
        for (const BodyId body : world.bodies()) {
            end.velocity.push_back(world.velocity(body));
            end.spin.push_back(world.angular_velocity(body));
        }
        const Measures measures = world.measure();
        end.momentum = measures.momentum;
        end.energy = measures.kinetic_energy;
        return true;
    });
    return end;
}

// Balls of 1 m along x, touching or apart, the first ones moving.
Scene row_of_balls(const CaseBench& bench,
                   ImpactLaw law,
                   std::initializer_list<double> masses,
                   double separation,
                   int moving,
                   double speed)
{
    SceneParts parts = without_gravity(bench, law);
    const std::uint32_t material = parts.material(0, 1);
    int place = 0;
    for (const double mass : masses) {
        const std::uint32_t ball =
            parts.ball(material, mass, 0.5, Vec3((1 + separation) * place, 0, 0));
        if (place < moving) parts.body(ball).velocity = Vec3(speed, 0, 0);
        ++place;
    }
    return parts.scene();
}

void cradle(CaseBench& bench, const std::string& name, ImpactLaw law)
{
    for (const int moving : {1, 2}) {
        const End end =
            end_of(bench, row_of_balls(bench, law, {1, 1, 1, 1, 1}, 0, moving, 1), 0.01);
        double error = 0;
        for (int i = 0; i < 5; ++i) {
            const Vec3 wanted(i < 5 - moving ? 0 : 1, 0, 0);
            error = std::max(error, (end.velocity[static_cast<std::size_t>(i)] - wanted).norm());
        }
        const std::string what = name + (moving == 1 ? ", one in" : ", two in");
        bench.report(what, "error of the velocities", error, kExact, "m/s");
        bench.report(what, "error of the momentum", (end.momentum - Vec3(moving, 0, 0)).norm(),
                     kExact, "N s");
        bench.report(what, "error of the energy", std::abs(end.energy - moving / 2.0), kExact, "J");
    }
    const End end = end_of(bench, row_of_balls(bench, law, {1, 2, 4}, 0.01, 1, 3), 0.1);
    const double wanted[3] = {-1, -2.0 / 3, 4.0 / 3};
    double error = 0;
    for (std::size_t i = 0; i < 3; ++i)
        error = std::max(error, std::abs(end.velocity[i].x() - wanted[i]));
    bench.report(name + ", 1-2-4 kg apart", "error of the velocities", error, kExact, "m/s");
}

// A ball falls between two others, 30 degrees to either side.
void symmetric_drop(CaseBench& bench)
{
    SceneParts parts = without_gravity(bench, ImpactLaw::simultaneous);
    const std::uint32_t material = parts.material(0, 1);
    for (const double side : {-1.0, 1.0})
        parts.ball(material, 1, 0.5, Vec3(side * std::sin(kPi / 6), 0, -std::cos(kPi / 6)));
    const std::uint32_t ball = parts.ball(material, 1, 0.5, Vec3::Zero());
    parts.body(ball).velocity = Vec3(0, 0, -1);
    const End end = end_of(bench, parts.scene(), 0.01);
    const double asymmetry = std::max({std::abs(end.velocity[0].x() + end.velocity[1].x()),
                                       std::abs(end.velocity[0].z() - end.velocity[1].z()),
                                       std::abs(end.velocity[2].x())});
    const char* const name = "drop between two, simultaneous";
    bench.report(name, "difference of the mirror images", asymmetry, 1e-12, "m/s");
    bench.report(name, "error of the momentum", (end.momentum - Vec3(0, 0, -1)).norm(), kExact,
                 "N s");
    bench.report(name, "error of the energy", std::abs(end.energy - 0.5), kExact, "J");
}

// Fifteen balls in a triangle and the cue ball, in that order of ids or backwards.
Scene billiards(const CaseBench& bench, bool backwards)
{
    const double radius = 0.028575, mass = 0.17;
    SceneParts parts = without_gravity(bench, ImpactLaw::simultaneous);
    const std::uint32_t material = parts.material(0, 1);
    std::vector<Vec3> places;
    for (int row = 0; row < 5; ++row)
        for (int i = 0; i <= row; ++i)
            places.emplace_back(row * radius * std::sqrt(3.0), (2 * i - row) * radius, 0);
    places.emplace_back(-2 * radius, 0, 0);
    if (backwards) std::reverse(places.begin(), places.end());
    for (const Vec3& at : places) {
        const std::uint32_t ball = parts.ball(material, mass, radius, at);
        if (at.x() < -radius) parts.body(ball).velocity = Vec3(5, 0, 0);
    }
    return parts.scene();
}

Vec3 mirrored(const Vec3& v) { return {v.x(), -v.y(), v.z()}; }

// Rows take their coefficients in float.
constexpr double kRows = 1e-6;

// A solver in its digits, and the bound that these leave.
struct ImpactSolver {
    const char* name;
    Solver solver;
    Precision precision;
    double bound;
};
constexpr ImpactSolver kImpactSolvers[] = {
    {"direct", Solver::direct, Precision::double_, kExact},
    {"direct, float", Solver::direct, Precision::float_, 1e-4},
    {"soft_step", Solver::soft_step, Precision::double_, kRows},
    {"soft_step, float", Solver::soft_step, Precision::float_, 1e-4},
    {"pgs", Solver::pgs, Precision::double_, kRows},
    {"pgs, float", Solver::pgs, Precision::float_, 1e-4},
};

// A ball of radius 0.1 m strikes the floor at (3, -4) m/s, turning at `spin`.
void spin_bounce(CaseBench& bench,
                 const ImpactSolver& by,
                 const char* name,
                 double friction,
                 double spin,
                 const Vec3& wanted)
{
    SceneParts parts = without_gravity(bench, ImpactLaw::sequential);
    parts.scene().settings.solver = by.solver;
    parts.scene().settings.precision = by.precision;
    const std::uint32_t material = parts.material(friction, 0.8);
    parts.plane(material, Vec3::UnitZ(), 0);
    const std::uint32_t ball = parts.ball(material, 1, 0.1, Vec3(0, 0, 0.1));
    parts.body(ball).velocity = Vec3(3, 0, -4);
    parts.body(ball).angular_velocity = Vec3(0, -spin, 0);  // counter-clockwise seen from -y
    const End end = end_of(bench, parts.scene(), 0.001);
    const Vec3 got(end.velocity.back().x(), end.velocity.back().z(), -end.spin.back().y());
    bench.report(std::string(name) + ", " + by.name, "error of velocity and spin",
                 (got - wanted).norm(), by.bound, "1");
}

}  // namespace

void case_spin_bounce(CaseBench& bench)
{
    const double grips = 15.0 / 7, fast = 27.0 / 7;
    for (const ImpactSolver& by : kImpactSolvers) {
        spin_bounce(bench, by, "(c) mu 0.2, no spin", 0.2, 0, Vec3(grips, 3.2, -grips / 0.1));
        spin_bounce(bench, by, "(c) mu 0.2, spin -60", 0.2, -60, Vec3(fast, 3.2, -fast / 0.1));
        spin_bounce(bench, by, "(c) mu 0.05, no spin", 0.05, 0, Vec3(2.64, 3.2, -9));
    }
    bounces(bench);
}

void case_cradle(CaseBench& bench)
{
    cradle(bench, "sequential", ImpactLaw::sequential);
    cradle(bench, "simultaneous", ImpactLaw::simultaneous);
    symmetric_drop(bench);
}

void case_break(CaseBench& bench)
{
    const End end = end_of(bench, billiards(bench, false), 0.01);
    const End other = end_of(bench, billiards(bench, true), 0.01);
    double order = 0, asymmetry = 0;
    for (std::size_t i = 0; i < 16; ++i)
        order = std::max(order, (end.velocity[i] - other.velocity[15 - i]).norm());
    for (std::size_t row = 0, first = 0; row < 5; first += ++row)
        for (std::size_t i = 0; i <= row; ++i)
            asymmetry = std::max(
                asymmetry,
                (end.velocity[first + i] - mirrored(end.velocity[first + row - i])).norm());
    const char* const name = "15 balls, simultaneous";
    bench.report(name, "error of the momentum", (end.momentum - Vec3(0.85, 0, 0)).norm(), kExact,
                 "N s");
    bench.report(name, "error of the energy", std::abs(end.energy - 2.125), kExact, "J");
    bench.report(name, "difference of the mirror images", asymmetry, 1e-10, "m/s");
    bench.report(name, "difference by the order of bodies", order, kExact, "m/s");
}

void case_struck_rod(CaseBench& bench)
{
    // A slender rod of 2 m as a thin box with a rod's inertia, struck at its end.
    SceneParts parts = without_gravity(bench, ImpactLaw::sequential);
    const std::uint32_t material = parts.material(0, 0.7);
    const std::uint32_t rod =
        parts.box(material, 3, Vec3(1, 0.01, 0.01), {Vec3::Zero(), Quat::Identity()});
    parts.body(rod).inertia = Sym3{1, 1, 1, 0, 0, 0};
    const double radius = 0.1;
    const std::uint32_t ball = parts.ball(material, 1, radius, Vec3(1, 0, 0.01 + radius));
    parts.body(ball).velocity = Vec3(0, 0, -10);
    const End end = end_of(bench, parts.scene(), 0.001);
    const char* const name = "ball of 1 kg on the end of a rod, direct";
    const double impulse = 1.7 * 10 / (1 + 1.0 / 3 + 1);
    bench.report(name, "error of the ball's velocity",
                 (end.velocity[1] - Vec3(0, 0, impulse - 10)).norm(), kExact, "m/s");
    bench.report(name, "error of the rod's velocity",
                 (end.velocity[0] - Vec3(0, 0, -impulse / 3)).norm(), kExact, "m/s");
    bench.report(name, "error of the rod's spin", (end.spin[0] - Vec3(0, impulse, 0)).norm(),
                 kExact, "rad/s");
    bench.report(name, "error of the momentum", (end.momentum - Vec3(0, 0, -10)).norm(), kExact,
                 "N s");
    motion_without_friction(bench);
}

}  // namespace throng
