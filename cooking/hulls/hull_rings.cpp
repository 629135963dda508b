#include "cooking/hulls/hull_rings.hpp"

#include <algorithm>
#include <numeric>

namespace throng {

HullRings::HullRings(std::span<const Vec3> points, const TriangleHull& hull)
    : begin_(points.size() + 1, 0), ring_(3 * hull.triangles.size()), first_block_(points.size(), 0)
{
    std::vector<std::uint32_t> triangle_at(points.size(), 0);
    for (std::uint32_t t = 0; t < hull.triangles.size(); ++t)
        for (const std::uint32_t corner : hull.triangles[t]) {
            triangle_at[corner] = t;
            ++begin_[corner + std::size_t{1}];
        }
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    for (std::uint32_t corner = 0; corner < points.size(); ++corner) {
        std::uint32_t triangle = triangle_at[corner];
        for (std::uint32_t i = begin_[corner]; i < begin_[corner + 1]; ++i) {
            const auto& corners = hull.triangles[triangle];
            const std::size_t k = corners[0] == corner ? 0 : corners[1] == corner ? 1 : 2;
            ring_[i] = corners[(k + 1) % 3];
            triangle = hull.adjacent[triangle][k];
        }
        if (begin_[corner + 1] - begin_[corner] < kLong) continue;
        first_block_[corner] = static_cast<std::uint32_t>(blocks_.size());
        for (std::uint32_t i = begin_[corner]; i < begin_[corner + 1]; ++i) {
            const Box3 point{points[ring_[i]], points[ring_[i]]};
            const bool first = (i - begin_[corner]) % kBlock == 0;
            if (first) blocks_.push_back(point);
            blocks_.back() = joined(blocks_.back(), point);
        }
    }
}

}  // namespace throng
