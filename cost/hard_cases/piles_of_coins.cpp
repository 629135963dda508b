// Piles of coins: H122, what is stacked high beside its thickness, and many light ones that bear
// somebody heavy together, stand.
//
// Answer: where they were built, but for what their load makes them give.
//
// In a step of 1/60 s a coin falls by more than its thickness, so that a pile has to bear itself
// within a few substeps: one of ten coins sinks into itself by the usual ones. A plate on a hundred
// balls is borne by each a little, and they take many iterations to share what lies on it.
#include "cost/hard_cases/hard_cases.hpp"
#include "throng/rotation.hpp"

#include <iterator>
#include <span>
#include <string>
#include <vector>

namespace throng {

namespace {

constexpr double kSeconds = 5, kBriefSeconds = 2;
constexpr double kRadius = 0.012, kHalf = 0.001, kMass = 7.2e-3;  // m, kg, of a coin
constexpr double kBall = 0.05, kHeavyBall = 0.4;                  // m, radii
constexpr double kRests = 1e-3, kMoved = 0.25, kDeep = 0.1;       // m/s; of the thickness

struct How {
    const char* setting;
    void (*set)(Settings&) = [](Settings&) {};
    Pose place = {};
};

//   thickness  m, of what is stacked
//   stays      where it was built
//   met_by     what holds it where the default does not; else empty
struct Built {
    const char* name;
    Scene scene;
    double thickness;
    bool stays = true;
    const char* met_by = "";
};

SceneParts on_floor(const CaseBench& bench, const How& how)
{
    SceneParts parts(bench.scene());
    how.set(parts.scene().settings);
    parts.scene().settings.sleep = false;
    parts.level_ground(parts.material(0.3), how.place);
    return parts;
}

Scene piles(const CaseBench& bench, const How& how, int across, int high)
{
    SceneParts parts = on_floor(bench, how);
    for (int i = 0; i < across * across; ++i)
        for (int k = 0; k < high; ++k) {
            const Vec3 at(0.1 * (i % across), 0.1 * (i / across), kHalf * (2 * k + 1));
            parts.cylinder(0, kMass, kRadius, kHalf, how.place * Pose{at, Quat::Identity()});
        }
    return parts.scene();
}

// 1 t on 58 kg on 100 times half a kilogram.
Scene on_balls(const CaseBench& bench, const How& how)
{
    SceneParts parts = on_floor(bench, how);
    for (int i = 0; i < 100; ++i)
        parts.ball(0, 0.5, kBall,
                   how.place * Vec3(2 * kBall * (i % 10), 2 * kBall * (i / 10), kBall));
    const Vec3 top(9 * kBall, 9 * kBall, 2 * kBall);
    const Vec3 middle = top + Vec3::UnitZ() * 0.02;
    parts.box(0, 58, Vec3(0.6, 0.6, 0.02), how.place * Pose{middle, Quat::Identity()});
    const double up = 0.04 + kHeavyBall + 0.5;
    parts.ball(0, 1000, kHeavyBall, how.place * Vec3(top + Vec3::UnitZ() * up));
    return parts.scene();
}

}  // namespace

void case_piles_of_coins(CaseBench& bench)
{
    const How hows[] = {
        {"default"},
        {"dt 1/240", [](Settings& s) { s.dt = 1.0 / 240; }},
        {"default, turned, far off",
         [](Settings&) {},
         {Vec3(7, -3, 0), exponential(Vec3(0.3, 0.6, 0.9))}},
        {"double", [](Settings& s) { s.precision = Precision::double_; }},
        {"16 substeps", [](Settings& s) { s.substeps = 16; }},
    };
    const double seconds = bench.brief() ? kBriefSeconds : kSeconds;
    for (const How& how : std::span(hows).first(bench.brief() ? 1 : std::size(hows))) {
        std::vector<Built> all;
        const double thick = 2 * kHalf;
        all.push_back({"a pile of 10 coins", piles(bench, how, 1, 10), thick});
        all.push_back({"1 t on a plate on 100 balls", on_balls(bench, how), 2 * kBall, false});
        if (!bench.brief()) {
            all.push_back({"9 piles of 30 coins", piles(bench, how, 3, 30), thick});
            // More than a step's budget of finer substeps holds, so that they sway and tremble.
            all.push_back(
                {"a pile of 100 coins", piles(bench, how, 1, 100), thick, true, "dt 1/240"});
            all.push_back(
                {"100 piles of 15 coins", piles(bench, how, 10, 15), thick, true, "dt 1/240"});
        }
        for (const Built& built : all) {
            const Stands stands = stand_for(bench, built.scene, seconds);
            bench.forgive_residual();
            const std::string of = std::string(built.name) + ": ";
            bench.report_default(how.setting, of + "fastest", stands.speed, kRests, "m/s",
                                 built.met_by);
            bench.report(how.setting, of + "overlap, over the thickness",
                         stands.deep / built.thickness, kDeep, "1");
            if (built.stays)
                bench.report_default(how.setting, of + "moved, over the thickness",
                                     stands.moved / built.thickness, kMoved, "1", built.met_by);
        }
    }
}

}  // namespace throng
