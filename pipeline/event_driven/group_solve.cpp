// Group solve: the points of a group solved together, and point by point where that fails.
#include "pipeline/event_driven/event_driven_group.hpp"
#include "pipeline/solvers/solve_island.hpp"

#include <algorithm>

namespace throng {

namespace {

// Iterations to every point, where the joint solve comes to no sound answer.
constexpr int kPlainSweeps = 200;
// In work, of a point in a factorisation.
constexpr std::size_t kPointWork = 2;
// Greater tables of pivots take longer than all else that is tried: seventy points half a second,
// hundreds of times a step.
constexpr std::size_t kPivotPoints = 16;
// A residual that is no answer.
constexpr double kLost = 0.1;
// Contacts that do not bounce leave nobody this much faster than the fastest of them was.
constexpr double kFaster = 100;

}  // namespace

void EventDrivenGroup::solve(Motions& bodies, std::vector<DirectPoint>& points)
{
    const Motions before = bodies;
    DirectEffort effort = asked_effort(scene_.parameters);
    effort.pivots = points.size() <= kPivotPoints;
    const DirectAnswer answer = solver_.solve(bodies, points, effort);
    spend(points.size() * (1 + kPointWork * static_cast<std::size_t>(answer.steps)));
    const bool sound = std::all_of(bodies.begin(), bodies.end(), [](const DirectBody& body) {
        return holdable(body.velocity) && holdable(body.spin);
    });
    const double most = kFaster * fastest_at(before, points);
    if (sound && answer.residual < kLost && fastest_at(bodies, points) <= most) {
        outcome_.residual = std::max(outcome_.residual, answer.residual);
        return;
    }
    outcome_.residual = std::max(outcome_.residual, 1.0);
    bodies = before;
    for (DirectPoint& point : points) point.impulse = point.torque = Vec3::Zero();
    solve_points(bodies, points);
    spend(points.size() * kPlainSweeps / 4);
}

// m/s, by how much the points close faster than they may, at worst.
double EventDrivenGroup::worst_miss(const Motions& bodies, const std::vector<DirectPoint>& points)
{
    double worst = 0;
    for (const DirectPoint& point : points)
        worst = std::max(worst, point.least - relative_normal_velocity(point, bodies));
    return worst;
}

// m/s, at the points.
double EventDrivenGroup::fastest_at(const Motions& bodies, const std::vector<DirectPoint>& points)
{
    double fastest = 0;
    for (const DirectPoint& point : points)
        fastest =
            std::max(fastest, relative_velocity(point, bodies).norm() + std::abs(point.least));
    return fastest;
}

// Point by point, and what came nearest is kept: where what moves by itself wants more than there
// is room for, no answer will do, and pushing on only throws bodies about.
void EventDrivenGroup::solve_points(Motions& bodies, std::vector<DirectPoint>& points)
{
    Motions nearest = bodies;
    std::vector<DirectPoint> nearest_points = points;
    double least = worst_miss(bodies, points);
    const double most = kFaster * fastest_at(bodies, points);
    for (int iteration = 0; iteration < kPlainSweeps && least > 0; ++iteration) {
        for (DirectPoint& point : points) solve_point(point, bodies);
        const double missed = worst_miss(bodies, points);
        if (!(missed < least) || !(fastest_at(bodies, points) <= most)) continue;
        least = missed;
        nearest = bodies;
        nearest_points = points;
    }
    bodies = std::move(nearest);
    points = std::move(nearest_points);
}

// One iteration to a point: to its least speed along the normal, then against sliding, within what
// the normal impulse allows. It resists no rolling.
void EventDrivenGroup::solve_point(DirectPoint& point, Motions& bodies)
{
    const auto change = [&](const Vec3& impulse) {
        apply_impulse(point, impulse - point.impulse, bodies);
        point.impulse = impulse;
    };
    const double normal_ease = inverse_mass_along(point, point.normal, bodies);
    if (!(normal_ease > 0)) return;
    const double before = point.normal.dot(point.impulse);
    const double missing = point.least - relative_normal_velocity(point, bodies);
    const double normal = std::max(before + missing / normal_ease, 0.0);
    change(point.impulse + point.normal * (normal - before));

    Vec3 slide = relative_velocity(point, bodies);
    slide -= point.normal * point.normal.dot(slide);
    const double sliding = slide.norm(), most = point.friction * normal;
    Vec3 across = point.impulse - point.normal * normal;
    if (sliding > 0) across -= slide / inverse_mass_along(point, slide / sliding, bodies);
    const double length = across.norm();
    if (length > most) across *= most / length;
    change(point.normal * normal + across);
}

}  // namespace throng
