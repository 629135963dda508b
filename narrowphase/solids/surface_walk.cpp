#include "narrowphase/solids/surface_walk.hpp"

#include "kernels/geometry/mesh.hpp"
#include "kernels/geometry/mesh_distance.hpp"

#include <algorithm>
#include <cmath>

namespace throng {
namespace {

// Trilinear values are means of the corners' of a cell: this many voxels from the place at most.
constexpr double kSlack = 0.87;

Box3 surface_box(const Solid& solid)
{
    if (!solid.mesh.tree.empty()) return {solid.mesh.tree[0].lower, solid.mesh.tree[0].upper};
    const VoxelBricks& bricks = solid.field;
    const double side = VoxelBricks::kCells * bricks.voxel;
    const Vec3 size = side * Vec3(bricks.bricks[0], bricks.bricks[1], bricks.bricks[2]);
    return {bricks.origin, bricks.origin + size};
}

void put(LeafSample& leaf, std::size_t i, double distance, const Vec3& gradient)
{
    leaf.distance[i] = distance;
    leaf.gx[i] = gradient.x();
    leaf.gy[i] = gradient.y();
    leaf.gz[i] = gradient.z();
}

Vec3 place_of(const LeafSample& leaf, std::size_t i) { return {leaf.x[i], leaf.y[i], leaf.z[i]}; }

// Static meshes keep no normals of their corners: the sum of those of the triangles there.
Vec3 front_at(const Mesh& mesh, const MeshPoint& where)
{
    if (where.region < TriangleRegion::vertex0 || !mesh.vertex_normals.empty())
        return outward_at(mesh, where);
    const auto corner =
        static_cast<std::size_t>(where.region) - static_cast<std::size_t>(TriangleRegion::vertex0);
    const std::uint32_t vertex = mesh.triangles[where.triangle][corner];
    Vec3 sum = Vec3::Zero();
    visit_triangles(mesh, {mesh.vertices[vertex], mesh.vertices[vertex]}, [&](std::uint32_t t) {
        const auto& [v0, v1, v2] = mesh.triangles[t];
        if (v0 == vertex || v1 == vertex || v2 == vertex) sum += mesh.normals[t];
    });
    return sum.squaredNorm() > 1e-12 ? Vec3(sum.normalized()) : mesh.normals[where.triangle];
}

SurfaceDistance to_front(const Mesh& mesh, const MeshPoint& nearest, const Vec3& place)
{
    const Vec3 front = front_at(mesh, nearest);
    const Vec3 away = place - nearest.point;
    const double sign = front.dot(away) < 0 ? -1 : 1;
    // On a face, or so near that rounding says where from, the face says the way.
    const bool flat = nearest.region == TriangleRegion::face;
    if (flat || !(nearest.distance > 1e-12 * place.cwiseAbs().maxCoeff()))
        return {sign * nearest.distance, front};
    return {sign * nearest.distance, away * (sign / nearest.distance)};
}

}  // namespace

FieldSide::FieldSide(const Solid& solid) : bricks_(solid.field), box_(surface_box(solid)) { }

double FieldSide::at_least(const Vec3& place) const
{
    const FieldSample<double> here = sample_bricks<double>(bricks_, place);
    const double outside = (place - place.cwiseMax(box_.lower).cwiseMin(box_.upper)).norm();
    const double told =
        here.distance < bricks_.band ? here.distance - kSlack * bricks_.voxel : bricks_.band;
    return std::max(outside, told);
}

// One by one; a wide kernel may take the leaf as it is.
void FieldSide::sample(LeafSample& leaf) const
{
    for (std::size_t i = 0; i < leaf.count; ++i) {
        const auto here = sample_bricks<double>(bricks_, place_of(leaf, i));
        put(leaf, i, here.distance, here.gradient);
    }
}

void ConvexSide::sample(LeafSample& leaf) const
{
    for (std::size_t i = 0; i < leaf.count; ++i) {
        const SurfaceDistance here = distance_to(shapes_, shape_, place_of(leaf, i));
        put(leaf, i, here.distance, here.outward);
    }
}

double MeshSide::at_least(const Vec3& place) const
{
    // Behind as in front: a ball this far from all triangles has no touch in it.
    return nearest_on_mesh(mesh_, place).distance - std::max(deepest_ - reach_, 0.0);
}

void MeshSide::sample(LeafSample& leaf) const
{
    for (std::size_t i = 0; i < leaf.count; ++i) {
        const Vec3 place = place_of(leaf, i);
        const MeshPoint nearest = nearest_on_mesh(mesh_, place, std::max(reach_, deepest_));
        SurfaceDistance here{std::numeric_limits<double>::infinity(), Vec3::Zero()};
        if (nearest.distance <= std::max(reach_, deepest_)) here = to_front(mesh_, nearest, place);
        if (here.distance < -deepest_) here.distance = std::numeric_limits<double>::infinity();
        put(leaf, i, here.distance, here.outward);
    }
}

namespace {

// Moves the points of a leaf into the other's frame, and back what is told of them.
template <class Other>
class Walk {
public:
    Walk(const SurfacePoints& points,
         const Other& other,
         const Pose& pose,
         double reach,
         std::vector<PointTouch>& out)
        : points_(points), other_(other), turn_(pose.orientation.toRotationMatrix()),
          position_(pose.position), reach_(reach), out_(out)
    { }

    void run()
    {
        if (points_.nodes.empty()) return;
        // A child holds at most half of its parent's leaves, rounded up: 2^32 points are 32 levels.
        std::array<std::uint32_t, 64> waiting;
        std::size_t count = 0;
        waiting[count++] = 0;
        while (count > 0) {
            const SurfacePoints::Node& node = points_.nodes[waiting[--count]];
            const Vec3 center = node.center.template cast<double>();
            if (!(other_.at_least(seen(center)) <= reach_ + double{node.radius})) continue;
            if (node.count > 0) {
                visit_leaf(node);
                continue;
            }
            waiting[count++] = node.first + 1;
            waiting[count++] = node.first;
        }
    }

private:
    Vec3 seen(const Vec3& place) const { return turn_.transpose() * (place - position_); }
    Vec3 point_at(std::size_t i) const
    {
        return Vec3T<float>(points_.x[i], points_.y[i], points_.z[i]).template cast<double>();
    }

    void visit_leaf(const SurfacePoints::Node& node)
    {
        LeafSample leaf;
        leaf.count = node.count;
        for (std::size_t i = 0; i < leaf.count; ++i) {
            const Vec3 place = seen(point_at(node.first + i));
            leaf.x[i] = place.x();
            leaf.y[i] = place.y();
            leaf.z[i] = place.z();
        }
        other_.sample(leaf);
        for (std::size_t i = 0; i < leaf.count; ++i) {
            if (!(leaf.distance[i] <= reach_) || !(leaf.distance[i] < other_.furthest())) continue;
            take(node.first + static_cast<std::uint32_t>(i), leaf.distance[i],
                 {leaf.gx[i], leaf.gy[i], leaf.gz[i]});
        }
    }

    void take(std::uint32_t point, double distance, const Vec3& gradient)
    {
        const Vec3 normal = points_.normals[point].template cast<double>();
        const double steep = gradient.norm();
        Vec3 outward = -normal;
        if (steep >= kNoGradient) {
            outward = turn_ * gradient / steep;
            if (!(-normal.dot(outward) >= double{points_.cones[point]})) return;
        }
        out_.push_back({point, point_at(point), outward, distance});
    }

    const SurfacePoints& points_;
    const Other& other_;
    Mat3 turn_;
    Vec3 position_;
    double reach_;
    std::vector<PointTouch>& out_;
};

}  // namespace

template <class Other>
void walk_surface(const SurfacePoints& points,
                  const Other& other,
                  const Pose& pose,
                  double reach,
                  std::vector<PointTouch>& out)
{
    Walk<Other>(points, other, pose, reach, out).run();
}

#define THRONG_INSTANTIATE(Other)                                                                  \
    template void walk_surface<Other>(const SurfacePoints&, const Other&, const Pose&, double,     \
                                      std::vector<PointTouch>&);
THRONG_INSTANTIATE(FieldSide)
THRONG_INSTANTIATE(ConvexSide)
THRONG_INSTANTIATE(MeshSide)
#undef THRONG_INSTANTIATE

}  // namespace throng
