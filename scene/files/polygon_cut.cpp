#include "scene/files/polygon_cut.hpp"

#include "kernels/check.hpp"

#include <algorithm>
#include <vector>

namespace throng {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

/// Cuts off ears until a triangle is left.
class EarCutter {
public:
    EarCutter(std::span<const Vec3> vertices, std::span<const std::uint32_t> corners)
        : vertices_(vertices), corners_(corners.begin(), corners.end())
    {
        // Twice the polygon's area, in its direction; a flat one may be looked at from any corner.
        const Vec3& first = vertices[corners[0]];
        for (std::size_t i = 1; i + 1 < corners.size(); ++i)
            normal_ += (vertices[corners[i]] - first).cross(vertices[corners[i + 1]] - first);
    }

    /// Whether each triangle of a fan about the first corner turns as the polygon does.
    bool fan_does() const
    {
        for (std::size_t i = 1; i + 1 < corners_.size(); ++i)
            if (turn(corners_[0], corners_[i], corners_[i + 1]) < 0) return false;
        return true;
    }

    void cut(std::span<Triangle> triangles)
    {
        for (Triangle& triangle : triangles) {
            std::size_t at = 0;
            while (at < corners_.size() && !is_ear(at)) ++at;
            // Without an ear, the second corner goes: what is left is cut as a fan.
            if (at == corners_.size()) at = 1;
            triangle = around(at);
            corners_.erase(corners_.begin() + static_cast<std::ptrdiff_t>(at));
        }
    }

private:
    double turn(std::uint32_t a, std::uint32_t b, std::uint32_t c) const
    {
        return (vertices_[b] - vertices_[a]).cross(vertices_[c] - vertices_[a]).dot(normal_);
    }

    Triangle around(std::size_t at) const
    {
        const std::size_t n = corners_.size();
        return {corners_[(at + n - 1) % n], corners_[at], corners_[(at + 1) % n]};
    }

    /// It sticks out, and no other corner lies in it.
    bool is_ear(std::size_t at) const
    {
        const Triangle ear = around(at);
        const std::uint32_t a = ear[0], b = ear[1], c = ear[2];
        if (!(turn(a, b, c) > 0)) return false;
        return std::none_of(corners_.begin(), corners_.end(), [&](std::uint32_t other) {
            return other != a && other != b && other != c && turn(a, b, other) >= 0
                && turn(b, c, other) >= 0 && turn(c, a, other) >= 0;
        });
    }

    std::span<const Vec3> vertices_;
    std::vector<std::uint32_t> corners_;
    Vec3 normal_ = Vec3::Zero();
};

}  // namespace

void cut_polygon(std::span<const Vec3> vertices,
                 std::span<const std::uint32_t> corners,
                 std::span<Triangle> triangles)
{
    THRONG_CHECK(corners.size() >= 3 && triangles.size() == corners.size() - 2,
                 "a polygon has two fewer triangles than corners");
    EarCutter cutter(vertices, corners);
    if (corners.size() <= kMostCutCorners && !cutter.fan_does())
        cutter.cut(triangles);
    else
        for (std::size_t i = 0; i < triangles.size(); ++i)
            triangles[i] = {corners[0], corners[i + 1], corners[i + 2]};
}

}  // namespace throng
