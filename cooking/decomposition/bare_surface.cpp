#include "cooking/decomposition/bare_surface.hpp"

#include <algorithm>
#include <limits>
#include <queue>

namespace throng {
namespace {

// The most pieces of the surface to look into. Where hulls overlap some dozens are enough.
constexpr int kLooks = 2000;

// A piece of the surface, and how far out of the hull that covers it best.
struct Bare {
    double bound;
    std::uint32_t triangle, number;
    std::array<Vec3, 3> corners;

    bool operator<(const Bare& other) const
    {
        return bound != other.bound ? bound < other.bound : number > other.number;
    }
    Vec3 middle() const { return (corners[0] + corners[1] + corners[2]) / 3; }
};

// Distance from what is convex is greatest at a corner. No more than `little` is as good as none.
double out_of_best(const std::vector<HullMesh>& hulls, std::span<const Vec3> corners, double little)
{
    double least = std::numeric_limits<double>::infinity();
    for (const HullMesh& hull : hulls) {
        double most = 0;
        // The height above a face is never more than the distance, and quickly found.
        for (std::size_t i = 0; i < corners.size() && most < least; ++i)
            most = std::max(most, height_above(hull, corners[i]));
        for (std::size_t i = 0; i < corners.size() && most > 0 && most < least; ++i)
            most = std::max(most, distance_outside(hull, corners[i]));
        least = std::min(least, most);
        if (least <= little) break;
    }
    return least;
}

// Whether some corner is so far outside of all hulls that cutting on would not help.
bool is_out(const std::vector<HullMesh>& hulls, const Bare& bare, double enough)
{
    const auto& [a, b, c] = bare.corners;
    // Corners of what is as small as that are out together.
    const double small = 16 * enough * enough;
    if (std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()}) > small)
        return false;
    return std::any_of(bare.corners.begin(), bare.corners.end(), [&](const Vec3& corner) {
        return out_of_best(hulls, std::span(&corner, 1), enough) > enough;
    });
}

}  // namespace

BareSurface find_bare_surface(const Mesh& mesh, const std::vector<HullMesh>& hulls, double enough)
{
    BareSurface answer;
    std::priority_queue<Bare> waiting;
    std::uint32_t count = 0;
    const auto look = [&](std::uint32_t triangle, const std::array<Vec3, 3>& corners) {
        const double bound = out_of_best(hulls, corners, enough / 8);
        if (bound > enough)
            waiting.push({bound, triangle, count++, corners});
        else
            answer.bound = std::max(answer.bound, bound);
    };
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto& [a, b, c] = mesh.triangles[t];
        look(t, {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]});
    }
    for (int i = 0; i < kLooks && !waiting.empty(); ++i) {
        const Bare bare = waiting.top();
        if (is_out(hulls, bare, enough)) break;
        waiting.pop();
        const auto& [a, b, c] = longest_edge_first(bare.corners);
        const Vec3 ab = (a + b) / 2;
        look(bare.triangle, {a, ab, c});
        look(bare.triangle, {ab, b, c});
    }
    if (waiting.empty()) return answer;
    const Bare& bare = waiting.top();
    return {bare.bound, bare.middle(), mesh.normals[bare.triangle]};
}

}  // namespace throng
