// Slid rods: H21, where rigid bodies with friction have no answer or many, and ends that strike in
// turn.
//
// A slender rod whose tip is slid ahead of it along a rough floor, at an angle t to the floor, has
// no acceleration that keeps Coulomb's law, or many, where mu > (1 + 3 cos^2 t) / (3 sin t cos t):
// from 4/3, at 63.4 degrees. Impulses have an answer on either side of that: the tip catches.
//
// Source: Painleve 1895; Stewart, "Rigid-body dynamics with friction and impact", 2000.
#include "cost/hard_cases/hard_cases.hpp"
#include "throng/energy_ledger.hpp"
#include "throng/rotation.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

constexpr double kSlop = 1e-6;  // m

// A rod of 1 kg with pointed ends, along x before it is turned.
std::uint32_t add_rod(SceneParts& parts, std::uint32_t material, double length, const Pose& pose)
{
    const double thin = 0.01 * length;
    HullShape shape;
    for (const double side : {-1.0, 1.0}) {
        shape.points.emplace_back(side * length / 2, 0, 0);
        shape.points.emplace_back(0, side * thin, 0);
        shape.points.emplace_back(0, 0, side * thin);
    }
    const std::uint32_t rod = parts.hull(material, 1, std::move(shape), pose);
    const double inertia = length * length / 12;
    parts.body(rod).inertia = Sym3{1e-3 * inertia, inertia, inertia, 0, 0, 0};
    return rod;
}

struct Watched {
    double not_finite = 0;
    double step_gain = 0;  // J, the most that energy grew from one step to the next
    double gain = 0;       // J, the most that it rose, told by the ledger
    double overlap = 0;    // m
    double first = 0;      // J, energy at the start, of motion and height
    double speed = 0, force = 0;
};

Watched watch(CaseBench& bench, const Scene& scene, double time)
{
    Watched seen;
    double last = 0;
    bench.inspect(scene, [&](const World& world) {
        const Measures measures = world.measure();
        last = seen.first = measures.kinetic_energy + measures.potential_energy;
    });
    EnergyLedger ledger;
    const auto look = [&](World& world, double) {
        const Measures measures = world.measure();
        const double energy = measures.kinetic_energy + measures.potential_energy;
        if (!std::isfinite(energy)) seen.not_finite = 1;
        seen.step_gain = std::max(seen.step_gain, energy - last);
        last = energy;
        seen.overlap = std::max(seen.overlap, measures.greatest_overlap);
        seen.speed = world.velocity(world.bodies().back()).norm();
        seen.force = -world.contact_force(world.bodies().front()).z();
        return seen.not_finite == 0;
    };
    bench.run(scene, time, look, &ledger);
    seen.gain = ledger.gained();
    return seen;
}

// At 63.4 degrees to the floor, its tip ahead, at 1 m/s.
Scene slid_rod(const CaseBench& bench, double friction)
{
    const double angle = 63.4 * kPi / 180, length = 2;
    SceneParts parts(bench.scene());
    const std::uint32_t material = parts.material(friction);
    parts.plane(material, Vec3::UnitZ(), 0);
    const Vec3 center(-length / 2 * std::cos(angle), 0, length / 2 * std::sin(angle));
    const std::uint32_t rod =
        add_rod(parts, material, length, {center, exponential(Vec3(0, angle, 0))});
    parts.body(rod).velocity = Vec3(1, 0, 0);
    parts.scene().settings.sleep = false;
    return parts.scene();
}

// Dropped from a tenth of a metre at 5 degrees.
Scene dropped_rod(const CaseBench& bench, double restitution)
{
    const double angle = 5 * kPi / 180;
    const Vec3 half(0.5, 0.01, 0.01);
    SceneParts parts(bench.scene());
    const std::uint32_t material = parts.material(0.3, restitution);
    parts.plane(material, Vec3::UnitZ(), 0);
    const Vec3 center(0, 0, 0.1 + half.x() * std::sin(angle) + half.z() * std::cos(angle));
    parts.box(material, 1, half, {center, exponential(Vec3(0, angle, 0))});
    parts.scene().settings.sleep = false;
    return parts.scene();
}

// Who stays on the floor has a velocity of the moment; that of who bounces is half a substep
// behind, and beside the place of the moment it would seem to win g h v: of such the ledger tells.
void follow(
    CaseBench& bench, const std::string& name, Scene scene, double time, double Watched::*gain)
{
    const Watched soft = watch(bench, scene, time);
    const bool in_steps = gain == &Watched::step_gain;
    const char *const grows = in_steps ? "growth of energy in a step over the first"
                                       : "growth of energy over the first",
                      *const sinks = "greatest overlap";
    const std::string usual = name + ", default", met_by = "solver=direct, dt 1e-3";
    bench.report_default(usual, grows, soft.*gain / soft.first, 1e-9, "1", met_by);
    bench.report_default(usual, sinks, soft.overlap, kSlop, "m", met_by);
    ask_exactly(scene.settings);
    scene.settings.dt = 1e-3;
    const Watched exact = watch(bench, scene, time);
    const std::string direct = name + ", direct, dt 1e-3";
    bench.report(direct, "states that are not finite", exact.not_finite, 0, "1");
    bench.report(direct, grows, exact.*gain / exact.first, 1e-9, "1");
    bench.report(direct, sinks, exact.overlap, kSlop, "m");
    bench.report(direct, "speed at the end", exact.speed, 1e-6, "m/s");
    bench.report(direct, "error of the force on the floor at the end",
                 std::abs(exact.force / kGravity - 1), 1e-6, "1");
}

}  // namespace

void case_painleve(CaseBench& bench)
{
    for (const double friction : {1.2, 1.5, 3.0})
        follow(bench, "rod slid at 63.4 degrees, mu " + std::to_string(friction).substr(0, 3),
               slid_rod(bench, friction), 4, &Watched::step_gain);
    for (const double restitution : {0.0, 0.5, 0.9})
        follow(bench,
               "rod dropped at 5 degrees, restitution " + std::to_string(restitution).substr(0, 3),
               dropped_rod(bench, restitution), 4, &Watched::gain);
}

}  // namespace throng
