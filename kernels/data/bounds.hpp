// Bounds: a box round each collider, with a margin for what it may do before it is looked at again.
#pragma once

#include "kernels/math/types.hpp"

#include <limits>
#include <vector>

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

/// What the broad phase works on.
///
///   boxes     [colliders] margin included
///   reach     [colliders] m, how far from its surface a contact is looked for in this step
///   moving    [colliders] 1 for those of bodies that can move
///   placed    [colliders] where each shape is, as of the start of the last step it was awake in
///   asked     colliders whose boxes changed in this step, ascending
///   touched   colliders that were added, removed or moved from outside since the last step
struct Bounds {
    std::vector<Box3> boxes;
    std::vector<double> reach;
    std::vector<std::uint8_t> moving;
    std::vector<Pose> placed;
    std::vector<std::uint32_t> asked;
    std::vector<std::uint32_t> touched;
    bool still_changed = true;
    std::vector<std::vector<std::uint32_t>> of_block;  // scratch
};

}  // namespace throng
