// Small structures: H123, walls, towers, pyramids and blocks of hundreds of small pieces stand.
//
// Answer: where they were built, but for what their load makes them give.
//
// Soft contacts give way by what bears on them, and a piece falls by more than a hair in a step:
// the smaller the pieces, the more of them one on another, the sooner they sink into one another,
// come back, and are thrown off. Great islands are escalated as small ones are, to four times the
// substeps.
#include "cost/hard_cases/hard_cases.hpp"
#include "throng/rotation.hpp"

#include <cmath>
#include <iterator>
#include <numbers>
#include <span>
#include <string>
#include <vector>

namespace throng {

namespace {

constexpr double kSeconds = 10, kBriefSeconds = 2;
// m/s; of the height of the structure; of the height of a piece.
constexpr double kRests = 1e-3, kMoved = 0.01, kDeep = 0.05;
constexpr double kBrickMass = 2.16;  // kg
const Vec3 kBrick(0.1, 0.05, 0.03);  // m, half extents, as those below
const Vec3 kBlockOfTower(0.0375, 0.0125, 0.0075);

struct How {
    const char* setting;
    void (*set)(Settings&) = [](Settings&) {};
    Pose place = {};
    bool from_above = false;
    const char* met_by = "";  // what holds what it does not; else empty
};

// What is built of equal boxes.
struct Structure {
    std::string name;
    double mass = 0;
    Vec3 half;                // m, of a piece
    std::vector<Pose> poses;  // from below
    bool always = false;      // by all settings, not by the default alone
};

Quat about_z(double angle) { return exponential(Vec3(0, 0, angle)); }

Structure brick_wall(int courses, int bricks, bool always)
{
    Structure wall{
        "wall of " + std::to_string(courses) + " courses", kBrickMass, kBrick, {}, always};
    for (int k = 0; k < courses; ++k)
        for (int i = 0; i < bricks; ++i)
            wall.poses.push_back(
                {Vec3(0.202 * i + 0.07 * (k % 2), 0, 0.03 + 0.06 * k), Quat::Identity()});
    return wall;
}

Structure round_tower()
{
    Structure tower{"round tower of 40 courses", kBrickMass, kBrick, {}};
    constexpr int kRound = 28;
    for (int k = 0; k < 40; ++k)
        for (int i = 0; i < kRound; ++i) {
            const double angle = 2 * std::numbers::pi * (i + 0.5 * (k % 2)) / kRound;
            tower.poses.push_back({Vec3(std::cos(angle), std::sin(angle), 0.03 + 0.06 * k),
                                   about_z(angle + std::numbers::pi / 2)});
        }
    return tower;
}

// Three blocks a level, crosswise.
Structure tower_of_blocks()
{
    Structure tower{"tower of 162 blocks", 0.0169, kBlockOfTower, {}, true};
    for (int k = 0; k < 54; ++k)
        for (int i = -1; i <= 1; ++i) {
            const double aside = 0.025 * i, up = 0.0075 + 0.015 * k;
            if (k % 2 == 0)
                tower.poses.push_back({Vec3(0, aside, up), Quat::Identity()});
            else
                tower.poses.push_back({Vec3(aside, 0, up), about_z(std::numbers::pi / 2)});
        }
    return tower;
}

Structure pyramid()
{
    Structure pyramid{"pyramid of 465 cubes", 0.064, Vec3::Constant(0.02), {}, true};
    for (int k = 0; k < 30; ++k)
        for (int i = 0; i < 30 - k; ++i)
            pyramid.poses.push_back(
                {Vec3(0.041 * (i - (29 - k) / 2.0), 0, 0.02 + 0.04 * k), Quat::Identity()});
    return pyramid;
}

// So near that they are one island.
Structure stacks(const char* name, double half, double mass, int across, int deep, int high)
{
    Structure stacks{name, mass, Vec3::Constant(half), {}};
    for (int k = 0; k < high; ++k)
        for (int i = 0; i < across; ++i)
            for (int j = 0; j < deep; ++j)
                stacks.poses.push_back(
                    {Vec3(2.02 * half * i, 2.02 * half * j, half * (2 * k + 1)), Quat::Identity()});
    return stacks;
}

Scene built(const CaseBench& bench, const Structure& structure, const How& how)
{
    SceneParts parts(bench.scene());
    how.set(parts.scene().settings);
    parts.level_ground(parts.material(0.5), how.place);
    const std::size_t count = structure.poses.size();
    for (std::size_t i = 0; i < count; ++i)
        parts.box(0, structure.mass, structure.half,
                  how.place * structure.poses[how.from_above ? count - 1 - i : i]);
    return parts.scene();
}

}  // namespace

void case_small_structures(CaseBench& bench)
{
    const How hows[] = {
        {"default"},
        {"default, turned, far off",
         [](Settings&) {},
         {Vec3(70, -30, 0), exponential(Vec3(0.3, 0.6, 0.9))}},
        {"default, made from above", [](Settings&) {}, {}, true},
        {"default, no sleep", [](Settings& s) { s.sleep = false; }},
        {"dt 1/240", [](Settings& s) { s.dt = 1.0 / 240; }},
        {"16 substeps", [](Settings& s) { s.substeps = 16; }},
        {"1 substep", [](Settings& s) { s.substeps = 1; }, {}, false, "default"},
        {"pgs", [](Settings& s) { s.solver = Solver::pgs; }, {}, false, "default"},
        {"double", [](Settings& s) { s.precision = Precision::double_; }},
    };
    const double seconds = bench.brief() ? kBriefSeconds : kSeconds;
    std::vector<Structure> structures;
    structures.push_back(tower_of_blocks());
    if (!bench.brief()) {
        structures.push_back(pyramid());
        structures.push_back(brick_wall(30, 20, true));
        structures.push_back(brick_wall(100, 20, false));
        structures.push_back(round_tower());
        structures.push_back(stacks("12 stacks of 30 boxes", 0.1, 8, 12, 1, 30));
        structures.push_back(stacks("64 stacks of 15 boxes", 0.05, 1, 8, 8, 15));
    }
    for (const How& how : std::span(hows).first(bench.brief() ? 1 : std::size(hows)))
        for (const Structure& structure : structures) {
            if (!structure.always && &how != hows) continue;
            const Stands stands = stand_for(bench, built(bench, structure, how), seconds);
            bench.forgive_residual();
            const double height = structure.poses.back().position.z();
            const std::string of = structure.name + ": ";
            const auto tell = [&](const char* what, double value, double bound, const char* unit) {
                bench.report_default(how.setting, of + what, value, bound, unit, how.met_by);
            };
            tell("fastest", stands.speed, kRests, "m/s");
            tell("moved, over its height", stands.moved / height, kMoved, "1");
            tell("overlap, over a piece's height", stands.deep / (2 * structure.half.z()), kDeep,
                 "1");
        }
}

}  // namespace throng
