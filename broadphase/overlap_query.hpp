// Overlap query: what a finder of pairs is asked, and which answers are right.
#pragma once

#include "broadphase/pair_filter.hpp"
#include "kernels/data/bounds.hpp"
#include "kernels/data/pairs.hpp"

#include <span>
#include <vector>

namespace throng {

/// What a finder is asked.
///
///   boxes     [colliders] where each is now, margin included; see meets_nothing()
///   moving    [colliders] 0 still (static), 1 moving
///   asked     ids, ascending, none twice: every collider that was added, removed (its box made
///             empty) or whose box changed since the last call, and any other one cares to name
///   still_changed  a still collider was added, removed or changed, or a collider went from still
///             to moving or back, since the last call
///   filter    which pairs may touch at all; null lets every pair pass
///
/// A finder reports every pair with at least one side in `asked`, at most one side still, boxes
/// that overlap in double precision, and the filter's consent. It keeps what it learned between
/// calls, so that the cost follows `asked` and not the number of colliders.
struct OverlapQuery {
    std::span<const Box3> boxes;
    std::span<const std::uint8_t> moving;
    std::span<const std::uint32_t> asked;
    bool still_changed = false;
    const PairFilter* filter = nullptr;
};

/// True for a box that is empty or not a number along some axis: it overlaps no box at all.
/// Infinite boxes are fine.
inline bool meets_nothing(const Box3& box)
{
    return !(box.lower.x() <= box.upper.x() && box.lower.y() <= box.upper.y()
             && box.lower.z() <= box.upper.z());
}

/// True when a side is not a number: unlike an empty box this is a mistake further up, so whoever
/// makes boxes should count them. Finders treat them as empty.
inline bool not_a_number(const Box3& box) { return box.lower.hasNaN() || box.upper.hasNaN(); }

}  // namespace throng
