// Cards and arches: H10 and H11, what nothing but friction holds.
//
// A tent of two cards leaning at an angle a from upright stands by itself when the floor's friction
// is at least tan(a) / 2. Houses of cards and arches of stones stand as they were built.
#include "cost/hard_cases/hard_cases.hpp"
#include "throng/rotation.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

constexpr double kStands = 60, kDrifts = 1e-3;  // s; m, of a house of cards

// Two cards whose upper ends are cut upright, so that they meet face to face: where edges meet, any
// normal between their faces would do.
Scene tent(const CaseBench& bench, double friction)
{
    const double lean = 25 * kPi / 180;
    const Vec3 half(0.2, 0.1, 0.001);
    SceneParts parts(bench.scene());
    const std::uint32_t material = parts.material(friction);
    parts.plane(material, Vec3::UnitZ(), 0);
    for (const double side : {-1.0, 1.0}) {
        const Vec3 along(-side * std::sin(lean), 0, std::cos(lean));
        const Vec3 through(-side * std::cos(lean), 0, -std::sin(lean));
        const Vec3 middle(side * half.x() * std::sin(lean), 0,
                          half.x() * std::cos(lean) + half.z() * std::sin(lean));
        HullShape card;
        for (const double face : {-1.0, 1.0}) {
            const Vec3 foot = -half.x() * along + face * half.z() * through;
            const Vec3 head = foot - along * ((foot.x() + middle.x()) / along.x());
            for (const double y : {-half.y(), half.y()})
                for (const Vec3& end : {foot, head}) card.points.emplace_back(end + Vec3(0, y, 0));
        }
        parts.hull(material, 0.01, std::move(card), {middle, Quat::Identity()});
    }
    return parts.scene();
}

struct Drift {
    double greatest = 0, of_last = 0;  // m, of any body; of the last, upwards or down
};

Drift watch(CaseBench& bench, const Scene& scene, double time)
{
    std::vector<Vec3> first;
    bench.inspect(scene, [&](const World& world) {
        for (const BodyId body : world.bodies()) first.push_back(world.pose(body).position);
    });
    Drift drift;
    bench.run(scene, time, [&](World& world, double) {
        const std::vector<BodyId> bodies = world.bodies();
        for (std::size_t i = 0; i < bodies.size(); ++i)
            drift.greatest =
                std::max(drift.greatest, (world.pose(bodies[i]).position - first[i]).norm());
        drift.of_last = std::abs((world.pose(bodies.back()).position - first.back()).z());
        return drift.greatest < 0.05;
    });
    return drift;
}

// Stones of a kilogram and a meter along a hanging chain turned upside down, its feet level with
// the floor.
Scene arch(const CaseBench& bench, int stones)
{
    SceneParts parts(bench.scene());
    const std::uint32_t material = parts.material(0.5);
    parts.plane(material, Vec3::UnitZ(), 0);
    const double steepest = 3.6268604078470186, half = 0.5;  // sinh 2
    const double high = std::sqrt(1 + steepest * steepest), a = stones / (2 * steepest);
    const auto joint = [&](int after, double outwards) -> Vec3 {
        const double slope = steepest * (2.0 * after / stones - 1);
        const double secant = std::sqrt(1 + slope * slope);
        const Vec3 middle(a * std::asinh(slope), 0, a * (high - secant));
        if (after == 0 || after == stones)
            return {middle.x() + outwards * std::copysign(half * secant / steepest, slope), 0, 0};
        return middle + outwards * half / secant * Vec3(slope, 0, 1);
    };
    for (int i = 0; i < stones; ++i) {
        Vec3 corners[4] = {joint(i, -1), joint(i, 1), joint(i + 1, 1), joint(i + 1, -1)};
        const Vec3 middle = (corners[0] + corners[1] + corners[2] + corners[3]) / 4;
        HullShape wedge;
        for (const Vec3& corner : corners)
            for (const double y : {-half, half})
                wedge.points.emplace_back(corner - middle + Vec3(0, y, 0));
        parts.hull(material, 1, std::move(wedge), {middle, Quat::Identity()});
    }
    return parts.scene();
}

// What stands by the default dials, which soft contacts make sag.
void stand_by_default(
    CaseBench& bench, const std::string& name, Scene scene, double time, double bound)
{
    if (bench.brief()) return;
    scene.settings.sleep = false;
    const Drift soft = watch(bench, scene, time);
    bench.report_default(name + ", default", "greatest drift", soft.greatest, bound, "m",
                         "solver=direct");
    bench.report_time(name + ", default", "time a step", bench.time_a_step());
}

}  // namespace

Scene card_house(const CaseBench& bench, int levels, double friction)
{
    const double lean = 25 * kPi / 180, separation = 0.0004;
    const Vec3 half(0.2, 0.1, 0.001);
    SceneParts parts(bench.scene());
    const std::uint32_t material = parts.material(friction);
    parts.plane(material, Vec3::UnitZ(), 0);
    const double sideways = half.x() * std::sin(lean) + half.z() * std::cos(lean);
    const double upwards = half.x() * std::cos(lean) + half.z() * std::sin(lean);
    const double pitch = 2 * half.x() + separation;
    double floor = 0;
    for (int tents = levels; tents >= 1; --tents) {
        for (int i = 0; i < tents; ++i)
            for (const double side : {-1.0, 1.0})
                parts.box(
                    material, 0.01, half,
                    {Vec3((i - (tents - 1) / 2.0) * pitch + side * sideways, 0, floor + upwards),
                     exponential(Vec3(0, -side * lean - kPi / 2, 0))});
        const double roof = floor + 2 * upwards + half.z();
        for (int i = 0; i + 1 < tents; ++i)
            parts.box(material, 0.01, half,
                      {Vec3((i + 0.5 - (tents - 1) / 2.0) * pitch, 0, roof), Quat::Identity()});
        floor = roof + half.z();
    }
    return parts.scene();
}

void case_cards(CaseBench& bench)
{
    for (const auto& [friction, stands] : {std::pair(0.245, true), std::pair(0.22, false)}) {
        const std::string name = stands ? "tent, mu 0.245" : "tent, mu 0.22";
        Scene scene = tent(bench, friction);
        if (stands) stand_by_default(bench, name, scene, kStands, kDrifts);
        ask_exactly(scene.settings);
        scene.settings.sleep = false;
        const Drift drift = watch(bench, scene, bench.brief() ? 5 : kStands);
        if (stands)
            bench.report(name + ", direct", "greatest drift", drift.greatest, kDrifts, "m");
        else
            bench.report(name + ", direct", "falls: wrong outcomes", drift.greatest < 0.05 ? 1 : 0,
                         0, "1");
        bench.report_time(name + ", direct", "time a step", bench.time_a_step());
    }
    struct House {
        const char* name;
        int levels;
        double friction;
    };
    for (const House& house :
         {House{"2 levels, mu 0.5", 2, 0.5}, House{"3 levels, mu 0.5", 3, 0.5},
          House{"4 levels, mu 0.5", 4, 0.5}, House{"5 levels, mu 0.7", 5, 0.7}}) {
        if (bench.brief() && house.levels > 2) continue;
        Scene scene = card_house(bench, house.levels, house.friction);
        stand_by_default(bench, house.name, scene, kStands, kDrifts);
        ask_exactly(scene.settings);
        scene.settings.sleep = false;
        const Drift drift = watch(bench, scene, bench.brief() ? 2 : kStands);
        const std::string name = std::string(house.name) + ", direct";
        bench.report(name, "greatest drift", drift.greatest, kDrifts, "m");
        bench.report_time(name, "time a step", bench.time_a_step());
    }
}

void case_arch(CaseBench& bench)
{
    for (const int stones : {25, 101}) {
        if (bench.brief() && stones > 25) continue;
        const std::string name = std::to_string(stones) + " stones";
        Scene scene = arch(bench, stones);
        scene.settings.dt = 0.01;
        stand_by_default(bench, name, scene, 20, 0.01);
        ask_exactly(scene.settings);
        scene.settings.sleep = false;
        double force = 0;
        double sag = 0;
        bench.run(scene, bench.brief() ? 2 : 20, [&](World& world, double) {
            const BodyId crown = world.bodies()[static_cast<std::size_t>(stones + 1) / 2];
            const double first =
                scene.bodies[static_cast<std::size_t>(stones + 1) / 2].position.z();
            sag = std::max(sag, std::abs(world.pose(crown).position.z() - first));
            force = world.contact_force(world.bodies().front()).z();
            return true;
        });
        const double weight = stones * kGravity;
        bench.report(name + ", direct", "sag of the crown over a stone", sag, 0.01, "1");
        bench.report(name + ", direct", "error of the base force",
                     std::abs(force + weight) / weight, 1e-3, "1");
        bench.report_time(name + ", direct", "time a step", bench.time_a_step());
    }
}

}  // namespace throng
