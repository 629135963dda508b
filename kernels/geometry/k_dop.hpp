// k-DOP: points between slabs in k / 2 directions, and which slab parts two.
//
// The directions are fixed in the frame that the points are given in, so that two are compared slab
// by slab. They are those in which a cube has faces, corners and edges, two and two opposite: 6
// faces; 14 with the corners; 18 with the edges; 26 with both.
//
// Source: Klosowski, Held, Mitchell, Sowizral, Zikan, Efficient Collision Detection Using Bounding
//         Volume Hierarchies of k-DOPs (1998).
#pragma once

#include "kernels/data/k_dop.hpp"
#include "kernels/geometry/support.hpp"

namespace throng {

/// Which of all slabs a k-DOP has: 0 to 3 are those of the corners, 4 to 6 of the axes, 7 to 12 of
/// the edges.
struct Slabs {
    std::size_t begin = 0, end = 0;
};

/// Needs: k of 6, 14, 18 or 26.
Slabs slabs_of(int k);

/// The direction of a slab; its coordinates are -1, 0 or 1. And how long it is.
const Vec3& slab_direction(std::size_t slab);
double slab_length(std::size_t slab);

/// The k-DOP that holds nothing; add() makes it hold some points.
KDop empty_k_dop(Slabs slabs);
void add(const Vec3& point, Slabs slabs, KDop& to);
void add(const KDop& other, Slabs slabs, KDop& to);

/// Of a shape, along a direction of any length.
struct SlabRange {
    double lower, upper;
};
SlabRange range_along(const ConvexCore<double>& core, const Vec3& direction);
SlabRange range_along(const ConvexCore<double>& core,
                      const Mat3& turn,
                      const Vec3& position,
                      const Vec3& direction);

/// The least k-DOP round a placed shape, to rounding.
KDop k_dop_of(const ConvexCore<double>& core, const Mat3& turn, const Vec3& position, int k);

/// The first slab in which the two are further apart than `slack`, m along the slab's direction
/// once that is of unit length; slabs.end where there is none.
std::size_t parting_slab(const KDop& a, const KDop& b, Slabs slabs, double slack);

}  // namespace throng
