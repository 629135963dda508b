#include "broadphase/margins.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace throng {

namespace {

// How far a box reaches ahead along an axis along which it goes so far in a step.
double ahead_of(double way, double size, const MarginRule& rule)
{
    return std::max(way, std::min(rule.steps * way, rule.longest * size));
}

}  // namespace

double stretch_for(std::size_t pairs, std::size_t active)
{
    return pairs * 4 < active ? 4 : pairs < active ? 2 : 1;
}

bool loose(const Box3& box,
           const Box3& tight,
           const Vec3& velocity,
           double size,
           double dt,
           const MarginRule& rule)
{
    for (int axis = 0; axis < 3; ++axis) {
        const double most =
            (rule.base + rule.loose) * size + ahead_of(std::abs(velocity[axis] * dt), size, rule);
        if (tight.lower[axis] - box.lower[axis] > most) return true;
        if (box.upper[axis] - tight.upper[axis] > most) return true;
    }
    return false;
}

Box3 fattened(
    const Box3& tight, const Vec3& velocity, double size, double dt, const MarginRule& rule)
{
    Box3 fat = tight;
    const double base = rule.base * size;
    for (int axis = 0; axis < 3; ++axis) {
        const double step = velocity[axis] * dt;
        const double way = std::abs(step);
        double ahead = ahead_of(way, size, rule);
        if (!std::isfinite(ahead)) ahead = 0;
        // The sum rounds; a little more, so that what it promises to contain is contained.
        const double slack = 4 * std::numeric_limits<double>::epsilon();
        const double rounding =
            slack * (std::max(std::abs(tight.lower[axis]), std::abs(tight.upper[axis])) + ahead);
        const double padding = std::isfinite(rounding) ? base + rounding : base;
        fat.lower[axis] -= step < 0 ? padding + ahead : padding;
        fat.upper[axis] += step > 0 ? padding + ahead : padding;
    }
    return fat;
}

}  // namespace throng
