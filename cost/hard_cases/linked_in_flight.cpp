// Linked in flight: H125, boxes that springs join end to end, thrown tumbling, at any speed.
//
// Answer: their center of mass goes on as it was thrown, and they have among them what they began
// with, less what their impacts take: the same whether they fly past or tumble on the spot.
//
// The ends that springs hold together hit one another in every step, and who goes further in a step
// than he is thick is held where he hits: by those that fly with him, not by the world.
#include "cost/hard_cases/hard_cases.hpp"
#include "scene/catalog/parts.hpp"
#include "throng/energy_ledger.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <iterator>
#include <span>
#include <string>

namespace throng {

namespace {

constexpr double kTime = 5, kBriefTime = 1;             // s
constexpr double kThick = 0.02, kLong = 0.045;          // m, half
constexpr double kGap = 1e-3, kMass = 0.1, kSpin = 30;  // m, kg, rad/s at most
constexpr double kMade = 0.01;                          // of what they have among them
constexpr double kSlowed = 1e-3, kRounded = 1e-4;       // m/s; of their speed

struct How {
    const char* setting;
    void (*set)(Settings&) = [](Settings&) {};
    Pose place = {};
};

Scene thrown(const CaseBench& bench, const How& how, int links, double stiffness, const Vec3& speed)
{
    SceneParts parts(bench.scene());
    Scene& scene = parts.scene();
    how.set(scene.settings);
    scene.gravity = Vec3::Zero();
    const std::uint32_t smooth = parts.material(0);
    Random random(3);
    for (int i = 0; i < links; ++i) {
        const Pose at{Vec3(0, 0, 2 * (kLong + kGap / 2) * i), Quat::Identity()};
        const std::uint32_t link =
            parts.box(smooth, kMass, Vec3(kThick, kThick, kLong), how.place * at);
        parts.body(link).velocity = how.place.orientation * speed;
        parts.body(link).angular_velocity = random_vector(random, -kSpin, kSpin);
        if (i == 0) continue;
        Spring spring;
        spring.a = link - 1;
        spring.b = link;
        spring.at_a = Vec3(0, 0, kLong + kGap / 2);
        spring.at_b = -spring.at_a;
        spring.stiffness = stiffness;
        scene.springs.push_back(spring);
    }
    return scene;
}

// m/s.
Vec3 velocity_of_all(const World& world)
{
    Vec3 sum = Vec3::Zero();
    for (const BodyId body : world.bodies()) sum += world.velocity(body);
    return sum / static_cast<double>(world.bodies().size());
}

void throw_at(CaseBench& bench, const How& how, double speed)
{
    double made = 0, slowed = 0;
    for (const int links : {2, 3, 6})
        for (const double stiffness : {2e3, 2e4, 1e6}) {
            const Vec3 velocity(speed, 0, 0);
            const Scene scene = thrown(bench, how, links, stiffness, velocity);
            const double together = links * kMass * speed * speed / 2;
            EnergyLedger ledger;
            Vec3 last = Vec3::Zero();
            double among_them = 0;
            bench.run(
                scene, bench.brief() ? kBriefTime : kTime,
                [&](World& world, double) {
                    last = velocity_of_all(world);
                    among_them = std::max(among_them, world.measure().kinetic_energy - together);
                    return true;
                },
                &ledger);
            made = std::max(made, ledger.gained() / among_them);
            slowed = std::max(slowed, (last - how.place.orientation * velocity).norm());
        }
    const std::string at = "at " + std::to_string(static_cast<int>(speed)) + " m/s: ";
    bench.report(how.setting, at + "energy made, over what they have among them", made, kMade, "1");
    bench.report(how.setting, at + "change of their common velocity", slowed,
                 kSlowed + kRounded * speed, "m/s");
}

}  // namespace

void case_linked_in_flight(CaseBench& bench)
{
    const How hows[] = {
        {"default"},
        {"default, turned, far off",
         [](Settings&) {},
         {Vec3(700, -300, 100), turn(Vec3(0.6, 0, 0.8), 0.7)}},
        {"dt 1/240", [](Settings& s) { s.dt = 1.0 / 240; }},
        {"dt 1e-3", [](Settings& s) { s.dt = 1e-3; }},
        {"16 substeps", [](Settings& s) { s.substeps = 16; }},
        {"1 substep", [](Settings& s) { s.substeps = 1; }},
        {"pgs", [](Settings& s) { s.solver = Solver::pgs; }},
        {"direct", [](Settings& s) { s.solver = Solver::direct; }},
        {"double", [](Settings& s) { s.precision = Precision::double_; }},
    };
    for (const How& how : std::span(hows).first(bench.brief() ? 1 : std::size(hows)))
        for (const double speed : {0.0, 20.0, 50.0}) throw_at(bench, how, speed);
}

}  // namespace throng
