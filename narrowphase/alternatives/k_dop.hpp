// k-DOP: a convex shape between slabs in k directions, as a filter: it says `apart` or nothing.
//
// The directions are fixed in the frame that the shapes are placed in, so that two shapes are
// compared slab by slab. They are those in which a cube has faces, corners and edges, two and two
// opposite: 6 faces; 14 with the corners; 18 with the edges; 26 with both.
//
// Source: Klosowski, Held, Mitchell, Sowizral, Zikan, Efficient Collision Detection Using Bounding
//         Volume Hierarchies of k-DOPs (1998).
#pragma once

#include "narrowphase/alternatives/convex_methods.hpp"

#include <array>

namespace throng {

inline constexpr std::size_t kMaxSlabs = 13;

/// Which of all slabs a k-DOP has: 0 to 3 are those of the corners, 4 to 6 of the axes, 7 to 12 of
/// the edges.
struct Slabs {
    std::size_t begin = 0, end = 0;
};

/// Needs: k of 6, 14, 18 or 26.
Slabs slabs_of(int k);

/// The direction of a slab; its coordinates are -1, 0 or 1.
const Vec3& slab_direction(std::size_t slab);

/// direction . x of all points of a shape is between lower and upper; of slabs that it does not
/// have, these are 0.
struct KDop {
    std::array<double, kMaxSlabs> lower = {}, upper = {};
};

/// The k-DOP that holds nothing; add() makes it hold some points.
KDop empty_k_dop(Slabs slabs);
void add(const Vec3& point, Slabs slabs, KDop& to);
void add(const KDop& other, Slabs slabs, KDop& to);

/// The least k-DOP round a placed shape, to rounding.
KDop k_dop_of(const ConvexCore<double>& core, const Mat3& turn, const Vec3& position, int k);

/// The first slab in which the two are further apart than `slack`, m along the slab's direction
/// once that is of unit length; slabs.end where there is none.
std::size_t parting_slab(const KDop& a, const KDop& b, Slabs slabs, double slack);

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
