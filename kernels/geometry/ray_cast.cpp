#include "kernels/geometry/ray_cast.hpp"

#include "kernels/geometry/mesh.hpp"
#include "kernels/geometry/mesh_distance.hpp"
#include "kernels/geometry/ray_passage.hpp"
#include "kernels/geometry/support.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace throng {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

LocalRayHit first_of(const RayPassage& passage, const LocalRay& ray)
{
    const bool meets = !passage.empty() && passage.leave >= 0 && passage.enter <= ray.longest
        && passage.enter < kInfinity;
    if (!meets) return {};
    if (passage.enter < 0) return {0, -ray.along};
    return {passage.enter + 0.0, unit_or(passage.enter_normal, Vec3(-ray.along))};
}

// A ray against triangles, sheared so that it runs along one axis: whether it passes left or right
// of an edge then comes out the same for both triangles that share the edge.
//
// Source: Woop, Benthin, Wald, Watertight Ray/Triangle Intersection (2013).
class MeshRay {
public:
    MeshRay(const Mesh& mesh, const LocalRay& ray) : mesh_(mesh), ray_(ray)
    {
        ray.along.cwiseAbs().maxCoeff(&forward_);
        across_ = (forward_ + 1) % 3;
        up_ = (forward_ + 2) % 3;
        shear_ = Vec3(ray.along[across_], ray.along[up_], 1) / ray.along[forward_];
    }

    // Where the line meets a triangle, from the ray's start on; infinite where it does not.
    double hit_at(std::uint32_t triangle) const
    {
        const Vec3 a = sheared(triangle, 0), b = sheared(triangle, 1), c = sheared(triangle, 2);
        const double u = c.x() * b.y() - c.y() * b.x();
        const double v = a.x() * c.y() - a.y() * c.x();
        const double w = b.x() * a.y() - b.y() * a.x();
        const double sum = u + v + w;
        if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return kInfinity;
        if (sum == 0) return kInfinity;
        return (u / sum) * a.z() + (v / sum) * b.z() + (w / sum) * c.z();
    }

    // Where the line enters a node's box, or infinite; never later than it meets a triangle within.
    double enter(const Mesh::Node& node) const
    {
        constexpr double kWiden = 8 * std::numeric_limits<double>::epsilon();
        double first = -kInfinity, last = kInfinity;
        for (int axis = 0; axis < 3; ++axis) {
            const double along = ray_.along[axis];
            double low = node.lower[axis] - ray_.from[axis];
            double high = node.upper[axis] - ray_.from[axis];
            if (along == 0) {
                if (low > 0 || high < 0) return kInfinity;
                continue;
            }
            if (along < 0) std::swap(low, high);
            low /= along;
            high /= along;
            first = std::max(first, low - std::abs(low) * kWiden);
            last = std::min(last, high + std::abs(high) * kWiden);
        }
        return first <= last && last >= 0 ? first : kInfinity;
    }

private:
    Vec3 sheared(std::uint32_t triangle, std::size_t corner) const
    {
        const Vec3 to = mesh_.vertices[mesh_.triangles[triangle][corner]] - ray_.from;
        const double forward = to[forward_];
        return {to[across_] - shear_.x() * forward, to[up_] - shear_.y() * forward,
                shear_.z() * forward};
    }

    const Mesh& mesh_;
    const LocalRay& ray_;
    int forward_ = 0, across_ = 1, up_ = 2;
    Vec3 shear_;
};

struct Nearest {
    double distance;
    std::uint32_t triangle;
};

// Down the tree, the nearer child first.
Nearest nearest_triangle(const Mesh& mesh, const LocalRay& ray, double earliest)
{
    struct OpenNode {
        std::uint32_t node;
        double enter;
    };
    const MeshRay mesh_ray(mesh, ray);
    std::array<OpenNode, kMostWaiting> waiting;
    std::size_t count = 0;
    waiting[count++] = {0, mesh_ray.enter(mesh.tree.front())};
    Nearest nearest{kInfinity, 0};
    while (count > 0) {
        const OpenNode visit = waiting[--count];
        if (!(visit.enter <= std::min(nearest.distance, ray.longest)) || visit.enter == kInfinity)
            continue;
        const Mesh::Node& node = mesh.tree[visit.node];
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
            const std::uint32_t triangle = mesh.order[i];
            const double at = mesh_ray.hit_at(triangle);
            if (!(at >= earliest && at <= ray.longest)) continue;
            if (at < nearest.distance || (at == nearest.distance && triangle < nearest.triangle))
                nearest = {at, triangle};
        }
        if (node.count > 0) continue;
        OpenNode near{node.first, mesh_ray.enter(mesh.tree[node.first])};
        OpenNode far{node.first + 1, mesh_ray.enter(mesh.tree[node.first + 1])};
        if (far.enter < near.enter) std::swap(near, far);
        waiting[count++] = far;
        waiting[count++] = near;
    }
    return nearest;
}

LocalRayHit cast_at_mesh(const Mesh& mesh, const LocalRay& ray)
{
    if (mesh.tree.empty()) return {};
    // A ray from far away sets out again close by, where its numbers have digits to spare.
    const Mesh::Node& root = mesh.tree.front();
    const double enter = MeshRay(mesh, ray).enter(root);
    if (!(enter <= ray.longest) || enter == kInfinity) return {};
    const double skipped = std::max(0.0, enter - (root.upper - root.lower).norm());
    const LocalRay near{ray.from + ray.along * skipped, ray.along, ray.longest - skipped};
    const Nearest nearest = nearest_triangle(mesh, near, skipped > 0 ? -skipped : 0.0);
    if (nearest.distance == kInfinity) return {};
    const Vec3& normal = mesh.normals[nearest.triangle];
    return {skipped + nearest.distance, normal.dot(ray.along) > 0 ? Vec3(-normal) : normal};
}

}  // namespace

LocalRayHit cast_ray(const Shapes& shapes, ShapeRef shape, const LocalRay& ray)
{
    const std::size_t i = shape.index;
    switch (shape.kind) {
    case ShapeKind::mesh:
        return cast_at_mesh(shapes.meshes[i], ray);
    case ShapeKind::solid:
        if (signed_distance(shapes.solids[i].mesh, ray.from) <= 0) return {0, -ray.along};
        return cast_at_mesh(shapes.solids[i].mesh, ray);
    case ShapeKind::triangle:
        return {};
    default:
        return first_of(pass_through(shapes, shape, ray), ray);
    }
}

}  // namespace throng
