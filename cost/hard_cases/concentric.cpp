// Concentric: H35, shapes about one center, from equal ones to one a hundred times the other.
//
// Answer: a sphere leaves by the sum of the radii, a capsule by its side, boxes by the nearest
// face; those that are turned in four times the digits.
#include "cost/hard_cases/convex_judge.hpp"
#include "cost/hard_cases/hard_cases.hpp"
#include "scene/names.hpp"
#include "throng/rotation.hpp"

#include <algorithm>

namespace throng {

namespace {

constexpr double kRatios[] = {1, 2, 10, 100};
const Vec3 kHalf(0.5, 0.6, 0.7);  // m

struct RoundPair {
    const char* name;
    ShapeDescription a, b;
    double depth, size;
    double bound;  // the curved side of a cylinder is met by rounds that close in on it
};

// The second is the first, or the like, smaller by the ratio.
std::vector<RoundPair> round_pairs(double ratio)
{
    const double small = 0.5 / ratio, slim = 0.3 / ratio;
    const ShapeDescription ball{"", SphereShape{0.5}}, pill{"", CapsuleShape{0.3, 0.6}},
        can{"", CylinderShape{0.3, 0.6}}, crate{"", BoxShape{kHalf}};
    const ShapeDescription little_ball{"", SphereShape{small}},
        little_pill{"", CapsuleShape{slim, 2 * slim}},
        little_can{"", CylinderShape{slim, 2 * slim}};
    return {{"spheres", ball, little_ball, 0.5 + small, 0.5, 1e-9},
            {"capsules", pill, little_pill, 0.3 + slim, 0.9, 1e-9},
            {"cylinders", can, little_can, 0.3 + slim, 0.7, 1e-6},
            {"sphere in box", crate, little_ball, 0.5 + small, kHalf.norm(), 1e-9},
            {"sphere in capsule", pill, little_ball, 0.3 + small, 0.9, 1e-9},
            {"capsule in box", crate, little_pill, 0.5 + slim, kHalf.norm(), 1e-9}};
}

// The same question must get the same answer, bit for bit.
void judge_repeat(CaseBench& bench, MethodTally& tally, const KnownPair& pair)
{
    for (const MethodDescription& method : known_methods()) {
        if (!serves(method, pair.a, pair.b)) continue;
        ConvexAnswer answers[2];
        for (ConvexAnswer& answer : answers) {
            ConvexQuery query(pair.a, pair.b);
            answer =
                bench.ask(query, method.name, pair.at_a, pair.at_b, pair.size, MethodStart::cold);
        }
        const bool same = answers[0].verdict == answers[1].verdict
            && answers[0].separation == answers[1].separation
            && answers[0].normal == answers[1].normal && answers[0].volume == answers[1].volume;
        tally.count(method.name, "", "answers that change when asked again", same ? 0 : 1);
    }
}

}  // namespace

void case_concentric(CaseBench& bench)
{
    MethodTally tally;
    const Pose placed{Vec3(0.3, -2, 1), exponential(Vec3(0.3, 0.5, -0.4))};
    const auto inspect = [&](const KnownPair& pair, const char* name, double bound) {
        judge(bench, tally, pair, name, {.value = bound});
        judge_in_float(bench, tally, pair, name);
        judge_repeat(bench, tally, pair);
    };
    for (const double ratio : kRatios) {
        for (const Quat& turn : {Quat(Quat::Identity()), Quat(exponential(Vec3(0.9, 0.2, -0.6)))}) {
            const Pose inside{placed.position, placed.orientation * turn};
            inspect(known_boxes(kHalf, placed, kHalf / ratio, inside), "boxes", 1e-9);
        }
        for (const RoundPair& round : round_pairs(ratio))
            for (const Pose& at : {Pose{}, placed}) {
                KnownPair pair{round.a, round.b, at, at};
                pair.size = round.size;
                pair.truth = -round.depth;
                inspect(pair, round.name, round.bound);
            }
    }
    tally.report(bench);
}

}  // namespace throng
