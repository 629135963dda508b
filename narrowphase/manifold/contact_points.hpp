// Contact points: manifold reduction, the best four of many.
//
// Four points hold a flat contact as well as eight do, at half the cost to the solver.
#pragma once

#include "kernels/data/manifolds.hpp"

#include <span>

namespace throng {

/// A chosen point is drawn to one that is left out as far as that is deeper than all chosen: wholly
/// from this part of the contact's extent on.
template <class Real>
inline constexpr Real kDrawn = Real(5e-4);

/// Fills the manifold's points with four of the candidates, or with all if there are no more than
/// four: those that span the greatest area seen along the manifold's normal. Three, where all
/// others lie inside the triangle of those.
///
/// Which points are kept hangs on their places alone, so that a body at rest keeps the same four,
/// with the impulses that they have. Where it leans on one that is left out, the nearest of the
/// four goes there as far as it leans: were one taken for the other, the load would stand where no
/// four hold it, and the body tremble from the one to the other for ever. Ties go to the candidate
/// that comes first, so the order of the candidates has to be repeatable.
template <class Real>
void reduce_to_four(std::span<const typename LocalManifold<Real>::Point> candidates,
                    LocalManifold<Real>& manifold);

}  // namespace throng
