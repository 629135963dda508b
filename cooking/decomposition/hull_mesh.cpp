#include "cooking/decomposition/hull_mesh.hpp"

#include "cooking/hulls/hull_cloud.hpp"
#include "kernels/geometry/mesh_distance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

namespace throng {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// How deep below a facet the balls are that tell how far the facet is from the mesh, in its radii.
constexpr double kBallDepths[] = {16, 4};

// Keeps the corners in use, in the order of the points.
HullMesh from_triangles(std::span<const Vec3> points, const TriangleHull& made)
{
    HullMesh hull;
    std::vector<std::uint32_t> place(points.size(), 0);
    for (const auto& triangle : made.triangles)
        for (const std::uint32_t corner : triangle) place[corner] = 1;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (place[i] != 0) {
            place[i] = static_cast<std::uint32_t>(hull.vertices.size());
            hull.vertices.push_back(points[i]);
        }
    for (const auto& [a, b, c] : made.triangles) {
        const Vec3& origin = points[a];
        const Vec3 across = (points[b] - origin).cross(points[c] - origin);
        hull.volume += across.dot(origin - points[made.triangles[0][0]]) / 6;
        const double length = across.norm();
        // Slivers of no area bound nothing that their neighbors do not.
        if (!(length > 0)) continue;
        hull.triangles.push_back({place[a], place[b], place[c]});
        hull.normals.emplace_back(across / length);
        hull.offsets.push_back(hull.normals.back().dot(origin));
    }
    return hull;
}

// The highest above any face, and which.
struct Height {
    double height = -kInfinity;
    std::size_t face = 0;
};

Height highest_face(const HullMesh& hull, const Vec3& point)
{
    Height best;
    for (std::size_t i = 0; i < hull.normals.size(); ++i) {
        const double height = hull.normals[i].dot(point) - hull.offsets[i];
        if (height > best.height) best = {height, i};
    }
    return best;
}

// The furthest vertices in the 26 directions in which a cube has faces, edges and corners.
std::vector<std::uint32_t> extremes(const HullMesh& hull)
{
    std::vector<std::uint32_t> chosen;
    for (int code = 0; code < 27; ++code) {
        const Vec3 way(code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1);
        if (code == 13) continue;
        std::uint32_t best = 0;
        for (std::uint32_t i = 1; i < hull.vertices.size(); ++i)
            if (way.dot(hull.vertices[i]) > way.dot(hull.vertices[best])) best = i;
        chosen.push_back(best);
    }
    std::sort(chosen.begin(), chosen.end());
    chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
    return chosen;
}

HullMesh hull_of(const HullMesh& all, const std::vector<std::uint32_t>& chosen)
{
    std::vector<Vec3> points;
    points.reserve(chosen.size());
    for (const std::uint32_t i : chosen) points.push_back(all.vertices[i]);
    return hull_mesh(points);
}

// Of the vertices that stick out of `part` by more than enough the furthest over each face, the
// furthest of all first.
std::vector<std::uint32_t> sticking_out(const HullMesh& all, const HullMesh& part, double enough)
{
    struct Out {
        double height;
        std::uint32_t vertex;
    };
    std::vector<Out> over(part.triangles.size(), Out{enough, 0});
    for (std::uint32_t i = 0; i < all.vertices.size(); ++i) {
        const Height at = highest_face(part, all.vertices[i]);
        if (at.height > over[at.face].height) over[at.face] = {at.height, i};
    }
    std::erase_if(over, [&](const Out& out) { return !(out.height > enough); });
    std::sort(over.begin(), over.end(), [](const Out& a, const Out& b) {
        return a.height != b.height ? a.height > b.height : a.vertex < b.vertex;
    });
    std::vector<std::uint32_t> found;
    found.reserve(over.size());
    for (const Out& out : over) found.push_back(out.vertex);
    return found;
}

// A piece of a hull's face, and how far outside it may reach.
struct Facet {
    double bound;
    std::uint32_t number;
    std::array<Vec3, 3> corners;

    bool operator<(const Facet& other) const
    {
        return bound != other.bound ? bound < other.bound : number > other.number;
    }
};

// Distance changes no faster than place, and that from one triangle is greatest at a corner.
double bound_of(const Mesh& mesh, const Facet& facet, Overhang& found)
{
    const auto& [a, b, c] = facet.corners;
    const Vec3 middle = (a + b + c) / 3;
    const MeshPoint nearest = nearest_on_mesh(mesh, middle);
    const double distance = signed_distance(mesh, middle, nearest);
    if (distance > found.least) {
        found.least = distance;
        found.where = middle;
    }
    double radius = 0, off = 0;
    const auto& [u, v, w] = mesh.triangles[nearest.triangle];
    for (const Vec3& corner : facet.corners) {
        radius = std::max(radius, (corner - middle).norm());
        const Vec3 on = closest_on_triangle<double>(corner, mesh.vertices[u], mesh.vertices[v],
                                                    mesh.vertices[w])
                            .point;
        off = std::max(off, (corner - on).norm());
    }
    return std::min(distance + radius, off);
}

// Of balls in the mesh, deep below the facet, that which bounds it best: little where the facet
// lies along a surface, however wide it is.
double bound_by_balls(const Mesh& mesh, const Facet& facet, double enough)
{
    const auto& [a, b, c] = facet.corners;
    const Vec3 middle = (a + b + c) / 3, inward = (c - a).cross(b - a).normalized();
    double wide = 0, least = kInfinity;
    for (const Vec3& corner : facet.corners) wide = std::max(wide, (corner - middle).norm());
    for (const double depth : kBallDepths) {
        const Vec3 center = middle + depth * wide * inward;
        const double radius = -signed_distance(mesh, center);
        if (!(radius > 0)) continue;
        double furthest = 0;
        for (const Vec3& corner : facet.corners)
            furthest = std::max(furthest, (corner - center).norm());
        least = std::min(least, furthest - radius);
        if (least <= enough) break;
    }
    return least;
}

}  // namespace

HullMesh hull_mesh(std::span<const Vec3> points)
{
    if (points.size() < 4) return {};
    const HullCloud cloud = hull_cloud(points);
    if (!cloud.trouble.empty()) return {};
    std::vector<std::uint32_t> chosen(cloud.start.begin(), cloud.start.end());
    for (std::uint32_t i = 0; i < points.size(); ++i)
        if (std::find(cloud.start.begin(), cloud.start.end(), i) == cloud.start.end())
            chosen.push_back(i);
    return from_triangles(points, exact_hull(round_to_grid(cloud), chosen));
}

double height_above(const HullMesh& hull, const Vec3& point)
{
    return highest_face(hull, point).height;
}

double distance_outside(const HullMesh& hull, const Vec3& point)
{
    if (!hull.empty() && height_above(hull, point) <= 0) return 0;
    double nearest = kInfinity;
    for (const auto& [a, b, c] : hull.triangles) {
        const auto on = closest_on_triangle<double>(point, hull.vertices[a], hull.vertices[b],
                                                    hull.vertices[c]);
        nearest = std::min(nearest, (on.point - point).squaredNorm());
    }
    return std::sqrt(nearest);
}

HullMesh simplified(const HullMesh& hull, std::size_t most, double enough)
{
    return hull.vertices.size() <= most ? hull : thinned(hull, most, enough);
}

HullMesh thinned(const HullMesh& hull, std::size_t most, double enough)
{
    if (hull.empty()) return hull;
    std::vector<std::uint32_t> chosen = extremes(hull);
    HullMesh part = hull_of(hull, chosen);
    // Each round adds a vertex at least.
    while (!part.empty() && chosen.size() < most) {
        std::vector<std::uint32_t> add = sticking_out(hull, part, enough);
        if (add.empty()) break;
        // A few at a time: those that come later see what the first have covered.
        const std::size_t few = std::max<std::size_t>(1, (most - chosen.size()) / 4);
        add.resize(std::min(few, add.size()));
        chosen.insert(chosen.end(), add.begin(), add.end());
        part = hull_of(hull, chosen);
    }
    return part.empty() ? hull : part;
}

std::array<Vec3, 3> longest_edge_first(const std::array<Vec3, 3>& corners)
{
    const auto& [a, b, c] = corners;
    const double ab = (b - a).squaredNorm(), bc = (c - b).squaredNorm(), ca = (a - c).squaredNorm();
    if (ab >= bc && ab >= ca) return corners;
    return bc >= ca ? std::array<Vec3, 3>{b, c, a} : std::array<Vec3, 3>{c, a, b};
}

Overhang find_overhang(const Mesh& mesh,
                       const HullMesh& hull,
                       double slack,
                       double enough,
                       std::size_t looks,
                       FacetCut cut)
{
    Overhang answer;
    std::priority_queue<Facet> waiting;
    std::uint32_t count = 0;
    const auto look = [&](const std::array<Vec3, 3>& corners) {
        Facet facet{0, count++, corners};
        facet.bound = bound_of(mesh, facet, answer);
        if (cut == FacetCut::in_two && facet.bound > std::max(answer.least, enough))
            facet.bound = std::min(facet.bound, bound_by_balls(mesh, facet, enough));
        waiting.push(facet);
    };
    for (const auto& [a, b, c] : hull.triangles)
        look({hull.vertices[a], hull.vertices[b], hull.vertices[c]});
    const std::size_t each = cut == FacetCut::in_two ? 2 : 4;
    for (std::size_t i = 0; i + each <= looks && !waiting.empty(); i += each) {
        const Facet facet = waiting.top();
        if (facet.bound <= std::max(answer.least + slack, enough)) break;
        waiting.pop();
        const auto& [a, b, c] =
            cut == FacetCut::in_two ? longest_edge_first(facet.corners) : facet.corners;
        const Vec3 ab = (a + b) / 2, bc = (b + c) / 2, ca = (c + a) / 2;
        if (cut == FacetCut::in_two) {
            look({a, ab, c});
            look({ab, b, c});
            continue;
        }
        look({a, ab, ca});
        look({ab, b, bc});
        look({ca, bc, c});
        look({ab, bc, ca});
    }
    answer.bound = answer.least;
    if (!waiting.empty()) answer.bound = std::max(answer.bound, waiting.top().bound);
    return answer;
}

}  // namespace throng
