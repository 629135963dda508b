// Method contacts: where two convex shapes touch, as told by a method of the user's choice.
#pragma once

#include "kernels/data/manifolds.hpp"
#include "narrowphase/alternatives/convex_methods.hpp"
#include "narrowphase/alternatives/k_dop.hpp"
#include "narrowphase/convex/pair_input.hpp"

#include <vector>

namespace throng {

/// The points of touch by a method's own answer. False where it cannot give them: it does not serve
/// the pair, is undecided, or tells of touch alone and the two are not shown to be further apart
/// than `speculative_margin`. A body at rest hardly overlaps what bears it: were points within the
/// margin of each other left out, it would rock from one contact to the next for ever.
///
/// gjk gives points out to `speculative_margin`, and so does sat, whose points are those of
/// hull_hull_by_axes() unless it starts `plain`. clip_volume knows nothing of how far apart shapes
/// are: points where they overlap, none where they do not. Its normal is that of the shared
/// volume's surface, or of the face near it along which less must be moved; its depth is that move.
///
///   out  in a's frame; count 0 where nothing is within the margin
bool collide_by(const ConvexMethod& method,
                MethodStart start,
                const PairInput<double>& in,
                MethodMemory& memory,
                LocalManifold<double>& out);

/// What is kept for methods and filters of the user's choice; empty while there are none.
///
///   of_pair    [pairs]
///   bounds     [colliders] where a k-DOP filters, of where they are now
///   fallbacks  [blocks of pairs] pairs that another method had to answer
struct MethodPairs {
    std::vector<MethodMemory> of_pair;
    std::vector<KDop> bounds;
    std::uint64_t fell_back = 0;  // pairs, in this step
    struct Scratch {
        std::vector<std::uint32_t> fallbacks;
    } scratch;
};

}  // namespace throng
