// Attracted heaps: H96, bodies that fall together to an attractor make no energy.
//
// Answer: what an attractor gives it takes back. It draws no harder than a substep follows; an
// island that is solved more finely goes on in the same well.
#include "cost/hard_cases/certified_pairs.hpp"
#include "cost/hard_cases/hard_cases.hpp"
#include "throng/energy_ledger.hpp"

#include <algorithm>

namespace throng {

namespace {

constexpr double kStrength = 8, kTime = 10;  // m3/s2, s
constexpr int kBodies = 32;

struct Heap {
    const char* setting;
    Vec3 off = Vec3::Zero();
    void (*choose)(Settings&) = [](Settings&) {};
};

Scene heap(const CaseBench& bench, const Heap& how, std::uint64_t seed)
{
    Random random(seed);
    SceneParts parts(bench.scene());
    Scene& scene = parts.scene();
    how.choose(scene.settings);
    const std::uint32_t material = parts.material(1);
    scene.materials[material].density = 360;
    parts.plane(material, Vec3::UnitZ(), how.off.z());
    Attractor attractor;
    for (int i = 0; i < 2; ++i) attractor.position[i] = random.uniform(-1, 1);
    attractor.position.z() = 0.7;
    attractor.position += how.off;
    attractor.strength = kStrength;
    scene.attractors.push_back(attractor);
    for (int i = 0; i < kBodies; ++i) {
        ShapeDescription shape;
        const std::uint32_t kind = random.below(3);
        if (kind == 0) shape.shape = BoxShape{Vec3(0.039, 0.018, 0.039)};
        if (kind > 0) shape.shape = SphereShape{kind == 1 ? 0.017 : 0.023};
        BodyDescription body;
        body.shape = static_cast<std::uint32_t>(scene.shapes.size());
        body.material = material;
        body.position =
            how.off + Vec3(0.15 * (i % 3 - 1), 0.15 * (i / 3 % 3 - 1), 0.3 + 0.15 * (i / 9));
        body.orientation = random_turn(random);
        scene.shapes.push_back(std::move(shape));
        scene.bodies.push_back(body);
    }
    return scene;
}

void fall_together(CaseBench& bench, const Heap& how)
{
    double worst = 0;
    const int scenes = bench.brief() ? 1 : 8;
    const auto watch = [](World&, double) { return true; };
    for (int seed = 0; seed < scenes; ++seed) {
        EnergyLedger ledger;
        bench.run(heap(bench, how, static_cast<std::uint64_t>(seed)), kTime, watch, &ledger);
        worst = std::max(worst, ledger.gained() / ledger.greatest_kinetic());
    }
    bench.report(how.setting, "energy gained over the greatest kinetic energy, the worst", worst,
                 0.1, "1");
}

}  // namespace

void case_attracted_heaps(CaseBench& bench)
{
    const Heap all[] = {
        {.setting = "default"},
        {.setting = "default, dt 1/240", .choose = [](Settings& s) { s.dt = 1.0 / 240; }},
        {.setting = "default, 16 substeps", .choose = [](Settings& s) { s.substeps = 16; }},
        {.setting = "default, 32 substeps", .choose = [](Settings& s) { s.substeps = 32; }},
        {.setting = "default, far off", .off = Vec3(3e4, -1e4, 2e4)},
        {.setting = "escalation=off",
         .choose = [](Settings& s) { s.escalation = Escalation::off; }},
        {.setting = "double", .choose = [](Settings& s) { s.precision = Precision::double_; }},
    };
    for (const Heap& how : all) {
        fall_together(bench, how);
        if (bench.brief()) return;
    }
}

}  // namespace throng
