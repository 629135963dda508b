// Stacked parts: H114, bodies of several boxes, one on another as one sets them down by hand, and
// strewn on a floor.
//
// Answer: they stand where they were set down, at rest; and lie on the floor, not in it.
//
// Each part of the one meets each part of the other. Of so many points in one plane every one bears
// the load by turns, and what sways does not come to rest.
#include "cost/hard_cases/floors.hpp"
#include "cost/hard_cases/hard_cases.hpp"
#include "scene/catalog/parts.hpp"
#include "scene/catalog/random.hpp"
#include "throng/rotation.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace throng {

namespace {

constexpr double kHalf = 0.25, kGap = 3e-3, kAside = 0.02, kTurn = 0.02;  // m, m, m, rad
constexpr double kMass = 500, kSeconds = 10;                              // kg, s
constexpr double kStill = 1e-3, kMoved = 0.01;                            // m/s, m
constexpr int kBodies[] = {3, 6, 10};
// Those that are strewn are a tenth as large: many, as few come to lie on a corner and no more.
constexpr double kSmall = 0.1, kDeep = 1e-3;  // 1, m
constexpr int kStrewn = 40;
constexpr FloorSize kFloor{2, 0.05, 40};

struct How {
    const char* setting;
    void (*set)(Settings&) = [](Settings&) {};
    const char* met_by = "";
    int draws = 4;
    bool last_first = false;
    Vec3 far = Vec3::Zero();
};

struct Part {
    Vec3 half_extents, at;
};

struct Kind {
    const char* name;
    std::vector<Part> parts;
};

std::vector<Kind> kinds()
{
    std::vector<Kind> all = {
        {"crosses", {{{1, 0.25, kHalf}, {0, 0, 0}}, {{0.25, 1, kHalf}, {0, 0, 0}}}},
        {"tees", {{{1, 0.25, kHalf}, {0, 0, 0}}, {{0.25, 0.8, kHalf}, {1, 0, 0}}}},
        {"frames",
         {{{0.8, 0.15, kHalf}, {0, -0.65, 0}},
          {{0.8, 0.15, kHalf}, {0, 0.65, 0}},
          {{0.15, 0.5, kHalf}, {-0.65, 0, 0}},
          {{0.15, 0.5, kHalf}, {0.65, 0, 0}}}},
        {"tables", {{{0.8, 0.6, 0.05}, {0, 0, 0.2}}}},
    };
    for (const double x : {-0.7, 0.7})
        for (const double y : {-0.5, 0.5})
            all.back().parts.push_back({{0.06, 0.06, 0.2}, {x, y, -0.05}});
    return all;
}

struct End {
    double speed = 0, moved = 0;  // m/s, by mass; m, of the one that moved most
};

CompoundShape add_parts(Scene& scene, const Kind& kind, double scale)
{
    CompoundShape shape;
    for (const Part& part : kind.parts) {
        const auto place = static_cast<std::uint32_t>(scene.shapes.size());
        shape.parts.push_back({place, {scale * part.at, Quat::Identity()}});
        scene.shapes.push_back(
            {"part" + std::to_string(place), BoxShape{scale * part.half_extents}});
    }
    return shape;
}

// m, the greatest overlap once bodies lie that fell apart from one another, in any pose.
double strew(CaseBench& bench, const How& how, const Kind& kind, Floor floor, double restitution)
{
    Random random(1);
    SceneParts parts(bench.scene());
    Scene& scene = parts.scene();
    how.set(scene.settings);
    const std::uint32_t material = parts.material(0.5, restitution);
    put_floor(parts, material, floor, {how.far, Quat::Identity()}, kFloor);
    const CompoundShape shape = add_parts(scene, kind, kSmall);
    for (int i = 0; i < kStrewn; ++i) {
        BodyDescription body;
        body.material = material;
        body.mass = kMass * kSmall * kSmall * kSmall;
        body.position = how.far + kSmall * Vec3(4 * (i % 8) - 14, 4 * (i / 8) - 8, 1.5);
        body.orientation = random_turn(random, kPi);
        parts.add(shape, body);
    }
    double overlap = 0;
    bench.run(scene, bench.brief() ? 2 : kSeconds, [&](World& world, double) {
        overlap = world.measure().greatest_overlap;
        return true;
    });
    bench.forgive_residual();  // of the steps in which they land
    return overlap;
}

End stand(CaseBench& bench, const How& how, const Kind& kind, int bodies, int draw)
{
    Random random(static_cast<std::uint64_t>(draw));
    SceneParts parts(bench.scene());
    Scene& scene = parts.scene();
    how.set(scene.settings);
    scene.settings.sleep = false;
    const std::uint32_t material = parts.material(0.3 + 0.3 * (draw % 3));
    parts.plane(material, Vec3::UnitZ(), how.far.z());
    const CompoundShape shape = add_parts(scene, kind, 1);
    std::vector<Vec3> places;
    for (int i = 0; i < bodies; ++i) {
        const double x = random.uniform(-kAside, kAside), y = random.uniform(-kAside, kAside);
        places.emplace_back(how.far + Vec3(x, y, kHalf + (2 * kHalf + kGap) * i));
    }
    for (int i = 0; i < bodies; ++i) {
        BodyDescription body;
        body.material = material;
        body.mass = kMass;
        body.position = places[static_cast<std::size_t>(how.last_first ? bodies - 1 - i : i)];
        body.orientation = exponential(Vec3(0, 0, random.uniform(-kTurn, kTurn)));
        parts.add(shape, body);
    }
    End end;
    bench.run(scene, bench.brief() ? 2 : kSeconds, [&](World& world, double) {
        end = {};
        double square = 0;
        std::vector<Vec3> now;
        for (const BodyId body : world.bodies()) {
            if (world.motion(body) != Motion::dynamic) continue;
            square += world.velocity(body).squaredNorm();
            now.push_back(world.pose(body).position);
        }
        end.speed = std::sqrt(square / bodies);
        for (int i = 0; i < bodies; ++i) {
            const int at = how.last_first ? bodies - 1 - i : i;
            // They have come down by the gaps.
            const Vec3 place = places[static_cast<std::size_t>(at)] - Vec3(0, 0, kGap * at);
            end.moved = std::max(end.moved, (now[static_cast<std::size_t>(i)] - place).norm());
        }
        return true;
    });
    return end;
}

}  // namespace

void case_stacked_parts(CaseBench& bench)
{
    const How hows[] = {
        {"default"},
        {"default, dt 1/240", [](Settings& s) { s.dt = 1.0 / 240; }, "", 2},
        {"1 substep", [](Settings& s) { s.substeps = 1; }, "substeps=4", 2},
        {"16 substeps", [](Settings& s) { s.substeps = 16; }, "", 2},
        {"pgs", [](Settings& s) { s.solver = Solver::pgs; }, "solver=soft_step", 2},
        {"direct", [](Settings& s) { s.solver = Solver::direct; }, "", 1},
        {"points", [](Settings& s) { s.friction_at = FrictionAt::points; }, "", 2},
        {"default, last first", [](Settings&) {}, "", 2, true},
        {"default, far off", [](Settings&) {}, "", 2, false, Vec3(3e6, -2e6, 0)},
    };
    for (const How& how : hows) {
        for (const Kind& kind : kinds()) {
            End worst;
            for (const int bodies : kBodies)
                for (int draw = 0; draw < (bench.brief() ? 1 : how.draws); ++draw) {
                    if (bench.brief() && bodies != kBodies[1]) continue;
                    const End end = stand(bench, how, kind, bodies, draw);
                    worst.speed = std::max(worst.speed, end.speed);
                    worst.moved = std::max(worst.moved, end.moved);
                }
            const auto judge = [&](const char* quantity, double figure, double bound,
                                   const char* unit) {
                bench.report_default(how.setting, std::string(kind.name) + ": " + quantity, figure,
                                     bound, unit, how.met_by);
            };
            judge("speed at the end", worst.speed, kStill, "m/s");
            judge("way from where it was set down", worst.moved, kMoved, "m");
            for (const Floor floor : {Floor::plane, Floor::tiles}) {
                const double overlap = std::max(strew(bench, how, kind, floor, 0),
                                                strew(bench, how, kind, floor, 0.1));
                judge(floor == Floor::plane ? "strewn, overlap at the end"
                                            : "strewn on tiles, overlap at the end",
                      overlap, kDeep, "m");
            }
        }
        if (bench.brief()) return;
    }
}

}  // namespace throng
