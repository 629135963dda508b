#include "cooking/sphere_trees/mesh_cells.hpp"

#include "kernels/geometry/mesh.hpp"
#include "kernels/geometry/mesh_distance.hpp"

#include <algorithm>
#include <cmath>

namespace throng {
namespace {

// Cells along the longest side.
constexpr double kAcross = 24;

// Of distances, more than rounding takes from them.
constexpr double kSlack = 1 + 1e-9;

constexpr double kUnknown = std::numeric_limits<double>::infinity();

}  // namespace

MeshCells::MeshCells(const Mesh& mesh)
    : mesh_(mesh), box_(box_of(mesh)), side_(longest_side(mesh) / kAcross)
{
    const Vec3 size = box_.upper - box_.lower;
    for (std::size_t k = 0; k < 3; ++k) {
        const double along = std::ceil(size[static_cast<Eigen::Index>(k)] / side_);
        count_[k] = std::max<std::size_t>(1, static_cast<std::size_t>(along));
    }
    depths_.assign(count_[0] * count_[1] * count_[2], kUnknown);
}

double MeshCells::depth_bound(const Vec3& place)
{
    // Beyond the bounds all is outside.
    if (!box_.overlaps({place, place})) return 0;
    std::size_t at = 0;
    Vec3 middle;
    for (std::size_t k = 3; k-- > 0;) {
        const auto axis = static_cast<Eigen::Index>(k);
        const auto steps = static_cast<std::size_t>((place[axis] - box_.lower[axis]) / side_);
        const std::size_t i = std::min(steps, count_[k] - 1);
        middle[axis] = box_.lower[axis] + (static_cast<double>(i) + 0.5) * side_;
        at = at * count_[k] + i;
    }
    double& depth = depths_[at];
    if (depth == kUnknown) depth = -signed_distance(mesh_, middle);
    return depth + (place - middle).norm() * kSlack;
}

}  // namespace throng
