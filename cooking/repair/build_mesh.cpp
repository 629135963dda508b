#include "cooking/repair/build_mesh.hpp"

#include "kernels/geometry/mesh.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace throng {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

// Least area, against the square of the longest edge, that a triangle needs for a normal.
constexpr double kThin = 1e-12;
// Radians that an edge must stick out: well above the rounding of single precision files, well
// below what a rolling ball would feel.
constexpr double kSharp = 1e-3;
constexpr std::uint32_t kLeaf = 4;

std::string trouble_with(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles)
{
    if (triangles.empty()) return "has no triangles; give at least one";
    for (std::size_t i = 0; i < vertices.size(); ++i)
        if (!vertices[i].allFinite())
            return "vertex " + std::to_string(i) + " is not finite; give finite coordinates";
    for (std::size_t i = 0; i < triangles.size(); ++i)
        for (const std::uint32_t vertex : triangles[i])
            if (vertex >= vertices.size())
                return "triangle " + std::to_string(i) + " names vertex " + std::to_string(vertex)
                    + "; there are " + std::to_string(vertices.size());
    return {};
}

// For each vertex the first one that is identical.
std::vector<std::uint32_t> first_alike(const std::vector<Vec3>& vertices)
{
    const auto before = [&](std::uint32_t i, std::uint32_t j) {
        const Vec3 &a = vertices[i], &b = vertices[j];
        for (int k = 0; k < 3; ++k)
            if (a[k] != b[k]) return a[k] < b[k];
        return i < j;
    };
    std::vector<std::uint32_t> sorted(vertices.size());
    std::iota(sorted.begin(), sorted.end(), 0U);
    std::sort(sorted.begin(), sorted.end(), before);
    std::vector<std::uint32_t> first(vertices.size());
    for (std::size_t i = 0; i < sorted.size(); ++i) {
        const bool same = i > 0 && vertices[sorted[i]] == vertices[sorted[i - 1]];
        first[sorted[i]] = same ? first[sorted[i - 1]] : sorted[i];
    }
    return first;
}

Vec3 area_vector(const std::vector<Vec3>& vertices, const Triangle& triangle)
{
    const Vec3& origin = vertices[triangle[0]];
    return (vertices[triangle[1]] - origin).cross(vertices[triangle[2]] - origin);
}

bool has_area(const std::vector<Vec3>& vertices, const Triangle& triangle)
{
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k)
        longest = std::max(longest,
                           (vertices[triangle[(k + 1) % 3]] - vertices[triangle[k]]).squaredNorm());
    return area_vector(vertices, triangle).norm() > kThin * longest;
}

// Keeps what counts, in its order: triangles with area, and the vertices they use.
void keep_useful(const std::vector<Vec3>& vertices, std::vector<Triangle> triangles, Mesh& mesh)
{
    const std::vector<std::uint32_t> alike = first_alike(vertices);
    for (Triangle& triangle : triangles)
        for (std::uint32_t& vertex : triangle) vertex = alike[vertex];
    std::erase_if(triangles, [&](const Triangle& t) { return !has_area(vertices, t); });

    std::vector<std::uint8_t> used(vertices.size(), 0);
    for (const Triangle& triangle : triangles)
        for (const std::uint32_t vertex : triangle) used[vertex] = 1;
    std::vector<std::uint32_t> place(vertices.size(), 0);
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        if (!used[i]) continue;
        place[i] = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.push_back(vertices[i]);
    }
    for (Triangle& triangle : triangles)
        for (std::uint32_t& vertex : triangle) vertex = place[vertex];
    mesh.triangles = std::move(triangles);
    for (const Triangle& triangle : mesh.triangles)
        mesh.normals.push_back(area_vector(mesh.vertices, triangle).normalized());
}

struct HalfEdge {
    std::uint32_t low, high, triangle, edge;
    bool rising;  // runs from low to high
};

void join_neighbors(Mesh& mesh)
{
    std::vector<HalfEdge> edges;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
        for (std::uint32_t e = 0; e < 3; ++e) {
            const std::uint32_t from = mesh.triangles[t][e], to = mesh.triangles[t][(e + 1) % 3];
            edges.push_back({std::min(from, to), std::max(from, to), t, e, from < to});
        }
    std::sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
        return std::array{a.low, a.high, a.triangle, a.edge}
        < std::array{b.low, b.high, b.triangle, b.edge};
    });

    mesh.adjacent.assign(mesh.triangles.size(), {-1, -1, -1});
    for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
        const HalfEdge& a = edges[begin];
        while (end < edges.size() && edges[end].low == a.low && edges[end].high == a.high) ++end;
        const HalfEdge& b = edges[end - 1];
        if (end - begin != 2 || a.rising == b.rising) continue;
        mesh.adjacent[a.triangle][a.edge] = static_cast<std::int32_t>(b.triangle);
        mesh.adjacent[b.triangle][b.edge] = static_cast<std::int32_t>(a.triangle);
    }
}

// Whether the neighbor over an edge folds away below the triangle's plane, and whether it rises
// above it: what sticks out as seen from behind.
struct Fold {
    bool below = true, above = true;
};
Fold fold_at(const Mesh& mesh, std::size_t triangle, std::size_t edge)
{
    const std::int32_t other = mesh.adjacent[triangle][edge];
    if (other < 0) return {};
    const std::uint32_t from = mesh.triangles[triangle][edge];
    const std::uint32_t to = mesh.triangles[triangle][(edge + 1) % 3];
    std::uint32_t tip = from;
    for (const std::uint32_t vertex : mesh.triangles[static_cast<std::size_t>(other)])
        if (vertex != from && vertex != to) tip = vertex;

    // Both from the edge's line: how far the tip is from it, and how far below the plane.
    const Vec3 along = (mesh.vertices[to] - mesh.vertices[from]).normalized();
    const Vec3 arm = mesh.vertices[tip] - mesh.vertices[from];
    const Vec3 across = arm - along * along.dot(arm);
    const double rise = mesh.normals[triangle].dot(across);
    const bool folded_flat =
        mesh.normals[triangle].dot(mesh.normals[static_cast<std::size_t>(other)]) < -1 + 1e-6;
    const double least = kSharp * across.norm();
    return {rise < -least || folded_flat, rise > least && !folded_flat};
}

void mark_convex_edges(Mesh& mesh)
{
    mesh.convex_edges.assign(mesh.triangles.size(), 0);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        for (std::size_t e = 0; e < 3; ++e) {
            const Fold fold = fold_at(mesh, t, e);
            const unsigned bits = (fold.below ? 1U << e : 0U) | (fold.above ? 8U << e : 0U);
            mesh.convex_edges[t] = static_cast<std::uint8_t>(mesh.convex_edges[t] | bits);
        }
}

// Triangles from which a rim can be reached over edges: those of pieces that enclose nothing.
void mark_open_pieces(Mesh& mesh)
{
    std::vector<std::uint32_t> reached;
    const auto mark = [&](std::uint32_t t) {
        if ((mesh.convex_edges[t] & kOpenPiece) != 0) return;
        mesh.convex_edges[t] = static_cast<std::uint8_t>(mesh.convex_edges[t] | kOpenPiece);
        reached.push_back(t);
    };
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
        if (*std::min_element(mesh.adjacent[t].begin(), mesh.adjacent[t].end()) < 0) mark(t);
    for (std::size_t i = 0; i < reached.size(); ++i)
        for (const std::int32_t next : mesh.adjacent[reached[i]])
            if (next >= 0) mark(static_cast<std::uint32_t>(next));
}

double surface(const Box3& box)
{
    const Vec3 size = box.upper - box.lower;
    return size.x() * size.y() + size.y() * size.z() + size.z() * size.x();
}

class TreeBuilder {
public:
    explicit TreeBuilder(Mesh& mesh) : mesh_(mesh)
    {
        for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
            boxes_.push_back(triangle_box(mesh, t));
        costs_.resize(boxes_.size());
    }

    void build()
    {
        mesh_.order.resize(boxes_.size());
        std::iota(mesh_.order.begin(), mesh_.order.end(), 0U);
        mesh_.tree.resize(1);
        build(0, 0, static_cast<std::uint32_t>(boxes_.size()));
    }

private:
    void build(std::uint32_t node, std::uint32_t begin, std::uint32_t end)
    {
        Box3 box, middles;
        for (std::uint32_t i = begin; i < end; ++i) {
            const Box3& own = boxes_[mesh_.order[i]];
            const Vec3 middle = 0.5 * (own.lower + own.upper);
            box = joined(box, own);
            middles = joined(middles, {middle, middle});
        }
        mesh_.tree[node] = {box.lower, box.upper, begin, end - begin};
        if (end - begin <= kLeaf) {
            std::sort(mesh_.order.begin() + begin, mesh_.order.begin() + end);
            return;
        }
        int axis = 0;
        (middles.upper - middles.lower).maxCoeff(&axis);
        const std::uint32_t split = split_along(axis, begin, end);
        const auto left = static_cast<std::uint32_t>(mesh_.tree.size());
        mesh_.tree[node].first = left;
        mesh_.tree[node].count = 0;
        mesh_.tree.resize(mesh_.tree.size() + 2);
        build(left, begin, split);
        build(left + 1, split, end);
    }

    // Sorts along the axis and cuts where the two boxes have the least surface, each weighed by
    // its triangles, but never worse than one to three: the visit's stack relies on that.
    std::uint32_t split_along(int axis, std::uint32_t begin, std::uint32_t end)
    {
        std::sort(mesh_.order.begin() + begin, mesh_.order.begin() + end,
                  [&](std::uint32_t a, std::uint32_t b) {
                      const double at_a = boxes_[a].lower[axis] + boxes_[a].upper[axis];
                      const double at_b = boxes_[b].lower[axis] + boxes_[b].upper[axis];
                      return at_a != at_b ? at_a < at_b : a < b;
                  });
        Box3 right;
        for (std::uint32_t i = end - 1; i > begin; --i) {
            right = joined(right, boxes_[mesh_.order[i]]);
            costs_[i] = surface(right) * (end - i);
        }
        const std::uint32_t least = std::max(1U, (end - begin) / 4);
        std::uint32_t best = begin + (end - begin) / 2;
        double best_cost = std::numeric_limits<double>::infinity();
        Box3 left;
        for (std::uint32_t i = begin + 1; i <= end - least; ++i) {
            left = joined(left, boxes_[mesh_.order[i - 1]]);
            const double cost = costs_[i] + surface(left) * (i - begin);
            if (i < begin + least || !(cost < best_cost)) continue;
            best_cost = cost;
            best = i;
        }
        return best;
    }

    Mesh& mesh_;
    std::vector<Box3> boxes_;
    std::vector<double> costs_;
};

}  // namespace

MeshResult build_mesh(const std::vector<Vec3>& vertices, std::vector<Triangle> triangles)
{
    MeshResult result;
    result.trouble = trouble_with(vertices, triangles);
    if (!result.trouble.empty()) return result;
    keep_useful(vertices, std::move(triangles), result.mesh);
    if (result.mesh.triangles.empty()) {
        result.trouble = "has no triangle with an area; give at least one";
        return result;
    }
    join_neighbors(result.mesh);
    mark_convex_edges(result.mesh);
    mark_open_pieces(result.mesh);
    TreeBuilder(result.mesh).build();
    add_small_boxes(result.mesh);
    return result;
}

}  // namespace throng
