// Pressed balls: H112, balls that springs press upon one another and that bounce win nothing by it.
//
// Answer: springs give back what they take, and contacts take energy of motion or keep it.
//
// What springs draw together harder than a step can follow rests, however lively its material: who
// is thrown back from where he is in each substep, and drawn on in it, is thrown ever faster.
#include "cost/hard_cases/hard_cases.hpp"
#include "throng/energy_ledger.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <string>

namespace throng {

namespace {

constexpr double kRadius = 0.1, kMass = 4.2;                 // m, kg
constexpr double kApart = 2.03 * kRadius, kPressed = 0.15;   // m; share of a diameter
constexpr double kFrequencies[] = {1, 5, 15, 50, 150, 500};  // rad/s, of two balls on a spring

constexpr double kBound = 1e-3;

constexpr char kMetBy[] = "solver=soft_step; direct in double";

struct How {
    const char* setting;
    void (*set)(Settings&) = [](Settings&) {};
    const char* met_by = "";
    Quat turn = Quat::Identity();
    bool last_first = false;
};

// Over what the springs hold at the beginning.
double made(CaseBench& bench, const How& how, int balls, double frequency, double restitution)
{
    SceneParts parts(bench.scene());
    Scene& scene = parts.scene();
    how.set(scene.settings);
    scene.settings.sleep = false;
    scene.gravity = Vec3::Zero();
    const std::uint32_t material = parts.material(0.5, restitution);
    const double stiffness = kMass / 2 * frequency * frequency;
    const double length = 2 * kRadius * (1 - kPressed);
    for (int i = 0; i < balls; ++i) {
        const int at = how.last_first ? balls - 1 - i : i;
        const std::uint32_t ball =
            parts.ball(material, kMass, kRadius, how.turn * Vec3(kApart * at, 0, 0));
        parts.body(ball).velocity = how.turn * Vec3(at % 2 == 0 ? 0 : 0.1, 0, 0);
    }
    for (std::uint32_t i = 0; i + 1 < static_cast<std::uint32_t>(balls); ++i) {
        Spring spring;
        spring.a = i;
        spring.b = i + 1;
        spring.stiffness = stiffness;
        spring.length = length;
        scene.springs.push_back(spring);
    }
    EnergyLedger ledger;
    bench.run(
        scene, 10, [](World&, double) { return true; }, &ledger);
    bench.forgive_residual();
    const double stretch = kApart - length;
    return ledger.gained() / ((balls - 1) * stiffness * stretch * stretch / 2);
}

}  // namespace

void case_pressed_balls(CaseBench& bench)
{
    const How hows[] = {
        {"default"},
        {"default, dt 1/240", [](Settings& s) { s.dt = 1.0 / 240; }},
        {"default, dt 1e-3", [](Settings& s) { s.dt = 1e-3; }},
        {"1 substep", [](Settings& s) { s.substeps = 1; }},
        {"16 substeps", [](Settings& s) { s.substeps = 16; }},
        {"pgs", [](Settings& s) { s.solver = Solver::pgs; }, kMetBy},
        {"direct", [](Settings& s) { s.solver = Solver::direct; }, kMetBy},
        {"direct, double", ask_exactly},
        {"default, turned", [](Settings&) {}, "", Quat(0.8, 0.2, -0.4, 0.4).normalized()},
        {"default, last first", [](Settings&) {}, "", Quat::Identity(), true},
    };
    for (const How& how : hows) {
        for (const int balls : {2, 3, 6}) {
            double most = 0;
            for (const double frequency : kFrequencies)
                for (const double restitution : {1.0, 0.5})
                    most = std::max(most, made(bench, how, balls, frequency, restitution));
            const std::string quantity =
                std::to_string(balls) + " balls: energy made, over that of the springs";
            bench.report_default(how.setting, quantity, most, kBound, "1", how.met_by);
        }
        if (bench.brief()) return;
    }
}

}  // namespace throng
