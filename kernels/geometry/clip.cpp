#include "kernels/geometry/clip.hpp"

#include "kernels/check.hpp"

#include <algorithm>

namespace throng {
namespace {

// The corner whose triangle with its neighbors is smallest goes; its edge's line goes with it.
template <class Real>
void drop_least_corner(Polygon<Real>& polygon)
{
    const auto at = [&](int i) -> const Vec3T<Real>& {
        return polygon.corners[static_cast<std::size_t>((i + polygon.count) % polygon.count)];
    };
    int least = 0;
    Real least_area = -1;
    for (int i = 0; i < polygon.count; ++i) {
        const Real area = (at(i) - at(i - 1)).cross(at(i + 1) - at(i)).squaredNorm();
        if (least_area < 0 || area < least_area) {
            least_area = area;
            least = i;
        }
    }
    for (int i = least; i + 1 < polygon.count; ++i) {
        polygon.corners[static_cast<std::size_t>(i)] =
            polygon.corners[static_cast<std::size_t>(i + 1)];
        polygon.lines[static_cast<std::size_t>(i)] = polygon.lines[static_cast<std::size_t>(i + 1)];
    }
    --polygon.count;
}

}  // namespace

template <class Real>
void cut(
    Polygon<Real>& polygon, const Vec3T<Real>& normal, Real offset, Real slack, std::uint16_t line)
{
    THRONG_CHECK(polygon.count <= kMaxCorners, "a polygon holds at most kMaxCorners");
    // A cut adds at most one corner.
    if (polygon.count == kMaxCorners) drop_least_corner(polygon);

    std::array<Real, kMaxCorners> beyond;
    bool all_inside = true;
    for (int i = 0; i < polygon.count; ++i) {
        const auto at = static_cast<std::size_t>(i);
        beyond[at] = normal.dot(polygon.corners[at]) - offset;
        all_inside = all_inside && beyond[at] <= slack;
    }
    if (all_inside) return;

    Polygon<Real> kept;
    for (int i = 0; i < polygon.count; ++i) {
        const auto here = static_cast<std::size_t>(i);
        const auto next = static_cast<std::size_t>(i + 1 == polygon.count ? 0 : i + 1);
        const bool here_inside = beyond[here] <= slack, next_inside = beyond[next] <= slack;
        if (here_inside) kept.add(polygon.corners[here], polygon.lines[here]);
        if (here_inside == next_inside) continue;
        // Between 0 and 1 also where a corner within the slack is kept beyond the plane.
        const Real fraction =
            std::clamp(beyond[here] / (beyond[here] - beyond[next]), Real(0), Real(1));
        const Vec3T<Real> crossing =
            polygon.corners[here] + fraction * (polygon.corners[next] - polygon.corners[here]);
        kept.add(crossing, here_inside ? line : polygon.lines[here]);
    }
    polygon.count = kept.count;
    std::copy_n(kept.corners.begin(), kept.count, polygon.corners.begin());
    std::copy_n(kept.lines.begin(), kept.count, polygon.lines.begin());
}

template void cut<float>(Polygon<float>&, const Vec3T<float>&, float, float, std::uint16_t);
template void cut<double>(Polygon<double>&, const Vec3T<double>&, double, double, std::uint16_t);

}  // namespace throng
