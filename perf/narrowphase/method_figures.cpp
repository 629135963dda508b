#include "perf/narrowphase/method_figures.hpp"

#include "perf/narrowphase/pair_truth.hpp"

#include <algorithm>
#include <cmath>

namespace throng::perf {
namespace {

// A plain start looks at everything, of hulls beyond this for longer than it is worth.
constexpr std::size_t kMostPlain = 128;

Turn asking(const ConvexMethod& method,
            const RollingPairs& rolling,
            const PairCase& pair_case,
            MethodStart start)
{
    Turn turn;
    turn.ask = [&method, &rolling, speculative_margin = pair_case.speculative_margin, start,
                memory = std::vector<MethodMemory>(rolling.pairs.size())](
                   std::size_t count, std::size_t step) mutable {
        double sum = 0;
        for (std::size_t i = 0; i < count; ++i)
            sum += method.ask(*rolling.pairs[i].asked[step], speculative_margin, start, memory[i])
                       .separation;
        return sum;
    };
    return turn;
}

struct KnownPair {
    std::size_t pair, step;
    double separation, volume;
};

bool can_ask(const ConvexMethod& method, const Build& build, const PairCase& pair_case)
{
    const std::size_t vertices = std::max(build.vertices_a, build.vertices_b);
    return method.name != "sat" || vertices <= kMostAxes
        || (pair_case.clearance > 0 && !pair_case.either);
}

bool can_ask_plain(const Build& build)
{
    return std::max(build.vertices_a, build.vertices_b) <= kMostPlain;
}

std::vector<KnownPair>
know(const RollingPairs& rolling, const PairCase& pair_case, const Effort& effort, double& unproved)
{
    std::vector<KnownPair> known;
    for (std::size_t i = 0; i < std::min(effort.judged, rolling.pairs.size()); ++i) {
        const std::size_t step = i % 2 == 0 ? 0 : kSteps - 1;
        const Pose& pose = rolling.pairs[i].b_in_a[step];
        const PolytopePair& pair = *rolling.pairs[i].asked[step]->polytopes();
        const PairTruth truth = pair_truth(pair, pose);
        unproved = std::max(unproved, truth.unproved);
        const bool shares = pair_case.clearance < 0;  // enough to speak of
        known.push_back({i, step, truth.separation, shares ? shared_volume(pair, pose) : 0});
    }
    return known;
}

void judge(const ConvexMethod& method,
           const MethodAnswer& answer,
           const KnownPair& known,
           const PairCase& pair_case,
           Worth& worth)
{
    ++worth.asked;
    const bool touching = known.separation <= 0;
    if (answer.overlap == OverlapState::undecided) {
        ++worth.undecided;
        return;
    }
    if ((answer.overlap == OverlapState::touching) != touching) ++worth.wrong;
    const double off = std::abs(answer.separation - known.separation);
    if (touching && (method.tells & tells_depth) != 0) worth.add_error("depth", off);
    if (!touching && (method.tells & tells_distance) != 0
        && known.separation <= pair_case.speculative_margin)
        worth.add_error("distance", off);
    if (known.volume > 0 && (method.tells & tells_volume) != 0)
        worth.add_error("volume", std::abs(answer.volume - known.volume) / known.volume);
}

Worth worth_of(const ConvexMethod& method,
               const RollingPairs& rolling,
               std::span<const KnownPair> known,
               const Build& build,
               const PairCase& pair_case)
{
    Worth worth;
    for (const KnownPair& one : known) {
        const auto& asked = rolling.pairs[one.pair].asked;
        MethodMemory memory;
        for (std::size_t step = 0; step < one.step; ++step)
            method.ask(*asked[step], pair_case.speculative_margin, MethodStart::cached, memory);
        for (const MethodStart start :
             {MethodStart::cached, MethodStart::cold, MethodStart::plain}) {
            if (start == MethodStart::plain && !can_ask_plain(build)) continue;
            judge(method, method.ask(*asked[one.step], pair_case.speculative_margin, start, memory),
                  one, pair_case, worth);
        }
    }
    return worth;
}

}  // namespace

void measure_meeting(const Shapes& shapes,
                     const Build& build,
                     const PairCase& pair_case,
                     const Effort& effort,
                     double& unproved,
                     std::vector<Row>& rows)
{
    Effort here = effort;
    if (std::max(build.vertices_a, build.vertices_b) > kMostAxes) {
        here.pairs = std::min<std::size_t>(effort.pairs, 16);
        here.judged = std::min<std::size_t>(effort.judged, 4);
    }
    const RollingPairs small(shapes, build, pair_case, kSmall, here.pairs);
    const RollingPairs large(shapes, build, pair_case, kLarge, here.pairs);
    const std::vector<KnownPair> known = know(large, pair_case, here, unproved);

    std::vector<Row> made;
    std::vector<Turn> turns;
    for (const ConvexMethod& method : convex_methods()) {
        if (!can_ask(method, build, pair_case)) continue;
        made.push_back({method.name, build.name, pair_case.name, kNone, kNone, kNone, kNone,
                        worth_of(method, large, known, build, pair_case)});
        turns.push_back(asking(method, small, pair_case, MethodStart::cold));
        turns.push_back(asking(method, small, pair_case, MethodStart::cached));
        turns.push_back(asking(method, large, pair_case, MethodStart::cached));
        if (can_ask_plain(build))
            turns.push_back(asking(method, small, pair_case, MethodStart::plain));
    }
    take_turns(turns, here);
    std::size_t next = 0;
    for (Row& row : made) {
        row.cold = turns[next++].best;
        row.warm_small = turns[next++].best;
        row.warm_large = turns[next++].best;
        if (can_ask_plain(build)) row.plain = turns[next++].best;
        rows.push_back(std::move(row));
    }
}

}  // namespace throng::perf
