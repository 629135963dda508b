// k-DOP: a convex shape between slabs in k directions, as a filter: it says `apart` or nothing.
//
// Source: Klosowski, Held, Mitchell, Sowizral, Zikan, Efficient Collision Detection Using Bounding
//         Volume Hierarchies of k-DOPs (1998).
#pragma once

#include "kernels/geometry/k_dop.hpp"
#include "narrowphase/alternatives/convex_methods.hpp"

namespace throng {

/// The filter as a method, in the directions of a's frame: `apart` with the normal of the slab, or
/// `undecided`. Never `apart` of what touches: the slabs are widened by more than their rounding.
///
///   cached  begins with the slab that parted the two the last time
///   cold    with the one that their middles are furthest apart along
///   plain   looks at all slabs at once
template <int k>
MethodAnswer query_k_dop(const ConvexPair& pair,
                         double speculative_margin,
                         MethodStart start,
                         MethodMemory& memory);

}  // namespace throng
