// Broad phase: boxes in, pairs of boxes that overlap out.
//
// All finders report the same pairs; they differ in speed alone. all_pairs is the plain answer
// sheet for the others.
#pragma once

#include "kernels/data/bounds.hpp"
#include "kernels/data/pairs.hpp"

#include <memory>
#include <span>
#include <variant>
#include <vector>

namespace throng {

/// What a finder is asked.
///
///   boxes     [colliders] where each is now, margin included; an empty box meets nothing
///   group     [colliders] which half each belongs to: 0 still (static), 1 moving
///   asked     colliders (sorted, moving) whose boxes changed since the last call
///   still_changed  a box of a still collider was added, removed or changed since the last call
///
/// A finder reports every pair with at least one side in `asked` and at most one side still.
struct OverlapQuery {
    std::span<const Box3> boxes;
    std::span<const std::uint8_t> moving;
    std::span<const std::uint32_t> asked;
    bool still_changed = false;
};

}  // namespace throng
