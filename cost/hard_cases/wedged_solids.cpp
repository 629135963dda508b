// Wedged solids: H87, thin bodies of meshes that a fall drives through one another.
//
// Answer: what lies deep in another has ways out to all sides, which take it apart and give it no
// speed; a heap has never more energy than it began with, but for what it is lifted by.
#include "cost/hard_cases/hard_cases.hpp"
#include "cost/hard_cases/solid_parts.hpp"
#include "throng/catalog.hpp"
#include "throng/energy_ledger.hpp"
#include "throng/world.hpp"

#include <cmath>

namespace throng {

namespace {

constexpr double kFall = 5;  // s

// A flat star of six points, 1 m across and 30 mm thick: it falls five times that in a step.
TriangleSoup flat_star()
{
    constexpr std::uint32_t kRing = 12;
    constexpr double kOuter = 0.5, kInner = 0.15, kHalf = 0.015;
    TriangleSoup mesh;
    for (const double z : {-kHalf, kHalf}) {
        for (std::uint32_t i = 0; i < kRing; ++i) {
            const double radius = i % 2 == 0 ? kOuter : kInner, angle = 2 * kPi * i / kRing;
            mesh.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
        }
        mesh.vertices.emplace_back(0, 0, z);
    }
    constexpr std::uint32_t kTop = kRing + 1;
    for (std::uint32_t i = 0; i < kRing; ++i) {
        const std::uint32_t j = (i + 1) % kRing;
        mesh.triangles.push_back({kRing, j, i});
        mesh.triangles.push_back({kTop + kRing, kTop + i, kTop + j});
        mesh.triangles.push_back({i, j, kTop + j});
        mesh.triangles.push_back({i, kTop + j, kTop + i});
    }
    return mesh;
}

void drop_stars(CaseBench& bench, const std::string& setting, const Scene& scene)
{
    EnergyLedger ledger;
    double speed = 0;
    const auto watch = [&](World& world, double) {
        speed = greatest_speed(world);
        return true;
    };
    bench.run(scene, bench.brief() ? 1.5 : kFall, watch, &ledger);
    bench.report(setting, "energy gained over the greatest of motion",
                 ledger.gained() / ledger.greatest_kinetic(), 1e-2, "1");
    if (!bench.brief()) bench.show(setting, "speed after 5 s", speed, "m/s");
}

}  // namespace

void case_wedged_solids(CaseBench& bench)
{
    const TriangleSoup mesh = flat_star();
    for (const SolidRepresentationName& way : kSolidWays)
        for (const int substeps : {4, 16, 64}) {
            if (bench.brief() && (substeps > 4 || &way != &kSolidWays[0])) continue;
            Scene scene = taken(bench, find_scene("knots")->make_of(20, 1, mesh), way);
            scene.settings.substeps = substeps;
            const std::string name =
                std::string(way.name) + ", " + std::to_string(substeps) + " substeps";
            drop_stars(bench, name, scene);
            if (substeps > 4 || bench.brief()) continue;
            scene.settings.solver = Solver::pgs;
            drop_stars(bench, name + ", pgs", scene);
        }
}

}  // namespace throng
