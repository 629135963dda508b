#include "cooking/fields/surface_points.hpp"

#include "kernels/check.hpp"
#include "kernels/geometry/mesh_distance.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>

namespace throng {
namespace {

// Places offered and places kept, in parts of the spacing. Nothing is further than the first from
// an offered place, and no offered place is further than the second from one that is kept.
constexpr double kOffered = 0.2, kKept = 0.8;
// Cosine over which two normals look the same way: the faces beside a corner of a box still do.
constexpr double kAlike = 0.5;
// Cosines under which an edge, and a corner against its faces, counts as sharp: 20 and 30 degrees.
constexpr double kSharpEdge = 0.94, kSharpCorner = 0.866;
constexpr std::uint32_t kLeaf = 16;

struct Place {
    Vec3 position, normal;
    double least = 1;  // cosine of the angle to what leans most of the surface it stands for
};

// Cosine of the angle whose cosine is given, and 20 degrees more.
double cone(double least)
{
    constexpr double kCos = 0.94, kSin = 0.342;
    return least * kCos - std::sqrt(std::max(0.0, 1 - least * least)) * kSin;
}

// Keeps what is offered unless something kept is near. Cells of the grid may share a key: what is
// found there is measured all the same.
class Thinning {
public:
    explicit Thinning(double radius) : radius_(radius) { }

    void offer(const Place& place, double radius)
    {
        const Vec3 cell = (place.position / radius_).array().floor();
        for (int dz = -1; dz <= 1; ++dz)
            for (int dy = -1; dy <= 1; ++dy)
                for (int dx = -1; dx <= 1; ++dx)
                    if (meets(place, radius, key(cell + Vec3(dx, dy, dz)))) return;
        const auto [first, fresh] = first_.try_emplace(key(cell), kNone);
        next_.push_back(first->second);
        first->second = static_cast<std::uint32_t>(kept_.size());
        kept_.push_back(place);
    }
    const std::vector<Place>& kept() const { return kept_; }

private:
    static constexpr std::uint32_t kNone = ~std::uint32_t{0};

    static std::uint64_t key(const Vec3& cell)
    {
        std::uint64_t key = 0;
        for (int k = 0; k < 3; ++k)
            key = key << 21
                ^ (static_cast<std::uint64_t>(static_cast<std::int64_t>(cell[k])) & 0x1fffff);
        return key;
    }
    // What is kept stands for what it keeps away.
    bool meets(const Place& place, double radius, std::uint64_t cell)
    {
        const auto first = first_.find(cell);
        if (first == first_.end()) return false;
        for (std::uint32_t i = first->second; i != kNone; i = next_[i]) {
            const bool near = (kept_[i].position - place.position).squaredNorm() < radius * radius;
            const double alike = kept_[i].normal.dot(place.normal);
            if (!near || !(alike > kAlike)) continue;
            kept_[i].least = std::min(kept_[i].least, alike);
            return true;
        }
        return false;
    }

    double radius_;
    std::vector<Place> kept_;
    std::vector<std::uint32_t> next_;
    std::unordered_map<std::uint64_t, std::uint32_t> first_;
};

bool is_sharp(const Mesh& mesh, std::size_t triangle, std::size_t edge)
{
    const std::int32_t beyond = mesh.adjacent[triangle][edge];
    return (mesh.convex_edges[triangle] >> edge & 1) != 0
        && (beyond < 0
            || mesh.normals[triangle].dot(mesh.normals[static_cast<std::size_t>(beyond)])
                < kSharpEdge);
}

// Whether an edge is this triangle's to offer and not that of the one beyond.
bool is_own(const Mesh& mesh, std::size_t triangle, std::size_t edge)
{
    return mesh.adjacent[triangle][edge] < static_cast<std::int32_t>(triangle)
        || mesh.adjacent[triangle][edge] < 0;
}

// How far the faces at each vertex lean away from what it looks at: least cosine.
std::vector<double> find_leans(const Mesh& mesh)
{
    std::vector<double> leans(mesh.vertices.size(), 1);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        for (const std::uint32_t v : mesh.triangles[t])
            leans[v] = std::min(leans[v], mesh.vertex_normals[v].dot(mesh.normals[t]));
    return leans;
}

// Corners: where a face leans away from what the vertex looks at, but for those on the way of an
// edge that goes straight on.
std::vector<std::uint8_t> find_corners(const Mesh& mesh, const std::vector<double>& leans)
{
    std::vector<std::uint8_t> corners(mesh.vertices.size(), 0), edges(mesh.vertices.size(), 0);
    std::vector<Vec3> ways(mesh.vertices.size(), Vec3::Zero());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        for (std::size_t e = 0; e < 3; ++e) {
            const std::uint32_t from = mesh.triangles[t][e], to = mesh.triangles[t][(e + 1) % 3];
            if (leans[from] < kSharpCorner) corners[from] = 1;
            if (!is_sharp(mesh, t, e) || !is_own(mesh, t, e)) continue;
            const Vec3 way = (mesh.vertices[to] - mesh.vertices[from]).normalized();
            ways[from] += way;
            ways[to] -= way;
            for (const std::uint32_t end : {from, to})
                edges[end] = static_cast<std::uint8_t>(std::min(edges[end] + 1, 3));
        }
    for (std::size_t v = 0; v < corners.size(); ++v)
        if (edges[v] == 2 && ways[v].norm() < 0.35) corners[v] = 0;
    return corners;
}

// Those that are corners, or all.
void offer_vertices(const Mesh& mesh,
                    const std::vector<double>& leans,
                    const std::vector<std::uint8_t>& wanted,
                    double spacing,
                    Thinning& thinning)
{
    for (std::size_t v = 0; v < wanted.size(); ++v)
        if (wanted[v] != 0)
            thinning.offer({mesh.vertices[v], mesh.vertex_normals[v], leans[v]},
                           0.5 * kKept * spacing);
}

void offer_edges(const Mesh& mesh, double spacing, Thinning& thinning)
{
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
        for (std::size_t e = 0; e < 3; ++e) {
            if (!is_sharp(mesh, t, e) || !is_own(mesh, t, e)) continue;
            const Vec3& from = mesh.vertices[mesh.triangles[t][e]];
            const Vec3& to = mesh.vertices[mesh.triangles[t][(e + 1) % 3]];
            const auto region = static_cast<TriangleRegion>(1 + e);
            const Vec3 normal = outward_at(mesh, {0, from, t, region});
            const double parts = std::ceil((to - from).norm() / (2 * kOffered * spacing));
            for (double i = 0; i <= parts; ++i)
                thinning.offer(
                    {from + (to - from) * (i / parts), normal, normal.dot(mesh.normals[t])},
                    kKept * spacing);
        }
}

TriangleRegion region_of(int i, int k, int n)
{
    if (i == 0 && k == 0) return TriangleRegion::vertex0;
    if (k == 0) return i == n ? TriangleRegion::vertex1 : TriangleRegion::edge0;
    if (i == 0) return k == n ? TriangleRegion::vertex2 : TriangleRegion::edge2;
    return i + k == n ? TriangleRegion::edge1 : TriangleRegion::face;
}

double lean_of(const Mesh& mesh, const std::vector<double>& leans, const MeshPoint& where)
{
    const auto region = static_cast<std::size_t>(where.region);
    constexpr auto kVertex = static_cast<std::size_t>(TriangleRegion::vertex0);
    if (region >= kVertex) return leans[mesh.triangles[where.triangle][region - kVertex]];
    return outward_at(mesh, where).dot(mesh.normals[where.triangle]);
}

// A triangle cut into like ones so small that none of them reaches further than wanted from its
// corners: a third of the longest edge's square.
void offer_faces(const Mesh& mesh,
                 const std::vector<double>& leans,
                 double spacing,
                 Thinning& thinning)
{
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto& [a, b, c] = mesh.triangles[t];
        const Vec3 &va = mesh.vertices[a], &vb = mesh.vertices[b], &vc = mesh.vertices[c];
        const double longest2 =
            std::max({(vb - va).squaredNorm(), (vc - vb).squaredNorm(), (va - vc).squaredNorm()});
        const int n = std::max(
            1, static_cast<int>(std::ceil(std::sqrt(longest2 / 3) / (kOffered * spacing))));
        for (int i = 0; i <= n; ++i)
            for (int k = 0; i + k <= n; ++k) {
                const Vec3 at = va + (vb - va) * (double(i) / n) + (vc - va) * (double(k) / n);
                const MeshPoint where{0, at, t, region_of(i, k, n)};
                thinning.offer({at, outward_at(mesh, where), lean_of(mesh, leans, where)},
                               kKept * spacing);
            }
    }
}

// A tree by halving the longest side of what a node holds. All leaves but one are full.
class TreeBuilder {
public:
    TreeBuilder(const std::vector<Place>& places, SurfacePoints& out) : places_(places), out_(out)
    {
        order_.resize(places.size());
        std::iota(order_.begin(), order_.end(), 0U);
    }

    void build()
    {
        out_.nodes.resize(1);
        build(0, 0, static_cast<std::uint32_t>(places_.size()));
        for (const std::uint32_t i : order_) {
            out_.x.push_back(static_cast<float>(places_[i].position.x()));
            out_.y.push_back(static_cast<float>(places_[i].position.y()));
            out_.z.push_back(static_cast<float>(places_[i].position.z()));
            out_.normals.emplace_back(places_[i].normal.cast<float>());
            out_.cones.push_back(static_cast<float>(cone(places_[i].least)));
        }
    }

private:
    void build(std::uint32_t node, std::uint32_t begin, std::uint32_t end)
    {
        Vec3 lower = places_[order_[begin]].position, upper = lower;
        for (std::uint32_t i = begin; i < end; ++i) {
            lower = lower.cwiseMin(places_[order_[i]].position);
            upper = upper.cwiseMax(places_[order_[i]].position);
        }
        out_.nodes[node] = ball(0.5 * (lower + upper), begin, end);
        if (end - begin <= kLeaf) return;
        Eigen::Index axis = 0;
        (upper - lower).maxCoeff(&axis);
        const std::uint32_t leaves = (end - begin + kLeaf - 1) / kLeaf;
        const std::uint32_t split = begin + (leaves + 1) / 2 * kLeaf;
        std::sort(order_.begin() + begin, order_.begin() + end,
                  [&](std::uint32_t a, std::uint32_t b) {
                      const double at_a = places_[a].position[axis];
                      const double at_b = places_[b].position[axis];
                      return at_a != at_b ? at_a < at_b : a < b;
                  });
        const auto left = static_cast<std::uint32_t>(out_.nodes.size());
        out_.nodes[node].first = left;
        out_.nodes[node].count = 0;
        out_.nodes.resize(out_.nodes.size() + 2);
        build(left, begin, split);
        build(left + 1, split, end);
    }

    SurfacePoints::Node ball(const Vec3& center, std::uint32_t begin, std::uint32_t end) const
    {
        SurfacePoints::Node node;
        node.center = center.cast<float>();
        double squared = 0;
        for (std::uint32_t i = begin; i < end; ++i) {
            const Vec3T<float> rounded = places_[order_[i]].position.cast<float>();
            squared = std::max(squared, (rounded - node.center).cast<double>().squaredNorm());
        }
        // Wider by more than the difference in float may have lost.
        const double size = node.center.cast<double>().cwiseAbs().maxCoeff();
        node.radius = static_cast<float>(std::sqrt(squared) * (1 + 1e-6) + 1e-6 * size);
        node.first = begin;
        node.count = end - begin;
        return node;
    }

    const std::vector<Place>& places_;
    SurfacePoints& out_;
    std::vector<std::uint32_t> order_;
};

}  // namespace

SurfacePoints build_surface_points(const Mesh& mesh, double spacing)
{
    THRONG_CHECK(spacing > 0, "points need some spacing");
    THRONG_CHECK(mesh.vertex_normals.size() == mesh.vertices.size(), "points need vertex normals");
    SurfacePoints points;
    points.spacing = spacing;
    if (mesh.triangles.empty()) return points;
    Thinning thinning(kKept * spacing);
    const std::vector<double> leans = find_leans(mesh);
    offer_vertices(mesh, leans, find_corners(mesh, leans), spacing, thinning);
    offer_edges(mesh, spacing, thinning);
    offer_vertices(mesh, leans, std::vector<std::uint8_t>(mesh.vertices.size(), 1), spacing,
                   thinning);
    offer_faces(mesh, leans, spacing, thinning);
    TreeBuilder(thinning.kept(), points).build();
    return points;
}

}  // namespace throng
