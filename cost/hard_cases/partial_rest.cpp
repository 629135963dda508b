// Partial rest: H127, who rests by itself while others of its heap go on does as if it did not.
//
// Answer: what the same scene does with `partial_rest=off`. A heap that is pushed at lies as deep
// in itself and comes to rest; a house falls as a card of it is pulled, a tower as its lowest box
// is taken, at the same step; and loads that grow by less than anybody notices are noticed
// together.
#include "cost/hard_cases/hard_cases.hpp"
#include "scene/catalog/parts.hpp"
#include "throng/catalog.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace throng {

namespace {

constexpr double kSettled = 8, kAfter = 3;  // s, before the first push, and after the last
constexpr int kPushed = 10;                 // bodies a second
constexpr double kPush = 1;                 // m/s
// Of the overlap without; of the bodies, that are awake in the end; J a kg.
constexpr double kDeeper = 1.1, kUp = 0.05, kMoves = 1e-5;
constexpr double kSteps = 1;  // earlier or later
// Of the weight: each body of a column hides some, and forty plates do more than the box.
constexpr double kColumn = 0.25;

struct Way {
    const char* name;
    void (*set)(Settings&) = [](Settings&) {};
    bool heaps = true;
};
constexpr Way kWays[] = {
    {"default"},
    {"double", [](Settings& s) { s.precision = Precision::double_; }},
    // A heap that is pushed at does not come to rest by it in the time there is.
    {"pgs", [](Settings& s) { s.solver = Solver::pgs; }, false},
};

void rest(Settings& settings, const Way& way, bool rests)
{
    way.set(settings);
    settings.sleep = false;
    settings.partial_rest = rests;
}

struct Heap {
    double overlap = 0, deepest = 0;     // m
    double kinetic = 0;                  // J a kg
    double awake = 0, awake_before = 0;  // of the bodies, in the end and while they are pushed
    double mass = 0;                     // kg
};

Heap push_heap(CaseBench& bench, const Way& way, bool rests, int count, int pushes)
{
    Scene scene = make_scene("pile", count);
    scene.settings = bench.settings();
    rest(scene.settings, way, rests);
    Random random(7);
    Heap heap;
    double next = kSettled;
    int left = pushes, steps = 0;
    bench.run(scene, kSettled + pushes + kAfter, [&](World& world, double now) {
        const auto of = static_cast<std::uint32_t>(count);
        if (now > kSettled && left > 0) {
            heap.awake_before += double(world.report().bodies_awake) / of;
            ++steps;
        }
        if (left > 0 && now > next) {
            ++next;
            --left;
            const std::vector<BodyId> bodies = world.bodies();
            for (int k = 0; k < kPushed; ++k) {
                const BodyId body = bodies[bodies.size() - 1 - random.below(of)];
                const Vec3 push = kPush * random_direction(random);
                world.set_velocity(body, world.velocity(body) + push, world.angular_velocity(body));
            }
        }
        if (now + 1e-9 < kSettled + pushes + kAfter - scene.settings.dt) return true;
        const Measures measures = world.measure();
        heap.overlap = measures.mean_overlap;
        heap.deepest = measures.greatest_overlap;
        for (const BodyId body : world.bodies()) heap.mass += world.mass(body);
        heap.kinetic = measures.kinetic_energy / heap.mass;
        heap.awake = double(world.report().bodies_awake) / of;
        return true;
    });
    heap.awake_before /= std::max(steps, 1);
    return heap;
}

void compare_heaps(CaseBench& bench, const Way& way)
{
    // Of fewer it is by chance whether a heap is given finer substeps, which overlap a third as
    // much.
    const int count = bench.brief() ? 300 : 2000, pushes = bench.brief() ? 2 : 10;
    const Heap without = push_heap(bench, way, false, count, pushes);
    const Heap with = push_heap(bench, way, true, count, pushes);
    const std::string setting =
        std::string(way.name) + ", pile of " + std::to_string(count) + " pushed";
    bench.report(setting, "mean overlap over that without", with.overlap / without.overlap, kDeeper,
                 "1");
    bench.report(setting, "greatest overlap over that without", with.deepest / without.deepest, 1.5,
                 "1");
    bench.report(setting, "energy of motion a kg", with.kinetic,
                 std::max(kMoves, 2 * without.kinetic), "J/kg");
    bench.report(setting, "awake in the end, of all", with.awake, kUp, "1");
    bench.show(setting, "awake while they are pushed, of all", with.awake_before, "1");
}

// What is done in each step once all has come to rest, and who is to be so much lower by it.
struct Fall {
    double settled, lower;  // s; m
    std::function<void(World&)> act;
};

struct Fell {
    double steps = std::numeric_limits<double>::infinity();  // from the act on
    double awake = 0;                                        // bodies, as it begins
};

Fell fall_after(CaseBench& bench, Scene scene, const Way& way, bool rests, const Fall& fall)
{
    rest(scene.settings, way, rests);
    constexpr double kPatience = 6;  // s
    Fell fell;
    double height = 0;
    int steps = 0;
    bench.run(scene, fall.settled + kPatience, [&](World& world, double now) {
        if (now < fall.settled) return true;
        const double high = world.pose(world.bodies().back()).position.z();
        if (steps == 0) {
            height = high;
            fell.awake = static_cast<double>(world.report().bodies_awake);
        }
        if (high < height - fall.lower) fell.steps = steps;
        if (high < height - fall.lower) return false;
        fall.act(world);
        ++steps;
        return true;
    });
    return fell;
}

void compare_falls(
    CaseBench& bench, const Way& way, const std::string& name, const Scene& scene, const Fall& fall)
{
    const Fell without = fall_after(bench, scene, way, false, fall);
    const Fell with = fall_after(bench, scene, way, true, fall);
    const std::string setting = std::string(way.name) + ", " + name;
    bench.report(setting, "falls earlier or later, steps", std::abs(with.steps - without.steps),
                 kSteps, "1");
    bench.show(setting, "awake before", with.awake, "1");
    bench.show(setting, "falls after, steps", with.steps, "1");
}

Scene tower(const CaseBench& bench, int boxes)
{
    SceneParts parts(bench.scene());
    const std::uint32_t material = parts.material(0.5);
    parts.plane(material, Vec3::UnitZ(), 0);
    for (int i = 0; i < boxes; ++i)
        parts.box(material, 1, Vec3::Constant(0.1), {Vec3(0, 0, 0.1 + 0.2 * i), Quat::Identity()});
    return parts.scene();
}

// Plates of a hundredth of a box's weight, put one by one on a box: the floor must bear them all.
double hidden_load(CaseBench& bench, const Way& way)
{
    Scene scene = tower(bench, 1);
    rest(scene.settings, way, true);
    constexpr int kPlates = 40;
    constexpr double kEvery = 0.75, kMass = 0.01;  // s, kg
    int plates = 0;
    double hidden = 0;
    bench.run(scene, kEvery * (kPlates + 1), [&](World& world, double now) {
        if (now < kEvery * (plates + 1)) return true;
        const double weight = (1 + kMass * plates) * kGravity;
        const double borne = -world.contact_force(world.bodies().front()).z();
        hidden = std::max(hidden, std::abs(borne - weight) / weight);
        SceneParts parts{Scene(scene)};
        parts.scene().bodies.clear();
        parts.box(0, kMass, Vec3(0.1, 0.1, 0.002),
                  {Vec3(0, 0, 0.202 + 0.004 * plates), Quat::Identity()});
        world.add(parts.scene());
        ++plates;
        return plates < kPlates;
    });
    return hidden;
}

}  // namespace

void case_partial_rest(CaseBench& bench)
{
    for (const Way& way : kWays) {
        if (bench.brief() && &way != kWays) continue;
        if (way.heaps) compare_heaps(bench, way);
        compare_falls(bench, way, "tower of 10, the lowest taken", tower(bench, 10),
                      {2, 0.1, [](World& world) {
                           const std::vector<BodyId> bodies = world.bodies();
                           if (bodies.size() == 11) world.remove(std::span(&bodies[1], 1));
                       }});
        // The inner card of the first tent, out between the others.
        const auto pull = [](World& world) {
            const BodyId card = world.bodies()[2];
            if (world.pose(card).position.y() < 0.3)
                world.set_velocity(card, Vec3(0, 3, 0), Vec3::Zero());
        };
        for (const int levels : {2, 3})
            compare_falls(bench, way,
                          "house of " + std::to_string(levels) + " levels, a card pulled",
                          card_house(bench, levels, 0.7), {2, 0.05, pull});
        const std::string plates = std::string(way.name) + ", plates put on a box";
        constexpr const char* kHidden = "load that is not noticed";
        if (way.heaps)
            bench.report(plates, kHidden, hidden_load(bench, way), kColumn, "1");
        else
            bench.show(plates, kHidden, hidden_load(bench, way), "1");
    }
}

}  // namespace throng
