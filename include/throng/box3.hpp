// Box3: an axis-aligned box.
#pragma once

#include "throng/math.hpp"

#include <limits>

namespace throng {

/// An axis-aligned box. Closed: touching boxes overlap. Empty while lower > upper.
struct Box3 {
    Vec3 lower = Vec3::Constant(std::numeric_limits<double>::infinity());
    Vec3 upper = Vec3::Constant(-std::numeric_limits<double>::infinity());

    bool overlaps(const Box3& other) const
    {
        return lower.x() <= other.upper.x() && other.lower.x() <= upper.x()
            && lower.y() <= other.upper.y() && other.lower.y() <= upper.y()
            && lower.z() <= other.upper.z() && other.lower.z() <= upper.z();
    }
    bool contains(const Box3& other) const
    {
        return lower.x() <= other.lower.x() && other.upper.x() <= upper.x()
            && lower.y() <= other.lower.y() && other.upper.y() <= upper.y()
            && lower.z() <= other.lower.z() && other.upper.z() <= upper.z();
    }
    bool empty() const { return !(lower.x() <= upper.x()); }
};

/// The smallest box round two.
inline Box3 joined(const Box3& a, const Box3& b)
{
    return {a.lower.cwiseMin(b.lower), a.upper.cwiseMax(b.upper)};
}

}  // namespace throng
