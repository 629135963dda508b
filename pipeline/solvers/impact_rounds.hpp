// Impact rounds: how often a substep goes over contacts of which some strike.
//
// Each round takes a blow on by one body at least, and mostly there are one or two. A heavy body
// that closes in on a light one before a wall is turned back by as many as the square root of their
// masses' ratio tells, twice or so; what still comes in after the last round is stopped.
#pragma once

#include <algorithm>
#include <cstddef>

namespace throng {

/// At most, for so many contacts: as many as look at no more contacts in all than `most` of them,
/// within reason.
inline std::size_t impact_rounds(std::size_t most, std::size_t contacts)
{
    constexpr std::size_t kFewestRounds = 16, kMostRounds = 1024;
    return std::clamp(most / std::max<std::size_t>(contacts, 1), kFewestRounds, kMostRounds);
}

}  // namespace throng
