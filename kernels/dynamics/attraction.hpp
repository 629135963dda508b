// Attraction: how an attractor draws a body, and what it has given up for it.
//
// By strength / distance^2, as far in as substeps follow it. Nearer by, a substep would see a few
// places of a pass that turns all of the motion round, and make energy of any size; there it draws
// as the inside of a ball does whose density falls off to nothing at its edge: the force goes on
// smoothly, slope and all, is nothing in the middle, and has a potential. The ball is as wide as a
// circle of kRound substeps, so that a shorter substep makes it smaller.
//
// Source: Dehnen, Towards optimal softening in three-dimensional N-body codes (2001).
#pragma once

#include "kernels/data/forces.hpp"

#include <cmath>

namespace throng {

/// The cube of where the ball of an attractor ends, m3.
inline double attraction_ball(const AttractorForce& attractor, double substep)
{
    // Substeps of a circle of that radius. A swing through the middle then has an energy that is
    // seen to sway by a hundredth; with half as many, by three.
    constexpr double kRound = 62.8;
    constexpr double kNear = (kRound / 6.283185307179586) * (kRound / 6.283185307179586);
    return kNear * std::abs(attractor.strength) * (substep * substep);
}

/// N per m of the way to an attractor.
///
///   square  m2, of that way; above 0
inline double
attraction_pull(const AttractorForce& attractor, double mass, double square, double substep)
{
    const double cube = square * std::sqrt(square), ball = attraction_ball(attractor, substep);
    if (!(cube < ball)) return mass * attractor.strength / cube;
    const double share = std::cbrt(cube / ball);
    return mass * attractor.strength / ball * (2.5 - 1.5 * share * share);
}

/// J that an attractor has given up at a distance, m.
inline double
attraction_energy(const AttractorForce& attractor, double mass, double distance, double substep)
{
    const double cube = distance * distance * distance, ball = attraction_ball(attractor, substep);
    if (!(cube < ball)) return distance > 0 ? mass * attractor.strength / distance : 0;
    const double edge = std::cbrt(ball), square = (distance / edge) * (distance / edge);
    return mass * attractor.strength / edge * (1.875 - square * (1.25 - 0.375 * square));
}

}  // namespace throng
