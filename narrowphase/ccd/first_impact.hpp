// First impact: of a group of shapes on their ways, which two meet first.
#pragma once

#include "narrowphase/ccd/time_of_impact.hpp"

#include <span>

namespace throng {

/// Two of a group, by their places in it.
struct ImpactPair {
    std::uint32_t a = 0, b = 0;
};

/// The earliest of some pairs' impacts.
///
///   pair    its place among the pairs; the first of those at the same time
///   impact  what was found of it; where none meets, of meeting `none` and at the end
struct FirstImpact {
    std::size_t pair = 0;
    Impact impact;
};

/// The first impact of a group between two times. Pairs that touch as it begins are those of
/// contacts, and left out: let them part, or hold them by contact, and ask again. Each pair is
/// asked only until the earliest found so far, so likely ones are best put first.
///
///   tolerance   of impact_size() of each pair: see impact_rule()
FirstImpact first_impact(const Shapes& shapes,
                         std::span<const MovingShape> group,
                         std::span<const ImpactPair> pairs,
                         double begin,
                         double end,
                         ToiMethod method,
                         double tolerance);

}  // namespace throng
