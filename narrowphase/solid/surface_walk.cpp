#include "narrowphase/solid/surface_walk.hpp"

#include "kernels/geometry/mesh.hpp"
#include "kernels/geometry/mesh_distance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace throng {
namespace {

// Trilinear values are means of the corners' of a cell: this many voxels from the place at most.
constexpr double kSlack = 0.87;
// What is further away than asked for is told as this much of it.
constexpr double kMore = 1 + 1e-12;

Box3 surface_box(const Solid& solid)
{
    if (!solid.mesh.tree.empty()) return {solid.mesh.tree[0].lower, solid.mesh.tree[0].upper};
    const VoxelBricks& bricks = solid.field;
    const double side = VoxelBricks::kCells * bricks.voxel;
    const Vec3 size = side * Vec3(bricks.bricks[0], bricks.bricks[1], bricks.bricks[2]);
    return {bricks.origin, bricks.origin + size};
}

void put(LeafSample<double>& leaf, std::size_t i, double distance, const Vec3& gradient)
{
    leaf.distance[i] = distance;
    leaf.gx[i] = gradient.x();
    leaf.gy[i] = gradient.y();
    leaf.gz[i] = gradient.z();
}

Vec3 place_of(const LeafSample<double>& leaf, std::size_t i)
{
    return {leaf.x[i], leaf.y[i], leaf.z[i]};
}

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

// Whether a triangle ends here without another beyond.
bool is_on_rim(const Mesh& mesh, const MeshPoint& where)
{
    if (where.region == TriangleRegion::face) return false;
    const auto [first, last] = edges_at(where.region);
    const auto& adjacent = mesh.adjacent[where.triangle];
    return adjacent[first] < 0 || adjacent[last] < 0;
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

FieldSide::FieldSide(const Solid& solid)
    : bricks_(solid.field), furthest_(static_cast<float>(solid.field.band)),
      box_(surface_box(solid))
{ }

void FieldSide::bound(LeafSample<float>& places) const
{
    sample(places);
    const Vec3T<float> lower = box_.lower.cast<float>(), upper = box_.upper.cast<float>();
    const float slack = static_cast<float>(kSlack * bricks_.voxel), furthest = furthest_;
    for (std::size_t i = 0; i < LeafSample<float>::kPoints; ++i) {
        const float x = std::max({lower.x() - places.x[i], places.x[i] - upper.x(), 0.0F});
        const float y = std::max({lower.y() - places.y[i], places.y[i] - upper.y(), 0.0F});
        const float z = std::max({lower.z() - places.z[i], places.z[i] - upper.z(), 0.0F});
        const float here = places.distance[i];
        const float told = here < furthest ? here - slack : furthest;
        const float outside = std::sqrt(x * x + y * y + z * z);
        places.distance[i] = outside > told ? outside : told;
    }
}

void FieldSide::sample(LeafSample<float>& leaf) const
{
    const auto in = [&](const float* all) { return std::span<const float>(all, leaf.count); };
    const auto out = [&](float* all) { return std::span<float>(all, leaf.count); };
    sample_many(bricks_,
                {in(leaf.x), in(leaf.y), in(leaf.z), out(leaf.distance), out(leaf.gx), out(leaf.gy),
                 out(leaf.gz)});
}

void ConvexSide::bound(LeafSample<double>& places) const
{
    for (std::size_t i = 0; i < places.count; ++i)
        places.distance[i] = distance_to(shapes_, shape_, place_of(places, i)).distance;
}

void ConvexSide::sample(LeafSample<double>& leaf) const
{
    for (std::size_t i = 0; i < leaf.count; ++i) {
        const SurfaceDistance here = distance_to(shapes_, shape_, place_of(leaf, i));
        put(leaf, i, here.distance, here.outward);
    }
}

void MeshSide::bound(LeafSample<double>& places) const
{
    // Behind as in front: a ball this far from all triangles has no touch in it.
    const double behind = std::max(limits_.deepest_before - limits_.speculative_margin, 0.0);
    for (std::size_t i = 0; i < places.count; ++i) {
        const double asked = places.within[i] + behind;
        const bool near = comes_within(mesh_, place_of(places, i), asked);
        places.distance[i] = near ? -behind : kMore * places.within[i];
    }
}

void MeshSide::sample(LeafSample<double>& leaf) const
{
    const double furthest = std::max(limits_.speculative_margin, limits_.deepest_before);
    // Of what does not touch here: it may once the two have moved.
    const double apart = kMore * limits_.speculative_margin + std::numeric_limits<double>::min();
    std::uint32_t beside = kNoTriangle;  // points of a leaf are neighbors
    for (std::size_t i = 0; i < leaf.count; ++i) {
        const Vec3 place = place_of(leaf, i);
        const MeshPoint nearest = nearest_on_mesh(mesh_, place, furthest, beside);
        SurfaceDistance here{std::max(apart, furthest), Vec3::Zero()};
        if (nearest.distance <= furthest) {
            here = to_front(mesh_, nearest, place);
            beside = nearest.triangle;
        }
        if (here.distance < 0 && !touches(here.distance, nearest)) here.distance = apart;
        put(leaf, i, here.distance, here.outward);
    }
}

// Of what is behind.
bool MeshSide::touches(double distance, const MeshPoint& nearest) const
{
    if (distance < -limits_.past_rim && is_on_rim(mesh_, nearest)) return false;
    const Vec3& front = mesh_.normals[nearest.triangle];
    if (!(front.dot(limits_.middle - nearest.point) > 0)) return distance >= -limits_.deepest;
    pressed_in_ = pressed_in_ || distance < -0.5 * limits_.deepest;
    return distance >= -limits_.deepest_before;
}

namespace {

// Moves the points of a leaf into the other's frame, and back what is told of them.
template <class Other>
class Walk {
    using Real = typename Other::Real;
    using Places = LeafSample<Real>;

    struct Leaf {
        std::uint32_t first, count;
    };

public:
    Walk(const SurfacePoints& points,
         const Other& other,
         const Pose& pose,
         double speculative_margin,
         std::vector<PointCandidate>& out)
        : points_(points), other_(other), turn_(pose.orientation.toRotationMatrix()),
          back_(turn_.transpose().template cast<Real>()),
          shift_((turn_.transpose() * -pose.position).template cast<Real>()),
          speculative_margin_(static_cast<Real>(speculative_margin)), out_(out)
    { }

    double run()
    {
        if (points_.nodes.empty()) return double{least_};
        thread_local std::vector<std::uint32_t> level, next;
        thread_local std::vector<Leaf> leaves;
        level.assign(1, 0);
        leaves.clear();
        // A child holds at most half of its parent's leaves, rounded up: 2^32 points are 32 levels.
        while (!level.empty()) {
            next.clear();
            for (std::size_t first = 0; first < level.size(); first += Places::kPoints)
                visit_nodes(std::span(level).subspan(first), next, leaves);
            level.swap(next);
        }
        // Leaves may lie on two levels.
        std::sort(leaves.begin(), leaves.end(),
                  [](const Leaf& a, const Leaf& b) { return a.first < b.first; });
        visit_leaves(leaves);
        return double{least_};
    }

private:
    Vec3 point_at(std::size_t i) const
    {
        return Vec3T<float>(points_.x[i], points_.y[i], points_.z[i]).template cast<double>();
    }

    // Into the other's frame; all places, whether held or not, as that needs no tail.
    void move(Places& places) const
    {
        for (std::size_t i = 0; i < Places::kPoints; ++i) {
            const Real x = places.x[i], y = places.y[i], z = places.z[i];
            places.x[i] = back_(0, 0) * x + back_(0, 1) * y + back_(0, 2) * z + shift_[0];
            places.y[i] = back_(1, 0) * x + back_(1, 1) * y + back_(1, 2) * z + shift_[1];
            places.z[i] = back_(2, 0) * x + back_(2, 1) * y + back_(2, 2) * z + shift_[2];
        }
    }

    // The first of the nodes, as many as are looked at together. Leaves go by their first points.
    void visit_nodes(std::span<const std::uint32_t> nodes,
                     std::vector<std::uint32_t>& next,
                     std::vector<Leaf>& leaves)
    {
        Places places{};
        places.count = std::min(nodes.size(), Places::kPoints);
        for (std::size_t i = 0; i < places.count; ++i) {
            const SurfacePoints::Node& node = points_.nodes[nodes[i]];
            places.within[i] = speculative_margin_ + Real{node.radius};
            places.x[i] = Real{node.center.x()};
            places.y[i] = Real{node.center.y()};
            places.z[i] = Real{node.center.z()};
        }
        move(places);
        other_.bound(places);
        for (std::size_t i = 0; i < places.count; ++i) {
            const SurfacePoints::Node& node = points_.nodes[nodes[i]];
            if (!(places.distance[i] <= places.within[i])) {
                least_ = std::min(least_, places.distance[i] - Real{node.radius});
            } else if (node.count > 0) {
                leaves.push_back({node.first, node.count});
            } else {
                next.push_back(node.first);
                next.push_back(node.first + 1);
            }
        }
    }

    // Points of any number of leaves side by side.
    void visit_leaves(const std::vector<Leaf>& leaves)
    {
        Places places{};
        std::uint32_t of[Places::kPoints];
        for (const Leaf& leaf : leaves)
            for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
                places.x[places.count] = Real{points_.x[i]};
                places.y[places.count] = Real{points_.y[i]};
                places.z[places.count] = Real{points_.z[i]};
                of[places.count++] = i;
                if (places.count == Places::kPoints) take_near(places, of);
            }
        take_near(places, of);
    }

    void take_near(Places& places, const std::uint32_t* of)
    {
        if (places.count == 0) return;
        move(places);
        other_.sample(places);
        for (std::size_t i = 0; i < places.count; ++i) {
            const Real distance = places.distance[i];
            least_ = std::min(least_, distance);
            if (distance <= speculative_margin_ && distance < other_.furthest())
                take(of[i], double{distance},
                     {double{places.gx[i]}, double{places.gy[i]}, double{places.gz[i]}});
        }
        places.count = 0;
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
    Mat3T<Real> back_;
    Vec3T<Real> shift_;
    Real speculative_margin_;
    Real least_ = std::numeric_limits<Real>::infinity();
    std::vector<PointCandidate>& out_;
};

}  // namespace

template <class Other>
double walk_surface(const SurfacePoints& points,
                    const Other& other,
                    const Pose& pose,
                    double speculative_margin,
                    std::vector<PointCandidate>& out)
{
    return Walk<Other>(points, other, pose, speculative_margin, out).run();
}

#define THRONG_INSTANTIATE(Other)                                                                  \
    template double walk_surface<Other>(const SurfacePoints&, const Other&, const Pose&, double,   \
                                        std::vector<PointCandidate>&);
THRONG_INSTANTIATE(FieldSide)
THRONG_INSTANTIATE(ConvexSide)
THRONG_INSTANTIATE(MeshSide)
#undef THRONG_INSTANTIATE

}  // namespace throng
