// Heavy on a crowd: H124, somebody heavy falls into a pit of hundreds of light ones.
//
// Answer: none; the crowd bears him or gives way to him, and nobody makes energy.
//
// All that he weighs goes on through a few of those under him, each thousands of times as light. By
// the usual substeps they are pressed into one another, come out beside him, and go on boiling.
#include "cost/hard_cases/hard_cases.hpp"
#include "scene/catalog/random.hpp"
#include "throng/rotation.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <iterator>
#include <span>
#include <string>

namespace throng {

namespace {

constexpr double kSeconds = 10, kBriefSeconds = 3;
constexpr double kLight = 0.05, kLightMass = 0.02;  // m, radius or half an edge; kg
constexpr double kMade = 5e-3, kDeep = 0.25;        // of the greatest in motion; of the extent

struct How {
    const char* setting;
    void (*set)(Settings&) = [](Settings&) {};
    Pose place = {};
    const char* met_by = "";  // what holds what it does not; else empty
};

//   across, layers  of light ones
//   mass, size      kg; m, radius or half an edge, of the heavy one
struct Pit {
    const char* name;
    int across = 10, layers = 8;
    double mass = 60, size = 0.25, speed = 0;
    bool of_boxes = false, cube = false;
    double restitution = 0;
    bool always = false;  // by all settings, not by the default alone
    const char* met_by = "";
};

Scene filled(const CaseBench& bench, const Pit& pit, const How& how)
{
    SceneParts parts(bench.scene());
    how.set(parts.scene().settings);
    const std::uint32_t material = parts.material(0.5, pit.restitution);
    parts.level_ground(material, how.place);
    const double wide = 0.07 * pit.across + 0.1;
    const auto at = [&](const Vec3& where) { return how.place * Pose{where, Quat::Identity()}; };
    for (const double side : {-1.0, 1.0}) {
        parts.hold(parts.box(material, 1, Vec3(0.05, wide + 0.1, 1), at(Vec3(side * wide, 0, 1))));
        parts.hold(parts.box(material, 1, Vec3(wide + 0.1, 0.05, 1), at(Vec3(0, side * wide, 1))));
    }
    Random random(7);
    for (int k = 0; k < pit.layers; ++k)
        for (int i = 0; i < pit.across * pit.across; ++i) {
            const double aside = random.uniform(-0.01, 0.01), before = random.uniform(-0.01, 0.01);
            const double middle = (pit.across - 1) / 2.0;
            const Vec3 where(0.14 * (i % pit.across - middle) + aside,
                             0.14 * (i / pit.across - middle) + before, 0.07 + 0.12 * k);
            if (pit.of_boxes)
                parts.box(material, kLightMass, Vec3::Constant(0.8 * kLight), at(where));
            else
                parts.ball(material, kLightMass, kLight, at(where).position);
        }
    const Vec3 over(0.05, 0.02, 0.12 * pit.layers + 1.2);
    const std::uint32_t heavy = pit.cube
        ? parts.box(material, pit.mass, Vec3::Constant(pit.size), at(over))
        : parts.ball(material, pit.mass, pit.size, at(over).position);
    parts.body(heavy).velocity = how.place.orientation * Vec3(0, 0, -pit.speed);
    return parts.scene();
}

}  // namespace

void case_heavy_on_crowd(CaseBench& bench)
{
    const How hows[] = {
        {"default"},
        {"default, turned, far off",
         [](Settings&) {},
         {Vec3(7, -3, 0), exponential(Vec3(0.3, 0.6, 0.9))}},
        {"dt 1/240", [](Settings& s) { s.dt = 1.0 / 240; }},
        {"16 substeps", [](Settings& s) { s.substeps = 16; }},
        {"1 substep", [](Settings& s) { s.substeps = 1; }, {}, "default"},
        {"pgs", [](Settings& s) { s.solver = Solver::pgs; }},
        {"double", [](Settings& s) { s.precision = Precision::double_; }},
    };
    const Pit pits[] = {
        {.name = "30 kg on 216 balls",
         .across = 6,
         .layers = 6,
         .mass = 30,
         .size = 0.2,
         .always = true},
        {.name = "60 kg on 800 balls", .always = true},
        {.name = "1 t on 800 balls", .mass = 1000, .met_by = "16 substeps"},
        {.name = "60 kg at 15 m/s on 800 balls", .speed = 15},
        {.name = "60 kg on 800 balls, e = 0.5", .restitution = 0.5},
        {.name = "a cube of 60 kg on 800 balls", .size = 0.2, .cube = true},
        {.name = "60 kg on 800 boxes", .of_boxes = true},
        {.name = "200 kg on 2,048 balls", .across = 16, .mass = 200, .size = 0.4},
    };
    const double seconds = bench.brief() ? kBriefSeconds : kSeconds;
    for (const How& how : std::span(hows).first(bench.brief() ? 1 : std::size(hows)))
        for (const Pit& pit : std::span(pits).first(bench.brief() ? 1 : std::size(pits))) {
            if (!pit.always && &how != hows) continue;
            double deep = 0;
            const double made =
                energy_made(bench, filled(bench, pit, how), seconds, [&](World& world, double now) {
                    if (now < seconds - 1) return;
                    deep = std::max(deep, world.measure().greatest_overlap / (2 * kLight));
                });
            bench.forgive_residual();
            const std::string of = std::string(pit.name) + ": ";
            bench.report(how.setting, of + "energy made, over the greatest in motion", made, kMade,
                         "1");
            bench.report_default(how.setting,
                                 of + "overlap in the last second, over a light one's size", deep,
                                 kDeep, "1", *how.met_by != 0 ? how.met_by : pit.met_by);
        }
}

}  // namespace throng
