// Pebbles: H94, small hulls of many sides fall on a floor of any kind and stay on it.
//
// Answer: none is below the floor, or deep in it. In a step they fall by as much as they are thick,
// and tip from one side to another that nothing has held yet.
#include "cost/hard_cases/certified_pairs.hpp"
#include "cost/hard_cases/floors.hpp"
#include "cost/hard_cases/hard_cases.hpp"
#include "throng/world.hpp"

#include <algorithm>

namespace throng {

namespace {

constexpr double kTime = 3;        // s
constexpr double kThickness = 1;   // m, a floor's, half of it
constexpr double kDensity = 3000;  // kg/m3
constexpr std::uint32_t kCount = 30;

struct Fall {
    const char* how = "";
    double size = 0.012;  // m
    double friction = 0.5;
    Vec3 at = Vec3::Zero();
    bool last = false;  // the floor is made after them
    void (*choose)(Settings&) = [](Settings&) {};
};

HullShape pebble(Random& random, double size)
{
    Vec3 half;
    for (int i = 0; i < 3; ++i) half[i] = random.uniform(0.4, 1.1) * size;
    HullShape hull;
    for (int i = 0; i < 24; ++i) {
        Vec3 point;
        for (int k = 0; k < 3; ++k) point[k] = random.uniform(-half[k], half[k]);
        hull.points.push_back(point);
    }
    return hull;
}

void put_pebbles(SceneParts& parts, std::uint32_t material, Random& random, const Fall& fall)
{
    std::vector<std::uint32_t> kinds;
    for (std::uint32_t i = 0; i < kCount; ++i) {
        const double apart = 6 * fall.size;
        const auto place = [&](std::uint32_t k) { return apart * (k - 1.0); };
        BodyDescription body;
        body.material = material;
        body.position =
            fall.at + Vec3(place(i % 3), place(i / 3 % 3), 1.25 * apart + apart * (i / 9));
        body.orientation = random_turn(random);
        Scene& scene = parts.scene();
        body.shape = i < 4 ? static_cast<std::uint32_t>(scene.shapes.size()) : kinds[i % 4];
        if (i < 4) {
            scene.shapes.push_back({"pebble" + std::to_string(i), pebble(random, fall.size)});
            kinds.push_back(body.shape);
        }
        scene.bodies.push_back(body);
    }
}

const std::vector<Vec3>& points_of(const Scene& scene, std::uint32_t id)
{
    return std::get<HullShape>(scene.shapes[scene.bodies[id].shape].shape).points;
}

void let_fall(CaseBench& bench, Floor floor, const Fall& fall)
{
    const bool hilly = floor == Floor::grid;
    const FloorSize size{200 * fall.size, kThickness, 17, hilly ? 1.5 * fall.size : 0};
    int below = 0;
    double deepest = 0, dt = 0;
    const int scenes = bench.brief() ? 2 : 12;
    for (int seed = 0; seed < scenes; ++seed) {
        Random random(static_cast<std::uint64_t>(seed));
        SceneParts parts(bench.scene());
        fall.choose(parts.scene().settings);
        dt = parts.scene().settings.dt;
        const std::uint32_t material = parts.material(fall.friction);
        parts.scene().materials[material].density = kDensity;
        const Pose frame{fall.at, Quat::Identity()};
        if (!fall.last) put_floor(parts, material, floor, frame, size);
        const auto first = static_cast<std::uint32_t>(parts.scene().bodies.size());
        put_pebbles(parts, material, random, fall);
        if (fall.last) put_floor(parts, material, floor, frame, size);
        int now_below = 0;
        bench.run(parts.scene(), kTime, [&](World& world, double now) {
            now_below = 0;
            for (std::uint32_t i = first; i < first + kCount; ++i) {
                Pose pose = world.pose(world.bodies()[i]);
                pose.position -= fall.at;
                const double beside = pose.position.head<2>().cwiseAbs().maxCoeff();
                if (beside > size.wide - fall.size) continue;
                const double depth = -lowest_of(points_of(parts.scene(), i), pose);
                // As they land they turn by radians in a step.
                if (now > kTime / 2) deepest = std::max(deepest, depth);
                // All of it, and a grid's corners are above 0.
                now_below += depth > 3 * fall.size ? 1 : 0;
            }
            return true;
        });
        below += now_below;
    }
    const std::string setting = std::string(name_of(floor)) + fall.how;
    bench.report(setting, "hulls below the floor after 3 s", below, 0, "1");
    if (!hilly)
        bench.report(setting, "deepest point in the floor from 1.5 s on over their size",
                     deepest / fall.size, dt > 0.02 ? 1 : 0.3, "1");
}

}  // namespace

void case_pebbles(CaseBench& bench)
{
    constexpr auto slowly = [](Settings& settings) { settings.dt = 1.0 / 30; };
    const Fall falls[] = {
        {},
        {.how = ", smooth, dt 1/30", .friction = 0, .choose = slowly},
        {.how = ", dt 1/30", .choose = slowly},
        {.how = ", smooth", .friction = 0},
        {.how = ", smooth, of 4 cm", .size = 0.04, .friction = 0},
        {.how = ", of 3 mm", .size = 0.003},
        {.how = ", dt 1/240", .choose = [](Settings& settings) { settings.dt = 1.0 / 240; }},
        {.how = ", dt 1e-3", .choose = [](Settings& settings) { settings.dt = 1e-3; }},
        {.how = ", 16 substeps", .choose = [](Settings& settings) { settings.substeps = 16; }},
        {.how = ", double", .choose = [](Settings& s) { s.precision = Precision::double_; }},
        {.how = ", pgs", .choose = [](Settings& settings) { settings.solver = Solver::pgs; }},
        {.how = ", direct", .choose = ask_exactly},
        {.how = ", far off", .at = Vec3(3e4, -1e4, 2e4)},
        {.how = ", made last", .last = true},
    };
    for (const Floor floor : kFloorsAndGrid)
        for (std::size_t i = 0; i < (bench.brief() ? 2 : std::size(falls)); ++i)
            let_fall(bench, floor, falls[i]);
}

}  // namespace throng
