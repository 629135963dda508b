// Leaning planks: H105, what leans edge against edge stands where friction is enough, and no
// longer.
//
// Answer: of two planks of half length l and half thickness t that lean on one another at an angle
// a from upright, the edges press straight across, without friction, and the floor holds the feet
// from a coefficient of (tan a - t / l) / 2 on (moments about a foot).
//
// Any normal between the faces beside the edges would do as well for all that a depth of overlap
// tells. Planks are boxes and hulls, thin and thick, each drawn a hair off its place.
#include "cost/hard_cases/hard_cases.hpp"
#include "scene/catalog/parts.hpp"
#include "throng/rotation.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <string>

namespace throng {

namespace {

constexpr double kStands = 10, kMoves = 0.02;  // s; of half the length
constexpr double kHalf = 0.5;                  // m
constexpr double kOff = 1e-6;                  // m, of what is drawn

enum class Made { boxes, hulls, both };

struct Frame {
    double lean;       // rad, from upright
    double thickness;  // half of it, m
    Made made = Made::boxes;
};

struct How {
    const char* setting;
    void (*set)(Settings&) = [](Settings&) {};
    Pose place = {};
};

double friction_needed(const Frame& frame)
{
    return (std::tan(frame.lean) - frame.thickness / kHalf) / 2;
}

void add_plank(const Vec3& half, bool hull, std::uint32_t material, const Pose& at, SceneParts& to)
{
    if (!hull) {
        to.box(material, 1, half, at);
        return;
    }
    HullShape shape;
    for (int corner = 0; corner < 8; ++corner)
        shape.points.emplace_back((corner & 1 ? 1 : -1) * half.x(),
                                  (corner & 2 ? 1 : -1) * half.y(),
                                  (corner & 4 ? 1 : -1) * half.z());
    to.hull(material, 1, std::move(shape), at);
}

Scene frame_of(
    const CaseBench& bench, const Frame& frame, double friction, const How& how, int seed)
{
    SceneParts parts(bench.scene());
    how.set(parts.scene().settings);
    parts.scene().settings.sleep = false;
    const std::uint32_t material = parts.material(friction);
    parts.plane(material, Vec3::UnitZ(), 0);
    Random random(static_cast<std::uint64_t>(seed));
    const Vec3 half(kHalf, 0.2, frame.thickness);
    const double sin = std::sin(frame.lean), cos = std::cos(frame.lean);
    for (const double side : {-1.0, 1.0}) {
        const Vec3 middle(side * (half.x() * sin + half.z() * cos), 0,
                          half.x() * cos + half.z() * sin);
        const Pose at{middle + random_vector(random, -kOff, kOff),
                      exponential(Vec3(0, -side * frame.lean - kPi / 2, 0))};
        const bool hull = frame.made == Made::hulls || (frame.made == Made::both && side > 0);
        add_plank(half, hull, material, how.place * at, parts);
    }
    return parts.scene();
}

bool stands(CaseBench& bench, const Scene& scene)
{
    std::vector<Vec3> first;
    bench.inspect(scene, [&](const World& world) {
        for (const BodyId body : world.bodies()) first.push_back(world.pose(body).position);
    });
    double moved = 0;
    bench.run(scene, kStands, [&](World& world, double) {
        const std::vector<BodyId> bodies = world.bodies();
        for (std::size_t i = 0; i < bodies.size(); ++i)
            moved = std::max(moved, (world.pose(bodies[i]).position - first[i]).norm());
        return moved < kMoves * kHalf;
    });
    return moved < kMoves * kHalf;
}

}  // namespace

void case_leaning_planks(CaseBench& bench)
{
    constexpr double kDegree = kPi / 180;
    const How hows[] = {
        {"default"},
        {"default, dt 1/240", [](Settings& s) { s.dt = 1.0 / 240; }},
        {"direct, double",
         [](Settings& s) {
             s.solver = Solver::direct;
             s.precision = Precision::double_;
         }},
        {"pgs", [](Settings& s) { s.solver = Solver::pgs; }},
        {"double", [](Settings& s) { s.precision = Precision::double_; }},
        {"default, turned, far off",
         [](Settings&) {},
         {Vec3(700, -300, 0), exponential(Vec3(0, 0, 0.7))}},
    };
    const double leans[] = {25 * kDegree, 15 * kDegree, 40 * kDegree};
    for (const How& how : std::span(hows).first(bench.brief() ? 1 : std::size(hows))) {
        int fell = 0, stood = 0;
        for (const double lean : std::span(leans).first(bench.brief() ? 1 : std::size(leans)))
            for (const double thickness : {0.0025, 0.05})
                for (const Made made : {Made::boxes, Made::hulls, Made::both}) {
                    const Frame frame{lean, thickness, made};
                    for (int seed = 1; seed <= (bench.brief() ? 1 : 4); ++seed) {
                        const double needed = friction_needed(frame);
                        fell +=
                            stands(bench, frame_of(bench, frame, 1.1 * needed, how, seed)) ? 0 : 1;
                        stood +=
                            stands(bench, frame_of(bench, frame, 0.9 * needed, how, seed)) ? 1 : 0;
                    }
                }
        bench.report(how.setting, "frames that slide apart by 1.1 times the friction needed", fell,
                     0, "1");
        bench.report(how.setting, "frames that stand by 0.9 times the friction needed", stood, 0,
                     "1");
    }
}

}  // namespace throng
