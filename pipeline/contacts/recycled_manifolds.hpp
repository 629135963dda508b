// Recycled manifolds: kinds of pairs that keep what was found for as long as it will do.
#pragma once

#include "pipeline/contacts/collide.hpp"

namespace throng {

/// Whether a kind of pair is worth it: its manifold costs far more than what it was found from.
inline bool is_recycled(ShapeKind a, ShapeKind b)
{
    using enum ShapeKind;
    return (a == hull && (b == hull || b == box)) || (a == box && b == hull);
}

/// The manifold of such a pair, told from what was found earlier or, true, found anew.
///
///   kept   what was found earlier; null where the pair had no contact
///   cache  tells, where nothing was found, how far the two are apart
///   out    found anew it is what is to be kept; else only its manifold says anything
template <class Real>
bool find_or_recycle(const Shapes& shapes,
                     const Colliders& colliders,
                     const Bounds& bounds,
                     const PairPlace& pair,
                     const CachedManifold<Real>* kept,
                     PairCache& cache,
                     CachedManifold<Real>& out);

}  // namespace throng
