#include "cooking/repair/mesh_holes.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace throng {
namespace {

using Triangle = std::array<std::uint32_t, 3>;
constexpr std::uint32_t kNone = 0xFFFFFFFF;
// Least area of a triangle against the square of its longest edge: well above what build_mesh()
// leaves out, since that would open the hole again.
constexpr double kThinnest = 1e-9;

double area_of(const Vec3& a, const Vec3& b, const Vec3& c)
{
    return 0.5 * (b - a).cross(c - a).norm();
}

// Edges of one triangle alone, as that triangle runs along them.
std::vector<std::array<std::uint32_t, 2>> find_rims(const std::vector<Triangle>& triangles)
{
    struct HalfEdge {
        std::uint32_t low, high, from;
    };
    std::vector<HalfEdge> edges;
    for (const Triangle& t : triangles)
        for (std::size_t e = 0; e < 3; ++e) {
            const std::uint32_t from = t[e], to = t[(e + 1) % 3];
            edges.push_back({std::min(from, to), std::max(from, to), from});
        }
    std::sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
        return std::array{a.low, a.high, a.from} < std::array{b.low, b.high, b.from};
    });
    std::vector<std::array<std::uint32_t, 2>> rims;
    for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
        const HalfEdge& edge = edges[begin];
        while (end < edges.size() && edges[end].low == edge.low && edges[end].high == edge.high)
            ++end;
        if (end - begin == 1) rims.push_back({edge.from, edge.low + edge.high - edge.from});
    }
    return rims;
}

// For each vertex of a rim the next one; kNone where there is no rim or not one way on.
std::vector<std::uint32_t> follow_rims(const std::vector<std::array<std::uint32_t, 2>>& rims,
                                       std::size_t vertices)
{
    std::vector<std::uint32_t> next(vertices, kNone), leaving(vertices, 0), coming(vertices, 0);
    for (const auto& [from, to] : rims) {
        next[from] = to;
        ++leaving[from];
        ++coming[to];
    }
    for (std::size_t v = 0; v < vertices; ++v)
        if (leaving[v] != 1 || coming[v] != 1) next[v] = kNone;
    return next;
}

// The loop that leads back to `first`, or none. What was passed is not passed again.
std::vector<std::uint32_t> take_loop(std::uint32_t first, std::vector<std::uint32_t>& next)
{
    std::vector<std::uint32_t> loop;
    std::uint32_t at = first;
    while (next[at] != kNone) {
        loop.push_back(at);
        at = std::exchange(next[at], kNone);
    }
    if (at != first) loop.clear();
    return loop;
}

// Of the surface that each vertex is part of, the area.
class SurfaceAreas {
public:
    SurfaceAreas(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles)
        : leader_(vertices.size()), area_(vertices.size(), 0)
    {
        std::iota(leader_.begin(), leader_.end(), 0U);
        for (const auto& [a, b, c] : triangles) {
            join(a, b);
            join(b, c);
        }
        for (const auto& [a, b, c] : triangles)
            area_[find(a)] += area_of(vertices[a], vertices[b], vertices[c]);
    }

    double at(std::uint32_t vertex) { return area_[find(vertex)]; }

private:
    std::uint32_t find(std::uint32_t v)
    {
        while (leader_[v] != v) v = leader_[v] = leader_[leader_[v]];
        return v;
    }
    void join(std::uint32_t a, std::uint32_t b)
    {
        a = find(a);
        b = find(b);
        leader_[std::max(a, b)] = std::min(a, b);
    }

    std::vector<std::uint32_t> leader_;
    std::vector<double> area_;
};

// Weighed by length, so that a rim cut more finely on one side has the same middle.
Vec3 middle_of(const std::vector<std::uint32_t>& loop, const std::vector<Vec3>& vertices)
{
    // About one of its vertices, so that nothing is lost far from the origin.
    const Vec3& origin = vertices[loop.front()];
    Vec3 sum = Vec3::Zero();
    double whole = 0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const Vec3& a = vertices[loop[i]];
        const Vec3& b = vertices[loop[(i + 1) % loop.size()]];
        const double length = (b - a).norm();
        sum += length * (0.5 * (a + b) - origin);
        whole += length;
    }
    return origin + sum / whole;
}

// Triangles over a loop and, where there are more than three corners, its middle; they run along it
// against the way of the triangles that are there.
std::vector<Triangle> fan_over(const std::vector<std::uint32_t>& loop, std::uint32_t middle)
{
    if (loop.size() == 3) return {{loop[2], loop[1], loop[0]}};
    std::vector<Triangle> fan;
    for (std::size_t i = 0; i < loop.size(); ++i)
        fan.push_back({loop[(i + 1) % loop.size()], loop[i], middle});
    return fan;
}

// Whether each triangle has an area that tells it from a line, and all together at most `most`.
bool is_good(const std::vector<Triangle>& fan, const std::vector<Vec3>& vertices, double most)
{
    double whole = 0;
    for (const auto& [i, j, k] : fan) {
        const Vec3 &a = vertices[i], &b = vertices[j], &c = vertices[k];
        const double area = area_of(a, b, c);
        const double longest =
            std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
        if (!(area > kThinnest * longest)) return false;
        whole += area;
    }
    return whole <= most;
}

}  // namespace

ClosedHoles close_holes(std::vector<Vec3>& vertices, std::vector<Triangle>& triangles)
{
    ClosedHoles closed;
    const auto rims = find_rims(triangles);
    if (rims.empty()) return closed;
    std::vector<std::uint32_t> next = follow_rims(rims, vertices.size());
    SurfaceAreas areas(vertices, triangles);
    for (const auto& rim : rims) {
        const std::vector<std::uint32_t> loop = take_loop(rim[0], next);
        if (loop.size() < 3) continue;
        vertices.push_back(middle_of(loop, vertices));
        const auto fan = fan_over(loop, static_cast<std::uint32_t>(vertices.size() - 1));
        const bool good = is_good(fan, vertices, kGreatestHole * areas.at(rim[0]));
        if (!good || fan.size() == 1) vertices.pop_back();
        if (!good) continue;
        triangles.insert(triangles.end(), fan.begin(), fan.end());
        ++closed.count;
        closed.longest = std::max(closed.longest, loop.size());
    }
    return closed;
}

}  // namespace throng
