// Kissing: H29, two cubes a hair apart, touching and a hair overlapped, by face, edge and corner.
//
// After FCL's generalised kissing test and openGJK's cubes. Answer: in four times the digits, of
// the places as rounded; and what is told never falls while the gap grows.
#include "cost/hard_cases/convex_judge.hpp"
#include "cost/hard_cases/hard_cases.hpp"
#include "scene/names.hpp"
#include "throng/rotation.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

constexpr double kEdges[] = {0.01, 0.25, 0.5, 10, 1000};  // m
constexpr double kEighthTurn = 0.78539816339744830962;

struct Kiss {
    const char* name;
    Quat turn;      // of b, against a
    double offset;  // of b towards a, in half edges
};

// Askew about the way they meet along, so that no two edges are parallel but those that kiss.
const Kiss kKisses[] = {
    {"face", exponential(Vec3(0.3, 0, 0)), 1},
    {"edge", exponential(Vec3(0.2, 0, 0)) * exponential(Vec3(0, 0, kEighthTurn)), std::sqrt(2.0)},
    // From (1, 1, 1) to (-1, 0, 0), the shortest way.
    {"corner",
     exponential(Vec3(0.1, 0, 0))
         * exponential(Vec3(0, -1, 1).normalized() * std::acos(-1 / std::sqrt(3.0))),
     std::sqrt(3.0)},
};
const Quat kPoses[] = {Quat::Identity(), exponential(Vec3(0.4, -0.7, 0.2)),
                       exponential(Vec3(-1.9, 0.3, 1.1))};

KnownPair kissing(double edge, const Kiss& kiss, const Quat& pose, double separation)
{
    const Vec3 half = Vec3::Constant(edge / 2);
    const Vec3 shift((1 + kiss.offset) * edge / 2 + separation, 0.11 * edge, -0.07 * edge);
    return known_boxes(half, {Vec3::Zero(), pose}, half, {pose * shift, pose * kiss.turn});
}

// By how much what is told falls behind the most it was for a lesser gap.
void judge_order(CaseBench& bench, MethodTally& tally, std::vector<KnownPair>& sweep)
{
    std::sort(sweep.begin(), sweep.end(),
              [](const KnownPair& one, const KnownPair& other) { return one.truth < other.truth; });
    for (const MethodDescription& method : known_methods()) {
        double most = -std::numeric_limits<double>::max();
        for (const KnownPair& pair : sweep) {
            ConvexQuery query(pair.a, pair.b);
            const double told = told_separation(
                method,
                bench.ask(query, method.name, pair.at_a, pair.at_b, pair.size, MethodStart::cold));
            if (std::isnan(told)) continue;
            tally.worst(method.name, "", "fall while the gap grows / size",
                        std::max(0.0, most - told) / pair.size, 1e-14);
            most = std::max(most, told);
        }
    }
}

void sweep_separations(
    CaseBench& bench, MethodTally& tally, double edge, const Kiss& kiss, const Quat& pose)
{
    std::vector<KnownPair> sweep;
    for (int i = -5; i <= 5; ++i) sweep.push_back(kissing(edge, kiss, pose, i * 2e-16));
    for (const double share : {1e-11, 1e-9, 1e-6})
        for (const double sign : {-1.0, 1.0})
            sweep.push_back(kissing(edge, kiss, pose, sign * share * edge));
    for (const KnownPair& pair : sweep) judge(bench, tally, pair, kiss.name);
    judge_order(bench, tally, sweep);
}

}  // namespace

void case_kissing(CaseBench& bench)
{
    MethodTally tally;
    for (const double edge : kEdges)
        for (const Kiss& kiss : kKisses)
            for (const Quat& pose : kPoses) sweep_separations(bench, tally, edge, kiss, pose);

    // Cubes further and further apart: what is asked grows with the gap once it is the greater.
    for (double separation = 1e8; separation > 0.5e-12; separation /= 10)
        for (const Quat& turn : {Quat(Quat::Identity()), kPoses[1]}) {
            KnownPair pair = known_boxes(Vec3::Constant(0.5), Pose{}, Vec3::Constant(0.5),
                                         {turn * Vec3(1 + separation, 0, 0), turn});
            pair.size = std::max(pair.size, separation);
            judge(bench, tally, pair, "gaps 1e8 to 1e-12",
                  {.decided_beyond = 0.9e-12, .value = 1e-12});
        }
    tally.report(bench);
}

}  // namespace throng
