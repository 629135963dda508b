#include "pipeline/contacts/recycled_manifolds.hpp"

#include "narrowphase/dispatch.hpp"
#include "narrowphase/manifold/recycling.hpp"

#include <algorithm>

namespace throng {

template <class Real>
bool find_or_recycle(const Shapes& shapes,
                     const Colliders& colliders,
                     const Bounds& bounds,
                     const PairPlace& pair,
                     const CachedManifold<Real>* kept,
                     PairCache& cache,
                     CachedManifold<Real>& out)
{
    const ShapeRef a = colliders.shape[pair.a], b = colliders.shape[pair.b];
    out.b_in_a = rounded<Real>(seen_from_first(pair.a, pair.b, shapes, colliders, bounds));
    out.speculative_margin = static_cast<Real>(pair.speculative_margin);
    const double least = std::min(colliders.inner_extent[pair.a], colliders.inner_extent[pair.b]);
    if (kept != nullptr
        && recycle(*kept, out.b_in_a, out.speculative_margin,
                   static_cast<Real>(colliders.outer_radius[pair.b]),
                   static_cast<Real>(kRecycled * least), out.manifold))
        return false;
    collide({shapes, a, b, out.b_in_a, out.speculative_margin}, cache, out.manifold);
    return true;
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template bool find_or_recycle<Real>(const Shapes&, const Colliders&, const Bounds&,            \
                                        const PairPlace&, const CachedManifold<Real>*, PairCache&, \
                                        CachedManifold<Real>&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
