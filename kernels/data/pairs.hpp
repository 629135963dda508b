// Pairs: two colliders that may touch, as one number so that order and equality are cheap.
#pragma once

#include "kernels/parallel/follow.hpp"

#include <cstdint>
#include <vector>

namespace throng {

/// The smaller id in the upper half: sorting keys sorts by the smaller id, then by the greater.
using PairKey = std::uint64_t;

constexpr PairKey pair_key(std::uint32_t a, std::uint32_t b)
{
    return a < b ? (PairKey{a} << 32 | b) : (PairKey{b} << 32 | a);
}
constexpr std::uint32_t first_of(PairKey key) { return static_cast<std::uint32_t>(key >> 32); }
constexpr std::uint32_t second_of(PairKey key) { return static_cast<std::uint32_t>(key); }

struct PairsScratch {
    std::vector<PairKey> found;
};

/// The pairs whose boxes overlap, margins included. They live on from step to step.
///
///   keys     ascending
///   from     [pairs] where each was in the last step's list, or kNewPair; filled when changed
///   on_mesh  places of the pairs of a convex shape and a mesh, ascending
///   on_solid the same of pairs with a solid on one side or both
struct Pairs {
    static constexpr std::uint32_t kNewPair = kNewItem;
    std::vector<PairKey> keys;
    std::vector<std::uint32_t> from;
    std::vector<std::uint32_t> on_mesh, on_solid;
    bool changed = false;
    std::vector<std::uint8_t> asked;  // [colliders] all 0 between stages
    PairsScratch scratch;
};

}  // namespace throng
