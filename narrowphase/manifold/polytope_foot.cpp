#include "narrowphase/manifold/polytope_foot.hpp"

#include "narrowphase/manifold/foot.hpp"

#include <vector>

namespace throng {
namespace {

using Point = LocalManifold<double>::Point;

// Places on b's surface and how high each is over the face.
struct Candidates {
    std::vector<Point> points;

    std::size_t size() const { return points.size(); }
    const Vec3& at(std::size_t i) const { return points[i].position; }
    double height(std::size_t i) const { return points[i].separation; }
};

bool is_over(const PolytopeView& shape, std::uint16_t face, const Vec3& place)
{
    const auto corners = shape.face(face);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec3& from = shape.vertices[corners[i]];
        const Vec3& to = shape.vertices[corners[i + 1 == corners.size() ? 0 : i + 1]];
        if ((to - from).cross(shape.normals[face]).dot(place - from) > 0) return false;
    }
    return true;
}

// The points of a manifold, on b.
void start_with(const LocalManifold<double>& manifold, std::vector<Point>& points)
{
    points.clear();
    for (int i = 0; i < manifold.count; ++i) {
        Point point = manifold.points[static_cast<std::size_t>(i)];
        point.position += manifold.normal * (point.separation / 2);
        points.push_back(point);
    }
}

void add_corners_over(const PolytopePair& pair,
                      std::uint16_t face,
                      double speculative_margin,
                      std::vector<Point>& points)
{
    for (std::size_t i = 0; i < pair.b.vertices.size(); ++i) {
        const Vec3 place = pair.turn * pair.b.vertices[i] + pair.shift;
        const double separation = pair.a.normals[face].dot(place) - pair.a.offsets[face];
        if (separation > speculative_margin || !is_over(pair.a, face, place)) continue;
        // Told from clipped corners, as of a corner by itself.
        const auto feature = 1u << 30 | std::uint32_t{face} << 16 | static_cast<std::uint32_t>(i);
        points.push_back({place, separation, feature});
    }
}

}  // namespace

bool is_long_step(double speculative_margin, double deepest, double inner_radius)
{
    constexpr double kFar = 0.3, kSunk = 0.1;
    return speculative_margin > kFar * inner_radius || deepest < -kSunk * inner_radius;
}

void spread_foot(const PolytopePair& pair,
                 std::uint16_t face,
                 double speculative_margin,
                 LocalManifold<double>& manifold)
{
    thread_local Candidates candidates;
    start_with(manifold, candidates.points);
    if (candidates.points.empty()) return;
    const double size = pair.b.outer_radius;
    const Vec3 into = -pair.a.normals[face], middle = pair.turn * pair.b.center + pair.shift;
    {
        Foot<double, Candidates> has(candidates, into, speculative_margin);
        if (!is_long_step(speculative_margin, has.lowest(), pair.b.inner_radius)) return;
        // Whatever their heights.
        has.spread(size, 1, speculative_margin);
        if (has.stands(middle)) return;
    }
    add_corners_over(pair, face, speculative_margin, candidates.points);
    Foot<double, Candidates> foot(candidates, into, speculative_margin);
    if (!foot.within_margin()) return;
    foot.spread_to_stand(size, speculative_margin / size, middle);
    manifold.normal = -into;
    manifold.count = 0;
    for (const std::size_t i : foot.chosen()) {
        if (i == foot.kNone) continue;
        const Point& point = candidates.points[i];
        manifold.add(point.position + into * (point.separation / 2), point.separation,
                     point.feature);
    }
}

}  // namespace throng
