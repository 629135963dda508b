#include "cooking/decomposition/cutting_planes.hpp"

#include <algorithm>
#include <cmath>

namespace throng {
namespace {

// Across an axis and across a diagonal. More of them find better cuts by little and take as many
// times longer.
constexpr int kAcrossAxis = 11, kAcrossDiagonal = 5;
constexpr std::size_t kEdges = 6;
// Planes nearer to each other than this, by their normals and against the extent, are one.
constexpr double kSame = 1e-6;

double extent_of(const HullMesh& hull)
{
    Vec3 lower = hull.vertices[0], upper = lower;
    for (const Vec3& vertex : hull.vertices) {
        lower = lower.cwiseMin(vertex);
        upper = upper.cwiseMax(vertex);
    }
    return (upper - lower).maxCoeff();
}

void add_plane(const Vec3& normal, const Vec3& through, double extent, std::vector<Plane>& planes)
{
    const double length = normal.norm();
    if (!(length > 0)) return;
    const Vec3 unit = normal / length;
    const Plane plane{unit, unit.dot(through)};
    const bool known = std::any_of(planes.begin(), planes.end(), [&](const Plane& other) {
        const double sign = other.normal.dot(unit) < 0 ? -1 : 1;
        return (other.normal - sign * unit).squaredNorm() < kSame * kSame
            && std::abs(other.offset - sign * plane.offset) < kSame * extent;
    });
    if (!known) planes.push_back(plane);
}

void add_spaced(const HullMesh& hull, const Vec3& normal, int count, std::vector<Plane>& planes)
{
    double lower = normal.dot(hull.vertices[0]), upper = lower;
    for (const Vec3& vertex : hull.vertices) {
        lower = std::min(lower, normal.dot(vertex));
        upper = std::max(upper, normal.dot(vertex));
    }
    for (int i = 1; i <= count; ++i)
        planes.push_back({normal, lower + (upper - lower) * i / (count + 1)});
}

struct Deep {
    double score;
    std::size_t edge;
};

// The edges within the piece, those that matter most first.
std::vector<Deep>
deepest_edges(const MeshPiece& piece, const HullMesh& hull, const std::vector<InwardEdge>& edges)
{
    std::vector<Deep> found;
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const Vec3& at = edges[i].middle;
        const bool within = std::all_of(piece.cell.begin(), piece.cell.end(), [&](const Plane& p) {
            return p.normal.dot(at) < p.offset;
        });
        if (!within) continue;
        const double depth = -height_above(hull, at);
        if (depth > 0) found.push_back({depth * (edges[i].normal - edges[i].other).norm(), i});
    }
    std::sort(found.begin(), found.end(), [](const Deep& a, const Deep& b) {
        return a.score != b.score ? a.score > b.score : a.edge < b.edge;
    });
    return found;
}

}  // namespace

std::vector<InwardEdge> inward_edges(const Mesh& mesh)
{
    std::vector<InwardEdge> edges;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::int32_t beyond = mesh.adjacent[t][k];
            if (beyond < static_cast<std::int32_t>(t) || (mesh.convex_edges[t] >> k & 1) != 0)
                continue;
            const Vec3& normal = mesh.normals[t];
            const Vec3& other = mesh.normals[static_cast<std::size_t>(beyond)];
            // As little as build_mesh() lets an edge stick out for flat.
            if ((normal - other).squaredNorm() < 1e-6) continue;
            const Vec3& a = mesh.vertices[mesh.triangles[t][k]];
            const Vec3& b = mesh.vertices[mesh.triangles[t][(k + 1) % 3]];
            edges.push_back({a, b, (a + b) / 2, normal, other});
        }
    return edges;
}

std::vector<Vec3> cutting_directions()
{
    std::vector<Vec3> ways = {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
    for (int code = 14; code < 27; ++code) {
        const Vec3 way(code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1);
        if (way.squaredNorm() > 1.5) ways.push_back(way.normalized());
    }
    return ways;
}

std::vector<Plane>
cutting_planes(const MeshPiece& piece, const HullMesh& hull, const std::vector<InwardEdge>& edges)
{
    std::vector<Plane> planes;
    const double extent = extent_of(hull);
    std::vector<Vec3> used;
    // Those beside one that is used would say the same.
    for (const Deep& deep : deepest_edges(piece, hull, edges)) {
        const InwardEdge& edge = edges[deep.edge];
        const bool near = std::any_of(used.begin(), used.end(), [&](const Vec3& at) {
            return (at - edge.middle).norm() < 0.1 * extent;
        });
        if (near) continue;
        used.push_back(edge.middle);
        add_plane(edge.normal, edge.middle, extent, planes);
        add_plane(edge.other, edge.middle, extent, planes);
        add_plane(edge.normal - edge.other, edge.middle, extent, planes);
        add_plane(edge.normal.cross(edge.other), edge.middle, extent, planes);
        if (used.size() == kEdges) break;
    }
    const std::vector<Vec3> ways = cutting_directions();
    for (std::size_t i = 0; i < ways.size(); ++i)
        add_spaced(hull, ways[i], i < 3 ? kAcrossAxis : kAcrossDiagonal, planes);
    return planes;
}

}  // namespace throng
