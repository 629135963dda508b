// Dominoes: H20, a row of pieces of which the first is pushed over.
//
// No closed form is claimed. What holds whatever the row: all fall, one after the other; away from
// both ends the wave runs at one speed; and a step half as long changes the time by little.
#include "cost/hard_cases/hard_cases.hpp"
#include "scene/names.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace throng {

namespace {

const Vec3 kPiece(0.125, 0.25, 0.5);  // m, half extents: solver2d's pieces, 0.25 by 1 m
// Past 0.245 rad none comes back by itself; at 0.253 it touches the next one, 0.5 m off.
constexpr double kFallen = 0.25;

struct Dominoes {
    int count = 15;
    double spacing = 0.75;  // m, of a height of 1 m
    double dt = 1.0 / 60;
    int substeps = 4;
    bool exactly = false;
};

Scene row_of(const CaseBench& bench, const Dominoes& row)
{
    SceneParts parts(bench.scene());
    const std::uint32_t material = parts.material(0.5);
    parts.plane(material, Vec3::UnitZ(), 0);
    for (int i = 0; i < row.count; ++i)
        parts.box(material, 250, kPiece, {Vec3(i * row.spacing, 0, kPiece.z()), Quat::Identity()});
    // Twice what it takes to pass its edge, 0.92 rad/s.
    const Vec3 push(0, 2, 0);
    parts.body(1).angular_velocity = push;
    parts.body(1).velocity = push.cross(Vec3(-kPiece.x(), 0, kPiece.z()));
    Settings& settings = parts.scene().settings;
    settings.dt = row.dt;
    settings.substeps = row.substeps;
    if (row.exactly) ask_exactly(settings);
    return parts.scene();
}

// How exactly solver direct solved the worst step is shown apart: what is asked is the wave's time.
struct Wave {
    // When each piece had leant by kFallen, s; between two steps as it went. Below 0 where it did
    // not.
    std::vector<double> when;
    double residual = 0;
};

Wave watch_row(CaseBench& bench, const Dominoes& row)
{
    constexpr double kPatience = 3;  // s, without another one fallen
    std::vector<double> when(static_cast<std::size_t>(row.count), -1);
    std::vector<double> leans(when.size(), 0);
    std::size_t fallen = 0;
    double last = 0, residual = 0;
    bench.run(row_of(bench, row), row.count, [&](World& world, double now) {
        residual = std::max(residual, world.report().direct_residual);
        const std::vector<BodyId> ids = world.bodies();
        for (std::size_t i = 0; i < when.size(); ++i) {
            if (when[i] >= 0) continue;
            const Vec3 up = world.pose(ids[i + 1]).orientation * Vec3::UnitZ();
            const double lean = std::atan2(up.x(), up.z());
            const double before = std::exchange(leans[i], lean);
            if (!(lean >= kFallen)) continue;
            last = when[i] = now - row.dt * (lean - kFallen) / (lean - before);
            ++fallen;
        }
        return fallen < when.size() && now < last + kPatience;
    });
    bench.forgive_residual();
    return {when, residual};
}

// Pieces that stood, or fell before the one ahead of them.
double out_of_order(const std::vector<double>& when)
{
    double count = when.front() < 0 ? 1 : 0;
    for (std::size_t i = 1; i < when.size(); ++i) count += when[i] > when[i - 1] ? 0 : 1;
    return count;
}

// By how much the last ten times between two falls differ, of the shortest.
double unsteadiness(const std::vector<double>& when)
{
    double least = 1e30, most = 0;
    for (std::size_t i = when.size() - 10; i < when.size(); ++i) {
        least = std::min(least, when[i] - when[i - 1]);
        most = std::max(most, when[i] - when[i - 1]);
    }
    return least > 0 ? most / least - 1 : 1e30;
}

// Returns how long the wave took by the shorter step, s.
double judge_row(CaseBench& bench, Dominoes row, const char* step)
{
    const std::string name = std::to_string(row.count) + " pieces, spacing "
        + number_text(row.spacing) + step + (row.exactly ? ", direct" : "");
    const auto judge = [&](const char* quantity, double figure, double bound) {
        bench.report_default(name, quantity, figure, bound, "1",
                             row.exactly ? "" : "solver=direct, dt 4e-3 or less");
    };
    const auto [when, residual] = watch_row(bench, row);
    bench.report(name, "pieces that stand, or fell out of order", out_of_order(when), 0, "1");
    // In a short row the wave is still gaining speed.
    if (row.count > 15 || row.spacing > 0.5)
        judge("unsteadiness of the last ten", unsteadiness(when), 0.02);
    row.dt /= 2;
    const auto [finer, finer_residual] = watch_row(bench, row);
    if (row.exactly)
        bench.show(name, "greatest residual of a step", std::max(residual, finer_residual), "1");
    bench.report(name + ", halved", "pieces that stand, or fell out of order", out_of_order(finer),
                 0, "1");
    judge("time of the wave, changed by half the step", std::abs(finer.back() / when.back() - 1),
          0.01);
    return finer.back();
}

}  // namespace

void case_dominoes(CaseBench& bench)
{
    for (const double spacing : {0.5, 0.75, 0.9}) {
        judge_row(bench, {.count = 15, .spacing = spacing}, ", dt 1/60");
        if (bench.brief()) continue;
        judge_row(bench, {.count = 100, .spacing = spacing}, ", dt 1/60");
        judge_row(bench, {.count = 100, .spacing = spacing, .dt = 1e-3}, ", dt 1e-3");
        const Dominoes exact{
            .count = spacing > 0.5 ? 15 : 30, .spacing = spacing, .dt = 4e-3, .exactly = true};
        const double time = judge_row(bench, exact, ", dt 4e-3");
        for (const int substeps : {4, 16, 64}) {
            const Dominoes row{
                .count = exact.count, .spacing = spacing, .dt = 2e-3, .substeps = substeps};
            bench.show("spacing " + number_text(spacing) + ", dt 2e-3, " + std::to_string(substeps)
                           + " substeps",
                       "time of the wave off that by direct",
                       std::abs(watch_row(bench, row).when.back() / time - 1), "1");
        }
    }
    if (bench.brief())
        judge_row(bench, {.dt = 2e-3}, ", dt 2e-3");
    else
        judge_row(bench, {.count = 400}, ", dt 1/60");
}

}  // namespace throng
