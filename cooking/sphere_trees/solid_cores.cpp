#include "cooking/sphere_trees/solid_cores.hpp"

#include "kernels/geometry/mesh.hpp"
#include "kernels/geometry/mesh_distance.hpp"

#include <algorithm>
#include <limits>

namespace throng {
namespace {

constexpr std::size_t kMost = 16;
constexpr std::size_t kGrown = 512;    // balls, of which those are chosen
constexpr double kThinnest = 1.0 / 3;  // of the smallest half extent
constexpr int kShrinks = 16;           // most balls are within after five
constexpr double kTouching = 1e-3;     // of the radius, by which a ball may stick out

// The greatest ball that touches the surface at a point from within, as told by what is nearest to
// the middle of one that is too great.
SolidCore grown_at(const Mesh& mesh, const Vec3& point, const Vec3& outward, double greatest)
{
    double radius = greatest;
    for (int i = 0; i < kShrinks; ++i) {
        const Vec3 center = point - radius * outward;
        const MeshPoint near = nearest_on_mesh(mesh, center);
        if (near.distance >= (1 - kTouching) * radius) break;
        const Vec3 way = near.point - point;
        const double deep = -2 * outward.dot(way);
        if (!(deep > 0)) return {center, 0};
        radius = std::min(way.squaredNorm() / deep, radius);
    }
    const Vec3 center = point - radius * outward;
    return {center, std::min(radius, nearest_on_mesh(mesh, center).distance)};
}

}  // namespace

std::vector<SolidCore> build_solid_cores(const Mesh& mesh, const SurfacePoints& points)
{
    std::vector<SolidCore> grown, cores;
    if (mesh.tree.empty()) return cores;
    const Box3 box = box_of(mesh);
    const double half = 0.5 * (box.upper - box.lower).minCoeff();
    const std::size_t stride = points.size() / kGrown + 1;
    for (std::size_t i = 0; i < points.size(); i += stride) {
        const Vec3 point(points.x[i], points.y[i], points.z[i]);
        const SolidCore core = grown_at(mesh, point, points.normals[i].cast<double>(), half);
        const bool inside = core.radius > 0 && signed_distance(mesh, core.center) < 0;
        if (inside && core.radius >= kThinnest * half) grown.push_back(core);
    }
    if (grown.empty()) return cores;
    const auto thinner = [](const SolidCore& a, const SolidCore& b) { return a.radius < b.radius; };
    cores.push_back(*std::max_element(grown.begin(), grown.end(), thinner));
    std::vector<double> outside(grown.size(), std::numeric_limits<double>::infinity());
    while (cores.size() < kMost) {
        for (std::size_t i = 0; i < grown.size(); ++i)
            outside[i] = std::min(
                outside[i], (grown[i].center - cores.back().center).norm() - cores.back().radius);
        const auto furthest = std::max_element(outside.begin(), outside.end());
        if (!(*furthest > 0)) break;
        cores.push_back(grown[static_cast<std::size_t>(furthest - outside.begin())]);
    }
    return cores;
}

}  // namespace throng
