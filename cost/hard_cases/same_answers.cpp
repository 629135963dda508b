// Same answers: H37, whatever a method does to be fast changes its time and never its answer.
//
// Answer: pairs certified apart or touching by how they were made, a hundred thousand of them, and
// hulls of 10 to 10,000 vertices, with rims and fans where climbing to a furthest vertex could come
// to rest too early; the pairs of H28 once more, each start against the plain one. What a step says
// of them, depths in float too, is held to the same. Filters are held to never part what touches,
// finders to the pairs of all_pairs.
#include "cost/hard_cases/broken_pairs.hpp"
#include "cost/hard_cases/certified_pairs.hpp"
#include "cost/hard_cases/convex_judge.hpp"
#include "cost/hard_cases/hard_cases.hpp"
#include "throng/rotation.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace throng {

namespace {

constexpr int kShapes = 500, kPlacings = 200;  // 100,000 pairs
constexpr MethodStart kStarts[] = {MethodStart::cached, MethodStart::cold, MethodStart::plain};
// Methods that look at faces or edges take time with the square of their number.
constexpr int kMostForPolytopes = 1000;
// Of the balls inside both, as in hull_hull.cpp: contacts keep to a face where edges are less deep
// by no more, so that bodies at rest do not rock.
constexpr double kFaceLead = 1e-3;
// Of random pairs that touch: so seldom are edges less deep by so little.
constexpr double kMostByLead = 0.05;

/// A hull, and what a scene would state to have it.
struct Stated {
    Hull hull;
    ShapeDescription shape;
};

Stated stated(Hull hull)
{
    ShapeDescription shape{"", HullShape{hull.vertices}};
    return {std::move(hull), std::move(shape)};
}

Stated random_box(Random& random)
{
    Vec3 half = Vec3::Zero();
    for (int axis = 0; axis < 3; ++axis) half[axis] = random.uniform(0.1, 1);
    std::vector<Vec3> corners;
    for (unsigned i = 0; i < 8; ++i)
        corners.emplace_back(
            half.cwiseProduct(Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
    return {build_hull(corners).hull, {"", BoxShape{half}}};
}

/// Each method's answers to certified pairs of one kind.
class Score {
public:
    Score(CaseBench& bench, std::string_view setting) : bench_(bench), setting_(setting) { }

    // The starts in turn, from pair to pair, so that what is remembered is of another placing.
    void run(const Stated& a, const Stated& b, int placings, Random& random)
    {
        ConvexQuery query(a.shape, b.shape);
        const double size = certified_size(a.hull, b.hull);
        const double lead = kFaceLead * (a.hull.inner_radius + b.hull.inner_radius);
        const auto most =
            static_cast<int>(std::max(a.hull.vertices.size(), b.hull.vertices.size()));
        for (int i = 0; i < placings; ++i) {
            const CertifiedPair pair = certified_pair(a.hull, b.hull, random);
            double depth = 0;
            for (std::size_t k = 0; k < methods_.size(); ++k) {
                const MethodDescription& method = methods_[k];
                if (!method.touch || (method.polytopes_only && most > kMostForPolytopes)) continue;
                const ConvexAnswer answer =
                    bench_.ask(query, method.name, Pose{}, pair.b_in_a, size, kStarts[i % 3]);
                inspect(counts_[k], pair, size, answer);
                if (method.name == "gjk") depth = -told_separation(method, answer);
            }
            const auto touch = [&](Precision precision) {
                return bench_.touch(query, precision, Pose{}, pair.b_in_a, size);
            };
            inspect(in_double_, pair, size, touch(Precision::double_));
            if (pair.separation <= kFloat * size) continue;
            const ConvexAnswer answer = touch(Precision::float_);
            inspect(in_float_, pair, size, answer);
            if (answer.verdict == QueryVerdict::touching && depth > 0)
                look_at_depth(std::abs(answer.separation + depth), lead, size);
        }
    }

    void tally(MethodTally& tally) const
    {
        tally.count("auto", setting_, "wrong verdicts", in_double_.wrong);
        tally.count("auto", in_float(setting_), "wrong verdicts", in_float_.wrong);
        if (depths_ > 0) {
            tally.worst("auto", in_float(setting_), "depth error beyond a face's lead / size",
                        beyond_lead_, kFloat);
            tally.worst("auto", in_float(setting_), "depth error, by a face's lead / size",
                        depth_error_, 2 * kFaceLead);
        }
        if (depths_ >= kPlacings)
            tally.worst("auto", in_float(setting_), "share of depths told by a face's lead",
                        by_lead_ / depths_, kMostByLead);
        for (std::size_t k = 0; k < methods_.size(); ++k) {
            const std::string_view method = methods_[k].name;
            const Count& count = counts_[k];
            if (!(count.asked > 0)) continue;
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
    inspect(Count& count, const CertifiedPair& pair, double size, const ConvexAnswer& answer)
    {
        const bool wrong = answer.verdict == QueryVerdict::refused
            || answer.verdict == (pair.touching ? QueryVerdict::apart : QueryVerdict::touching);
        const bool undecided = answer.verdict == QueryVerdict::undecided;
        count.asked += 1;
        count.wrong += wrong ? 1 : 0;
        count.said_touching += answer.verdict == QueryVerdict::touching ? 1 : 0;
        count.undecided += undecided ? 1 : 0;
        count.undecided_far +=
            undecided && !pair.touching && pair.separation >= kFarSeparation * size ? 1 : 0;
    }

    // A face that leads is deeper than the true depth, by up to its lead.
    void look_at_depth(double error, double lead, double size)
    {
        depths_ += 1;
        by_lead_ += error > kFloat * size ? 1 : 0;
        depth_error_ = std::max(depth_error_, error / size);
        beyond_lead_ = std::max(beyond_lead_, (error - lead) / size);
    }

    CaseBench& bench_;
    std::string_view setting_;
    std::vector<MethodDescription> methods_ = known_methods();
    std::vector<Count> counts_ = std::vector<Count>(methods_.size());
    Count in_float_, in_double_;  // a step's pair functions
    double depths_ = 0, by_lead_ = 0, depth_error_ = 0, beyond_lead_ = 0;
};

void judge_random_pairs(CaseBench& bench, MethodTally& tally)
{
    Random random(37);
    Score score(bench, bench.brief() ? "2e4 random pairs" : "1e5 random pairs");
    for (int i = 0; i < (bench.brief() ? kShapes / 5 : kShapes); ++i) {
        const bool boxes = i % 2 == 0;
        const Stated a = boxes ? random_box(random) : stated(random_hull(random, 6 + i % 11));
        const Stated b = i % 3 == 0 ? random_box(random) : stated(random_hull(random, 5 + i % 7));
        score.run(a, b, kPlacings, random);
    }
    score.tally(tally);
}

// A can's rim, a ball, a fan of vertices all but in one plane: where climbing could come to rest
// too early.
std::vector<Stated> hulls_to_climb()
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
    return {stated(build_hull(can).hull), stated(build_hull(dome).hull),
            stated(random_hull(random, 300))};
}

void judge_great_hulls(CaseBench& bench, MethodTally& tally)
{
    for (const auto& [vertices, placings, name] :
         {std::tuple(10, 150, "hulls of 10 vertices"), std::tuple(100, 60, "hulls of 100"),
          std::tuple(1000, 6, "hulls of 1000"), std::tuple(10000, 15, "hulls of 10,000")}) {
        Random random(static_cast<std::uint64_t>(vertices));
        const Stated a = stated(random_hull(random, vertices));
        const Stated b = stated(random_hull(random, vertices));
        Score score(bench, name);
        score.run(a, b, placings, random);
        score.tally(tally);
    }
    Random random(41);
    Score score(bench, "fans and rims");
    const std::vector<Stated> hulls = hulls_to_climb();
    for (const Stated& a : hulls)
        for (const Stated& b : hulls) score.run(a, b, 10, random);
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
            const auto ask = [&](MethodStart start) {
                return bench.ask(query, method.name, pair.at_a, pair.at_b, pair.size, start);
            };
            const ConvexAnswer plain = ask(MethodStart::plain);
            for (const MethodStart start : {MethodStart::cold, MethodStart::cached}) {
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

// Rounds a question of each method, on the average of a slow way of b round a, each step from what
// the last has left. 0 of those that look at all edges and faces.
std::vector<double> mean_rounds(CaseBench& bench, int vertices)
{
    constexpr int kSteps = 300;
    constexpr double kStep = 0.01;  // rad
    Random random(40);
    const Stated a = stated(random_hull(random, vertices));
    const Stated b = stated(random_hull(random, vertices));
    const double max_separation = a.hull.outer_radius + b.hull.outer_radius;
    ConvexQuery query(a.shape, b.shape);
    std::vector<double> rounds;
    for (const MethodDescription& method : known_methods()) {
        double sum = 0;
        for (int i = 0; i < kSteps && method.touch && !method.polytopes_only; ++i) {
            const Vec3 about(0, 0.3 * kStep * i, kStep * i);
            const Pose way{exponential(about) * Vec3(max_separation, 0, 0), exponential(2 * about)};
            sum += bench.ask(query, method.name, Pose{}, way, max_separation, MethodStart::cached)
                       .rounds;
        }
        rounds.push_back(sum / kSteps);
    }
    return rounds;
}

void judge_rounds(CaseBench& bench, MethodTally& tally)
{
    const std::vector<double> few = mean_rounds(bench, 10), many = mean_rounds(bench, 10000);
    const std::vector<MethodDescription> methods = known_methods();
    for (std::size_t i = 0; i < methods.size(); ++i)
        if (many[i] > 0)
            tally.worst(methods[i].name, "slow motion",
                        "rounds for 10,000 vertices / rounds for 10",
                        many[i] / std::max(1.0, few[i]), 3);
}

// A filter that is kept for many questions: it says `apart` or nothing.
void judge_trees(CaseBench& bench)
{
    constexpr int kHulls = 60, kPlaced = 200;
    for (const int k : {6, 14, 18, 26}) {
        Random random(42);
        double parted = 0, missed_far = 0;
        for (int i = 0; i < kHulls; ++i) {
            const Stated a = i % 3 == 0 ? random_box(random) : stated(random_hull(random, 6 + i));
            const Stated b = stated(random_hull(random, 5 + 2 * i));
            ConvexQuery query(a.shape, b.shape);
            const double size = certified_size(a.hull, b.hull);
            for (int n = 0; n < kPlaced; ++n) {
                const CertifiedPair pair = certified_pair(a.hull, b.hull, random);
                const QueryVerdict verdict = query.ask_trees(pair.b_in_a, k).verdict;
                const bool apart = verdict == QueryVerdict::apart;
                parted += pair.touching && apart ? 1 : 0;
                missed_far +=
                    !pair.touching && pair.separation >= kFarSeparation * size && !apart ? 1 : 0;
            }
        }
        const std::string setting = "k-DOP trees of " + std::to_string(k) + ", 12,000 pairs";
        bench.report(setting, "told apart though they touch", parted, 0, "1");
        bench.report(setting, "left undecided, far apart", missed_far, 0, "1");
    }
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
    judge_trees(bench);
    compare_pair_finders(bench);
}

}  // namespace throng
