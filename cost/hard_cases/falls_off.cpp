// Falls off: H108, who is heavy and rolls off what is light makes no energy, on it and beside it.
//
// The light ball is overloaded until the heavy one leaves it, so that the solver goes from finer
// substeps to the usual ones while somebody falls.
#include "cost/hard_cases/hard_cases.hpp"
#include "scene/catalog/parts.hpp"
#include "throng/energy_ledger.hpp"
#include "throng/rotation.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace throng {

namespace {

constexpr double kLight = 1;  // kg

struct How {
    const char* setting;
    double bound = 0.01;
    void (*set)(Settings&) = [](Settings&) {};
    Pose place = {};
    bool heavy_first = false;
};

// Energy made, over what the heavy ball has to fall.
double gained(CaseBench& bench, const How& how, double ratio, double radius, double aside)
{
    SceneParts parts(bench.scene());
    Scene& scene = parts.scene();
    how.set(scene.settings);
    scene.gravity = how.place.orientation * Vec3(0, 0, -kGravity);
    const std::uint32_t material = parts.material(0.3);
    parts.hold(parts.box(material, 1, Vec3(1, 1, 0.1),
                         how.place * Pose{Vec3(0, 0, -0.1), Quat::Identity()}));
    const Vec3 of_light = how.place * Vec3(0, 0, radius);
    const double up = 2 * radius * std::sqrt(1 - aside * aside / 4);
    const Vec3 of_heavy = how.place * Vec3(aside * radius, 0, radius + up);
    if (how.heavy_first) parts.ball(material, ratio * kLight, radius, of_heavy);
    parts.ball(material, kLight, radius, of_light);
    if (!how.heavy_first) parts.ball(material, ratio * kLight, radius, of_heavy);

    EnergyLedger ledger;
    bench.run(
        scene, 2, [](World&, double) { return true; }, &ledger);
    return ledger.gained() / (ratio * kLight * kGravity * 2 * radius);
}

}  // namespace

void case_falls_off(CaseBench& bench)
{
    const Pose turned{Vec3(70, -30, 5), exponential(Vec3(0.3, -0.5, 0.7))};
    const How hows[] = {
        {"default"},
        {"default, dt 1/240", 0.01, [](Settings& s) { s.dt = 1.0 / 240; }},
        {"default, dt 1e-3", 0.01, [](Settings& s) { s.dt = 1e-3; }},
        {"1 substep", 0.03, [](Settings& s) { s.substeps = 1; }},
        {"16 substeps", 0.03, [](Settings& s) { s.substeps = 16; }},
        {"pgs", 0.01, [](Settings& s) { s.solver = Solver::pgs; }},
        {"direct, double", 0.03, ask_exactly},
        {"rk4", 0.01, [](Settings& s) { s.integrator = Integrator::rk4; }},
        {"default, turned, far off", 0.01, [](Settings&) {}, turned},
        {"default, the heavy one created first", 0.01, [](Settings&) {}, {}, true},
    };
    for (const How& how : hows) {
        double worst = 0;
        for (const double ratio : {1.0, 10.0, 100.0, 1000.0})
            for (const double radius : {0.01, 0.1})
                for (const double aside : {0.02, 0.2}) {
                    if (bench.brief() && (ratio != 10 || aside != 0.2)) continue;
                    worst = std::max(worst, gained(bench, how, ratio, radius, aside));
                }
        bench.report(how.setting, "energy gained over what there is to fall", worst, how.bound,
                     "1");
    }
}

}  // namespace throng
