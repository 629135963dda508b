// Leaning discs: H121, cans and coins that fall on one another make no energy and sink into none.
//
// Answer: no energy is made, and what lies is no deeper in what bears it than what it weighs makes
// it.
//
// A disc that comes down beside the middle of another leans with its flat side on that one's rim,
// and with its own rim on the floor. Both places run far as it rocks about the line between them:
// told as the step found them they lag behind, and feed the rocking.
#include "cost/hard_cases/hard_cases.hpp"
#include "scene/catalog/parts.hpp"
#include "throng/rotation.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <string>

namespace throng {

namespace {

constexpr double kSeconds = 10, kBriefSeconds = 3;
constexpr double kSmall = 0.012, kGreat = 0.2;  // m, radii
// Over the greatest in motion; of the thickness. A coin falls by more than its thickness in a step.
constexpr double kMade = 2e-2, kMadeByCoins = 6e-2, kSinks = 0.25;

struct How {
    const char* setting;
    void (*set)(Settings&) = [](Settings&) {};
    Pose place = {};
    bool on_box = false;
    int draws = 4;
};

struct Leans {
    double made = 0, deep = 0;  // over the greatest in motion; over the thickness
};

// One disc to three lie side by side, and as many fall on them, each turned by up to a fifth of a
// radian.
Scene strewn(const CaseBench& bench, double radius, double aspect, const How& how, int draw)
{
    SceneParts parts(bench.scene());
    how.set(parts.scene().settings);
    parts.scene().settings.sleep = false;
    parts.scene().gravity = how.place.orientation * Vec3(0, 0, -kGravity);
    Random random(static_cast<std::uint64_t>(draw));
    const double half = aspect * radius, mass = 1000 * kPi * radius * radius * 2 * half;
    const std::uint32_t material = parts.material(0.3);
    const Vec3 up = how.place.orientation * Vec3::UnitZ();
    if (how.on_box)
        parts.hold(parts.box(material, 1, Vec3(20, 20, 1) * radius,
                             how.place * Pose{-Vec3::UnitZ() * radius, Quat::Identity()}));
    else
        parts.plane(material, up, up.dot(how.place.position));
    const auto put = [&](const Vec3& at, const Quat& turn) {
        parts.cylinder(material, mass, radius, half, how.place * Pose{at, turn});
    };
    const int under = 1 + draw % 3;
    const auto along = [&](int k) -> Vec3 { return Vec3::UnitX() * (2.02 * radius * k); };
    for (int k = 0; k < under; ++k) put(along(k) + Vec3::UnitZ() * half, Quat::Identity());
    for (int k = 0; k < under; ++k) {
        const double aside = random.uniform(-1.5, 1.5), before = random.uniform(-1.3, 1.3);
        const Vec3 at(aside * radius, before * radius,
                      3.1 * half + random.uniform(0.3, 0.7) * radius);
        const Vec3 lean(random.uniform(-0.14, 0.14), random.uniform(-0.14, 0.14), 0);
        put(along(k) + at, exponential(lean));
    }
    return parts.scene();
}

Leans lean(CaseBench& bench, double radius, double aspect, const How& how, int draw)
{
    Leans leans;
    const double seconds = bench.brief() ? kBriefSeconds : kSeconds;
    leans.made = energy_made(
        bench, strewn(bench, radius, aspect, how, draw), seconds, [&](World& world, double now) {
            if (now < seconds - 0.1) return;
            leans.deep =
                std::max(leans.deep, world.measure().greatest_overlap / (2 * aspect * radius));
        });
    return leans;
}

// Of discs of every thickness, so many draws of each.
Leans worst_of(CaseBench& bench, double radius, const How& how)
{
    Leans worst;
    for (const double aspect : {0.05, 0.1, 0.3, 1.0}) {
        if (bench.brief() && aspect != 0.1) continue;
        for (int draw = 1; draw <= (bench.brief() ? 2 : how.draws); ++draw) {
            const Leans leans = lean(bench, radius, aspect, how, draw);
            worst.made = std::max(worst.made, leans.made);
            worst.deep = std::max(worst.deep, leans.deep);
        }
    }
    return worst;
}

}  // namespace

void case_leaning_discs(CaseBench& bench)
{
    const How hows[] = {
        {"default"},
        {"dt 1/240", [](Settings& s) { s.dt = 1.0 / 240; }},
        {"default, dt 1e-3", [](Settings& s) { s.dt = 1e-3; }, {}, false, 2},
        {"default, turned, far off",
         [](Settings&) {},
         {Vec3(70, -30, 0), exponential(Vec3(0.3, 0.6, 0.9))}},
        {"default, on a box", [](Settings&) {}, {}, true},
        {"double", [](Settings& s) { s.precision = Precision::double_; }},
        {"16 substeps", [](Settings& s) { s.substeps = 16; }},
        {"1 substep", [](Settings& s) { s.substeps = 1; }},
        {"pgs", [](Settings& s) { s.solver = Solver::pgs; }},
        {"direct", [](Settings& s) { s.solver = Solver::direct; }},
    };
    for (const How& how : std::span(hows).first(bench.brief() ? 1 : std::size(hows)))
        for (const double radius : {kSmall, kGreat}) {
            const Leans worst = worst_of(bench, radius, how);
            // What slaps down may miss the law in a step.
            bench.forgive_residual();
            const bool coins = radius == kSmall;
            const std::string of = coins ? "coins: " : "discs: ";
            bench.report(how.setting, of + "energy made, over the greatest in motion", worst.made,
                         coins ? kMadeByCoins : kMade, "1");
            bench.report_default(how.setting, of + "overlap, over the thickness", worst.deep,
                                 kSinks, "1", coins ? "dt 1/240" : "");
        }
}

}  // namespace throng
