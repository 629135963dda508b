#include "kernels/geometry/k_dop.hpp"

#include "kernels/check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace throng {
namespace {

const std::array<Vec3, kMaxSlabs>& directions()
{
    static const std::array<Vec3, kMaxSlabs> all = {
        Vec3(1, 1, 1),  Vec3(1, 1, -1), Vec3(1, -1, 1), Vec3(1, -1, -1), Vec3(1, 0, 0),
        Vec3(0, 1, 0),  Vec3(0, 0, 1),  Vec3(1, 1, 0),  Vec3(1, -1, 0),  Vec3(1, 0, 1),
        Vec3(1, 0, -1), Vec3(0, 1, 1),  Vec3(0, 1, -1)};
    return all;
}

}  // namespace

double slab_length(std::size_t slab)
{
    constexpr double kRoot2 = 1.41421356237309504880, kRoot3 = 1.73205080756887729353;
    return slab < 4 ? kRoot3 : slab < 7 ? 1 : kRoot2;
}

Slabs slabs_of(int k)
{
    THRONG_CHECK(k == 6 || k == 14 || k == 18 || k == 26, "a k-DOP has 6, 14, 18 or 26 sides");
    return {k == 6 || k == 18 ? 4U : 0U, k == 6 || k == 14 ? 7U : kMaxSlabs};
}

const Vec3& slab_direction(std::size_t slab) { return directions()[slab]; }

KDop empty_k_dop(Slabs slabs)
{
    KDop nothing;
    for (std::size_t slab = slabs.begin; slab < slabs.end; ++slab) {
        nothing.lower[slab] = std::numeric_limits<double>::infinity();
        nothing.upper[slab] = -std::numeric_limits<double>::infinity();
    }
    return nothing;
}

void add(const Vec3& point, Slabs slabs, KDop& to)
{
    const double x = point.x(), y = point.y(), z = point.z();
    const double sum = x + y, difference = x - y;
    const std::array<double, kMaxSlabs> along = {
        sum + z, sum - z,    difference + z, difference - z, x,     y,    z,
        sum,     difference, x + z,          x - z,          y + z, y - z};
    for (std::size_t slab = slabs.begin; slab < slabs.end; ++slab) {
        to.lower[slab] = along[slab] < to.lower[slab] ? along[slab] : to.lower[slab];
        to.upper[slab] = along[slab] > to.upper[slab] ? along[slab] : to.upper[slab];
    }
}

void add(const KDop& other, Slabs slabs, KDop& to)
{
    for (std::size_t slab = slabs.begin; slab < slabs.end; ++slab) {
        to.lower[slab] = std::min(to.lower[slab], other.lower[slab]);
        to.upper[slab] = std::max(to.upper[slab], other.upper[slab]);
    }
}

// Of a shape in its own frame, along a direction of any length.
SlabRange range_along(const ConvexCore<double>& core, const Vec3& direction)
{
    if (core.kind != ShapeKind::hull) {
        // All others are the same seen from both sides.
        const double extent = direction.dot(support(core, direction).position)
            + core.convex_radius * std::sqrt(direction.squaredNorm());
        return {-extent, extent};
    }
    SlabRange range = {std::numeric_limits<double>::infinity(),
                       -std::numeric_limits<double>::infinity()};
    for (const Vec3& vertex : core.hull->vertices) {
        const double along = direction.dot(vertex);
        range.lower = along < range.lower ? along : range.lower;
        range.upper = along > range.upper ? along : range.upper;
    }
    return range;
}

SlabRange range_along(const ConvexCore<double>& core,
                      const Mat3& turn,
                      const Vec3& position,
                      const Vec3& direction)
{
    const SlabRange own = range_along(core, turn.transpose() * direction);
    const double shift = direction.dot(position);
    return {own.lower + shift, own.upper + shift};
}

KDop k_dop_of(const ConvexCore<double>& core, const Mat3& turn, const Vec3& position, int k)
{
    const Slabs slabs = slabs_of(k);
    KDop dop = empty_k_dop(slabs);
    if (core.kind == ShapeKind::hull) {
        for (const Vec3& vertex : core.hull->vertices) add(turn * vertex + position, slabs, dop);
        return dop;
    }
    for (std::size_t slab = slabs.begin; slab < slabs.end; ++slab) {
        const SlabRange range = range_along(core, turn, position, slab_direction(slab));
        dop.lower[slab] = range.lower;
        dop.upper[slab] = range.upper;
    }
    return dop;
}

std::size_t parting_slab(const KDop& a, const KDop& b, Slabs slabs, double slack)
{
    for (std::size_t slab = slabs.begin; slab < slabs.end; ++slab) {
        const double separation =
            std::max(b.lower[slab] - a.upper[slab], a.lower[slab] - b.upper[slab]);
        if (separation > slack * slab_length(slab)) return slab;
    }
    return slabs.end;
}

}  // namespace throng
