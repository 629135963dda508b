// Solid heap: H44, scans and lumps dropped in a bin.
//
// Answer: at rest by ten seconds, and what the bodies share, told by fine depth images of their own
// triangles and not by the way that the step takes, is a ten-thousandth of their volume at most.
#include "cost/hard_cases/hard_cases.hpp"
#include "cost/hard_cases/solid_parts.hpp"
#include "cost/shared_in_heap.hpp"
#include "cost/shared_meshes.hpp"
#include "scene/catalog/noisy_balls.hpp"
#include "throng/catalog.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <stdexcept>

namespace throng {

namespace {

// Radius of the lumps, m.
constexpr double kLump = 0.5;
constexpr double kTime = 10;
constexpr int kRays = 48;

struct HeapEnd {
    double speed = 0;
    double energy = 0;  // J / kg
    SharedInHeap shared;
};

HeapEnd drop_heap(CaseBench& bench, const Scene& scene)
{
    HeapEnd end;
    bench.run(scene, kTime, [&](World& world, double now) {
        if (now < kTime - 1e-9) return true;
        double mass = 0;
        for (const BodyId body : world.bodies()) mass += world.mass(body);
        end.speed = greatest_speed(world);
        end.energy = world.measure().kinetic_energy / mass;
        end.shared = shared_in_heap(scene, world, kRays);
        return true;
    });
    return end;
}

// Where the bench's own step or voxels are too coarse: the step, s, and the voxel, m, 0 as they
// are; or what meets the bounds, where they are left as they are.
struct Finer {
    double dt = 0, voxel = 0;
    const char* met_by = nullptr;
};

std::string setting_of(const std::string& kind,
                       int count,
                       const SolidRepresentationName& way,
                       const Finer& finer)
{
    std::string setting = std::to_string(count) + " " + kind + ", " + std::string(way.name);
    if (finer.dt > 0) setting += " in finer steps";
    return setting;
}

void judge_heap(CaseBench& bench,
                const std::string& kind,
                const TriangleSoup& mesh,
                int count,
                const SolidRepresentationName& way,
                const Finer& finer = {})
{
    Scene scene = taken(bench, find_scene("knots")->make_of(count, 1, mesh), way);
    if (finer.dt > 0) scene.settings.dt = finer.dt;
    if (finer.voxel > 0) scene.settings.voxel_size = finer.voxel;
    const HeapEnd end = drop_heap(bench, scene);
    const std::string setting = setting_of(kind, count, way, finer);
    const auto report = [&](const char* quantity, double figure, double bound, const char* unit) {
        if (finer.met_by == nullptr)
            bench.report(setting, quantity, figure, bound, unit);
        else
            bench.report_default(setting, quantity, figure, bound, unit, finer.met_by);
    };
    report("speed after 10 s", end.speed, 1e-2, "m/s");
    report("kinetic energy after 10 s", end.energy, 5e-5, "J/kg");
    if (end.shared.trouble.empty())
        report("shared volume, of the bodies'", end.shared.volume / end.shared.body, 1e-4, "1");
    else
        bench.skip(setting, "shared volume, of the bodies'", end.shared.trouble);
}

void judge_file(CaseBench& bench,
                const std::string& kind,
                int count,
                const SolidRepresentationName& way,
                const Finer& finer = {})
{
    const std::string setting = setting_of(kind, count, way, finer);
    const auto mesh = shared_mesh(kind + ".obj");
    if (!mesh) {
        bench.skip(setting, "rest and shared volume",
                   "meshes/" + kind + ".obj is not in the shared data");
        return;
    }
    try {
        judge_heap(bench, kind, *mesh, count, way, finer);
    } catch (const std::invalid_argument& refusal) {
        bench.skip(setting, "rest and shared volume", refusal.what());
    }
}

}  // namespace

void case_solid_heap(CaseBench& bench)
{
    const SolidRepresentationName& voxels = kSolidWays[0];
    if (bench.brief()) {
        judge_heap(bench, "lumps", noisy_ball(kLump, 0.3, 320, 7), 6, voxels);
        return;
    }
    // Lumps need no data, so that there is always something to see.
    for (const SolidRepresentationName& way : kSolidWays)
        judge_heap(bench, "lumps", noisy_ball(kLump, 0.3, 500, 7), 20, way);
    for (const SolidRepresentationName& way : kSolidWays) judge_file(bench, "bunny", 20, way);
    judge_file(bench, "bunny", 200, voxels);
    for (const char* kind : {"spot", "kettle", "torus", "cube_cup"})
        judge_file(bench, kind, 50, voxels);
    // 0.032 m thick, and falls five times that in a step: plates then come to lie through one
    // another, whatever the voxels, and the nearest way out is to either side. Steps of about its
    // thickness and three voxels across it will do; parts come to rest without, in one another by a
    // hair.
    judge_file(bench, "snowflake", 50, voxels, {0, 0, "dt 1/240, voxel_size 0.01, below"});
    judge_file(bench, "snowflake", 50, voxels, {1.0 / 240, 0.01});
    judge_file(bench, "snowflake", 50, kSolidWays[1], {0, 0, "dt 1/240, below"});
    judge_file(bench, "snowflake", 50, kSolidWays[1], {1.0 / 240});
}

}  // namespace throng
