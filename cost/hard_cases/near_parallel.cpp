// Near parallel: H34, boxes tilted against one another by 1e-9 to 1e-2 rad, and edges parallel to
// within 1e-12.
//
// Answer: the normal leans by no more than some tilts; depths and distances in four times the
// digits; a box that rests on another has a contact of four points whatever the tilt.
#include "cost/hard_cases/convex_judge.hpp"
#include "cost/hard_cases/hard_cases.hpp"
#include "scene/names.hpp"
#include "throng/rotation.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

const Vec3 kHalf(0.5, 0.4, 0.3);  // m

struct Axes {
    const char* name;
    Vec3 about;  // rad, for a tilt of 1
};
const Axes kAxes[] = {{"tilt about one axis", Vec3(1, 0, 0)},
                      {"tilt about two axes", Vec3(0.8, 0.6, 0)}};

void judge_normal(
    CaseBench& bench, MethodTally& tally, const KnownPair& pair, const char* setting, double tilt)
{
    for (const MethodDescription& method : known_methods()) {
        ConvexQuery query(pair.a, pair.b);
        const ConvexAnswer answer =
            bench.ask(query, method.name, pair.at_a, pair.at_b, pair.size, MethodStart::cold);
        if (std::isnan(told_separation(method, answer))) continue;
        tally.worst(method.name, setting, "lean of the normal / tilt",
                    (answer.normal - Vec3::UnitZ()).norm() / tilt, 10);
    }
    // What a step would have; in float a normal is no better than its last digits. It keeps to the
    // faces, which may be deeper than the least depth by a share of the square of the tilt.
    const ConvexQuery query(pair.a, pair.b);
    for (const Precision precision : {Precision::double_, Precision::float_}) {
        const ConvexAnswer answer = bench.touch(query, precision, pair.at_a, pair.at_b, pair.size);
        if (answer.verdict != QueryVerdict::touching) continue;
        const bool in_float = precision == Precision::float_;
        const double least = in_float ? std::max(tilt, 1e-7) : tilt;
        const std::string way = std::string(setting) + (in_float ? ", float" : "");
        tally.worst("auto", way,
                    in_float ? "lean of the normal / tilt or 1e-7" : "lean of the normal / tilt",
                    (answer.normal - Vec3::UnitZ()).norm() / least, 10);
        const double off = std::abs(answer.separation - pair.truth) / pair.size;
        tally.worst("auto", way, "separation off the truth / size, beyond the tilt's square",
                    std::max(0.0, off - tilt * tilt), in_float ? 1e-6 : 1e-11);
    }
}

void judge_faces(CaseBench& bench, MethodTally& tally)
{
    for (double tilt = 1e-9; tilt < 2e-2; tilt *= 10)
        for (const Axes& axes : kAxes)
            for (const double up : {0.598, 0.62}) {  // overlapped, apart
                const Pose pose{Vec3(0.1, 0.05, up), exponential(tilt * axes.about)};
                const KnownPair pair = known_boxes(kHalf, Pose{}, kHalf, pose);
                judge(bench, tally, pair, axes.name);
                judge_normal(bench, tally, pair, axes.name, tilt);
            }
}

// The contact of two faces: what it spans may change with the tilt, not jump.
void judge_area(CaseBench& bench)
{
    const Vec3 shift(0.1, 0.05, 0.59);  // deeper than any of these tilts lifts a corner
    const double whole = (2 * kHalf.x() - shift.x()) * (2 * kHalf.y() - shift.y());
    for (const Axes& axes : kAxes) {
        double worst = 0;
        for (double tilt = 1e-9; tilt < 2e-2; tilt *= 10) {
            const Pose pose{shift, exponential(tilt * axes.about)};
            const KnownPair pair = known_boxes(kHalf, Pose{}, kHalf, pose);
            const ConvexAnswer answer = ConvexQuery(pair.a, pair.b).touch(pose, Precision::double_);
            worst = std::max(worst, std::abs(answer.surface / whole - 1) / tilt);
        }
        bench.report(axes.name, "area lost by the contact, of it / tilt", worst, 10, "1");
    }
}

// Edge upon edge: two cubes turned on their edges, all but parallel along x.
void judge_edges(CaseBench& bench, MethodTally& tally)
{
    constexpr double kEighthTurn = 0.78539816339744830962;
    const Vec3 half = Vec3::Constant(0.5);
    const Quat on_edge = exponential(Vec3(kEighthTurn, 0, 0));
    for (const double tilt : {0.0, 1e-16, 1e-15, 1e-14, 1e-13, 1e-12, 1e-11, 1e-10})
        for (const Axes& axes : kAxes)
            for (const double clearance : {-1e-3, -1e-9, 0.0, 1e-9, 1e-3}) {
                // About y and z here: the edges run along x.
                const Vec3 about(0, axes.about.x(), axes.about.y());
                const Pose pose{Vec3(0.03, 0, std::sqrt(2.0) + clearance),
                                exponential(tilt * about) * on_edge};
                judge(bench, tally, known_boxes(half, {Vec3::Zero(), on_edge}, half, pose),
                      "edges all but parallel");
            }
}

// Points that a box and the one it is set down upon share after one step: four to eight. By 10 mm
// no tilt lifts a corner off it, by 0.5 mm none up to 1e-3 rad does.
void judge_contact(CaseBench& bench, const char* name, double depth, double steepest)
{
    double fewest = 1e9, most = 0;
    for (double tilt = 1e-9; tilt < 2 * steepest; tilt *= 10)
        for (const Axes& axes : kAxes) {
            SceneParts parts(bench.scene());
            const std::uint32_t stuff = parts.material(0.5);
            const Pose above{Vec3(0.1, 0.05, 0.6 - depth), exponential(tilt * axes.about)};
            parts.hold(parts.box(stuff, 1, kHalf, Pose{}));
            parts.box(stuff, 1, kHalf, above);
            const double dt = parts.scene().settings.dt;
            bench.run(parts.scene(), dt, [&](World& world, double) {
                const auto points = static_cast<double>(world.report().contacts);
                fewest = std::min(fewest, points);
                most = std::max(most, points);
                return true;
            });
        }
    bench.report(name, "points missing of four", 4 - fewest, 0, "1");
    bench.report(name, "points beyond eight", std::max(0.0, most - 8), 0, "1");
}

}  // namespace

void case_near_parallel(CaseBench& bench)
{
    MethodTally tally;
    judge_faces(bench, tally);
    judge_edges(bench, tally);
    tally.report(bench);
    judge_area(bench);
    judge_contact(bench, "contact in a world, 0.5 mm deep, tilts to 1e-3", 0.5e-3, 1e-3);
    judge_contact(bench, "contact in a world, 10 mm deep, tilts to 1e-2", 1e-2, 1e-2);
}

}  // namespace throng
