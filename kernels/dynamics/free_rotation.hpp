// Free rotation: how a body on which no torque acts turns, in parts that are exact each.
//
// With moments A <= B <= C the energy is |L|^2 / 2B and what is left about the two other axes. The
// first turns the body about its angular momentum as it stands in space and has nothing to do with
// the rest, so one turn does for any time. The rest turn about one axis each, which hands momentum
// over between the two others: half about one, all about the other, half about the first. The
// length of the momentum is kept to rounding, energy sways and never drifts, and a body with an
// axis of symmetry, of which one part of the rest is nothing, is carried exactly.
//
// Source: Touma & Wisdom, Lie-Poisson integrators for rigid body dynamics in the solar system
//         (1994); McLachlan & Zanna, The discrete Moser-Veselov algorithm for the free rigid body,
//         revisited (2005), 4.
#pragma once

#include "kernels/math/rotation.hpp"
#include "throng/math.hpp"

namespace throng {

struct FreeRotation {
    int middle = 0;               // the axis of the middle moment; outer and inner follow in turn
    double share = 0;             // 1 / that moment, 1 / (kg m2)
    double outer = 0, inner = 0;  // by how much 1 / moment is greater about those
    /// How much of a nutation's phase is one of angular momentum in a time, 1 / (kg m2).
    double pace = 0;
};

/// moments: about principal axes, kg m2
FreeRotation free_rotation(const Vec3& moments);

/// Into how many parts a span, s, has to go for nutation to keep time; 0 where it would take more
/// than `most`.
///
///   momentum  its length, N m s
int parts_of(const FreeRotation& rotation, double momentum, double span, int most);

/// Carries a body for a span, s.
///
///   parts     from 1
///   momentum  N m s, principal axes; in and out
///   turn_by   called with every turn that the body makes, rad, about an axis in principal axes
template <typename TurnBy>
void turn_freely(
    const FreeRotation& rotation, double span, int parts, Vec3& momentum, TurnBy&& turn_by)
{
    turn_by(Vec3(span * rotation.share * momentum));
    const double part = span / parts;
    const int outer = (rotation.middle + 1) % 3, inner = (rotation.middle + 2) % 3;
    const auto turn_about = [&](int axis, double inverse_inertia) {
        const int next = (axis + 1) % 3, last = (axis + 2) % 3;
        const double angle = part * inverse_inertia * momentum[axis];
        if (angle == 0) return;
        const SinCos turn = sin_cos(angle);
        const double x = momentum[next], y = momentum[last];
        momentum[next] = turn.cos * x + turn.sin * y;
        momentum[last] = turn.cos * y - turn.sin * x;
        turn_by(Vec3(angle * Vec3::Unit(axis)));
    };
    turn_about(outer, 0.5 * rotation.outer);
    for (int i = 0; i < parts; ++i) {
        turn_about(inner, rotation.inner);
        turn_about(outer, (i + 1 < parts ? 1 : 0.5) * rotation.outer);
    }
}

}  // namespace throng
