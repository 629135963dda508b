// Sticks: H71, heaps of bodies that turn about one axis far more easily than about another.
//
// Dropped in random poses on a floor they lose energy with every touch and never have more of it
// than they began with, whatever their shape; what cannot roll comes to rest. Where a body's spin
// about its length stays behind as it tips over, its greater moment makes energy of it.
#include "cost/hard_cases/hard_cases.hpp"
#include "scene/catalog/random.hpp"
#include "throng/energy_ledger.hpp"
#include "throng/rotation.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

struct Stick {
    const char* name;
    decltype(ShapeDescription::shape) shape;
    bool rolls;         // on and on: nothing resists rolling here
    bool wide = false;  // two ways
};

constexpr double kLength = 0.6;       // m, of what is longest
constexpr char kMetBy[] = "1/240 s";  // the step by which energy is kept where the default does not

Stick capsule(const char* name, double ratio)
{
    const double radius = 0.5 * kLength / ratio;
    return {name, CapsuleShape{radius, 0.5 * kLength - radius}, true};
}
Stick beam(const char* name, const Vec3& share)
{
    return {name, BoxShape{0.5 * kLength * share}, false};
}
Stick cylinder(const char* name, double radius, double half_length)
{
    return {name, CylinderShape{0.5 * kLength * radius, 0.5 * kLength * half_length}, true};
}
Stick sliver()
{
    const double thin = kLength / 30;
    return {"slivers of four points 1:30",
            HullShape{{Vec3(0, 0, 0), Vec3(kLength, 0, 0), Vec3(0, thin, 0),
                       Vec3(0.5 * kLength, 0, thin)}},
            false};
}

Stick wide(Stick stick)
{
    stick.wide = true;
    return stick;
}

std::vector<Stick> all_sticks()
{
    return {capsule("capsules 1:3", 3),
            capsule("capsules 1:10", 10),
            capsule("capsules 1:30", 30),
            capsule("capsules 1:100", 100),
            beam("beams 1:10", Vec3(1, 0.1, 0.1)),
            beam("beams 1:30", Vec3(1, 1.0 / 30, 1.0 / 30)),
            beam("planks 1:5:20", Vec3(1, 0.2, 0.05)),
            wide(beam("plates 1:30", Vec3(1, 1, 1.0 / 30))),
            cylinder("cylinders 1:10", 0.1, 1),
            cylinder("cylinders 1:30", 1.0 / 30, 1),
            wide(cylinder("discs 1:30", 1, 1.0 / 30)),
            sliver()};
}

Quat random_turn(Random& random)
{
    // Uniform, by Shoemake (1992).
    const double u = random.unit();
    const SinCos a = sin_cos(2 * kPi * random.unit()), b = sin_cos(2 * kPi * random.unit());
    const double inner = std::sqrt(1 - u), outer = std::sqrt(u);
    return {outer * b.cos, inner * a.sin, inner * a.cos, outer * b.sin};
}

// How the heap is laid out, none of which is to matter.
struct Layout {
    const char* name = "";
    Quat turn = Quat::Identity();  // of the world
    Vec3 off = Vec3::Zero();       // m, from its origin
    bool backwards = false;        // the last body first
};

// So many of them in layers of three by three.
Scene heap(const CaseBench& bench, const Stick& stick, int count, const Layout& layout = {})
{
    SceneParts parts(bench.scene());
    const std::uint32_t material = parts.material(0.5);
    const Vec3 up = layout.turn * Vec3::UnitZ();
    parts.plane(material, up, up.dot(layout.off));
    Scene& scene = parts.scene();
    scene.gravity = -kGravity * up;
    scene.shapes.push_back({"stick", stick.shape});
    Random random(1);
    for (int i = 0; i < count; ++i) {
        BodyDescription& body = scene.bodies.emplace_back();
        body.shape = static_cast<std::uint32_t>(scene.shapes.size() - 1);
        body.material = material;
        const Vec3 cell(i % 3 - 1, i / 3 % 3 - 1, i / 9);
        const Vec3 at = 0.9 * kLength * cell + Vec3(0, 0, 0.5);
        const Vec3 shift(random.uniform(-0.02, 0.02), random.uniform(-0.02, 0.02), 0);
        body.position = layout.off + layout.turn * Vec3(at + shift);
        body.orientation = layout.turn * random_turn(random);
    }
    if (layout.backwards) std::reverse(scene.bodies.begin() + 1, scene.bodies.end());
    return scene;
}

void drop(CaseBench& bench, const Stick& stick, Scene scene, const std::string& how, double time)
{
    // Heights are over the floor.
    double start = 0;
    const double floor =
        scene.gravity.dot(Vec3(-std::get<PlaneShape>(scene.shapes.front().shape).normal
                               * std::get<PlaneShape>(scene.shapes.front().shape).offset));
    const auto energy_of = [&](const World& world) {
        const Measures measures = world.measure();
        double mass = 0;
        for (const BodyId body : world.bodies()) mass += world.mass(body);
        return std::pair(measures.kinetic_energy,
                         measures.kinetic_energy + measures.potential_energy - mass * floor);
    };
    bench.inspect(scene, [&](const World& world) { start = energy_of(world).second; });
    EnergyLedger ledger;
    double most = start, kinetic = 0;
    const auto watch = [&](World& world, double) {
        const auto [moving, all] = energy_of(world);
        kinetic = moving;
        most = std::max(most, all);
        return true;
    };
    bench.run(scene, time, watch, &ledger);
    const std::string name = stick.name + how;
    bench.report(name, "energy above that of the start, of it", (most - start) / start, 1e-3, "1");
    if (scene.settings.response == Response::penalty)
        bench.skip(name, "energy gained on the way, of it",
                   "springs of contacts hold energy that is not counted, and give it back");
    else if (how.empty())
        bench.report_default(name, "energy gained on the way, of it", ledger.gained() / start, 1e-3,
                             "1", kMetBy);
    else
        bench.report(name, "energy gained on the way, of it", ledger.gained() / start, 1e-3, "1");
    // What rolls may go on to.
    if (time >= 10)
        bench.report(name, "energy of motion left, of it", kinetic / start,
                     stick.rolls ? 0.1 : 1e-4, "1");
}

}  // namespace

void case_sticks(CaseBench& bench)
{
    const bool brief = bench.brief();
    const int count = brief ? 9 : 63;
    const double time = brief ? 1.5 : 15;
    for (const Stick& stick : all_sticks()) {
        drop(bench, stick, heap(bench, stick, count), "", time);
        if (brief) break;
        // What is wide and thin lies in many layers, which give way as they are struck, and as they
        // part raise all that lies on them.
        if (!stick.wide) continue;
        Scene scene = heap(bench, stick, count);
        scene.settings.dt = 1.0 / 240;
        drop(bench, stick, std::move(scene), std::string(", ") + kMetBy, time);
    }

    const Stick stick = capsule("capsules 1:30", 30);
    const Layout layouts[] = {{", turned", exponential(Vec3(0.4, -1.1, 0.7))},
                              {", far off", Quat::Identity(), Vec3(1e6, -1e6, 1e6)},
                              {", created backwards", Quat::Identity(), Vec3::Zero(), true}};
    for (const Layout& layout : layouts)
        if (!brief) drop(bench, stick, heap(bench, stick, count, layout), layout.name, time);

    const auto with = [&](const char* how, int bodies, double seconds, auto&& change) {
        Scene scene = heap(bench, stick, brief ? 9 : bodies);
        change(scene.settings);
        drop(bench, stick, scene, how, brief ? 1 : seconds);
    };
    with(", pgs", 63, 15, [](Settings& s) { s.solver = Solver::pgs; });
    with(", penalty", 63, 15, [](Settings& s) { s.response = Response::penalty; });
    with(", direct", 9, 4, [](Settings& s) { s.solver = Solver::direct; });
    if (brief) return;
    with(", 1/240 s", 63, 15, [](Settings& s) { s.dt = 1.0 / 240; });
    with(", 1e-3 s", 63, 15, [](Settings& s) { s.dt = 1e-3; });
    with(", 32 substeps", 63, 15, [](Settings& s) { s.substeps = 32; });
    with(", double", 63, 15, [](Settings& s) { s.precision = Precision::double_; });
}

}  // namespace throng
