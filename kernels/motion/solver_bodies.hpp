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

/// Stops every body whose velocity is no longer a number, or beyond what products of it can hold,
/// and marks it: it stands still for the rest of the step, so that what touches it stays sound.
template <class Real>
void stop_runaways(std::span<SolverBody<Real>> bodies);

template <class Real>
bool ran_away(const SolverBody<Real>& body)
{
    return body.drift[3] != 0;
}

/// How far a body has turned since the step began.
template <class Real>
Quat turn_of(const SolverBody<Real>& body)
{
    return {double{body.drift[7]}, double{body.drift[4]}, double{body.drift[5]},
            double{body.drift[6]}};
}

}  // namespace throng
