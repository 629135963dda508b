// Pressed through: H110, what is not convex stays above a floor that has nothing behind it, however
// heavy what falls on it.
//
// A floor of triangles does not say how thick it is. Stars lie on it, and a box a thousand times as
// heavy comes down on them, so that for some steps they are driven in deeper than any body at rest.
#include "cost/hard_cases/hard_cases.hpp"
#include "scene/catalog/parts.hpp"
#include "scene/catalog/random.hpp"
#include "scene/catalog/sheets.hpp"
#include "throng/energy_ledger.hpp"
#include "throng/rotation.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace throng {

namespace {

constexpr double kLight = 0.7, kHeavy = 660;                     // kg
constexpr double kTip = 0.155, kNotch = 0.052, kHeight = 0.204;  // m, a star of five
constexpr int kTips = 5, kStars = 3;
constexpr double kLost = 0.5;  // m below the floor

constexpr double kBound = 0.01;
constexpr char kMetBy[] = "dt=1/60 by 4 substeps of soft_step";

struct How {
    const char* setting;
    void (*set)(Settings&) = [](Settings&) {};
    int seeds = 3;
    const char* met_by = kMetBy;
};

// A prism over a star of five.
MeshShape star()
{
    MeshShape mesh;
    for (const double z : {-kHeight / 2, kHeight / 2}) mesh.vertices.emplace_back(0, 0, z);
    for (int i = 0; i < 2 * kTips; ++i) {
        const SinCos at = sin_cos(kPi * i / kTips);
        const double radius = i % 2 == 0 ? kTip : kNotch;
        for (const double z : {-kHeight / 2, kHeight / 2})
            mesh.vertices.emplace_back(radius * at.cos, radius * at.sin, z);
    }
    for (std::uint32_t i = 0; i < 2 * kTips; ++i) {
        const std::uint32_t low = 2 + 2 * i, high = low + 1;
        const std::uint32_t next_low = 2 + 2 * ((i + 1) % (2 * kTips)), next_high = next_low + 1;
        mesh.triangles.push_back({0, next_low, low});
        mesh.triangles.push_back({1, high, next_high});
        mesh.triangles.push_back({low, next_low, next_high});
        mesh.triangles.push_back({low, next_high, high});
    }
    return mesh;
}

// One sheet, 96 m wide so that nobody slides off it, its corners up to `uneven` m high.
MeshShape sheet(double uneven, Random& random)
{
    constexpr int kCells = 12;
    constexpr double kCell = 8;  // m
    return mesh_shape(sheet_mesh(kCells, [&](int i, int k) {
        return Vec3(kCell * (i - kCells / 2) + 0.31, kCell * (k - kCells / 2) + 0.17,
                    random.uniform(0, uneven));
    }));
}

struct Heap {
    int lost = 0;       // stars below the floor at the end
    double gained = 0;  // energy, over what the box has to fall
};

Heap press(CaseBench& bench, const How& how, double drop, double uneven, int seed)
{
    Random random(static_cast<std::uint64_t>(seed));
    SceneParts parts(bench.scene());
    how.set(parts.scene().settings);
    const std::uint32_t material = parts.material(seed % 2 == 0 ? 0.1 : 0.5);
    BodyDescription floor;
    floor.material = material;
    floor.motion = Motion::static_;
    parts.add(sheet(uneven, random), floor);
    std::vector<std::uint32_t> stars;
    for (int i = 0; i < kStars; ++i) {
        BodyDescription light;
        light.material = material;
        light.mass = kLight;
        light.position =
            Vec3(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), uneven + 0.2 + 0.35 * i);
        light.orientation = random_turn(random, kPi);
        stars.push_back(parts.add(star(), light));
    }
    const Quat turn = seed % 2 == 0 ? Quat(Quat::Identity()) : random_turn(random, kPi);
    const double height = uneven + 2.3 + drop;
    parts.box(material, kHeavy, Vec3(0.7, 0.73, 1.19), {Vec3(0, 0, height), turn});
    Heap heap;
    EnergyLedger ledger;
    bench.run(
        parts.scene(), bench.brief() ? 1 : 3,
        [&](World& world, double) {
            heap.lost = 0;
            const std::vector<BodyId> ids = world.bodies();
            for (const std::uint32_t one : stars)
                heap.lost += world.pose(ids[one]).position.z() < -kLost ? 1 : 0;
            return true;
        },
        &ledger);
    heap.gained = ledger.gained() / (kHeavy * kGravity * height);
    return heap;
}

}  // namespace

void case_pressed_through(CaseBench& bench)
{
    const How hows[] = {
        {"default", [](Settings&) {}, 10, ""},
        {"default, dt 1/240", [](Settings& s) { s.dt = 1.0 / 240; }},
        {"1 substep", [](Settings& s) { s.substeps = 1; }},
        {"16 substeps", [](Settings& s) { s.substeps = 16; }},
        {"pgs", [](Settings& s) { s.solver = Solver::pgs; }},
        {"escalation off", [](Settings& s) { s.escalation = Escalation::off; }},
        {"spheres", [](Settings& s) { s.nonconvex = NonConvex::spheres; }},
        {"parts", [](Settings& s) { s.nonconvex = NonConvex::parts; }, 1},
        {"depth_image", [](Settings& s) { s.nonconvex = NonConvex::depth_image; }, 1},
    };
    for (const How& how : hows) {
        int lost = 0, all = 0;
        double gained = 0;
        for (const double drop : {0.0, 3.0, 12.0})
            for (const double uneven : {0.0, 0.3})
                for (int seed = 0; seed < (bench.brief() ? 1 : how.seeds); ++seed) {
                    if (bench.brief() && drop + uneven > 0) continue;
                    const Heap heap = press(bench, how, drop, uneven, seed);
                    lost += heap.lost;
                    gained = std::max(gained, heap.gained);
                    all += kStars;
                }
        const auto judge = [&](const char* quantity, double figure) {
            bench.report_default(how.setting, quantity, figure, kBound, "1", how.met_by);
        };
        judge("stars pressed through the floor, of all", static_cast<double>(lost) / all);
        judge("energy made, over what the box has to fall", gained);
        if (bench.brief()) return;
    }
}

}  // namespace throng
