// Spikes and wedges: H43, what the scenes of exact queries were made of, let fall.
//
// A spike upon a spike, a wedge upon a wedge, a cube upon a cliff whose top is as wide as it is.
// Their corners are those of the public queries: of the one that stands still those that a step
// leaves where they are, of the one that falls those that the first step of its fall moves.
//
// Answers: they overlap at no step, win no energy, and the cube lies on the cliff, edge on edge.
//
// Source: Erleben, Methodology for Assessing Mesh-Based Contact Point Methods (2018).
#include "cost/exact_queries.hpp"
#include "cost/hard_cases/hard_cases.hpp"
#include "cost/hard_cases/quad_truth.hpp"
#include "cost/shared_data.hpp"
#include "throng/energy_ledger.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace throng {

namespace {

// As the queries have them: y is up.
constexpr double kFall = 9.80665;             // m/s2
constexpr double kFirst = 0.1 * 0.1 * kFall;  // m, down in the first step

struct Corners {
    std::vector<Vec3> still, falling;
};

void add_once(std::vector<Vec3>& corners, const Vec3& corner)
{
    const auto same = [&](const Vec3& other) { return other == corner; };
    if (std::none_of(corners.begin(), corners.end(), same)) corners.push_back(corner);
}

Corners corners_of(const std::filesystem::path& folder)
{
    Corners corners;
    for (const bool edges : {false, true})
        for (const ExactQuery& query : read_exact_queries(folder, edges))
            for (std::size_t i = 0; i < 4; ++i) {
                const Vec3 from = query.question.from[i], way = query.question.to[i] - from;
                if (way == Vec3::Zero()) add_once(corners.still, from);
                if ((way + kFirst * Vec3::UnitY()).norm() < 1e-6) add_once(corners.falling, from);
            }
    return corners;
}

Vec3 middle_of(const std::vector<Vec3>& corners)
{
    Vec3 sum = Vec3::Zero();
    for (const Vec3& corner : corners) sum += corner;
    return sum / static_cast<double>(corners.size());
}

std::vector<Vec3> about(const Vec3& middle, std::vector<Vec3> corners)
{
    for (Vec3& corner : corners) corner -= middle;
    return corners;
}

double least_half_extent(const std::vector<Vec3>& corners)
{
    Vec3 lower = corners.front(), upper = lower;
    for (const Vec3& corner : corners) {
        lower = lower.cwiseMin(corner);
        upper = upper.cwiseMax(corner);
    }
    return (upper - lower).minCoeff() / 2;
}

// What came of a fall: the least gap ever, below 0 by overlap, and the way from where it hung, m.
struct Fallen {
    double clearance = 1;
    Vec3 way = Vec3::Zero();
    double speed = 0, gained = 0;  // m/s at the end; of the fall's energy
};

Fallen let_fall(CaseBench& bench, const Corners& corners, Overlap overlap)
{
    SceneParts parts(bench.scene());
    Settings& settings = parts.scene().settings;
    settings.overlap = overlap;
    settings.dt = 0.01;
    settings.sleep = false;
    if (overlap != Overlap::allow) settings.precision = Precision::double_;
    parts.scene().gravity = -kFall * Vec3::UnitY();
    const std::uint32_t material = parts.material(0.5);
    const Vec3 base = middle_of(corners.still), start = middle_of(corners.falling);
    const std::vector<Vec3> below = about(base, corners.still);
    const std::vector<Vec3> above = about(start, corners.falling);
    parts.hold(parts.hull(material, 1, {below}, {base, Quat::Identity()}));
    parts.hull(material, 1, {above}, {start, Quat::Identity()});

    Fallen fallen;
    EnergyLedger ledger;
    const QuadSolid still = quad_cloud(below, QuadPose({base, Quat::Identity()}));
    bench.run(
        parts.scene(), bench.brief() ? 0.4 : 2,
        [&](World& world, double) {
            const BodyId body = world.bodies().back();
            const Pose pose = world.pose(body);
            const QuadTruth truth = quad_truth(still, quad_cloud(above, QuadPose(pose)));
            fallen.clearance = std::min(fallen.clearance, truth.separation);
            fallen.way = pose.position - start;
            fallen.speed = world.velocity(body).norm();
            return true;
        },
        &ledger);
    fallen.gained = ledger.gained() / ledger.greatest_kinetic();
    return fallen;
}

}  // namespace

void spikes_and_wedges(CaseBench& bench)
{
    for (const auto& [set, name] : {std::pair("erleben-spikes", "spike upon a spike, "),
                                    std::pair("erleben-wedges", "wedge upon a wedge, "),
                                    std::pair("erleben-cube-cliff-edges", "cube upon a cliff, ")}) {
        const std::filesystem::path folder = find_shared(std::filesystem::path("ccd") / set);
        const char* const quantity = "greatest overlap, at any step";
        if (folder.empty()) {
            bench.skip(name + std::string("exact corners"), quantity,
                       std::string("shared/data/ccd/") + set + " is absent");
            continue;
        }
        const Corners corners = corners_of(folder);
        const double half = least_half_extent(corners.falling);
        for (const auto& [overlap, way, most] :
             {std::tuple(Overlap::allow, "allow", 0.05 * half),
              std::tuple(Overlap::back_up, "back_up", 0.0),
              std::tuple(Overlap::subdivide, "subdivide", bench.settings().toi_tolerance * half)}) {
            const Fallen fallen = let_fall(bench, corners, overlap);
            const std::string setting = name + std::string(way);
            bench.report(setting, quantity, std::max(0.0, -fallen.clearance), most, "m");
            bench.report(setting, "energy gained, of the greatest in motion", fallen.gained, 1e-3,
                         "1");
            if (corners.falling.size() != 8 || bench.brief()) continue;
            // It hung a whole edge above where it comes to lie.
            const double height = std::sqrt(3.0) / 2 - 0.5;
            bench.report(setting, "off its place on the cliff",
                         (fallen.way + height * Vec3::UnitY()).norm(), 1e-3, "m");
            bench.report(setting, "speed at the end", fallen.speed, 1e-3, "m/s");
        }
    }
}

}  // namespace throng
