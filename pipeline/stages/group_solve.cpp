// Group solve: the points of a group solved together, and point by point where that fails.
#include "pipeline/stages/group_flight.hpp"

#include <algorithm>

namespace throng {

namespace {

constexpr int kNewtonSteps = 50;
// Visits to every point, where the joint solve comes to no sound answer.
constexpr int kPlainSweeps = 200;

}  // namespace

// m/s, of b against a.
Vec3 GroupFlight::closing(const DirectPoint& point, const Motions& bodies)
{
    const auto speed = [&](std::int32_t seat, const Vec3& arm) -> Vec3 {
        if (seat < 0) return Vec3::Zero();
        const DirectBody& body = bodies[static_cast<std::size_t>(seat)];
        return body.velocity + body.spin.cross(arm);
    };
    return speed(point.b, point.arm_b) - speed(point.a, point.arm_a);
}

// Along the normal: below 0 while they close.
double GroupFlight::approach(const DirectPoint& point, const Motions& bodies)
{
    return point.normal.dot(closing(point, bodies));
}

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

// kg-1: by how much an impulse along a direction changes the speed of b against a along it.
double GroupFlight::ease(const DirectPoint& point, const Vec3& along, const Motions& bodies)
{
    const auto of = [&](std::int32_t seat, const Vec3& arm) {
        if (seat < 0) return 0.0;
        const DirectBody& body = bodies[static_cast<std::size_t>(seat)];
        const Vec3 turn = arm.cross(along);
        return body.inverse_mass + turn.dot(body.inverse_inertia.matrix() * turn);
    };
    return of(point.a, point.arm_a) + of(point.b, point.arm_b);
}

void GroupFlight::change(DirectPoint& point, const Vec3& impulse, Motions& bodies)
{
    const auto give = [&](std::int32_t seat, const Vec3& arm, const Vec3& more) {
        if (seat < 0) return;
        DirectBody& body = bodies[static_cast<std::size_t>(seat)];
        body.velocity += more * body.inverse_mass;
        body.spin += body.inverse_inertia.matrix() * arm.cross(more);
    };
    const Vec3 more = impulse - point.impulse;
    give(point.a, point.arm_a, -more);
    give(point.b, point.arm_b, more);
    point.impulse = impulse;
}

// One visit to a point: to its least speed along the normal, then against sliding, within what the
// normal impulse allows. It resists no rolling.
void GroupFlight::push(DirectPoint& point, Motions& bodies)
{
    const double normal_ease = ease(point, point.normal, bodies);
    if (!(normal_ease > 0)) return;
    const double before = point.normal.dot(point.impulse);
    const double missing = point.least - approach(point, bodies);
    const double normal = std::max(before + missing / normal_ease, 0.0);
    change(point, point.impulse + point.normal * (normal - before), bodies);

    Vec3 slide = closing(point, bodies);
    slide -= point.normal * point.normal.dot(slide);
    const double sliding = slide.norm(), most = point.friction * normal;
    Vec3 across = point.impulse - point.normal * normal;
    if (sliding > 0) across -= slide / ease(point, slide / sliding, bodies);
    const double length = across.norm();
    if (length > most) across *= most / length;
    change(point, point.normal * normal + across, bodies);
}

}  // namespace throng
