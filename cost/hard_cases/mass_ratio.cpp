// Mass ratio: H9, heavy boxes on light ones.
//
// Answer: they rest, and the floor bears the weight of all. A soft contact under a box r times as
// heavy as the one below gives way by about r times as much as under an equal one; solved exactly
// none gives way.
#include "cost/hard_cases/hard_cases.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

constexpr double kTime = 10;  // s
constexpr double kOverlap = 1e-6;

struct Pile {
    std::string name;
    Scene scene;
    double small = 1;  // m, edge of the smallest box
};

Pile heavy_cube(const CaseBench& bench, double ratio)
{
    SceneParts parts(bench.scene());
    const std::uint32_t material = parts.material(0.5);
    parts.plane(material, Vec3::UnitZ(), 0);
    parts.box(material, 1, Vec3::Constant(0.5), {Vec3(0, 0, 0.5), Quat::Identity()});
    parts.box(material, ratio, Vec3::Constant(0.5), {Vec3(0, 0, 1.5), Quat::Identity()});
    return {"1:" + std::to_string(static_cast<int>(ratio)), parts.scene(), 1};
}

// Cubes of one density, the smallest at the bottom.
Pile growing_cubes(const CaseBench& bench, const char* name, std::initializer_list<double> edges)
{
    SceneParts parts(bench.scene());
    const std::uint32_t material = parts.material(0.5);
    parts.plane(material, Vec3::UnitZ(), 0);
    double height = 0;
    for (const double edge : edges) {
        const Pose pose{Vec3(0, 0, height + edge / 2), Quat::Identity()};
        parts.box(material, edge * edge * edge, Vec3::Constant(edge / 2), pose);
        height += edge;
    }
    return {name, parts.scene(), *edges.begin()};
}

// Ten rows of boxes of 2 m, each over the joint of two, and one on top that many times denser.
Pile loaded_pyramid(const CaseBench& bench, double denser)
{
    SceneParts parts(bench.scene());
    const std::uint32_t material = parts.material(0.6);
    parts.plane(material, Vec3::UnitZ(), 0);
    constexpr int kRows = 10;
    for (int row = 0; row < kRows; ++row)
        for (int i = 0; i < kRows - row; ++i) {
            const Vec3 at(2.2 * (i + 0.5 * row), 0, 1 + 2 * row);
            parts.box(material, row == kRows - 1 ? 8 * denser : 8, Vec3::Ones(),
                      {at, Quat::Identity()});
        }
    return {"pyramid, top " + std::to_string(static_cast<int>(denser)) + " times denser",
            parts.scene(), 2};
}

struct Resting {
    double overlap = 0, force_error = 0, sunk = 0;
};

Resting watch(CaseBench& bench, const Scene& scene, double time)
{
    double weight = 0;
    for (const BodyDescription& body : scene.bodies) weight += body.mass.value_or(0) * kGravity;
    const double first = scene.bodies.back().position.z();
    Resting rest;
    double next_look = 1;
    bench.run(scene, time, [&](World& world, double now) {
        if (now + 1e-9 < next_look) return true;
        next_look += 1;
        rest.overlap = std::max(rest.overlap, world.measure().greatest_overlap);
        rest.sunk = first - world.pose(world.bodies().back()).position.z();
        const Vec3 force = world.contact_force(world.bodies().front());
        rest.force_error = (force - Vec3(0, 0, -weight)).norm() / weight;
        return true;
    });
    return rest;
}

}  // namespace

void case_mass_ratio(CaseBench& bench)
{
    std::vector<Pile> piles;
    for (const double ratio : {1e2, 1e3, 1e4}) piles.push_back(heavy_cube(bench, ratio));
    piles.push_back(growing_cubes(bench, "10 m cube on a 1 m cube", {1, 10}));
    piles.back().scene.settings.dt = 0.01;
    piles.push_back(
        growing_cubes(bench, "six cubes, each twice the one below", {0.25, 0.5, 1, 2, 4, 8}));
    for (const double denser : {100.0, 200.0, 300.0})
        if (!bench.brief() || denser == 300) piles.push_back(loaded_pyramid(bench, denser));
    for (Pile& pile : piles) {
        const double time = bench.brief() ? 1 : kTime;
        pile.scene.settings.sleep = false;
        if (!bench.brief()) {
            const Resting soft = watch(bench, pile.scene, time);
            bench.report_default(pile.name + ", default", "greatest overlap over the smallest box",
                                 soft.overlap / pile.small, kOverlap, "1", "solver=direct");
            bench.report_default(pile.name + ", default", "error of the base force",
                                 soft.force_error, 1e-3, "1", "solver=direct");
        }
        ask_exactly(pile.scene.settings);
        const Resting rest = watch(bench, pile.scene, time);
        const std::string name = pile.name + ", direct";
        bench.report(name, "greatest overlap over the smallest box", rest.overlap / pile.small,
                     kOverlap, "1");
        bench.report(name, "error of the base force", rest.force_error, 1e-3, "1");
        bench.report(name, "way that the top one sank", std::abs(rest.sunk), 1e-6 * pile.small,
                     "m");
    }
}

}  // namespace throng
