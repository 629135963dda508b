// Link chains: H97, chains of links that hold one another by contact alone.
//
// Answer: a chain that hangs stays as it hangs, whatever hangs on it; one that swings stays a chain
// and makes no energy. What a load keeps in line turns back the faster the greater it is: the upper
// links of these by a radian and more in a step.
#include "cost/hard_cases/hard_cases.hpp"
#include "scene/catalog/parts.hpp"
#include "throng/energy_ledger.hpp"
#include "throng/rotation.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

// Of a link's length: how wide it is, and the radius of its wire; middles of two that touch.
constexpr double kWide = 0.5, kWire = 0.1, kPitch = 1 - 2 * kWire;
constexpr double kDensity = 1000;  // kg/m3

struct Chain {
    int links = 20;
    double length = 0.06;  // m, of a link between the middles of its ends
    double load = 1;       // the last link's mass over that of another
    double aslant = 0;     // rad, from which it swings
    Pose frame = {};
    bool backwards = false;  // the last link is made first
    void (*choose)(Settings&) = [](Settings&) {};
};

// kg, where its rods meet counted twice.
double link_mass(double length)
{
    const double wire = kWire * length;
    const auto rod = [&](double half_length) {
        return kPi * wire * wire * (2 * half_length + 4 * wire / 3);
    };
    return kDensity * 2 * (rod(length / 2) + rod(kWide * length / 2));
}

// Two ends across, along y, and two sides.
std::uint32_t add_link(Scene& scene, double length)
{
    const double wide = kWide * length, wire = kWire * length;
    const auto rod = [&](std::string_view name, double half_length) {
        return add_shape(scene, name, CapsuleShape{wire, half_length});
    };
    const std::uint32_t side = rod("side", length / 2), end = rod("end", wide / 2);
    const Quat across = exponential(Vec3(kPi / 2, 0, 0));
    CompoundShape link;
    for (const double sign : {1.0, -1.0}) {
        link.parts.push_back({side, {Vec3(0, sign * wide / 2, 0), Quat::Identity()}});
        link.parts.push_back({end, {Vec3(0, 0, sign * length / 2), across}});
    }
    return add_shape(scene, "link", std::move(link));
}

Scene chain_scene(const CaseBench& bench, const Chain& chain)
{
    SceneParts parts(bench.scene());
    Scene& scene = parts.scene();
    scene.settings.sleep = false;
    chain.choose(scene.settings);
    scene.gravity = chain.frame.orientation * Vec3(0, 0, -kGravity);
    const std::uint32_t material = parts.material(0.3);
    scene.materials[material].density = kDensity;
    const std::uint32_t shape = add_link(scene, chain.length);
    const Quat leans = exponential(Vec3(0, -chain.aslant, 0));
    for (int i = 0; i < chain.links; ++i) {
        const int link = chain.backwards ? chain.links - 1 - i : i;
        const Quat quarter = exponential(Vec3(0, 0, link % 2 * kPi / 2));
        const Pose placed =
            chain.frame * Pose{leans * Vec3(0, 0, -link * kPitch * chain.length), leans * quarter};
        BodyDescription body;
        body.shape = shape;
        body.material = material;
        body.position = placed.position;
        body.orientation = placed.orientation;
        if (link == 0) body.motion = Motion::static_;
        if (link == chain.links - 1 && chain.load != 1)
            body.mass = chain.load * link_mass(chain.length);
        scene.bodies.push_back(body);
    }
    return scene;
}

struct Held {
    double stretch = 0;  // of a pitch, the greatest between two links at any step
    double speed = 0;    // m/s, of the fastest at the end
    double gained = 0;   // energy over the weight times the length
};

Held hold(CaseBench& bench, const Chain& chain, double seconds)
{
    Held held;
    EnergyLedger ledger;
    const double pitch = kPitch * chain.length;
    const auto watch = [&](World& world, double) {
        const auto ids = world.bodies();
        held.speed = 0;
        for (std::size_t i = 0; i < ids.size(); ++i) {
            held.speed = std::max(held.speed, world.velocity(ids[i]).norm());
            if (i == 0) continue;
            const double apart =
                (world.pose(ids[i]).position - world.pose(ids[i - 1]).position).norm();
            held.stretch = std::max(held.stretch, apart / pitch - 1);
        }
        return true;
    };
    bench.run(chain_scene(bench, chain), seconds, watch, &ledger);
    const double weight = kGravity * link_mass(chain.length) * (chain.links - 2 + chain.load);
    held.gained = ledger.gained() / (weight * pitch * chain.links);
    return held;
}

// `met_by`: what holds it where the default does not; empty where the default does.
void judge(CaseBench& bench,
           const std::string& name,
           const Chain& chain,
           double seconds,
           const std::string& met_by = "")
{
    const Held held = hold(bench, chain, seconds);
    const auto report = [&](const char* quantity, double figure, double bound) {
        bench.report_default(name, quantity, figure, bound, "1", met_by);
    };
    report("greatest stretch over a pitch", held.stretch, 0.2);
    report("energy gained over weight times length", held.gained, 5e-3);
    bench.show(name, "greatest speed at the end", held.speed, "m/s");
}

void hung(CaseBench& bench,
          const std::string& name,
          const Chain& chain,
          const std::string& met_by = "")
{
    judge(bench, name, chain, bench.brief() ? 2 : 10, met_by);
}

void swung(CaseBench& bench, const std::string& name, Chain chain)
{
    chain.aslant = kPi / 6;
    judge(bench, name, chain, 5);
}

void sleeps(CaseBench& bench)
{
    const Held held = hold(bench, {.choose = [](Settings& s) { s.sleep = true; }}, 2);
    bench.report("20 links, sleep=on", "greatest speed at the end", held.speed, 0, "m/s");
}

void shorter(Settings& settings) { settings.dt = 1e-3; }

void direct(Settings& settings) { settings.solver = Solver::direct; }

}  // namespace

void case_link_chains(CaseBench& bench)
{
    hung(bench, "20 links", {});
    sleeps(bench);
    if (bench.brief()) return;
    hung(bench, "20 links, dt 1/30", {.choose = [](Settings& s) { s.dt = 1.0 / 30; }}, "dt=1/60");
    hung(bench, "20 links, dt 1/240", {.choose = [](Settings& s) { s.dt = 1.0 / 240; }});
    hung(bench, "20 links, dt 1e-3", {.choose = shorter});
    hung(bench, "20 links, turned", {.frame = {Vec3::Zero(), exponential(Vec3(0.3, -0.5, 0.7))}});
    hung(bench, "20 links, far off", {.frame = {Vec3(3e4, -1e4, 2e4), Quat::Identity()}});
    hung(bench, "20 links, made backwards", {.backwards = true});
    hung(bench, "20 links, 16 substeps", {.choose = [](Settings& s) { s.substeps = 16; }});
    hung(bench, "20 links, double",
         {.choose = [](Settings& s) { s.precision = Precision::double_; }});
    hung(bench, "20 links, direct", {.choose = direct});
    hung(bench, "8 links", {.links = 8});
    hung(bench, "20 links of 0.6 m", {.length = 0.6});
    hung(bench, "60 links of 0.6 m", {.links = 60, .length = 0.6});
    hung(bench, "12 links, the last 10 times as heavy", {.links = 12, .load = 10});
    hung(bench, "12 links of 0.6 m, the last 100 times as heavy",
         {.links = 12, .length = 0.6, .load = 100});
    const struct {
        const char* name;
        Chain chain;
    } fast[] = {
        {"60 links", {.links = 60}},
        {"20 links of 6 mm", {.length = 6e-3}},
        {"12 links, the last 100 times as heavy", {.links = 12, .load = 100}},
    };
    for (const auto& [name, chain] : fast) {
        hung(bench, name, chain, "dt=0.001");
        Chain finer = chain;
        finer.choose = shorter;
        hung(bench, std::string(name) + ", dt 1e-3", finer);
    }
    for (const double length : {0.06, 0.6}) {
        const std::string name = length < 0.1 ? "swing, 20 links" : "swing, 20 links of 0.6 m";
        swung(bench, name, {.length = length});
        swung(bench, name + ", dt 1/240",
              {.length = length, .choose = [](Settings& s) { s.dt = 1.0 / 240; }});
        swung(bench, name + ", direct", {.length = length, .choose = direct});
    }
}

}  // namespace throng
