// Dragged bounces: H107, what air brakes makes no energy as it bounces, and rises as high as it
// can.
//
// Answer: who falls at its terminal speed v = g / k, k being its drag over its mass, and bounces
// off nothing lost, rises by v^2 / g (1 - ln 2), the drag being linear.
#include "cost/hard_cases/hard_cases.hpp"
#include "scene/catalog/parts.hpp"
#include "throng/energy_ledger.hpp"
#include "throng/rotation.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace throng {

namespace {

constexpr double kHalf = 0.04;      // m, of its shape
constexpr double kSpinDrag = 0.01;  // kg m2/s

struct How {
    const char* setting;
    void (*set)(Settings&) = [](Settings&) {};
    Pose place = {};
};

struct Bounce {
    double gained = 0;  // of the greatest kinetic energy
    double off = 0;     // of its rise, over a step's way at terminal speed
};

// It meets the floor in the fourth step, when `early` of that has gone by.
Bounce bounce(CaseBench& bench, const How& how, bool is_ball, double rate, double early)
{
    SceneParts parts(bench.scene());
    Scene& scene = parts.scene();
    how.set(scene.settings);
    scene.gravity = how.place.orientation * Vec3(0, 0, -kGravity);
    const std::uint32_t material = parts.material(0.5);
    scene.materials[material].restitution = 1;
    parts.hold(parts.box(material, 1, Vec3(1, 1, 0.1),
                         how.place * Pose{Vec3(0, 0, -0.1), Quat::Identity()}));
    const double terminal = kGravity / rate;
    const double above = terminal * scene.settings.dt * (3 + early);
    const Pose at = how.place * Pose{Vec3(0, 0, kHalf + above), Quat::Identity()};
    const auto body = is_ball ? parts.ball(material, 1, kHalf, at.position)
                              : parts.box(material, 1, Vec3(kHalf, kHalf, kHalf), at);
    parts.body(body).linear_drag = rate;
    parts.body(body).angular_drag = kSpinDrag;
    parts.body(body).velocity = how.place.orientation * Vec3(0, 0, -terminal);

    double rise = 0;  // m, at most, over where it lies
    EnergyLedger ledger;
    bool has_bounced = false;
    bench.run(
        scene, 4 * scene.settings.dt + 2 / rate,
        [&](World& world, double) {
            const BodyId id = world.bodies().back();
            const double up = (how.place.orientation.conjugate() * world.velocity(id)).z();
            has_bounced = has_bounced || up > 0;
            if (has_bounced)
                rise = std::max(rise, how.place.to_local(world.pose(id).position).z() - kHalf);
            return true;
        },
        &ledger);
    const double wanted = terminal * terminal / kGravity * (1 - std::numbers::ln2);
    return {ledger.gained() / ledger.greatest_kinetic(),
            std::abs(rise - wanted) / (terminal * scene.settings.dt)};
}

}  // namespace

void case_dragged_bounces(CaseBench& bench)
{
    const How hows[] = {
        {"default"},
        {"default, dt 1/240", [](Settings& s) { s.dt = 1.0 / 240; }},
        {"default, dt 1e-3", [](Settings& s) { s.dt = 1e-3; }},
        {"1 substep", [](Settings& s) { s.substeps = 1; }},
        {"16 substeps", [](Settings& s) { s.substeps = 16; }},
        {"pgs", [](Settings& s) { s.solver = Solver::pgs; }},
        {"direct, double", ask_exactly},
        {"semi_implicit", [](Settings& s) { s.integrator = Integrator::semi_implicit; }},
        {"default, turned, far off",
         [](Settings&) {},
         {Vec3(700, -300, 50), exponential(Vec3(0.3, -0.5, 0.7))}},
    };
    for (const How& how : hows)
        for (const bool is_ball : {true, false}) {
            Bounce worst;
            for (const double rate : {1.0, 5.0, 25.0})
                for (const double early : {0.1, 0.35, 0.6, 0.85}) {
                    if (bench.brief() && early != 0.35) continue;
                    const Bounce seen = bounce(bench, how, is_ball, rate, early);
                    worst.gained = std::max(worst.gained, seen.gained);
                    worst.off = std::max(worst.off, seen.off);
                }
            const std::string setting =
                std::string(how.setting) + (is_ball ? ", a ball" : ", a cube");
            bench.report(setting, "energy gained over the greatest kinetic energy", worst.gained,
                         1e-3, "1");
            bench.report(setting, "error of the rise, over a step's way at terminal speed",
                         worst.off, 1.25, "1");
        }
}

}  // namespace throng
