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

// Those that are left out and deeper than all that were chosen, around one of these.
template <class Real>
class Drawn {
public:
    void see(Real separation) { least_ = std::min(least_, separation); }

    // The deepest count most, so that going from one to the other is no jump either.
    void add(const typename LocalManifold<Real>::Point& point, Real whole)
    {
        const Real share = std::max(1 - (point.separation - least_) / whole, Real(0));
        position_ += share * point.position;
        separation_ += share * point.separation;
        sum_ += share;
    }

    void draw(Real chosen_least, Real whole, typename LocalManifold<Real>::Point& point) const
    {
        if (!(sum_ > 0)) return;
        const Real part = std::min((chosen_least - least_) / whole, Real(1));
        point.position += part * (position_ / sum_ - point.position);
        point.separation += part * (separation_ / sum_ - point.separation);
    }

private:
    Vec3T<Real> position_ = Vec3T<Real>::Zero();
    Real separation_ = 0, sum_ = 0, least_ = std::numeric_limits<Real>::max();
};

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
    const std::array<std::size_t, 4> chosen = spread_four<Real>(candidates, manifold.normal);

    Real least = std::numeric_limits<Real>::max();
    for (const std::size_t i : chosen) least = std::min(least, candidates[i].separation);
    const auto nearest_to = [&](const Point& point) {
        const auto distance2 = [&](std::size_t i) {
            return (candidates[i].position - point.position).squaredNorm();
        };
        std::size_t nearest = 0;
        for (std::size_t k = 1; k < 4; ++k)
            if (distance2(chosen[k]) < distance2(chosen[nearest])) nearest = k;
        return nearest;
    };
    const Real extent = (candidates[chosen[1]].position - candidates[chosen[0]].position).norm();
    // Above nothing, as all may lie in one point.
    const Real whole = std::max(kDrawn<Real> * extent, std::numeric_limits<Real>::min());
    std::array<Drawn<Real>, 4> drawn;
    for (const Point& point : candidates)
        if (point.separation < least) drawn[nearest_to(point)].see(point.separation);
    for (const Point& point : candidates)
        if (point.separation < least) drawn[nearest_to(point)].add(point, whole);

    // Each once, in the candidates' order, so that the manifold's order is repeatable too.
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        const auto place = std::find(chosen.begin(), chosen.end(), i);
        if (place == chosen.end()) continue;
        Point point = candidates[i];
        drawn[static_cast<std::size_t>(place - chosen.begin())].draw(least, whole, point);
        manifold.add(point.position, point.separation, point.feature);
    }
}

template void reduce_to_four<float>(std::span<const LocalManifold<float>::Point>,
                                    LocalManifold<float>&);
template void reduce_to_four<double>(std::span<const LocalManifold<double>::Point>,
                                     LocalManifold<double>&);

}  // namespace throng
