#include "narrowphase/mesh/concave_edges.hpp"

#include <algorithm>
#include <optional>

namespace throng {
namespace {

// Edges between a point's place and the triangle; further ones are for steps to come.
constexpr int kMostCrossed = 8;

// Sine by which what lies between may be beyond the triangle's plane: up to there edges are flat.
constexpr double kLevel = 1e-3;

constexpr std::size_t kNone = 3;

// The edge that a point is furthest outside of, seen along the normal; kNone where it is over the
// triangle.
std::size_t edge_towards(const MeshTriangle& triangle, const Vec3& point)
{
    std::size_t edge = kNone;
    double furthest = 0;
    for (std::size_t e = 0; e < 3; ++e) {
        const Vec3& corner = triangle.corners[e];
        const Vec3 along = triangle.corners[(e + 1) % 3] - corner;
        double outside = along.cross(triangle.normal).dot(point - corner);
        if (!(outside > 0)) continue;
        outside /= along.norm();
        if (!(outside > furthest)) continue;
        furthest = outside;
        edge = e;
    }
    return edge;
}

bool is_beyond_plane(const MeshTriangle& triangle, const MeshTriangle& other)
{
    return std::any_of(other.corners.begin(), other.corners.end(), [&](const Vec3& corner) {
        return triangle.height(corner) < -kLevel * (corner - triangle.corners[0]).norm();
    });
}

// The triangle that a point is over, where the mesh bends up from there to this one and first of
// all at an edge of it.
std::optional<MeshTriangle> foot_of_rise(const MeshTriangle& triangle, const Vec3& point)
{
    std::uint32_t place = triangle.index;
    for (int crossed = 0; crossed < kMostCrossed; ++crossed) {
        const MeshTriangle here(triangle.mesh, place, triangle.behind);
        if (crossed > 0 && is_beyond_plane(triangle, here)) return {};
        const std::size_t edge = edge_towards(here, point);
        if (edge == kNone && crossed > 0) return here;
        if (edge == kNone) return {};
        if (crossed == 0 ? !here.is_concave(edge) : here.is_convex(edge)) return {};
        const std::int32_t next = here.adjacent(edge);
        if (next < 0) return {};
        place = static_cast<std::uint32_t>(next);
    }
    return {};
}

// What comes along the triangle that it is over, or down to it, comes to the plane of the other by
// no more than this.
double nearing(const MeshTriangle& foot,
               const MeshTriangle& triangle,
               double separation,
               double speculative_margin)
{
    return std::max(separation, 0.0) * foot.normal.dot(triangle.normal)
        + speculative_margin * foot.normal.cross(triangle.normal).norm();
}

}  // namespace

void add_points_ahead(const MeshTriangle& triangle,
                      std::span<const Vec3> points,
                      double radius,
                      double speculative_margin,
                      LocalManifold<double>& out)
{
    out.normal = triangle.normal;
    std::uint32_t feature = 0;
    for (const Vec3& point : points) {
        ++feature;
        const double height = triangle.height(point), separation = height - radius;
        // Where the planes meet, the point is over the triangle already.
        if (separation < 0 || separation > speculative_margin) continue;
        const std::optional<MeshTriangle> foot = foot_of_rise(triangle, point);
        if (!foot) continue;
        const double over_foot = foot->height(point);
        if (over_foot < -speculative_margin
            || separation > nearing(*foot, triangle, over_foot - radius, speculative_margin))
            continue;
        out.add(point - triangle.normal * ((height + radius) / 2), separation, feature);
    }
}

}  // namespace throng
