// Sphere pairs: what a place is to a convex shape, in closed form.
#pragma once

#include "narrowphase/convex/pair_functions.hpp"

namespace throng {

/// Where a place is, seen from the surface of a shape, in the shape's frame.
template <class Real>
struct Outward {
    Vec3T<Real> direction = Vec3T<Real>::UnitZ();  // unit, from the surface to the place
    Real distance = 0;                             // below 0 inside
};

/// The way out of a sphere, capsule, cylinder, box or hull.
///
///   enough  m, of a hull more than this may be told as less, but not as less than this
///   cache   of this shape alone
Outward<double> outward_of_convex(
    const Shapes& shapes, ShapeRef convex, const Vec3& place, double enough, PairCache& cache);

}  // namespace throng
