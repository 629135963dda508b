// Solver bodies: what a substep does to them besides contacts.
#pragma once

#include "kernels/data/rows.hpp"
#include "kernels/math/types.hpp"

#include <span>

namespace throng {

/// Adds a change of velocity to every body that has mass.
template <class Real>
void add_velocity(std::span<SolverBody<Real>> bodies, const Vec3& change);

/// Moves every body by its velocity for a time.
template <class Real>
void move_bodies(std::span<SolverBody<Real>> bodies, Real time);

/// Turns every body by its angular velocity for a time: the exponential map, exact for a constant
/// angular velocity.
template <class Real>
void turn_bodies(std::span<SolverBody<Real>> bodies, Real time);

/// How far a body has turned since the step began.
template <class Real>
Quat turn_of(const SolverBody<Real>& body)
{
    return {double{body.drift[7]}, double{body.drift[4]}, double{body.drift[5]},
            double{body.drift[6]}};
}

}  // namespace throng
