// Driven contacts: who is driven walks. The ground under it is to friction a belt that runs as the
// body is driven, so that it takes nothing from what has its speed, and helps what has not up to
// what it bears.
//
// Friction that saw the ground stand still would take its share after the drive has set the
// velocity: in a step of 1/60 s, with a coefficient of 0.5, 0.08 m/s of any speed.
#pragma once

#include "kernels/data/bodies.hpp"
#include "kernels/data/contact_constraints.hpp"
#include "throng/math.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

/// Against the fall; zero where nothing falls.
inline Vec3 up_of(const Vec3& gravity)
{
    const double fall = gravity.norm();
    return fall > 0 ? Vec3(-gravity / fall) : Vec3(Vec3::Zero());
}

/// Whether a body stands on what it touches.
///
///   normal  towards the body
inline bool stands_on(const Vec3& normal, const Vec3& up)
{
    return normal.dot(up) >= kSteepestWalk;
}

/// Along the ground, against what is there: as the drive wants it on its axes and, where the ground
/// slopes, what follows on the axes that it leaves free.
inline Vec3 walk_along(const PrescribedVelocity& wanted, const Vec3& ground, const Vec3& normal)
{
    Vec3 walk = Vec3::Zero(), free = normal;
    for (int k = 0; k < 3; ++k) {
        const double speed = wanted[static_cast<std::size_t>(k)];
        if (std::isnan(speed)) continue;
        walk[k] = speed - ground[k];
        free[k] = 0;
    }
    walk -= free * (normal.dot(walk) / std::max(free.squaredNorm(), kLeastFreeWalk));
    return walk - normal * normal.dot(walk);
}

/// The velocity across the normal of b against a, m/s, that friction is to bring about: none but
/// where one of them walks on the other.
///
///   by_a, by_b  where they are driven; null who is not, or no contact moves
///   normal      from a to b
///   rolls       whether b, or else a, is round there and turns: then friction is what has it roll
///   velocity    of the material of b, or else of a, at the contact
template <class Rolls, class Velocity>
Vec3 walk_of(const PrescribedVelocity* by_a,
             const PrescribedVelocity* by_b,
             const Vec3& normal,
             const Vec3& up,
             const Rolls& rolls,
             const Velocity& velocity)
{
    if (by_b != nullptr && stands_on(normal, up) && !rolls(true))
        return walk_along(*by_b, velocity(false), normal);
    if (by_a != nullptr && stands_on(-normal, up) && !rolls(false))
        return -walk_along(*by_a, velocity(true), -normal);
    return Vec3::Zero();
}

}  // namespace throng
