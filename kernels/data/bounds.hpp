// Bounds: a box round each collider, with a margin for what it may do before it is looked at again.
#pragma once

#include "kernels/parallel/compact.hpp"
#include "throng/box3.hpp"

#include <limits>
#include <vector>

namespace throng {

/// Whether two boxes of float meet; four numbers a corner, of which the fourth is not looked at.
/// Whole registers and no branch for each side: which of them parts two boxes is anybody's guess.
inline bool boxes_overlap(const float* lower_a,
                          const float* upper_a,
                          const float* lower_b,
                          const float* upper_b)
{
    using Four __attribute__((vector_size(16))) = float;
    const auto load = [](const float* from) {
        Four four;
        __builtin_memcpy(&four, from, sizeof four);
        return four;
    };
    const auto overlap = (load(lower_a) <= load(upper_b)) & (load(lower_b) <= load(upper_a));
    return (overlap[0] & overlap[1] & overlap[2]) != 0;
}

/// A box in float, rounded outward: two that are apart show that their contents are.
struct NearBox {
    alignas(16) float lower[4];
    alignas(16) float upper[4];

    bool overlaps(const NearBox& other) const
    {
        return boxes_overlap(lower, upper, other.lower, other.upper);
    }
};

///   flags  [colliders] all 0 between stages
struct BoundsScratch {
    std::vector<std::uint8_t> flags;
    std::vector<std::vector<std::uint32_t>> of_block;
    BlockLists<std::uint32_t> fast_of_block, fast_candidates_of_block;
};

/// What the broad phase works on.
///
///   boxes               [colliders] margin included
///   speculative_margin  [colliders] m, how far from its surface a contact is looked for in this
///                       step
///   near                [colliders] where it may find contacts in this step: its tight box, grown
///                       by `speculative_margin`
///   moving              [colliders] 1 for those of bodies that can move
///   placed              [colliders] where each shape is, as of the start of the last step it was
///                       awake in
///   asked               colliders whose boxes changed in this step, ascending
///   placed_anew         colliders that may be elsewhere than in the last step, none twice
///   touched             colliders that were added, removed or moved from outside since the last
///                       step
///   half, round, form   [colliders] the shape as active_bounds.hpp wants it, rounded up
///   stretch             how many times further than usual margins look ahead: see stretch_for()
///   fast                bodies that a later stage stops where they meet something, ascending:
///                       contacts are looked for no further from them than from bodies at rest
///   kept                [colliders] m, of those of fast bodies, else 0: how far contacts that they
///                       have already are looked for; empty where nobody is ever stopped
///   flush               [colliders] whether it may lie flush with another, by these bits: all but
///                       single ones of dynamic bodies; a plane has no rim
///   flush_end           behind the last of those, or further
///   fast_candidates     bodies that may go about half their smallest half extent in this step, or
///                       more, ascending
struct Bounds {
    std::vector<Box3> boxes;
    std::vector<double> speculative_margin;
    std::vector<NearBox> near;
    std::vector<std::uint8_t> moving;
    std::vector<Pose> placed;
    std::vector<std::uint32_t> asked;
    std::vector<std::uint32_t> placed_anew;
    std::vector<std::uint32_t> touched;
    std::vector<float> half[3], round;
    std::vector<std::uint8_t> form;
    double stretch = 1;
    std::vector<std::uint32_t> fast;
    std::vector<double> kept;
    static constexpr std::uint8_t kPlane = 1, kRimmed = 2;
    std::vector<std::uint8_t> flush;
    std::uint32_t flush_end = 0;
    std::vector<std::uint32_t> fast_candidates;
    bool still_changed = true;
    BoundsScratch scratch;
};

}  // namespace throng
