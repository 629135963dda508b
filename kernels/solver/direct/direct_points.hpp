// Direct points: what bodies do at a point where they meet, and what an impulse there does to them.
#pragma once

#include "kernels/solver/direct/direct.hpp"

#include <algorithm>

namespace throng {

/// Velocity of b against a at a point, m/s, as friction sees it: less the walk.
inline Vec3 relative_velocity(const DirectPoint& point, std::span<const DirectBody> bodies)
{
    const auto speed = [&](std::int32_t index, const Vec3& arm) -> Vec3 {
        if (index < 0) return Vec3::Zero();
        const DirectBody& body = bodies[static_cast<std::size_t>(index)];
        return body.velocity + body.spin.cross(arm);
    };
    return speed(point.b, point.arm_b) - speed(point.a, point.arm_a) - point.walk;
}

/// Of that, the part along the normal: below 0 while they close.
inline double relative_normal_velocity(const DirectPoint& point, std::span<const DirectBody> bodies)
{
    return point.normal.dot(relative_velocity(point, bodies));
}

/// By how much an impulse along a direction changes the speed of b against a along it, 1/kg.
inline double
inverse_mass_along(const DirectPoint& point, const Vec3& along, std::span<const DirectBody> bodies)
{
    const auto of = [&](std::int32_t index, const Vec3& arm) {
        if (index < 0) return 0.0;
        const DirectBody& body = bodies[static_cast<std::size_t>(index)];
        const Vec3 turn = arm.cross(along);
        return body.inverse_mass + turn.dot(Vec3(body.inverse_inertia.matrix() * turn));
    };
    return of(point.a, point.arm_a) + of(point.b, point.arm_b);
}

/// At least what any direction across the normal comes to of that.
inline double widest_inverse_mass(const DirectPoint& point, std::span<const DirectBody> bodies)
{
    const Vec3 along = point.normal.unitOrthogonal(), other = point.normal.cross(along);
    return inverse_mass_along(point, along, bodies) + inverse_mass_along(point, other, bodies);
}

/// Gives an impulse, N s, to b, and its opposite to a.
inline void
apply_impulse(const DirectPoint& point, const Vec3& impulse, std::span<DirectBody> bodies)
{
    const auto apply = [&](std::int32_t index, const Vec3& arm, double sign) {
        if (index < 0) return;
        DirectBody& body = bodies[static_cast<std::size_t>(index)];
        body.velocity += sign * body.inverse_mass * impulse;
        body.spin += sign * Vec3(body.inverse_inertia.matrix() * arm.cross(impulse));
    };
    apply(point.a, point.arm_a, -1);
    apply(point.b, point.arm_b, 1);
}

/// Angular velocity of b against a, rad/s.
inline Vec3 relative_spin(const DirectPoint& point, std::span<const DirectBody> bodies)
{
    const auto spin = [&](std::int32_t index) -> Vec3 {
        return index < 0 ? Vec3(Vec3::Zero()) : bodies[static_cast<std::size_t>(index)].spin;
    };
    return spin(point.b) - spin(point.a);
}

/// By how much a torque about an axis, for a time, changes the spin of b against a about it,
/// 1 / (kg m2).
inline double inverse_inertia_about(const DirectPoint& point,
                                    const Vec3& axis,
                                    std::span<const DirectBody> bodies)
{
    const auto of = [&](std::int32_t index) {
        if (index < 0) return 0.0;
        const Mat3 inverse = bodies[static_cast<std::size_t>(index)].inverse_inertia.matrix();
        return axis.dot(Vec3(inverse * axis));
    };
    return of(point.a) + of(point.b);
}

/// Gives a torque for a time, N m s, to b, and its opposite to a.
inline void apply_torque(const DirectPoint& point, const Vec3& torque, std::span<DirectBody> bodies)
{
    const auto turn = [&](std::int32_t index, double sign) {
        if (index < 0) return;
        DirectBody& body = bodies[static_cast<std::size_t>(index)];
        body.spin += sign * Vec3(body.inverse_inertia.matrix() * torque);
    };
    turn(point.a, -1);
    turn(point.b, 1);
}

/// J, what the impulses of points did to the bodies, as seen from those that move by themselves.
inline double work_of(std::span<const DirectPoint> points,
                      std::span<const DirectBody> before,
                      std::span<const DirectBody> after)
{
    double work = 0;
    for (const DirectPoint& point : points) {
        const Vec3 passed = relative_velocity(point, before) + relative_velocity(point, after);
        const Vec3 turned = relative_spin(point, before) + relative_spin(point, after);
        work += 0.5 * (point.impulse.dot(passed) + point.torque.dot(turned));
    }
    return work;
}

/// Friction of an impact at a point, and what resists rolling, up to what they bear of the impulse
/// that threw it back, N s. Adds to the point's impulse and torque, and never to the energy.
inline void apply_impact_friction(double load, DirectPoint& point, std::span<DirectBody> bodies)
{
    const Vec3 between = relative_velocity(point, bodies);
    const Vec3 sliding = between - point.normal * point.normal.dot(between);
    const double fast = sliding.norm();
    if (fast > 0 && point.friction > 0) {
        const double sticks = 1 / inverse_mass_along(point, sliding / fast, bodies);
        const Vec3 impulse = sliding * -std::min(sticks, point.friction * load / fast);
        point.impulse += impulse;
        apply_impulse(point, impulse, bodies);
    }
    const Vec3 turning = relative_spin(point, bodies);
    const double turns = turning.norm();
    if (!(turns > 0 && point.rolling > 0)) return;
    const double inverse_mass = inverse_inertia_about(point, turning / turns, bodies);
    if (!(inverse_mass > 0)) return;
    const Vec3 torque = turning * -std::min(1 / inverse_mass, point.rolling * load / turns);
    point.torque += torque;
    apply_torque(point, torque, bodies);
}

/// The restitution of points that are struck together: the mean over the work that stopping each
/// took, so that where coefficients differ none gains energy.
///
///   points       with the impulses that stopped them
///   speeds       [points] m/s, at which they closed
///   restitution  [points]
inline double shared_restitution(std::span<const DirectPoint> points,
                                 std::span<const double> speeds,
                                 std::span<const double> restitution)
{
    double all = 0, kept = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double work = points[i].normal.dot(points[i].impulse) * speeds[i];
        all += work;
        kept += work * restitution[i];
    }
    return all > 0 ? kept / all : 0;
}

/// Takes bodies from how they were beyond where they were stopped: `times` the change, so that 2
/// mirrors them.
///
/// Source: Smith, Kaufman, Vouga, Tamstorf and Grinspun, Reflections on Simultaneous Impact (2012).
inline void mirror(std::span<const DirectBody> stopped, double times, std::span<DirectBody> bodies)
{
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        bodies[i].velocity += (stopped[i].velocity - bodies[i].velocity) * times;
        bodies[i].spin += (stopped[i].spin - bodies[i].spin) * times;
    }
}

/// Leaves so much of what the impulses of points did to the bodies.
inline void leave_share(double share,
                        std::span<const DirectBody> before,
                        std::span<DirectPoint> points,
                        std::span<DirectBody> after)
{
    mirror(before, 1 - share, after);
    for (DirectPoint& point : points) {
        point.impulse *= share;
        point.torque *= share;
    }
}

}  // namespace throng
