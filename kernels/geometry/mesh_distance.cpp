#include "kernels/geometry/mesh_distance.hpp"

#include "kernels/check.hpp"
#include "kernels/geometry/mesh.hpp"

#include <algorithm>
#include <cmath>

namespace throng {
namespace {

// Rounding of the distance from a triangle's plane, and more.
constexpr double kSlack = 1 + 1e-9;

double distance2_to(const Vec3& lower, const Vec3& upper, const Vec3& point)
{
    return (point - point.cwiseMax(lower).cwiseMin(upper)).squaredNorm();
}

double distance2_to(const Mesh::Node& node, const Vec3& point)
{
    return distance2_to(node.lower, node.upper, point);
}

// Most triangles of a leaf are ruled out by their planes alone.
bool plane_is_beyond(const Mesh& mesh, std::uint32_t triangle, const Vec3& point, double distance2)
{
    const Vec3& corner = mesh.vertices[mesh.triangles[triangle][0]];
    const double height = mesh.normals[triangle].dot(point - corner);
    return height * height > distance2 * kSlack;
}

// And most others by their boxes: far cheaper than to find the nearest point.
bool is_beyond(const Mesh& mesh, std::uint32_t triangle, const Vec3& point, double distance2)
{
    if (plane_is_beyond(mesh, triangle, point, distance2)) return true;
    const Box3 box = triangle_box(mesh, triangle);
    return distance2_to(box.lower, box.upper, point) > distance2 * kSlack;
}

MeshPoint on_triangle(const Mesh& mesh, std::uint32_t triangle, const Vec3& point)
{
    const auto& [a, b, c] = mesh.triangles[triangle];
    const TrianglePoint<double> nearest =
        closest_on_triangle<double>(point, mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
    return {(nearest.point - point).norm(), nearest.point, triangle, nearest.region};
}

// Without the arc cosine of the C library, whose last bits differ from machine to machine: a half
// angle by its tangent, and that by a series that the halving has made short.
double angle_between(const Vec3& a, const Vec3& b)
{
    const Vec3 x = a.normalized(), y = b.normalized();
    // tan(angle / 2), and twice halved again.
    double tangent = (x - y).norm() / std::max((x + y).norm(), 1e-300);
    if (!(tangent < 1e150)) tangent = 1e150;
    for (int k = 0; k < 3; ++k) tangent = tangent / (1 + std::sqrt(1 + tangent * tangent));
    const double t2 = tangent * tangent;
    double sum = 0;
    for (int n = 12; n >= 0; --n) sum = (n % 2 == 0 ? 1.0 : -1.0) / (2 * n + 1) + t2 * sum;
    return 16 * tangent * sum;
}

}  // namespace

// Down the tree, the nearer child first.
MeshPoint nearest_on_mesh(const Mesh& mesh, const Vec3& point, double limit, std::uint32_t beside)
{
    struct OpenNode {
        std::uint32_t node;
        double distance2;
    };
    std::array<OpenNode, kMostWaiting> waiting;
    std::size_t count = 0;
    if (!mesh.tree.empty()) waiting[count++] = {0, distance2_to(mesh.tree.front(), point)};
    MeshPoint nearest;
    double within2 = limit * limit;
    const auto process = [&](std::uint32_t triangle) {
        if (is_beyond(mesh, triangle, point, within2)) return;
        const MeshPoint now = on_triangle(mesh, triangle, point);
        if (!(now.distance < nearest.distance)) return;
        nearest = now;
        within2 = std::min(within2, now.distance * now.distance);
    };
    if (beside < mesh.triangles.size()) process(beside);
    while (count > 0) {
        const OpenNode visit = waiting[--count];
        if (visit.distance2 > within2 * kSlack) continue;
        const Mesh::Node& node = mesh.tree[visit.node];
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) process(mesh.order[i]);
        if (node.count > 0) continue;
        OpenNode near{node.first, distance2_to(mesh.tree[node.first], point)};
        OpenNode far{node.first + 1, distance2_to(mesh.tree[node.first + 1], point)};
        if (far.distance2 < near.distance2) std::swap(near, far);
        waiting[count++] = far;
        waiting[count++] = near;
    }
    return nearest;
}

bool comes_within(const Mesh& mesh, const Vec3& point, double distance)
{
    const double distance2 = distance * distance;
    if (!(distance >= 0)) return false;
    std::array<std::uint32_t, kMostWaiting> waiting;
    std::size_t count = 0;
    if (!mesh.tree.empty()) waiting[count++] = 0;
    while (count > 0) {
        const Mesh::Node& node = mesh.tree[waiting[--count]];
        if (distance2_to(node, point) > distance2 * kSlack) continue;
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
            if (!is_beyond(mesh, mesh.order[i], point, distance2)
                && on_triangle(mesh, mesh.order[i], point).distance <= distance)
                return true;
        if (node.count > 0) continue;
        waiting[count++] = node.first + 1;
        waiting[count++] = node.first;
    }
    return false;
}

void find_vertex_normals(Mesh& mesh)
{
    mesh.vertex_normals.assign(mesh.vertices.size(), Vec3::Zero());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3& at = mesh.vertices[mesh.triangles[t][k]];
            const Vec3& next = mesh.vertices[mesh.triangles[t][(k + 1) % 3]];
            const Vec3& last = mesh.vertices[mesh.triangles[t][(k + 2) % 3]];
            mesh.vertex_normals[mesh.triangles[t][k]] +=
                mesh.normals[t] * angle_between(next - at, last - at);
        }
    for (Vec3& normal : mesh.vertex_normals)
        if (normal.squaredNorm() > 0) normal.normalize();
}

Vec3 outward_at(const Mesh& mesh, const MeshPoint& where)
{
    const auto place = static_cast<std::size_t>(where.region);
    constexpr auto kEdge = static_cast<std::size_t>(TriangleRegion::edge0);
    constexpr auto kVertex = static_cast<std::size_t>(TriangleRegion::vertex0);
    const Vec3& normal = mesh.normals[where.triangle];
    if (where.region == TriangleRegion::face) return normal;
    if (place >= kVertex)
        return mesh.vertex_normals[mesh.triangles[where.triangle][place - kVertex]];
    const std::int32_t beyond = mesh.adjacent[where.triangle][place - kEdge];
    if (beyond < 0) return normal;
    const Vec3 sum = normal + mesh.normals[static_cast<std::size_t>(beyond)];
    // Folded flat: neither side is outside.
    return sum.squaredNorm() > 1e-24 ? Vec3(sum.normalized()) : normal;
}

double signed_distance(const Mesh& mesh, const Vec3& point, const MeshPoint& nearest)
{
    THRONG_CHECK(mesh.vertex_normals.size() == mesh.vertices.size(), "a side needs vertex normals");
    const bool inside = outward_at(mesh, nearest).dot(point - nearest.point) < 0;
    return inside ? -nearest.distance : nearest.distance;
}

double signed_distance(const Mesh& mesh, const Vec3& point)
{
    return signed_distance(mesh, point, nearest_on_mesh(mesh, point));
}

}  // namespace throng
