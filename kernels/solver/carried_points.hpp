// Carried points: where two meet in the middle of the time ahead, while the surface of one turns
// and takes the other along.
//
// A velocity of where they met before leads along the tangent: by it a body that a plate carries
// round leaves it by half the square of the angle, each time. The middle of the arc leads to its
// end.
#pragma once

#include "kernels/solver/direct/direct_points.hpp"

#include <limits>

namespace throng {

/// How easily a body is moved: inverse mass, 1/kg, and the trace of the inverse inertia, 1/(kg m2).
struct InverseMass {
    double linear = 0, angular = 0;
};

inline InverseMass inverse_mass_of(const DirectBody& body)
{
    return {body.inverse_mass,
            body.inverse_inertia.xx + body.inverse_inertia.yy + body.inverse_inertia.zz};
}

/// How many times as heavy, or as hard to turn, a body is that takes another along.
inline constexpr double kHeavier = 10;

/// Whether a body takes along what lies on it as it turns: one that nothing turns, one that is held
/// at a point or an axle and ten times as hard to turn as the other or, where it turns enough to be
/// seen, one that is ten times as heavy. Of two of like weight neither goes round by itself for
/// long, and to aim at where it would wins energy; a sway of heavy bodies is no turning.
///
///   spin  rad/s
///   dt    s, of the step that arms are taken in
inline bool
carries(const Vec3& spin, const InverseMass& carrier, const InverseMass& carried, double dt)
{
    constexpr double kSeen = 1e-3;  // rad a step
    if (spin.isZero(0)) return false;
    if (carrier.linear == 0) return carrier.angular * kHeavier <= carried.angular;
    return carrier.linear * kHeavier <= carried.linear
        && spin.squaredNorm() * dt * dt >= kSeen * kSeen;
}

/// The share of b's material in where a point goes that a turning surface carries; the rest is that
/// of a. A round side takes the point along and lets its material pass, of two round ones the
/// rounder does more so; of two flat ones who is carried.
///
///   round_a, _b  m, radii; 0 for a side that is not round
double goes_with_b(double round_a, double round_b, bool carried_by_a);

/// How far one side goes by the middle of the time ahead, m, since its arm was taken: its center of
/// mass, and what of its material was at the point.
///
///   turns  something turns it but itself
struct CarriedSide {
    Vec3 center = Vec3::Zero(), material = Vec3::Zero();
    bool turns = false;
};

/// Of a body that has moved and turned since then.
///
///   core  m, the arm to what turns with the body: a round side is the same however it turns
///   half  s, of the time ahead
CarriedSide carried_side(
    const Vec3& moved, const Quat& turned, const DirectBody& body, const Vec3& core, double half);

/// The square of how far the place of a contact may get from where it was of a side, m2: its arm,
/// or without end where nothing turns the side. Who has left what took him along would have arms
/// that grow without end.
///
///   arm_squared  m2, of the arm as it was taken
template <class Real>
Real range_of(Real arm_squared, bool turns)
{
    return turns ? arm_squared : std::numeric_limits<Real>::infinity();
}

/// Moves the arms of a point, as they were taken, to there, unless that is out of range of a side.
void carry_arms(const CarriedSide& a, const CarriedSide& b, double share_of_b, DirectPoint& point);

}  // namespace throng
