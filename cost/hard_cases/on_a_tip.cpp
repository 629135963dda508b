// On a tip: H115, tops, posts and poles on pivots at their feet, on a floor, and balls that fall on
// them.
//
// Answers: no energy is made; and a floor under the tip of a top changes nothing in how it falls.
//
// Next to its pivot a body neither comes nearer to a floor nor leaves it, however it turns: what
// separation is told there is rounding, and to part the two it would have to spin without end.
#include "cost/hard_cases/floors.hpp"
#include "cost/hard_cases/hard_cases.hpp"
#include "scene/catalog/parts.hpp"
#include "scene/catalog/random.hpp"
#include "throng/rotation.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace throng {

namespace {

constexpr double kSize = 0.5;                      // m, from the foot to the middle
constexpr double kMade = 1e-3, kAngle = 1e-3;      // 1, rad
constexpr double kSeconds = 6, kFalls = 0.6;       // s
constexpr double kLeans = 0.3, kLeansAlone = 0.1;  // rad, of a top at first
constexpr int kBalls = 3, kRim = 9;
constexpr Floor kFloorsUnder[] = {Floor::plane, Floor::box, Floor::mesh, Floor::tiles};

struct How {
    const char* setting;
    void (*set)(Settings&) = [](Settings&) {};
    const char* met_by = "";
    double size = kSize;
    bool last_first = false;
    Vec3 far = Vec3::Zero();
};

struct Kind {
    const char* name;
    decltype(ShapeDescription::shape) shape;
    std::vector<double> leans;  // rad
};

std::vector<Kind> kinds(double size)
{
    HullShape top;
    top.points.emplace_back(0, 0, -size);
    for (int i = 0; i < kRim; ++i) {
        const SinCos at = sin_cos(2 * kPi * i / kRim);
        top.points.emplace_back(0.4 * size * at.cos, 0.4 * size * at.sin, size / 2);
    }
    return {{"tops", top, {0, kLeans}},
            {"posts", CylinderShape{0.4 * size, size}, {0}},
            {"poles", BoxShape{Vec3(0.3 * size, 0.3 * size, size)}, {0}}};
}

BodyDescription on_its_foot(const How& how, std::uint32_t material, double lean)
{
    BodyDescription body;
    body.material = material;
    body.mass = how.size * how.size * how.size * 800;
    body.orientation = exponential(Vec3(lean, 0, 0));
    body.position = how.far + body.orientation * Vec3(0, 0, how.size);
    body.pivot = Vec3(0, 0, -how.size);
    return body;
}

void hit(CaseBench& bench,
         const How& how,
         const Kind& kind,
         double lean,
         Floor floor,
         double restitution,
         double& worst)
{
    Random random(1);
    SceneParts parts(bench.scene());
    how.set(parts.scene().settings);
    const double size = how.size, radius = 0.3 * size;
    const std::uint32_t material = parts.material(0.6, restitution);
    put_floor(parts, material, floor, {how.far, Quat::Identity()}, {40 * size, size, 9});
    std::vector<Vec3> places;
    for (int i = 0; i < kBalls; ++i) {
        const double x = random.uniform(-0.1, 0.1), y = random.uniform(-0.1, 0.1);
        places.push_back(how.far + size * Vec3(x, y, 3 + 1.1 * i));
    }
    if (!how.last_first) parts.add(kind.shape, on_its_foot(how, material, lean));
    for (int i = 0; i < kBalls; ++i) {
        const int at = how.last_first ? kBalls - 1 - i : i;
        const std::uint32_t ball = parts.ball(material, 800 * 4 * radius * radius * radius, radius,
                                              places[static_cast<std::size_t>(at)]);
        parts.body(ball).velocity = Vec3(0, 0, -3);
    }
    if (how.last_first) parts.add(kind.shape, on_its_foot(how, material, lean));
    worst = std::max(worst, energy_made(bench, parts.scene(), bench.brief() ? 1 : kSeconds));
    bench.forgive_residual();
}

// Where a top's axis points after it has leaned and fallen for a while.
Vec3 fall(CaseBench& bench, const How& how, const Kind& top, bool on_floor, Floor floor)
{
    SceneParts parts(bench.scene());
    how.set(parts.scene().settings);
    const std::uint32_t material = parts.material(0.6);
    const Vec3 place = how.far - Vec3(0, 0, on_floor ? 0 : 10 * how.size);
    put_floor(parts, material, floor, {place, Quat::Identity()}, {4 * how.size, how.size, 9});
    const std::uint32_t id = parts.add(top.shape, on_its_foot(how, material, kLeansAlone));
    Vec3 axis;
    bench.run(parts.scene(), kFalls * std::sqrt(how.size / kSize), [&](World& world, double) {
        axis = world.pose(world.bodies()[id]).orientation * Vec3::UnitZ();
        return true;
    });
    bench.forgive_residual();
    return axis;
}

}  // namespace

void case_on_a_tip(CaseBench& bench)
{
    const How hows[] = {
        {"default"},
        {"default, dt 1/240", [](Settings& s) { s.dt = 1.0 / 240; }},
        {"1 substep", [](Settings& s) { s.substeps = 1; }, "substeps=4"},
        {"16 substeps", [](Settings& s) { s.substeps = 16; }},
        {"pgs", [](Settings& s) { s.solver = Solver::pgs; }},
        {"direct", [](Settings& s) { s.solver = Solver::direct; }},
        {"points", [](Settings& s) { s.friction_at = FrictionAt::points; }},
        {"double", [](Settings& s) { s.precision = Precision::double_; }},
        {"default, 10 mm", [](Settings&) {}, "", 0.01},
        {"default, 8 m", [](Settings&) {}, "", 8},
        {"default, last first", [](Settings&) {}, "", kSize, true},
        {"default, far off", [](Settings&) {}, "", kSize, false, Vec3(3e6, -2e6, 0)},
    };
    for (const How& how : hows) {
        const std::vector<Kind> all = kinds(how.size);
        for (const Kind& kind : all) {
            double worst = 0;
            for (const double lean : kind.leans)
                for (const Floor floor : kFloorsUnder)
                    for (const double restitution : {0.0, 0.5, 1.0})
                        hit(bench, how, kind, lean, floor, restitution, worst);
            bench.report_default(how.setting,
                                 std::string(kind.name)
                                     + ", struck: energy made, over the greatest in motion",
                                 worst, kMade, "1", how.met_by);
        }
        double off = 0;
        for (const Floor floor : kFloorsUnder)
            off = std::max(
                off,
                (fall(bench, how, all[0], true, floor) - fall(bench, how, all[0], false, floor))
                    .norm());
        bench.report_default(how.setting, "a top alone: direction that the floor changes", off,
                             kAngle, "rad", how.met_by);
        if (bench.brief()) return;
    }
}

}  // namespace throng
