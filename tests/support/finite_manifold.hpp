// Finite manifold: whether all numbers of one are.
#pragma once

#include "narrowphase/convex/pair_functions.hpp"

#include <cmath>

namespace throng {

template <class Real>
bool all_finite(const LocalManifold<Real>& manifold)
{
    bool finite = manifold.normal.allFinite();
    for (int i = 0; i < manifold.count; ++i) {
        const auto& point = manifold.points[static_cast<std::size_t>(i)];
        finite = finite && point.position.allFinite() && std::isfinite(point.separation);
    }
    return finite;
}

}  // namespace throng
