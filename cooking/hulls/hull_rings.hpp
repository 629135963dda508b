// Hull rings: the corners round each corner of a hull, looked through for those that lie high.
//
// The tip of a cone has as many corners round it as there are faces, each of which asks for its
// highest corner: so long rings are kept in blocks with boxes, and low blocks are passed over.
#pragma once

#include "cooking/hulls/exact_hull.hpp"
#include "kernels/data/bounds.hpp"

namespace throng {

/// For each corner of a hull those that share an edge with it, in their order round it.
class HullRings {
public:
    HullRings(std::span<const Vec3> points, const TriangleHull& hull);

    /// Calls visit(other) for those round a corner, in order, but for some that are lower along the
    /// direction than the level.
    template <class Visitor>
    void visit_high(std::uint32_t corner, const Vec3& direction, double level, Visitor visit) const
    {
        const std::uint32_t begin = begin_[corner], end = begin_[corner + 1];
        if (end - begin < kLong) {
            for (std::uint32_t i = begin; i < end; ++i) visit(ring_[i]);
            return;
        }
        std::uint32_t block = first_block_[corner];
        for (std::uint32_t i = begin; i < end; i += kBlock, ++block) {
            if (top_of(blocks_[block], direction) < level) continue;
            for (std::uint32_t k = i; k < std::min(i + kBlock, end); ++k) visit(ring_[k]);
        }
    }

private:
    // Shorter rings are not worth boxes.
    static constexpr std::uint32_t kLong = 64, kBlock = 32;
    // Rounding of a height, of points whose coordinates are at most about 1.
    static constexpr double kRounding = 1e-14;

    /// No point in the box is higher along the direction.
    static double top_of(const Box3& box, const Vec3& direction)
    {
        return direction.cwiseMax(0).dot(box.upper) + direction.cwiseMin(0).dot(box.lower)
            + kRounding;
    }

    std::vector<std::uint32_t> begin_;  // [points + 1] of its ring
    std::vector<std::uint32_t> ring_;
    std::vector<std::uint32_t> first_block_;  // [points] of a long ring
    std::vector<Box3> blocks_;                // round kBlock corners of a ring one after another
};

}  // namespace throng
