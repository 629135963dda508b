// Known apart: the pairs that are seen at once to be apart, and those that need not be looked at as
// they cannot have met since.
#pragma once

#include "kernels/data/bounds.hpp"
#include "kernels/data/contacts.hpp"

#include <span>

namespace throng {

/// Of the pairs [begin, end), the places of those whose boxes meet; how many there are.
///
///   contacts  where colliders are followed on their way, pairs that cannot have met since they
///             were last looked at are left out, and it is noted which of the others are apart
///   parted    appended to: places of those left out that have a contact
///   near      [at least as many as the pairs] out: places, ascending
template <class Real>
std::size_t find_near(const Pairs& pairs,
                      const Bounds& bounds,
                      std::size_t begin,
                      std::size_t end,
                      ConvexContacts<Real>& contacts,
                      std::vector<std::uint32_t>& parted,
                      std::span<std::uint32_t> near);

/// Notes that the two of a pair are further apart than their speculative margin by so much.
void note_apart(PairKey key, double beyond_margin, const Travels& travels, float& apart_until);

}  // namespace throng
