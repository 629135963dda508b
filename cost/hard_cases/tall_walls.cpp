// Tall walls: H85, walls of bricks that nothing holds from the side.
//
// Answer: they stand. Soft contacts give way by what bears on them, so that a wall is a column of
// springs, and one higher than a certain height buckles under its own weight (Greenhill 1881): of
// rows b high and w thick, each of which presses its bed in by d, (7.84 b^2 w^2 / 4 d)^(1/3) stand.
// With d = 0.12 mm, as by the usual substeps at 1/60 s, that are 10 m; d goes with the square of
// the substep, and what is higher gets finer ones.
#include "cost/hard_cases/hard_cases.hpp"
#include "throng/rotation.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

constexpr double kThick = 0.5, kHigh = 0.5, kLong = 1;  // m, a brick
constexpr double kWeight = 250;                         // kg, likewise

// Rows in running bond, closed by half bricks; `place` is where its foot is.
Scene wall(const CaseBench& bench, int rows, int columns, const Pose& place, bool from_above)
{
    SceneParts parts(bench.scene());
    parts.plane(parts.material(0.5), Vec3::UnitZ(), 0);
    const auto lay = [&](double begin, double end, double row) {
        parts.box(0, kWeight * (end - begin), Vec3((end - begin) / 2, kThick / 2, kHigh / 2),
                  place * Pose{Vec3((begin + end) / 2, 0, (row + 0.5) * kHigh), Quat::Identity()});
    };
    for (int i = 0; i < rows; ++i) {
        const int row = from_above ? rows - 1 - i : i;
        const double shift = row % 2 == 0 ? 0 : kLong / 2;
        if (shift > 0) lay(0, shift, row);
        for (int k = 0; k + (shift > 0 ? 1 : 0) < columns; ++k)
            lay(shift + k * kLong, shift + (k + 1) * kLong, row);
        if (shift > 0) lay(columns * kLong - shift, columns * kLong, row);
    }
    return parts.scene();
}

struct Stood {
    double leaned = 0;  // m, furthest that a brick left the wall's plane, at any step
    double sunk = 0;    // m, the top at the end
};

Stood stand(CaseBench& bench, const Scene& scene, const Pose& place, int rows, double time)
{
    const Vec3 across = place.orientation * Vec3::UnitY();
    Stood stood;
    bench.run(scene, time, [&](World& world, double) {
        double top = 0;
        for (const BodyId body : world.bodies()) {
            if (world.motion(body) != Motion::dynamic) continue;
            const Vec3 at = world.pose(body).position;
            stood.leaned = std::max(stood.leaned, std::abs(across.dot(at - place.position)));
            top = std::max(top, at.z());
        }
        stood.sunk = (rows - 0.5) * kHigh - top;
        return stood.leaned < kThick;
    });
    return stood;
}

const Pose kHere, kAway{Vec3(700, -300, 0), exponential(Vec3(0, 0, 0.7))};

void tell(CaseBench& bench, const std::string& setting, const Stood& stood)
{
    bench.report(setting, "leans", stood.leaned, 0.02, "m");
    bench.report(setting, "top sinks", stood.sunk, 0.05, "m");
}

}  // namespace

void case_tall_walls(CaseBench& bench)
{
    const double time = bench.brief() ? 4 : 20;
    const auto by_default = [&](const std::string& name, int rows, int columns, const Pose& place,
                                bool from_above, double dt) {
        Scene scene = wall(bench, rows, columns, place, from_above);
        scene.settings.dt = dt;
        tell(bench, name, stand(bench, scene, place, rows, time));
    };
    by_default("8 m", 16, 6, kHere, false, 1.0 / 60);
    if (bench.brief()) return;
    by_default("8 m, far off and turned", 16, 6, kAway, false, 1.0 / 60);
    by_default("8 m, made from above", 16, 6, kHere, true, 1.0 / 60);
    by_default("8 m long as it is high", 16, 16, kHere, false, 1.0 / 60);
    by_default("15 m, dt=1/240", 30, 12, kHere, false, 1.0 / 240);

    // What the usual substeps do not hold: it is escalated.
    for (const auto& [rows, substeps] : {std::pair(24, 16), std::pair(50, 32)}) {
        const std::string name = std::to_string(rows / 2) + " m";
        by_default(name, rows, 12, kHere, false, 1.0 / 60);
        const std::string dial = "substeps=" + std::to_string(substeps);
        Scene scene = wall(bench, rows, 12, kHere, false);
        scene.settings.substeps = substeps;
        tell(bench, name + ", " + dial, stand(bench, scene, kHere, rows, time));
    }
}

}  // namespace throng
