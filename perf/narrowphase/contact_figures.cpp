#include "perf/narrowphase/contact_figures.hpp"

#include "narrowphase/alternatives/method_contacts.hpp"
#include "narrowphase/convex/pair_functions.hpp"
#include "narrowphase/convex/wide/box_pairs.hpp"
#include "perf/narrowphase/method_figures.hpp"

#include <algorithm>

namespace throng::perf {
namespace {

template <class Found>
double told(const Found& found)
{
    return found.count > 0 ? static_cast<double>(found.points[0].separation) : 0;
}

Turn colliding_by(std::string_view name, const Shapes& shapes, const RollingPairs& rolling)
{
    Turn turn;
    turn.ask = [&shapes, &rolling, method = find_convex_method(name),
                memory = std::vector<MethodMemory>(rolling.pairs.size())](
                   std::size_t count, std::size_t step) mutable {
        double sum = 0;
        LocalManifold<double> found;
        for (std::size_t i = 0; i < count; ++i) {
            const auto& one = rolling.pairs[i];
            collide_by(*method, MethodStart::cached,
                       {shapes, one.a, one.b, one.b_in_a[step], kReach}, memory[i], found);
            sum += told(found);
        }
        return sum;
    };
    return turn;
}

template <class Real>
Turn colliding(const Shapes& shapes, const RollingPairs& rolling)
{
    const bool boxes = rolling.pairs[0].b.kind == ShapeKind::box;
    Turn turn;
    turn.ask = [&shapes, &rolling, collide = boxes ? box_box<Real> : hull_hull<Real>,
                caches = std::vector<PairCache>(rolling.pairs.size())](std::size_t count,
                                                                       std::size_t step) mutable {
        double sum = 0;
        LocalManifold<Real> found;
        for (std::size_t i = 0; i < count; ++i) {
            const auto& one = rolling.pairs[i];
            const PoseT<Real> pose{one.b_in_a[step].position.template cast<Real>(),
                                   one.b_in_a[step].orientation.template cast<Real>()};
            collide({shapes, one.a, one.b, pose, static_cast<Real>(kReach)}, caches[i], found);
            sum += told(found);
        }
        return sum;
    };
    return turn;
}

// All pairs at once, as the step has its boxes in float collided.
Turn colliding_boxes(const Shapes& shapes, const RollingPairs& rolling)
{
    Turn turn;
    turn.ask = [&shapes, &rolling, pairs = std::vector<BoxPair>(),
                manifolds = std::vector<LocalManifold<float>>(rolling.pairs.size())](
                   std::size_t count, std::size_t step) mutable {
        pairs.clear();
        for (std::size_t i = 0; i < count; ++i) {
            const auto& one = rolling.pairs[i];
            const PoseT<float> pose{one.b_in_a[step].position.cast<float>(),
                                    one.b_in_a[step].orientation.cast<float>()};
            pairs.push_back(box_pair(pose, shapes.boxes[one.a.index].half_extents.cast<float>(),
                                     shapes.boxes[one.b.index].half_extents.cast<float>(),
                                     static_cast<float>(kReach)));
        }
        collide_boxes(pairs, std::span(manifolds).first(count));
        return told(manifolds[0]);
    };
    return turn;
}

}  // namespace

std::vector<ContactRow>
measure_contacts(const Shapes& shapes, const Build& build, const Effort& effort)
{
    std::vector<ContactRow> rows;
    const bool too_many = std::max(build.vertices_a, build.vertices_b) > kMostAxes;
    Effort here = effort;
    if (too_many) here.pairs = std::min<std::size_t>(effort.pairs, 8);
    for (const PairCase& pair_case : {kTouching, kDeep})
        for (const Motion& motion : {kSmall, kLarge}) {
            const RollingPairs rolling(shapes, build, pair_case, motion, here.pairs);
            const bool boxes = rolling.pairs[0].b.kind == ShapeKind::box;
            // Of two hulls of thousands GJK alone; beside a box the other ways still end.
            const bool gjk_alone = too_many && std::min(build.vertices_a, build.vertices_b) > 0;
            std::vector<Turn> turns{colliding_by("gjk", shapes, rolling)};
            if (!gjk_alone) {
                turns.push_back(colliding_by("sat", shapes, rolling));
                turns.push_back(boxes ? colliding_boxes(shapes, rolling)
                                      : colliding<float>(shapes, rolling));
                turns.push_back(colliding<double>(shapes, rolling));
            }
            take_turns(turns, here);
            ContactRow row{build.name, pair_case.name, motion.name, turns[0].best};
            if (!gjk_alone) {
                row.sat = turns[1].best;
                row.auto_float = turns[2].best;
                row.auto_double = turns[3].best;
            }
            rows.push_back(row);
        }
    return rows;
}

}  // namespace throng::perf
