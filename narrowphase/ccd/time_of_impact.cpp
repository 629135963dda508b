#include "narrowphase/ccd/time_of_impact.hpp"

#include "kernels/geometry/mesh.hpp"
#include "kernels/geometry/shape_bounds.hpp"
#include "narrowphase/ccd/impact_of_spheres.hpp"
#include "narrowphase/ccd/impact_of_surfaces.hpp"
#include "narrowphase/ccd/moving_cores.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace throng {

namespace {

// Distances found afresh. What is not settled by then grazes, and is told early. Advancement takes
// a step a round, and past a wall that it misses by a millionth some ten thousand.
constexpr int kMostRounds = 512, kMostAdvances = 32768;
// Separations asked for, but for those of one last fall: of two that turn faster than any search
// can follow. A triangle of a mesh has some left even when those before it used them up.
constexpr int kMostEvaluations = 8192, kLeastEvaluations = 64;

int most_rounds(ToiMethod method)
{
    return method == ToiMethod::conservative ? kMostAdvances : kMostRounds;
}

Impact at_end(double end, int evaluations)
{
    Impact impact;
    impact.time = end;
    impact.evaluations = evaluations;
    return impact;
}

// Along the direction that parts them now until that no longer does, then along the next.
template <class Ways>
Impact impact_of(const Ways& ways,
                 double begin,
                 double end,
                 const ImpactRule& rule,
                 int most_evaluations = kMostEvaluations)
{
    Impact impact;
    double time = begin;
    const int most = most_rounds(rule.method);
    if (rule.method == ToiMethod::conservative) most_evaluations = 2 * kMostAdvances;
    for (int round = 0;; ++round) {
        const Apart apart = ways.distance_at(time);
        ++impact.evaluations;
        impact.time = time;
        impact.distance = std::max(0.0, apart.separation.value);
        impact.normal = apart.normal;
        if (!(apart.separation.value > rule.close)) {
            impact.state = round == 0 ? ToiState::touching_at_start : ToiState::hit;
            return impact;
        }
        if (round == most || impact.evaluations >= most_evaluations) break;
        const auto separation_at = [&](double at) {
            ++impact.evaluations;
            return ways.separation_rate(apart.normal, at);
        };
        const Crossing crossing = first_crossing(rule, separation_at, time, apart.separation, end,
                                                 ways.limits_along(apart.normal));
        if (crossing.clear) return at_end(end, impact.evaluations);
        if (!(crossing.time > time)) break;
        time = crossing.time;
    }
    impact.state = ToiState::hit;
    impact.cut_short = true;
    return impact;
}

// The triangles of a mesh, each for itself; the first that is met ends the search of the others.
Impact impact_with_mesh(const Mesh& mesh,
                        const MovingShape& on,
                        const ConvexCore<double>& core,
                        const MovingShape& other,
                        double begin,
                        double end,
                        const ImpactRule& rule)
{
    Impact first = at_end(end, 0);
    int evaluations = 0;
    const Approach approach{begin, end, rule.close};
    visit_triangles_in_way(mesh, on, core, other, approach, [&](std::uint32_t at) {
        const auto& [u, v, w] = mesh.triangles[at];
        const Vec3 corners[] = {mesh.vertices[u], mesh.vertices[v], mesh.vertices[w]};
        const MovingCores cores(convex_core_of_points(std::span<const Vec3>(corners)), on, core,
                                other);
        const Impact impact =
            impact_of(cores, begin, first.time, rule,
                      std::max(kLeastEvaluations, kMostEvaluations - evaluations));
        evaluations += impact.evaluations;
        if (impact.state == ToiState::separated) return;
        if (first.state != ToiState::separated && impact.time >= first.time) {
            // Of those met at once the one that is nearest.
            if (impact.distance >= first.distance) return;
        }
        first = impact;
    });
    first.evaluations = evaluations;
    return first;
}

Impact turned_round(Impact impact)
{
    impact.normal = -impact.normal;
    return impact;
}

// The ball within a shape, about its middle: what stands for a mesh against a mesh.
Impact impact_of_meshes(const Shapes& shapes,
                        const MovingShape& a,
                        const MovingShape& b,
                        double begin,
                        double end,
                        const ImpactRule& rule)
{
    const bool ball_of_b = !(inner_extent(shapes, a.shape) > inner_extent(shapes, b.shape));
    MovingShape other = ball_of_b ? b : a;
    other.ball = inner_extent(shapes, other.shape);
    return ball_of_b ? time_of_impact(shapes, a, other, begin, end, rule)
                     : time_of_impact(shapes, other, b, begin, end, rule);
}

// Its triangles, unless a ball stands for it.
const Mesh* mesh_of(const Shapes& shapes, const MovingShape& moving)
{
    return moving.ball > 0 ? nullptr : mesh_of(shapes, moving.shape);
}

}  // namespace

Impact impact_of_cores(const MovingCores& cores, double begin, double end, const ImpactRule& rule)
{
    return impact_of(cores, begin, end, rule);
}

double impact_size(const Shapes& shapes, ShapeRef a, ShapeRef b)
{
    constexpr double kNone = std::numeric_limits<double>::infinity();
    double inner = kNone, outer = kNone;
    for (const ShapeRef shape : {a, b}) {
        const double extent = inner_extent(shapes, shape);
        if (extent > 0) inner = std::min(inner, extent);
        outer = std::min(outer, outer_radius(shapes, shape));
    }
    return inner < kNone ? inner : outer;
}

ImpactRule impact_rule(ToiMethod method, double tolerance)
{
    return {method, tolerance / 2, tolerance};
}

Impact time_of_impact(const Shapes& shapes,
                      const MovingShape& a,
                      const MovingShape& b,
                      double begin,
                      double end,
                      const ImpactRule& rule)
{
    if (a.shape.kind == ShapeKind::plane && b.shape.kind == ShapeKind::plane) return at_end(end, 0);
    if (stands_as_spheres(shapes, a) || stands_as_spheres(shapes, b))
        return impact_of_spheres(shapes, a, b, begin, end, rule);
    const Mesh *on_a = mesh_of(shapes, a), *on_b = mesh_of(shapes, b);
    if (a.shape.kind == ShapeKind::plane)
        return impact_of(OverPlane(shapes, a, b), begin, end, rule);
    if (b.shape.kind == ShapeKind::plane)
        return turned_round(impact_of(OverPlane(shapes, b, a), begin, end, rule));
    if (on_a && on_b && (a.pieces || b.pieces))
        return impact_of_surfaces(*on_a, a, *on_b, b, begin, end, rule);
    if (on_a && on_b) return impact_of_meshes(shapes, a, b, begin, end, rule);
    if (on_a) {
        const ConvexCore<double> core = moving_core(shapes, b);
        return impact_with_mesh(*on_a, a, core, b, begin, end, rule);
    }
    const ConvexCore<double> core = moving_core(shapes, a);
    if (on_b) return turned_round(impact_with_mesh(*on_b, b, core, a, begin, end, rule));
    return impact_of(MovingCores(core, a, moving_core(shapes, b), b), begin, end, rule);
}

}  // namespace throng
