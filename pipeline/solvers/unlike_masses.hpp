// Unlike masses: who is so much heavier than another that iterations settle slowly between them.
#pragma once

#include "pipeline/step/step_data.hpp"

#include <algorithm>

namespace throng {

/// Over the other's mass.
inline constexpr double kHeavy = 8;

/// Whether one of two bodies that can be moved is that much heavier than the other.
inline bool are_unlike(const Masses& masses, std::uint32_t body_a, std::uint32_t body_b)
{
    const double a = masses.inverse_mass[body_a], b = masses.inverse_mass[body_b];
    return std::min(a, b) > 0 && std::max(a, b) > kHeavy * std::min(a, b);
}

}  // namespace throng
