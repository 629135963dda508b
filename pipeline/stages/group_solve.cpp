// Group solve: the points of a group solved together, and point by point where that fails.
#include "pipeline/stages/group_flight.hpp"

#include <algorithm>

namespace throng {

namespace {

constexpr int kNewtonSteps = 50;
// Visits to every point, where the joint solve comes to no sound answer.
constexpr int kPlainSweeps = 200;

}  // namespace

void GroupFlight::solve(Motions& bodies, std::vector<DirectPoint>& points)
{
    const int asked = scene_.conditions.settings.iterations;
    const Motions before = bodies;
    const DirectAnswer answer = solver_.solve(bodies, points, asked > 0 ? asked : kNewtonSteps);
    const bool sound = std::all_of(bodies.begin(), bodies.end(), [](const DirectBody& body) {
        return holdable(body.velocity) && holdable(body.spin);
    });
    if (sound) {
        residual_ = std::max(residual_, answer.residual);
        return;
    }
    residual_ = std::max(residual_, 1.0);
    bodies = before;
    for (DirectPoint& point : points) point.impulse = point.torque = Vec3::Zero();
    for (int sweep = 0; sweep < kPlainSweeps; ++sweep)
        for (DirectPoint& point : points) push(point, bodies);
}

// One visit to a point: to its least speed along the normal, then against sliding, within what the
// normal impulse allows. It resists no rolling.
void GroupFlight::push(DirectPoint& point, Motions& bodies)
{
    const auto change = [&](const Vec3& impulse) {
        apply_impulse(point, impulse - point.impulse, bodies);
        point.impulse = impulse;
    };
    const double normal_ease = ease_along(point, point.normal, bodies);
    if (!(normal_ease > 0)) return;
    const double before = point.normal.dot(point.impulse);
    const double missing = point.least - speed_apart(point, bodies);
    const double normal = std::max(before + missing / normal_ease, 0.0);
    change(point.impulse + point.normal * (normal - before));

    Vec3 slide = velocity_between(point, bodies);
    slide -= point.normal * point.normal.dot(slide);
    const double sliding = slide.norm(), most = point.friction * normal;
    Vec3 across = point.impulse - point.normal * normal;
    if (sliding > 0) across -= slide / ease_along(point, slide / sliding, bodies);
    const double length = across.norm();
    if (length > most) across *= most / length;
    change(point.normal * normal + across);
}

}  // namespace throng
