#include "narrowphase/recycling.hpp"

#include "kernels/math/rotation.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

template <class Real>
bool recycle(const FoundManifold<Real>& found,
             const PoseT<Real>& b_in_a,
             Real reach,
             Real radius_b,
             Real bound,
             LocalManifold<Real>& out)
{
    const QuatT<Real> turn = b_in_a.orientation * found.b_in_a.orientation.conjugate();
    const Vec3T<Real> shift = b_in_a.position - found.b_in_a.position;
    const Vec3T<Real> half_turn = turn.vec();
    const Real moved = furthest_moved(shift, turn, radius_b);
    // What was out of reach then may be within a greater reach now.
    if (!(moved + std::max(Real(0), reach - found.reach) <= bound)) return false;

    const LocalManifold<Real>& then = found.manifold;
    out.normal = then.normal;
    out.count = 0;
    for (int i = 0; i < then.count; ++i) {
        const auto& point = then.points[static_cast<std::size_t>(i)];
        const Vec3T<Real> on_b =
            point.position + then.normal * (point.separation / 2) - found.b_in_a.position;
        const Vec3T<Real> across = 2 * half_turn.cross(on_b);
        const Vec3T<Real> by = shift + turn.w() * across + half_turn.cross(across);
        const Real separation = point.separation + then.normal.dot(by);
        if (separation <= reach) out.add(point.position + by / 2, separation, point.feature);
    }
    return true;
}

template bool recycle<float>(
    const FoundManifold<float>&, const PoseT<float>&, float, float, float, LocalManifold<float>&);
template bool recycle<double>(
    const FoundManifold<double>&, const Pose&, double, double, double, LocalManifold<double>&);

}  // namespace throng
