// Same answers: H37, whatever a method does to be fast changes its time and never its answer.
//
// Answer: pairs certified apart or touching by how they were made, a hundred thousand of them, and
// hulls of 10 to 10,000 vertices; the pairs of H28 once more, each start against the plain one; and
// of climbing to a furthest vertex, a look at all vertices.
#include "cost/hard_cases/broken_pairs.hpp"
#include "cost/hard_cases/certified_pairs.hpp"
#include "cost/hard_cases/convex_judge.hpp"
#include "cost/hard_cases/hard_cases.hpp"
#include "kernels/geometry/support.hpp"
#include "kernels/math/rotation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace throng {

namespace {

constexpr int kShapes = 500, kPlacings = 200;  // 100,000 pairs
constexpr QueryStart kStarts[] = {QueryStart::cached, QueryStart::cold, QueryStart::plain};
// Methods that look at faces or edges take time with the square of their number.
constexpr int kMostForPolytopes = 1000;

ShapeDescription described(const Hull& hull) { return {"", HullShape{hull.vertices}}; }

Hull box_hull(Random& random)
{
    Vec3 half = Vec3::Zero();
    for (int axis = 0; axis < 3; ++axis) half[axis] = random.uniform(0.1, 1);
    std::vector<Vec3> corners;
    for (unsigned i = 0; i < 8; ++i)
        corners.push_back(half.cwiseProduct(Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
    return build_hull(corners).hull;
}

/// Each method's answers to certified pairs of one kind.
class Score {
public:
    Score(CaseBench& bench, std::string_view setting) : bench_(bench), setting_(setting) { }

    // The starts in turn, from pair to pair, so that what is remembered is of another placing.
    void run(const Hull& a, const Hull& b, int placings, Random& random)
    {
        ConvexQuery query(described(a), described(b));
        const double size = certified_size(a, b);
        const auto most = static_cast<int>(std::max(a.vertices.size(), b.vertices.size()));
        for (int i = 0; i < placings; ++i) {
            const CertifiedPair pair = certified_pair(a, b, random);
            const QueryStart start = kStarts[i % 3];
            for (const MethodDescription& method : known_methods()) {
                if (!method.touch || (method.polytopes_only && most > kMostForPolytopes)) continue;
                const ConvexAnswer answer =
                    bench_.ask(query, method.name, Pose{}, pair.b_in_a, size, start);
                look_at(counts_[std::string(method.name)], pair, size, answer);
            }
        }
    }

    void tally(MethodTally& tally) const
    {
        for (const auto& [method, count] : counts_) {
            tally.count(method, setting_, "wrong verdicts", count.wrong);
            tally.count(method, setting_, "left undecided, far apart", count.undecided_far);
            // One that never says `touching` is a filter, and leaves to others what is near. A
            // search may run out of rounds now and then.
            if (count.said_touching > 0)
                tally.worst(method, setting_, "share left undecided", count.undecided / count.asked,
                            1e-3);
        }
    }

private:
    struct Count {
        double asked = 0, wrong = 0, said_touching = 0, undecided = 0, undecided_far = 0;
    };

    static void
    look_at(Count& count, const CertifiedPair& pair, double size, const ConvexAnswer& answer)
    {
        const bool wrong = answer.verdict == QueryVerdict::refused
            || answer.verdict == (pair.touching ? QueryVerdict::apart : QueryVerdict::touching);
        const bool undecided = answer.verdict == QueryVerdict::undecided;
        count.asked += 1;
        count.wrong += wrong ? 1 : 0;
        count.said_touching += answer.verdict == QueryVerdict::touching ? 1 : 0;
        count.undecided += undecided ? 1 : 0;
        count.undecided_far += undecided && !pair.touching && pair.gap >= kFarGap * size ? 1 : 0;
    }

    CaseBench& bench_;
    std::string_view setting_;
    std::map<std::string, Count> counts_;
};

void judge_random_pairs(CaseBench& bench, MethodTally& tally)
{
    Random random(37);
    Score score(bench, "1e5 random pairs");
    for (int i = 0; i < kShapes; ++i) {
        const bool boxes = i % 2 == 0;
        const Hull a = boxes ? box_hull(random) : random_hull(random, 6 + i % 11);
        const Hull b = i % 3 == 0 ? box_hull(random) : random_hull(random, 5 + i % 7);
        score.run(a, b, kPlacings, random);
    }
    score.tally(tally);
}

// A can's rim, a ball, a fan of vertices all but in one plane: where climbing could come to rest
// too early.
std::vector<Hull> hulls_to_climb()
{
    std::vector<Vec3> can, dome;
    constexpr int kAround = 120;
    for (int i = 0; i < kAround; ++i) {
        const SinCos turn = sin_cos(2 * 3.14159265358979323846 * i / kAround);
        for (const double z : {-0.2, 0.2}) can.emplace_back(turn.cos, turn.sin, z);
        for (const double out : {0.3, 0.6, 1.0})
            dome.emplace_back(out * turn.cos, out * turn.sin, -1e-3 * out * out);
    }
    dome.emplace_back(0, 0, 0);
    dome.emplace_back(0, 0, -0.5);
    Random random(38);
    return {build_hull(can).hull, build_hull(dome).hull, random_hull(random, 300)};
}

void judge_great_hulls(CaseBench& bench, MethodTally& tally)
{
    for (const auto& [vertices, placings, name] :
         {std::tuple(10, 300, "hulls of 10 vertices"), std::tuple(100, 150, "hulls of 100"),
          std::tuple(1000, 6, "hulls of 1000"), std::tuple(10000, 30, "hulls of 10,000")}) {
        Random random(static_cast<std::uint64_t>(vertices));
        const Hull a = random_hull(random, vertices), b = random_hull(random, vertices);
        Score score(bench, name);
        score.run(a, b, placings, random);
        score.tally(tally);
    }
    Random random(41);
    Score score(bench, "fans and rims");
    const std::vector<Hull> hulls = hulls_to_climb();
    for (const Hull& a : hulls)
        for (const Hull& b : hulls) score.run(a, b, 10, random);
    score.tally(tally);
}

void judge_starts(CaseBench& bench, MethodTally& tally)
{
    for (const BrokenPair& broken : broken_pairs()) {
        const KnownPair pair =
            known_boxes(broken.a.size / 2, broken.a.pose, broken.b.size / 2, broken.b.pose);
        ConvexQuery query(pair.a, pair.b);
        for (const MethodDescription& method : known_methods()) {
            if (!method.touch) continue;
            const auto ask = [&](QueryStart start) {
                return bench.ask(query, method.name, pair.at_a, pair.at_b, pair.size, start);
            };
            const ConvexAnswer plain = ask(QueryStart::plain);
            for (const QueryStart start : {QueryStart::cold, QueryStart::cached}) {
                const ConvexAnswer answer = ask(start);
                const double change =
                    std::abs(told_separation(method, answer) - told_separation(method, plain));
                if (std::abs(pair.truth) > 1e-12 * pair.size)
                    tally.count(method.name, "H28", "verdicts unlike the plain one",
                                answer.verdict == plain.verdict ? 0 : 1);
                if (std::isfinite(change))
                    tally.worst(method.name, "H28", "change from the plain answer / size",
                                change / pair.size, 1e-12);
            }
        }
    }
}

// Rounds a question, on the average of a slow way of b round a, each step from what the last left.
double mean_rounds(CaseBench& bench, const MethodDescription& method, int vertices)
{
    constexpr int kSteps = 300;
    constexpr double kStep = 0.01;  // rad
    Random random(40);
    const Hull a = random_hull(random, vertices), b = random_hull(random, vertices);
    ConvexQuery query(described(a), described(b));
    double rounds = 0;
    for (int i = 0; i < kSteps; ++i) {
        const Vec3 about(0, 0.3 * kStep * i, kStep * i);
        const Pose way{exponential(about) * Vec3(a.outer_radius + b.outer_radius, 0, 0),
                       exponential(2 * about)};
        rounds +=
            bench.ask(query, method.name, Pose{}, way, a.outer_radius, QueryStart::cached).rounds;
    }
    return rounds / kSteps;
}

void judge_rounds(CaseBench& bench, MethodTally& tally)
{
    for (const MethodDescription& method : known_methods()) {
        if (!method.touch || method.polytopes_only) continue;
        const double few = mean_rounds(bench, method, 10), many = mean_rounds(bench, method, 10000);
        tally.worst(method.name, "slow motion", "rounds for 10,000 vertices / rounds for 10",
                    many / std::max(1.0, few), 3);
    }
}

void judge_climbing(CaseBench& bench)
{
    double worst = 0;
    Random random(39);
    for (Hull& hull : hulls_to_climb()) {
        Shapes shapes;
        shapes.hulls.push_back(std::move(hull));
        const Hull& kept = shapes.hulls.front();
        const Core<double> core = core_of<double>(shapes, {ShapeKind::hull, 0});
        for (int i = 0; i < 2000; ++i) {
            // Along the normals too, where whole faces are furthest.
            const Vec3 along = i % 4 == 0
                ? kept.normals[static_cast<std::size_t>(i) % kept.normals.size()]
                : random_turn(random) * Vec3::UnitX();
            double most = -kept.outer_radius;
            for (const Vec3& vertex : kept.vertices) most = std::max(most, along.dot(vertex));
            worst = std::max(worst, (most - along.dot(support(core, along).position)) / core.size);
        }
    }
    bench.report("furthest vertices", "short of the furthest / size", worst, 1e-15, "1");
}

}  // namespace

void case_same_answers(CaseBench& bench)
{
    MethodTally tally;
    judge_random_pairs(bench, tally);
    judge_great_hulls(bench, tally);
    judge_starts(bench, tally);
    judge_rounds(bench, tally);
    tally.report(bench);
    judge_climbing(bench);
}

}  // namespace throng
