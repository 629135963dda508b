#include "narrowphase/alternatives/bounding_sphere.hpp"

#include <cmath>
#include <limits>

namespace throng {
namespace {

// Of the size: a dozen roundings.
constexpr double kWidened = 64 * std::numeric_limits<double>::epsilon();

}  // namespace

Ball ball_round(const ConvexCore<double>& core)
{
    if (core.kind == ShapeKind::hull) return {core.hull->center, core.hull->outer_radius};
    // A cylinder's rim is as far to the side as its first extent says, and not its first two.
    const double side = core.kind == ShapeKind::cylinder ? 0 : core.extents.y();
    return {Vec3::Zero(),
            core.convex_radius + std::hypot(core.extents.x(), side, core.extents.z())};
}

MethodAnswer query_bounding_sphere(const ConvexPair& pair, double, MethodStart, MethodMemory&)
{
    const ConvexCorePair& cores = pair.cores();
    const Ball a = ball_round(cores.a), b = ball_round(cores.b);
    const Vec3 offset = cores.b_turn * b.center + cores.b_position - a.center;
    const double distance = std::sqrt(offset.squaredNorm());
    const double size = cores.size + std::sqrt(cores.b_position.squaredNorm());
    MethodAnswer answer;
    answer.rounds = 1;
    if (!(distance > a.radius + b.radius + kWidened * size)) return answer;
    answer.overlap = OverlapState::apart;
    answer.normal = offset / distance;
    return answer;
}

}  // namespace throng
