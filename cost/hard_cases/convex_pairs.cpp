// Convex pairs: H28, pairs of boxes that broke real libraries; H32, the same at other scales; H33,
// the same far from the origin.
//
// Answer: worked out in four times the digits for the very numbers that a method gets, whose
// rounding so counts for nothing.
#include "cost/hard_cases/broken_pairs.hpp"
#include "cost/hard_cases/convex_judge.hpp"
#include "cost/hard_cases/hard_cases.hpp"
#include "scene/names.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

constexpr int kMostRounds = 128;

Pose scaled(const Pose& pose, double scale) { return {pose.position * scale, pose.orientation}; }

KnownPair scaled(const BrokenPair& pair, double scale)
{
    return known_boxes(pair.a.size * scale / 2, scaled(pair.a.pose, scale), pair.b.size * scale / 2,
                       scaled(pair.b.pose, scale));
}

KnownPair moved(const BrokenPair& pair, const Vec3& by)
{
    Pose at_a = pair.a.pose, at_b = pair.b.pose;
    at_a.position += by;
    at_b.position += by;
    return known_boxes(pair.a.size / 2, at_a, pair.b.size / 2, at_b);
}

// What a method says of a pair from a cold start; NaN where it does not measure.
ConvexAnswer cold_answer(CaseBench& bench, const MethodDescription& method, const KnownPair& pair)
{
    ConvexQuery query(pair.a, pair.b);
    return bench.ask(query, method.name, pair.at_a, pair.at_b, pair.size, MethodStart::cold);
}

// An absolute tolerance anywhere shows as a figure that does not grow with the scale.
void judge_scale(CaseBench& bench,
                 MethodTally& tally,
                 const KnownPair& home,
                 const KnownPair& pair,
                 double scale,
                 bool by_two)
{
    for (const MethodDescription& method : known_methods()) {
        if (!method.touch) continue;
        const ConvexAnswer here = cold_answer(bench, method, home);
        const ConvexAnswer there = cold_answer(bench, method, pair);
        if (by_two || std::abs(home.truth) > 1e-12 * home.size)
            tally.count(method.name, "", "verdicts that change with the scale",
                        here.verdict == there.verdict ? 0 : 1);
        const double separation = told_separation(method, there) / scale;
        if (std::isnan(separation)) continue;
        tally.worst(method.name, "", "error once scaled back / size",
                    std::abs(separation - home.truth) / home.size, 1e-9);
        // What is scaled by a power of two is not even rounded otherwise.
        const double change = std::abs(separation - told_separation(method, here)) / home.size;
        if (by_two && std::isfinite(change))
            tally.worst(method.name, "", "change with a scale of 2^20 or 2^-20 / size", change,
                        1e-15);
    }
}

}  // namespace

void case_broken_pairs(CaseBench& bench)
{
    MethodTally tally;
    for (const double scale : {1e-6, 1.0, 1e6})
        for (const BrokenPair& pair : broken_pairs()) {
            const std::string setting = "scale " + number_text(scale);
            judge(bench, tally, scaled(pair, scale), setting, {.rounds = kMostRounds});
            judge_in_float(bench, tally, scaled(pair, scale), setting);
        }
    tally.report(bench);
}

void case_scaled(CaseBench& bench)
{
    MethodTally tally;
    for (const BrokenPair& pair : broken_pairs()) {
        const KnownPair home = scaled(pair, 1);
        for (const double scale : {1e-6, 1e6, 0x1p-20, 0x1p20}) {
            judge_scale(bench, tally, home, scaled(pair, scale), scale,
                        scale == 0x1p-20 || scale == 0x1p20);
            judge_in_float(bench, tally, scaled(pair, scale), "");
        }
    }
    tally.report(bench);
}

void far_away_pairs(CaseBench& bench)
{
    MethodTally tally;
    for (const auto& [name, by] : {std::pair("at (1e5, 0, -8e4) m", Vec3(1e5, 0, -8e4)),
                                   std::pair("at (1e7, 0, -8e6) m", Vec3(1e7, 0, -8e6))}) {
        const double ulp = std::nextafter(by.x(), 2 * by.x()) - by.x();
        for (const BrokenPair& pair : broken_pairs()) {
            const KnownPair home = moved(pair, Vec3::Zero()), away = moved(pair, by);
            judge(bench, tally, away, name, {.rounds = kMostRounds});
            judge_in_float(bench, tally, away, name);
            for (const MethodDescription& method : known_methods()) {
                const double here = told_separation(method, cold_answer(bench, method, home));
                const double there = told_separation(method, cold_answer(bench, method, away));
                if (std::isnan(here) || std::isnan(there)) continue;
                // Half a last place of each coordinate of both is what their places have lost.
                tally.worst(method.name, name, "change from the answer at the origin",
                            std::abs(here - there) / ulp, std::sqrt(3.0), "ulp");
            }
        }
    }
    tally.report(bench);
}

}  // namespace throng
