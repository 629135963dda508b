// Mesh crossings: whether a mesh cuts itself, for tests to look at.
#pragma once

#include "kernels/geometry/mesh.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

/// Whether a segment goes through a triangle, from one side to the other and inside its edges. One
/// that touches, or lies in the triangle's plane, does not.
inline bool
goes_through(const Vec3& from, const Vec3& to, const Vec3& p, const Vec3& q, const Vec3& r)
{
    const Vec3 normal = (q - p).cross(r - p).normalized(), way = to - from;
    const double before = normal.dot(from - p), after = normal.dot(to - p);
    const double rounding = 1e-12 * (way.norm() + (from - p).norm());
    if (before * after >= 0 || std::min(std::abs(before), std::abs(after)) < rounding) return false;
    const auto left_of = [&](const Vec3& a, const Vec3& b) {
        return way.dot((a - from).cross(b - from)) > 0;
    };
    return left_of(p, q) == left_of(q, r) && left_of(q, r) == left_of(r, p);
}

/// How many times an edge of a triangle goes through a triangle with which it shares no corner.
inline std::size_t count_crossings(const Mesh& mesh)
{
    std::size_t count = 0;
    for (const auto& triangle : mesh.triangles)
        for (std::size_t e = 0; e < 3; ++e) {
            const std::uint32_t i = triangle[e], k = triangle[(e + 1) % 3];
            const Vec3 &from = mesh.vertices[i], &to = mesh.vertices[k];
            visit_triangles(mesh, {from.cwiseMin(to), from.cwiseMax(to)}, [&](std::uint32_t t) {
                const auto [a, b, c] = mesh.triangles[t];
                if (a == i || b == i || c == i || a == k || b == k || c == k) return;
                count +=
                    goes_through(from, to, mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
            });
        }
    return count;
}

}  // namespace throng
