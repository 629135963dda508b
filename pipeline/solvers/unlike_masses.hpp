// Unlike masses: who is so much heavier than another that iterations settle slowly between them.
#pragma once

#include "pipeline/step/step_data.hpp"

#include <algorithm>
#include <span>

namespace throng {

/// Over the other's mass.
inline constexpr double kHeavy = 8;

/// Whether a body that can be moved is that much heavier than another.
inline bool is_heavy_for(const Masses& masses, std::uint32_t body, std::uint32_t light)
{
    return masses.inverse_mass[body] > 0 && masses.mass[body] > kHeavy * masses.mass[light];
}

/// Whether either of two bodies that can both be moved is.
inline bool are_unlike(const Masses& masses, std::uint32_t body_a, std::uint32_t body_b)
{
    return masses.inverse_mass[body_a] > 0 && masses.inverse_mass[body_b] > 0
        && (is_heavy_for(masses, body_a, body_b) || is_heavy_for(masses, body_b, body_a));
}

/// Whether any contact of some, places among the active ones, is of two such bodies.
inline bool any_unlike(const Masses& masses,
                       const ActiveContacts& active,
                       std::span<const std::uint32_t> contacts)
{
    return std::any_of(contacts.begin(), contacts.end(), [&](std::uint32_t contact) {
        const ActiveContacts::Entry& entry = active.entries[contact];
        return are_unlike(masses, entry.body_a, entry.body_b);
    });
}

}  // namespace throng
