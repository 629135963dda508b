#include "narrowphase/ccd/first_impact.hpp"

namespace throng {

FirstImpact first_impact(const Shapes& shapes,
                         std::span<const MovingShape> group,
                         std::span<const ImpactPair> pairs,
                         double begin,
                         double end,
                         ToiMethod method,
                         double tolerance)
{
    FirstImpact first;
    first.pair = pairs.size();
    first.impact.time = end;
    int evaluations = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const MovingShape &a = group[pairs[i].a], &b = group[pairs[i].b];
        const ImpactRule rule =
            impact_rule(method, tolerance * impact_size(shapes, a.shape, b.shape));
        const Impact impact = time_of_impact(shapes, a, b, begin, first.impact.time, rule);
        evaluations += impact.evaluations;
        if (impact.state != ToiState::hit) continue;
        if (first.impact.state == ToiState::hit && !(impact.time < first.impact.time)) continue;
        first = {i, impact};
    }
    first.impact.evaluations = evaluations;
    return first;
}

}  // namespace throng
