#include "narrowphase/manifold/contact_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace throng {
namespace {

template <class Real>
using Points = std::span<const typename LocalManifold<Real>::Point>;

template <class Real, class Score>
std::size_t best_of(Points<Real> points, const Score& score)
{
    std::size_t best = 0;
    Real best_score = score(points[0]);
    for (std::size_t i = 1; i < points.size(); ++i) {
        const Real value = score(points[i]);
        if (value > best_score) {
            best_score = value;
            best = i;
        }
    }
    return best;
}

// Points whose depths differ by less than this part of the contact's extent are as deep as one
// another: what is left of a body's motion at rest stays below it.
template <class Real>
constexpr Real kLevel = Real(1e-5);

// A direction across the normal that moves smoothly with it, but for seams far from the axes.
template <class Real>
Vec3T<Real> across(const Vec3T<Real>& normal)
{
    Eigen::Index greatest = 0;
    normal.cwiseAbs().maxCoeff(&greatest);
    return normal.cross(Vec3T<Real>::Unit((greatest + 1) % 3));
}

// Four places: one end, the other end, and the furthest to either side of the line between them.
template <class Real>
std::array<std::size_t, 4> spread_four(Points<Real> points, const Vec3T<Real>& normal)
{
    using Point = typename LocalManifold<Real>::Point;
    // A slanted direction, so that rectangles along the axes have one furthest corner.
    const Vec3T<Real> tangent = across(normal);
    const Vec3T<Real> start = tangent + Real(0.3) * normal.cross(tangent);
    const std::size_t one =
        best_of<Real>(points, [&](const Point& p) { return start.dot(p.position); });
    const Vec3T<Real> from = points[one].position;
    const std::size_t two =
        best_of<Real>(points, [&](const Point& p) { return (p.position - from).squaredNorm(); });
    const Vec3T<Real> side = normal.cross(points[two].position - from);
    const std::size_t three = best_of<Real>(
        points, [&](const Point& p) { return std::abs(side.dot(p.position - from)); });

    // The fourth adds the most area outside the triangle of the first three.
    const std::array<Vec3T<Real>, 3> at = {from, points[two].position, points[three].position};
    const Real turn = side.dot(at[2] - from) < 0 ? Real(-1) : Real(1);
    const std::size_t four = best_of<Real>(points, [&](const Point& p) {
        Real most = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3T<Real> edge = at[(i + 1) % 3] - at[i];
            most = std::max(most, -turn * normal.cross(edge).dot(p.position - at[i]));
        }
        return most;
    });
    return {one, two, three, four};
}

}  // namespace

template <class Real>
void reduce_to_four(std::span<const typename LocalManifold<Real>::Point> candidates,
                    LocalManifold<Real>& manifold)
{
    manifold.count = 0;
    if (candidates.size() <= 4) {
        for (const auto& point : candidates) {
            manifold.add(point.position, point.separation, point.feature);
        }
        return;
    }
    using Point = typename LocalManifold<Real>::Point;
    std::array<std::size_t, 4> chosen = spread_four<Real>(candidates, manifold.normal);

    // Where the deepest is left out, it takes the place of the chosen one nearest to it.
    const std::size_t deepest =
        best_of<Real>(candidates, [](const Point& p) { return -p.separation; });
    Real chosen_least = candidates[chosen[0]].separation;
    std::size_t nearest = 0;
    Real nearest_distance2 = std::numeric_limits<Real>::max();
    for (std::size_t i = 0; i < 4; ++i) {
        const Point& point = candidates[chosen[i]];
        const Real distance2 = (point.position - candidates[deepest].position).squaredNorm();
        chosen_least = std::min(chosen_least, point.separation);
        if (distance2 < nearest_distance2) {
            nearest_distance2 = distance2;
            nearest = i;
        }
    }
    const Real extent = (candidates[chosen[1]].position - candidates[chosen[0]].position).norm();
    if (candidates[deepest].separation < chosen_least - kLevel<Real> * extent) {
        chosen[nearest] = deepest;
    }

    // Each once, in the candidates' order, so that the manifold's order is repeatable too.
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        if (i == chosen[0] || i == chosen[1] || i == chosen[2] || i == chosen[3]) {
            const Point& point = candidates[i];
            manifold.add(point.position, point.separation, point.feature);
        }
    }
}

template void reduce_to_four<float>(std::span<const LocalManifold<float>::Point>,
                                    LocalManifold<float>&);
template void reduce_to_four<double>(std::span<const LocalManifold<double>::Point>,
                                     LocalManifold<double>&);

}  // namespace throng
