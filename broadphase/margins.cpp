#include "broadphase/margins.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace throng {

double stretch_for(std::size_t pairs, std::size_t movers)
{
    return pairs * 4 < movers ? 4 : pairs < movers ? 2 : 1;
}

Box3 fattened(
    const Box3& tight, const Vec3& velocity, double size, double dt, const MarginRule& rule)
{
    Box3 fat = tight;
    const double base = rule.base * size;
    for (int axis = 0; axis < 3; ++axis) {
        const double step = velocity[axis] * dt;
        const double way = std::abs(step);
        double ahead = std::max(way, std::min(rule.steps * way, rule.longest * size));
        if (!std::isfinite(ahead)) ahead = 0;
        // The sum rounds; a little more, so that what it promises to contain is contained.
        const double slack = 4 * std::numeric_limits<double>::epsilon();
        const double rounding =
            slack * (std::max(std::abs(tight.lower[axis]), std::abs(tight.upper[axis])) + ahead);
        const double room = std::isfinite(rounding) ? base + rounding : base;
        fat.lower[axis] -= step < 0 ? room + ahead : room;
        fat.upper[axis] += step > 0 ? room + ahead : room;
    }
    return fat;
}

}  // namespace throng
