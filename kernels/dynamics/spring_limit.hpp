// Spring limit: how long a step may be before a spring that is taken as it is at the step's
// beginning swings wider and wider.
#pragma once

#include "kernels/data/bodies.hpp"
#include "kernels/data/forces.hpp"

#include <span>

namespace throng {

/// What springs side by side come to, seen by what they move: the square of the angular frequency,
/// 1/s2, and the rate at which they damp, 1/s. Springs that share a body add up: the square of the
/// fastest frequency is at most that, and just that for a spring by itself.
struct SpringLoad {
    double square = 0, damping = 0;

    SpringLoad operator+(const SpringLoad& other) const
    {
        return {square + other.square, damping + other.damping};
    }
};

/// Of all springs of a body; nothing for the world.
SpringLoad spring_load(const Forces& forces, const Masses& masses, std::uint32_t body);

/// The share of critical damping.
double damping_ratio(const SpringLoad& load);

/// s, the longest step of the semi-implicit rule: 2 / w (sqrt(1 + z^2) - z), z the damping ratio.
/// Infinite where nothing pulls.
double longest_step(const SpringLoad& load);

/// The same of the springs of bodies that are joined (see Forces::groups), the least of them.
double
longest_step(const Forces& forces, const Masses& masses, std::span<const std::uint32_t> group);

}  // namespace throng
