// Heavy on light: H76, what stands by the default dials though its load is too much for soft
// contacts: heavy boxes on light ones, uneven columns, dice, cylinders and houses of cards; and
// slabs on what can only turn.
//
// Answer: they stand as they were put, and the floor bears the weight of all.
#include "cost/hard_cases/hard_cases.hpp"
#include "scene/catalog/parts.hpp"
#include "throng/energy_ledger.hpp"
#include "throng/rotation.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

// Something that stands, its ground first.
struct Stand {
    std::string name;
    Scene scene;
    double least = 1;  // m, extent of the smallest body
};

struct Block {
    double edge, mass;
};

// Where the whole is put: turned about the vertical, and away from the origin.
const Pose kHere, kAway{Vec3(700, -300, 0), exponential(Vec3(0, 0, 0.7))};

Scene ground(const CaseBench& bench, double friction)
{
    SceneParts parts(bench.scene());
    parts.plane(parts.material(friction), Vec3::UnitZ(), 0);
    return parts.scene();
}

// Boxes on one another, the first at the bottom; made in the order of `order`, or from below.
Stand column(const CaseBench& bench,
             std::string name,
             const std::vector<Block>& blocks,
             const std::vector<std::size_t>& order = {},
             const Pose& place = kHere)
{
    SceneParts parts(ground(bench, 0.5));
    std::vector<double> middle;
    double height = 0, least = 1e30;
    for (const Block& block : blocks) {
        middle.push_back(height + block.edge / 2);
        height += block.edge;
        least = std::min(least, block.edge);
    }
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        const std::size_t at = order.empty() ? i : order[i];
        parts.box(0, blocks[at].mass, Vec3::Constant(blocks[at].edge / 2),
                  place * Pose{Vec3(0, 0, middle[at]), Quat::Identity()});
    }
    return {std::move(name), parts.scene(), least};
}

Stand dice(const CaseBench& bench, std::string name, double edge)
{
    return column(bench, std::move(name),
                  std::vector<Block>(10, Block{edge, 1000 * edge * edge * edge}));
}

Stand cylinders(const CaseBench& bench, std::string name, double radius)
{
    SceneParts parts(ground(bench, 0.5));
    for (int i = 0; i < 12; ++i)
        parts.cylinder(0, 1, radius, 0.5, {Vec3(0, 0, 0.5 + i), Quat::Identity()});
    return {std::move(name), parts.scene(), std::min(1.0, 2 * radius)};
}

// Each card a hair off its place, by a draw; none is by the first.
Stand house(const CaseBench& bench, std::string name, int draw)
{
    Scene scene = card_house(bench, 2, 0.5);
    Random random(static_cast<std::uint64_t>(draw));
    for (BodyDescription& body : scene.bodies)
        if (draw > 0 && body.mass) body.position += random_vector(random, -1e-6, 1e-6);
    return {std::move(name), std::move(scene), 0.002};
}

std::vector<Stand> stands(const CaseBench& bench)
{
    const std::vector<Block> heavy = {{1, 1}, {1, 1000}};
    const std::vector<Block> uneven = {{1, 1}, {1, 1e4}, {1, 1}, {1, 1e4}, {1, 1}, {1, 1e4}};
    std::vector<Stand> all;
    all.push_back(column(bench, "1:300", {{1, 1}, {1, 300}}));
    all.push_back(column(bench, "1:1000", heavy));
    all.push_back(column(bench, "1:1000, made from above, turned, far off", heavy, {1, 0}, kAway));
    all.push_back(column(bench, "uneven, 1:10000", uneven));
    all.push_back(
        column(bench, "uneven, 1:10000, made in another order", uneven, {3, 0, 5, 1, 4, 2}, kAway));
    all.push_back(column(bench, "a half, then twice as wide up to 4 m",
                         {{0.5, 125}, {1, 1000}, {2, 8000}, {4, 64000}}));
    all.push_back(dice(bench, "ten dice of 5 cm", 0.05));
    all.push_back(dice(bench, "ten dice of 5 mm", 0.005));
    all.push_back(cylinders(bench, "twelve cylinders", 0.5));
    all.push_back(cylinders(bench, "twelve slender cylinders", 0.3));
    all.push_back(house(bench, "cards of two levels", 0));
    for (int draw = 1; draw <= (bench.brief() ? 2 : 6); ++draw)
        all.push_back(
            house(bench, "cards of two levels, a hair off, " + std::to_string(draw), draw));
    return all;
}

struct Watched {
    double sunk = 0;     // of its height, the top in the end
    double overlap = 0;  // of the least extent, greatest
    double force = 0;    // of the weight, error in the end
    double speed = 0;    // m/s, greatest after the first second
};

Watched watch(CaseBench& bench, const Stand& stand, double time)
{
    double weight = 0, highest = 0;
    std::size_t top = 0;
    for (std::size_t i = 0; i < stand.scene.bodies.size(); ++i) {
        const BodyDescription& body = stand.scene.bodies[i];
        weight += body.mass.value_or(0) * kGravity;
        if (body.position.z() > highest) highest = body.position.z(), top = i;
    }
    Watched seen;
    double next_look = 0.5;
    bench.run(stand.scene, time, [&](World& world, double now) {
        if (now + 1e-9 < next_look) return true;
        next_look += 0.5;
        seen.sunk = (highest - world.pose(world.bodies()[top]).position.z()) / highest;
        seen.overlap = std::max(seen.overlap, world.measure().greatest_overlap / stand.least);
        const Vec3 force = world.contact_force(world.bodies().front());
        seen.force = (force - Vec3(0, 0, -weight)).norm() / weight;
        for (const BodyId body : world.bodies())
            if (now > 1) seen.speed = std::max(seen.speed, world.velocity(body).norm());
        return true;
    });
    return seen;
}

void judge(CaseBench& bench, const std::string& name, const Stand& stand, double time)
{
    const Watched seen = watch(bench, stand, time);
    bench.report(name, "way that the top sank over its height", std::abs(seen.sunk), 0.05, "1");
    bench.report(name, "greatest overlap over the least extent", seen.overlap, 0.05, "1");
    // Cylinders sway a little where they stand on one another.
    const bool sways = name.find("cylinders") != std::string::npos
        && stand.scene.settings.solver != Solver::direct;
    const auto report = [&](const char* quantity, double figure, const char* unit) {
        if (sways)
            bench.report_default(name, quantity, figure, 0.05, unit, "solver=direct");
        else
            bench.report(name, quantity, figure, 0.05, unit);
    };
    report("error of the base force", seen.force, "1");
    report("greatest speed after a second", seen.speed, "m/s");
    bench.report_time(name, "time a step", bench.time_a_step());
}

// Falls as it may, but nothing is thrown: no faster than from its height.
void judge_thrown(CaseBench& bench, const Stand& stand, double time)
{
    double highest = 0, top = 0;
    for (const BodyDescription& body : stand.scene.bodies)
        highest = std::max(highest, body.position.z());
    bench.run(stand.scene, time, [&](World& world, double) {
        for (const BodyId body : world.bodies()) top = std::max(top, world.pose(body).position.z());
        return true;
    });
    bench.report(stand.name + ", pgs", "rise above the top over its height",
                 std::max(0.0, top / highest - 1), 0.05, "1");
}

// Slabs of 500 kg on three balls of half a kilogram that stay where they are, and turn. Neither a
// ball nor the floor gives way to the other, and turned their contact has levers of rounding alone.
Scene slabs_on_balls(const CaseBench& bench, const Quat& turn)
{
    SceneParts parts(bench.scene());
    parts.scene().gravity = turn * Vec3(0, 0, -kGravity);
    parts.plane(parts.material(0.5), turn * Vec3::UnitZ(), 0);
    for (int i = 0; i < 3; ++i) {
        const double angle = 2.1 * i;
        const Vec3 at(0.4 * std::cos(angle), 0.4 * std::sin(angle), 0.05);
        parts.body(parts.ball(0, 0.5, 0.05, turn * at)).pivot = Vec3::Zero();
    }
    for (int i = 0; i < 4; ++i)
        parts.box(0, 500, Vec3(0.5, 0.5, 0.1), {turn * Vec3(0, 0, 0.2 + 0.2 * i), turn});
    return parts.scene();
}

// Who bears them is spun by nothing.
void judge_spun(CaseBench& bench, const std::string& name, const Scene& scene, double time)
{
    double weight = 0, fastest = 0;
    for (const BodyDescription& body : scene.bodies) weight += body.mass.value_or(0) * kGravity;
    EnergyLedger ledger;
    bench.run(
        scene, time,
        [&](World& world, double) {
            for (const BodyId body : world.bodies())
                fastest = std::max(fastest, world.angular_velocity(body).norm());
            return true;
        },
        &ledger);
    bench.report(name, "energy gained over the weight times a metre", ledger.gained() / weight,
                 1e-3, "1");
    bench.report(name, "fastest spin", fastest, 0.5, "rad/s");
}

void judge_who_only_turns(CaseBench& bench, double time)
{
    const std::pair<const char*, Quat> turns[] = {
        {"", Quat::Identity()}, {", turned", exponential(Vec3(0.29, 0.59, 0.88))}};
    for (const auto& [turned, turn] : turns) {
        Scene scene = slabs_on_balls(bench, turn);
        scene.settings.sleep = false;
        const std::string name = std::string("slabs on balls that only turn") + turned;
        judge_spun(bench, name, scene, time);
        Scene exact = scene;
        exact.settings.precision = Precision::double_;
        judge_spun(bench, name + ", double", exact, time);
        if (bench.brief()) continue;
        scene.settings.dt = 1.0 / 240;
        judge_spun(bench, name + ", dt 1/240", scene, time);
        ask_exactly(scene.settings);
        judge_spun(bench, name + ", direct", scene, time);
    }
}

}  // namespace

void case_heavy_on_light(CaseBench& bench)
{
    const double time = bench.brief() ? 1.5 : 20;
    for (Stand& stand : stands(bench)) {
        stand.scene.settings.sleep = false;
        judge(bench, stand.name, stand, time);
        if (bench.brief()) continue;
        for (const auto& [name, dt] :
             {std::pair(", dt 1/240", 1.0 / 240), std::pair(", dt 0.001", 1e-3)}) {
            Stand finer = stand;
            finer.scene.settings.dt = dt;
            judge(bench, stand.name + name, finer, time);
        }
        Stand asleep = stand;
        asleep.scene.settings.sleep = true;
        judge(bench, stand.name + ", sleep=on", asleep, time);
        ask_exactly(stand.scene.settings);
        judge(bench, stand.name + ", direct", stand, time);
    }
    judge_who_only_turns(bench, time);
    for (Stand& stand : stands(bench)) {
        if (bench.brief() && stand.scene.bodies.size() > 7) continue;
        stand.scene.settings.solver = Solver::pgs;
        judge_thrown(bench, stand, time);
    }
}

}  // namespace throng
