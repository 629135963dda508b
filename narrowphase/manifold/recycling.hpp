// Recycling: the manifold of a pair that has hardly moved since it was found, told from where its
// points are now.
//
// Each point is held as two, one on either body, and its separation is how far they are from one
// another along the normal: exact for a corner over a face, and for the rest as near as the square
// of what they moved. What was found is never changed, so nothing adds up from step to step.
#pragma once

#include "kernels/data/manifolds.hpp"

namespace throng {

/// The manifold at another pose; false where it has to be found anew.
///
///   b_in_a              as for PairFunction
///   speculative_margin  m, points further apart than this are left out
///   radius_b            m, b has no point further than this from its origin
///   bound               m, no point of b may have moved further than this since, seen from a. What
///                       was left out then may be deeper by so much than it was
///
/// At the pose that it was found at it is what was found, to the bit.
template <class Real>
bool recycle(const CachedManifold<Real>& found,
             const PoseT<Real>& b_in_a,
             Real speculative_margin,
             Real radius_b,
             Real bound,
             LocalManifold<Real>& out);

/// The manifold at another pose, however far that is.
template <class Real>
void move_manifold(const CachedManifold<Real>& found,
                   const PoseT<Real>& b_in_a,
                   Real speculative_margin,
                   LocalManifold<Real>& out);

/// No point of b that is where a is has moved further from one pose to the other, seen from a, m.
///
///   radius_a  m, of a ball about a's origin with all of a in it, or what of it matters
///   radius_b  m, the same of b
template <class Real>
Real furthest_moved_near(const PoseT<Real>& then,
                         const PoseT<Real>& b_in_a,
                         Real radius_a,
                         Real radius_b);

}  // namespace throng
