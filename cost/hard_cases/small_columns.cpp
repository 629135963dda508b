// Small columns: H91, heaps of small bodies of unlike weight fall on a floor as one column.
//
// Answer: they make no energy. Within a step of theirs a small body goes many times its size: the
// heavy one that it met at the start, and that turns, takes it nowhere any more.
#include "cost/hard_cases/certified_pairs.hpp"
#include "cost/hard_cases/hard_cases.hpp"
#include "throng/energy_ledger.hpp"

#include <algorithm>

namespace throng {

namespace {

constexpr double kDensity = 130;  // kg/m3

struct Columns {
    const char* setting;
    double dt = 1.0 / 60;  // s
    double scale = 1;      // of lengths, and of the square of speeds
    double spin = 0;       // rad/s, of the first of each
    Vec3 off = Vec3::Zero();
    const char* met_by = nullptr;  // the setting that meets the bound where this one does not
    void (*choose)(Settings&) = [](Settings&) {};
};

// A ball, a capsule or a box, of 1 to 11 times the mass of the least.
BodyDescription piece(Scene& scene, Random& random, double scale)
{
    const std::uint32_t kind = random.below(3);
    ShapeDescription shape;
    if (kind == 0) shape.shape = SphereShape{0.012 * scale};
    if (kind == 1) shape.shape = CapsuleShape{0.018 * scale, 0.027 * scale};
    if (kind == 2) shape.shape = BoxShape{Vec3(0.01, 0.014, 0.02) * scale};
    BodyDescription body;
    body.shape = static_cast<std::uint32_t>(scene.shapes.size());
    body.material = 0;
    scene.shapes.push_back(std::move(shape));
    return body;
}

Scene column(const CaseBench& bench, const Columns& all, std::uint64_t seed)
{
    Random random(seed);
    SceneParts parts(bench.scene());
    Scene& scene = parts.scene();
    scene.settings.dt = all.dt;
    all.choose(scene.settings);
    scene.materials[parts.material(1.1)].density = kDensity;
    parts.plane(0, Vec3::UnitZ(), all.off.z());
    const double spacings[] = {0.06, 0.09, 0.3, 0.5};  // m
    const double spacing = spacings[random.below(4)];
    for (int i = 0; i < 12; ++i) {
        BodyDescription body = piece(scene, random, all.scale);
        const double x = random.uniform(-0.02, 0.02), y = random.uniform(-0.02, 0.02);
        body.position = all.off + all.scale * Vec3(x, y, 0.03 + spacing * i);
        body.orientation = random_turn(random);
        if (i > 0) body.velocity = Vec3(0, 0, -random.uniform(0, 4) * std::sqrt(all.scale));
        if (i == 0) body.angular_velocity = random_turn(random) * Vec3(all.spin, 0, 0);
        scene.bodies.push_back(body);
    }
    return scene;
}

void fall(CaseBench& bench, const Columns& all)
{
    double worst = 0;
    const int scenes = bench.brief() ? 2 : 150;
    const auto watch = [](World&, double) { return true; };
    for (int seed = 0; seed < scenes; ++seed) {
        EnergyLedger ledger;
        bench.run(column(bench, all, static_cast<std::uint64_t>(seed)), 1, watch, &ledger);
        bench.forgive_residual();
        worst = std::max(worst, ledger.gained() / ledger.greatest_kinetic());
    }
    const char* what = "energy gained over the greatest kinetic energy, the worst";
    if (all.met_by == nullptr) return bench.report(all.setting, what, worst, 0.01, "1");
    bench.report_default(all.setting, what, worst, 0.01, "1", all.met_by);
}

}  // namespace

void case_small_columns(CaseBench& bench)
{
    const auto more = [](Settings& settings) { settings.substeps = 16; };
    const auto plain = [](Settings& settings) { settings.escalation = Escalation::off; };
    const auto finely = [](Settings& settings) { settings.precision = Precision::double_; };
    const auto plainly = [](Settings& settings) { settings.solver = Solver::pgs; };
    const auto plainly_in_more = [](Settings& settings) {
        settings.solver = Solver::pgs;
        settings.substeps = 16;
        settings.push_limit = 0.1;
    };
    const auto at_points = [](Settings& settings) { settings.friction_at = FrictionAt::points; };
    const double slow = 1.0 / 30;  // s
    const Columns all[] = {
        {.setting = "default"},
        {.setting = "default, dt=1/30", .dt = slow},
        {.setting = "default, dt=1/30, ten times as large", .dt = slow, .scale = 10},
        {.setting = "default, a tenth as large", .scale = 0.1},
        {.setting = "default, dt=1/30, a tenth as large",
         .dt = slow,
         .scale = 0.1,
         .met_by = "dt=1/60"},
        {.setting = "default, dt=1/30, far off", .dt = slow, .off = Vec3(1e5, -2e5, 3e5)},
        {.setting = "default, dt=1/30, the first spins", .dt = slow, .spin = 100},
        {.setting = "default, the first spins", .spin = 100},
        {.setting = "default, 16 substeps", .choose = more},
        {.setting = "double, dt=1/30", .dt = slow, .choose = finely},
        {.setting = "escalation=off, dt=1/30", .dt = slow, .choose = plain},
        {.setting = "friction at points, dt=1/30", .dt = slow, .choose = at_points},
        {.setting = "pgs, dt=1/30", .dt = slow, .choose = plainly},
        {.setting = "pgs, 16 substeps, push_limit=0.1", .choose = plainly_in_more},
        {.setting = "direct, dt=1/30", .dt = slow, .choose = ask_exactly},
    };
    for (const Columns& columns : all) fall(bench, columns);
}

}  // namespace throng
