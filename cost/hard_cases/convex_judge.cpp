#include "cost/hard_cases/convex_judge.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace throng {
namespace {

// Twice cached: once from what a cold start has left, once from what a cached one has.
constexpr std::array kStarts = {MethodStart::cold, MethodStart::cached, MethodStart::cached,
                                MethodStart::plain};
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

bool all_finite(const ConvexAnswer& answer)
{
    return std::isfinite(answer.separation) && answer.normal.allFinite() && answer.on_a.allFinite()
        && answer.on_b.allFinite() && std::isfinite(answer.volume) && std::isfinite(answer.surface)
        && answer.center.allFinite();
}

bool tells_values(const MethodDescription& method, const ConvexAnswer& answer)
{
    return (answer.verdict == QueryVerdict::apart && method.distance)
        || (answer.verdict == QueryVerdict::touching && method.depth);
}

// One that only filters may leave a pair to others; one that measures may not.
bool right_verdict(const MethodDescription& method, const ConvexAnswer& answer, double truth)
{
    switch (answer.verdict) {
    case QueryVerdict::apart:
        return truth > 0;
    case QueryVerdict::touching:
        return truth <= 0;
    case QueryVerdict::undecided:
        return !method.distance && !method.depth && !method.volume;
    default:
        return false;
    }
}

/// One way round of a pair.
struct Side {
    const KnownPair& pair;
    bool swapped;

    const ShapeDescription& a() const { return swapped ? pair.b : pair.a; }
    const ShapeDescription& b() const { return swapped ? pair.a : pair.b; }
    const Pose& at_a() const { return swapped ? pair.at_b : pair.at_a; }
    const Pose& at_b() const { return swapped ? pair.at_a : pair.at_b; }
    const QuadSolid& solid_a() const { return swapped ? *pair.solid_b : *pair.solid_a; }
    const QuadSolid& solid_b() const { return swapped ? *pair.solid_a : *pair.solid_b; }
    // From a's frame to where the solids are.
    Vec3 from_a(const Vec3& local) const
    {
        return at_a().orientation.normalized() * local + (at_a().position - pair.at_a.position);
    }
};

/// Answers to one way round of a pair, and what is found wrong with them.
struct Judge {
    MethodTally& tally;
    const MethodDescription& method;
    std::string_view setting;
    const AnswerBounds& bounds;
    const Side& side;

    void worst(std::string_view quantity, double error) const
    {
        tally.worst(method.name, setting, quantity, error / side.pair.size, bounds.value);
    }

    void inspect(const ConvexAnswer& answer) const
    {
        const double truth = side.pair.truth;
        const bool verdict_matters = std::abs(truth) > bounds.decided_beyond * side.pair.size;
        const bool measured = tells_values(method, answer);
        const bool wrong = answer.verdict == QueryVerdict::refused || !all_finite(answer)
            || (verdict_matters && !right_verdict(method, answer, truth))
            || (measured && !(std::abs(answer.normal.norm() - 1) < 1e-12));
        tally.count(method.name, setting, "wrong or no answers", wrong ? 1 : 0);
        // Those for polytopes alone look at all there is of a pair; the others search.
        if (bounds.rounds > 0 && !method.polytopes_only) {
            tally.worst(method.name, setting, "rounds", answer.rounds, bounds.rounds);
            tally.count(method.name, setting, "cut short", answer.cut_short ? 1 : 0);
        }
        if (!measured) return;
        const bool apart = answer.verdict == QueryVerdict::apart;
        worst(apart ? "error of the distance / size" : "error of the depth / size",
              std::abs(answer.separation - truth));
        if (side.pair.solid_a) look_at_normal(answer, apart);
    }

    // Any normal will do by which the shapes really are as far apart, or as little overlapped.
    void look_at_normal(const ConvexAnswer& answer, bool apart) const
    {
        const Vec3 normal = side.at_a().orientation.normalized() * answer.normal;
        const double along = quad_separation_along(side.solid_a(), side.solid_b(), normal);
        if (!apart) {
            worst("error of the depth along its normal / size",
                  std::abs(along - answer.separation));
            return;
        }
        worst("overlap along a normal that parts / size", std::max(0.0, -along));
        const Vec3 on_a = side.from_a(answer.on_a), on_b = side.from_a(answer.on_b);
        worst("error of the nearest points / size",
              std::max({quad_outside(side.solid_a(), on_a), quad_outside(side.solid_b(), on_b),
                        std::abs((on_b - on_a).norm() - answer.separation)}));
    }
};

bool is_polytope(const ShapeDescription& shape)
{
    return std::holds_alternative<BoxShape>(shape.shape)
        || std::holds_alternative<HullShape>(shape.shape);
}

}  // namespace

MethodTally::Line& MethodTally::line(std::string_view method,
                                     std::string_view setting,
                                     std::string_view quantity,
                                     double bound,
                                     std::string_view unit)
{
    for (Line& one : lines_)
        if (one.method == method && one.setting == setting && one.quantity == quantity) return one;
    lines_.push_back({std::string(method), std::string(setting), std::string(quantity),
                      std::string(unit), 0, bound});
    return lines_.back();
}

void MethodTally::worst(std::string_view method,
                        std::string_view setting,
                        std::string_view quantity,
                        double figure,
                        double bound,
                        std::string_view unit)
{
    Line& kept = line(method, setting, quantity, bound, unit);
    if (std::isnan(figure) || figure > kept.figure) kept.figure = figure;
}

void MethodTally::count(std::string_view method,
                        std::string_view setting,
                        std::string_view quantity,
                        double more,
                        double bound)
{
    line(method, setting, quantity, bound, "1").figure += more;
}

void MethodTally::report(CaseBench& bench) const
{
    for (const Line& one : lines_)
        bench.report_method(one.method, one.setting, one.quantity, one.figure, one.bound, one.unit);
}

KnownPair known_boxes(const Vec3& half_a, const Pose& at_a, const Vec3& half_b, const Pose& at_b)
{
    KnownPair pair{{"", BoxShape{half_a}}, {"", BoxShape{half_b}}, at_a, at_b};
    pair.size = std::max(half_a.norm(), half_b.norm());
    pair.solid_a = quad_box(half_a, QuadPose(at_a, at_a.position));
    pair.solid_b = quad_box(half_b, QuadPose(at_b, at_a.position));
    pair.truth = quad_truth(*pair.solid_a, *pair.solid_b).separation;
    return pair;
}

bool serves(const MethodDescription& method, const ShapeDescription& a, const ShapeDescription& b)
{
    return !method.polytopes_only || (is_polytope(a) && is_polytope(b));
}

double told_separation(const MethodDescription& method, const ConvexAnswer& answer)
{
    return tells_values(method, answer) ? answer.separation : kNaN;
}

void judge(CaseBench& bench,
           MethodTally& tally,
           const KnownPair& pair,
           std::string_view setting,
           const AnswerBounds& bounds)
{
    const Side sides[] = {{pair, false}, {pair, true}};
    ConvexQuery queries[] = {{pair.a, pair.b}, {pair.b, pair.a}};
    for (const MethodDescription& method : known_methods()) {
        if (!method.touch || !serves(method, pair.a, pair.b)) continue;
        double separations[2][kStarts.size()] = {};
        for (std::size_t way = 0; way < 2; ++way) {
            const Judge one{tally, method, setting, bounds, sides[way]};
            for (std::size_t k = 0; k < kStarts.size(); ++k) {
                const ConvexAnswer answer = bench.ask(queries[way], method.name, sides[way].at_a(),
                                                      sides[way].at_b(), pair.size, kStarts[k]);
                one.inspect(answer);
                separations[way][k] = told_separation(method, answer);
            }
        }
        for (std::size_t k = 0; k < kStarts.size(); ++k) {
            const double change = std::abs(separations[0][k] - separations[1][k]);
            if (std::isfinite(change))
                tally.worst(method.name, setting, "change by turning the pair round / size",
                            change / pair.size, bounds.value);
        }
    }
}

std::string in_float(std::string_view setting)
{
    return std::string(setting) + (setting.empty() ? "float" : ", float");
}

void judge_in_float(CaseBench& bench,
                    MethodTally& tally,
                    const KnownPair& pair,
                    std::string_view setting)
{
    if (!(std::abs(pair.truth) > kFloat * pair.size)) return;
    const ConvexQuery queries[] = {{pair.a, pair.b}, {pair.b, pair.a}};
    const QueryVerdict right = pair.truth > 0 ? QueryVerdict::apart : QueryVerdict::touching;
    for (const bool swapped : {false, true}) {
        const ConvexAnswer answer =
            bench.touch(queries[swapped], Precision::float_, swapped ? pair.at_b : pair.at_a,
                        swapped ? pair.at_a : pair.at_b, pair.size);
        const bool wrong = answer.verdict != right || !std::isfinite(answer.separation)
            || !(std::abs(answer.normal.norm() - 1) < kFloat);
        tally.count("auto", in_float(setting), "wrong or no answers", wrong ? 1 : 0);
    }
}

}  // namespace throng
