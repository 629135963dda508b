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
            const Meeting& meeting,
            MethodStart start)
{
    Turn turn;
    turn.ask = [&method, &rolling, reach = meeting.reach, start,
                memory = std::vector<MethodMemory>(rolling.pairs.size())](
                   std::size_t count, std::size_t step) mutable {
        double sum = 0;
        for (std::size_t i = 0; i < count; ++i)
            sum += method.ask(*rolling.pairs[i].asked[step], reach, start, memory[i]).separation;
        return sum;
    };
    return turn;
}

struct KnownPair {
    std::size_t pair, step;
    double separation, volume;
};

bool can_ask(const ConvexMethod& method, const Build& build, const Meeting& meeting)
{
    const std::size_t vertices = std::max(build.vertices_a, build.vertices_b);
    return method.name != "sat" || vertices <= kMostAxes || (meeting.gap > 0 && !meeting.either);
}

bool can_ask_plain(const Build& build)
{
    return std::max(build.vertices_a, build.vertices_b) <= kMostPlain;
}

std::vector<KnownPair>
know(const RollingPairs& rolling, const Meeting& meeting, const Effort& effort, double& unproved)
{
    std::vector<KnownPair> known;
    for (std::size_t i = 0; i < std::min(effort.judged, rolling.pairs.size()); ++i) {
        const std::size_t step = i % 2 == 0 ? 0 : kSteps - 1;
        const Pose& pose = rolling.pairs[i].b_in_a[step];
        const PolytopePair& pair = *rolling.pairs[i].asked[step]->polytopes();
        const PairTruth truth = pair_truth(pair, pose);
        unproved = std::max(unproved, truth.unproved);
        const bool shares = meeting.gap < 0;  // enough to speak of
        known.push_back({i, step, truth.separation, shares ? shared_volume(pair, pose) : 0});
    }
    return known;
}

void judge(const ConvexMethod& method,
           const MethodAnswer& answer,
           const KnownPair& known,
           const Meeting& meeting,
           Worth& worth)
{
    ++worth.asked;
    const bool touch = known.separation <= 0;
    if (answer.touch == Touch::undecided) {
        ++worth.undecided;
        return;
    }
    if ((answer.touch == Touch::touching) != touch) ++worth.wrong;
    const double off = std::abs(answer.separation - known.separation);
    if (touch && (method.tells & tells_depth) != 0) worth.add_error("depth", off);
    if (!touch && (method.tells & tells_distance) != 0 && known.separation <= meeting.reach)
        worth.add_error("distance", off);
    if (known.volume > 0 && (method.tells & tells_volume) != 0)
        worth.add_error("volume", std::abs(answer.volume - known.volume) / known.volume);
}

Worth worth_of(const ConvexMethod& method,
               const RollingPairs& rolling,
               std::span<const KnownPair> known,
               const Build& build,
               const Meeting& meeting)
{
    Worth worth;
    for (const KnownPair& one : known) {
        const auto& asked = rolling.pairs[one.pair].asked;
        MethodMemory memory;
        for (std::size_t step = 0; step < one.step; ++step)
            method.ask(*asked[step], meeting.reach, MethodStart::cached, memory);
        for (const MethodStart start :
             {MethodStart::cached, MethodStart::cold, MethodStart::plain}) {
            if (start == MethodStart::plain && !can_ask_plain(build)) continue;
            judge(method, method.ask(*asked[one.step], meeting.reach, start, memory), one, meeting,
                  worth);
        }
    }
    return worth;
}

}  // namespace

void measure_meeting(const Shapes& shapes,
                     const Build& build,
                     const Meeting& meeting,
                     const Effort& effort,
                     double& unproved,
                     std::vector<Row>& rows)
{
    Effort here = effort;
    if (std::max(build.vertices_a, build.vertices_b) > kMostAxes) {
        here.pairs = std::min<std::size_t>(effort.pairs, 16);
        here.judged = std::min<std::size_t>(effort.judged, 4);
    }
    const RollingPairs small(shapes, build, meeting, kSmall, here.pairs);
    const RollingPairs large(shapes, build, meeting, kLarge, here.pairs);
    const std::vector<KnownPair> known = know(large, meeting, here, unproved);

    std::vector<Row> made;
    std::vector<Turn> turns;
    for (const ConvexMethod& method : convex_methods()) {
        if (!can_ask(method, build, meeting)) continue;
        made.push_back({method.name, build.name, meeting.name, kNone, kNone, kNone, kNone,
                        worth_of(method, large, known, build, meeting)});
        turns.push_back(asking(method, small, meeting, MethodStart::cold));
        turns.push_back(asking(method, small, meeting, MethodStart::cached));
        turns.push_back(asking(method, large, meeting, MethodStart::cached));
        if (can_ask_plain(build))
            turns.push_back(asking(method, small, meeting, MethodStart::plain));
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
