// Contact points: manifold reduction, the best four of many.
//
// Four points hold a flat contact as well as eight do, at half the cost to the solver.
#pragma once

#include "kernels/data/manifolds.hpp"

#include <span>

namespace throng {

/// Fills the manifold's points with four of the candidates, or with all if there are no more than
/// four: the deepest, and those that span the greatest area seen along the manifold's normal.
/// Three, where all others lie inside the triangle of those.
///
/// Which points are kept hangs on their places rather than on small differences in depth, so that a
/// body at rest keeps the same four. The deepest is always among them, or one that is as deep to
/// within a hundred-thousandth of the contact's extent. Ties go to the candidate that comes first,
/// so the order of the candidates has to be repeatable.
template <class Real>
void reduce_to_four(std::span<const typename LocalManifold<Real>::Point> candidates,
                    LocalManifold<Real>& manifold);

}  // namespace throng
