#include "narrowphase/manifold/recycling.hpp"

#include "kernels/math/rotation.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

template <class Real>
bool recycle(const CachedManifold<Real>& found,
             const PoseT<Real>& b_in_a,
             Real speculative_margin,
             Real radius_b,
             Real bound,
             LocalManifold<Real>& out)
{
    const QuatT<Real> turn = b_in_a.orientation * found.b_in_a.orientation.conjugate();
    const Vec3T<Real> shift = b_in_a.position - found.b_in_a.position;
    const Real moved = furthest_moved(shift, turn, radius_b);
    // What was beyond the margin then may be within a greater margin now.
    if (!(moved + std::max(Real(0), speculative_margin - found.speculative_margin) <= bound))
        return false;

    move_manifold(found, b_in_a, speculative_margin, out);
    return true;
}

template <class Real>
void move_manifold(const CachedManifold<Real>& found,
                   const PoseT<Real>& b_in_a,
                   Real speculative_margin,
                   LocalManifold<Real>& out)
{
    const QuatT<Real> turn = b_in_a.orientation * found.b_in_a.orientation.conjugate();
    const Vec3T<Real> shift = b_in_a.position - found.b_in_a.position;
    const Vec3T<Real> half_turn = turn.vec();
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
        if (separation <= speculative_margin)
            out.add(point.position + by / 2, separation, point.feature);
    }
}

// About the origin of either: b may be a terrain that reaches far.
template <class Real>
Real furthest_moved_near(const PoseT<Real>& then,
                         const PoseT<Real>& b_in_a,
                         Real radius_a,
                         Real radius_b)
{
    const QuatT<Real> turn = b_in_a.orientation * then.orientation.conjugate();
    const Vec3T<Real> about_a = b_in_a.position - turn * then.position;
    const Real about_b =
        furthest_moved(Vec3T<Real>(b_in_a.position - then.position), turn, radius_b);
    // Of a plane, which has no end, that about b is no number.
    return std::min(furthest_moved(about_a, turn, radius_a), about_b);
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template bool recycle<Real>(const CachedManifold<Real>&, const PoseT<Real>&, Real, Real, Real, \
                                LocalManifold<Real>&);                                             \
    template void move_manifold<Real>(const CachedManifold<Real>&, const PoseT<Real>&, Real,       \
                                      LocalManifold<Real>&);                                       \
    template Real furthest_moved_near<Real>(const PoseT<Real>&, const PoseT<Real>&, Real, Real);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
