// Solver bodies: what a substep does to them besides contacts.
#pragma once

#include "kernels/data/rows.hpp"
#include "kernels/math/types.hpp"

#include <span>

namespace throng {

/// Turns the bodies that turn by kFastTurn and more in a time, and no other: the exponential map,
/// exact for a constant angular velocity. The wide kernels turn the rest.
template <class Real>
void turn_fast(std::span<SolverBody<Real>> bodies, Real time);

/// True for a body that begin_substep() stopped because its velocity could not be held.
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
