// Mesh pairs: a convex shape against the triangles of a mesh that are near it.
//
// A cylinder is seen as a prism of sixteen sides that keeps one of its edges turned to the
// triangle: what lies flat, stands or rolls is exact, and only an edge of the mesh under the curved
// side sees the prism's sides, two hundredths of the radius inside the cylinder.
#include "narrowphase/mesh/mesh_pairs.hpp"

#include "kernels/check.hpp"
#include "kernels/geometry/closest_points.hpp"
#include "kernels/geometry/mesh.hpp"
#include "kernels/geometry/shape_bounds.hpp"
#include "narrowphase/mesh/concave_edges.hpp"
#include "narrowphase/mesh/mesh_sides.hpp"
#include "narrowphase/mesh/near_triangles.hpp"
#include "narrowphase/mesh/triangle_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace throng {
namespace {

constexpr std::size_t kSides = 16;

// Corners this part of the inner radius above the lowest are as low.
constexpr double kAsLow = 1e-3;

// Sine to within which a cylinder is upright: it keeps the rim's depth to 2e-4 of the radius.
constexpr double kUpright = 0.01;

// What is left out beforehand is so by more than this share of its reach: rounding.
constexpr double kRounding = 1e-9;

double length(double x, double y) { return std::sqrt(x * x + y * y); }

// Of the way round a cylinder, as cosine and sine, where it is turned to a direction in its frame.
// Standing upright that would be noise: it stays with the body then.
Eigen::Vector2d way_round(const Vec3& towards)
{
    const double across = length(towards.x(), towards.y());
    if (across < kUpright) return {1, 0};
    return {towards.x() / across, towards.y() / across};
}

// Cosine and sine of the angles of a circle cut in 2 * kSides, by halving and adding angles.
std::array<Eigen::Vector2d, 2 * kSides> circle()
{
    const double cos8 = std::sqrt((1 + std::sqrt(0.5)) / 2), cos16 = std::sqrt((1 + cos8) / 2);
    const double sin16 = std::sqrt((1 - cos8) / 2);
    std::array<Eigen::Vector2d, 2 * kSides> points;
    points[0] = {1, 0};
    for (std::size_t i = 1; i < 2 * kSides; ++i) {
        const Eigen::Vector2d& last = points[i - 1];
        points[i] = {last.x() * cos16 - last.y() * sin16, last.x() * sin16 + last.y() * cos16};
    }
    return points;
}

// Sides 0-15, then the cap below and the cap above; vertices 0-15 below and 16-31 above.
struct PrismTopology {
    std::array<std::uint32_t, kSides + 3> face_begin{};
    std::array<std::uint16_t, 6 * kSides> face_vertices{};
    std::array<Hull::Edge, 3 * kSides> edges{};

    PrismTopology()
    {
        std::size_t at = 0;
        for (std::size_t i = 0; i < kSides; ++i) {
            const std::size_t next = (i + 1) % kSides;
            face_begin[i] = static_cast<std::uint32_t>(at);
            for (const std::size_t corner : {i, next, next + kSides, i + kSides}) {
                face_vertices[at++] = static_cast<std::uint16_t>(corner);
            }
            edges[3 * i] = edge(i, next, i, kSides);
            edges[3 * i + 1] = edge(next + kSides, i + kSides, i, kSides + 1);
            edges[3 * i + 2] = edge(next, next + kSides, i, next);
        }
        for (std::size_t cap = 0; cap < 2; ++cap) {
            face_begin[kSides + cap] = static_cast<std::uint32_t>(at);
            for (std::size_t i = 0; i < kSides; ++i) {
                const std::size_t corner = cap == 0 ? kSides - 1 - i : kSides + i;
                face_vertices[at++] = static_cast<std::uint16_t>(corner);
            }
        }
        face_begin[kSides + 2] = static_cast<std::uint32_t>(at);
    }

private:
    static Hull::Edge edge(std::size_t from, std::size_t to, std::size_t left, std::size_t right)
    {
        return {static_cast<std::uint16_t>(from), static_cast<std::uint16_t>(to),
                static_cast<std::uint16_t>(left), static_cast<std::uint16_t>(right)};
    }
};

struct Prism {
    std::array<Vec3, 2 * kSides> vertices;
    std::array<Vec3, kSides + 2> normals;
    std::array<double, kSides + 2> offsets;
    double inner_radius, outer_radius;

    // `towards` is a direction in the cylinder's frame that an edge of the prism is to look to.
    Prism(const Cylinder& cylinder, const Vec3& towards)
        : inner_radius(std::min(cylinder.radius, cylinder.half_length) * 0.98),
          outer_radius(length(cylinder.radius, cylinder.half_length))
    {
        static const std::array<Eigen::Vector2d, 2 * kSides> points = circle();
        const Eigen::Vector2d way = way_round(towards);
        const double c = way.x(), s = way.y();
        for (std::size_t i = 0; i < kSides; ++i) {
            const auto turned = [&](const Eigen::Vector2d& p) {
                return Vec3(c * p.x() - s * p.y(), s * p.x() + c * p.y(), 0);
            };
            const Vec3 corner = cylinder.radius * turned(points[2 * i]);
            vertices[i] = corner - Vec3(0, 0, cylinder.half_length);
            vertices[kSides + i] = corner + Vec3(0, 0, cylinder.half_length);
            normals[i] = turned(points[2 * i + 1]);
            offsets[i] = cylinder.radius * points[1].x();
        }
        normals[kSides] = -Vec3::UnitZ();
        normals[kSides + 1] = Vec3::UnitZ();
        offsets[kSides] = offsets[kSides + 1] = cylinder.half_length;
    }
    PolytopeView view() const
    {
        static const PrismTopology topology;
        return {vertices,       normals, offsets, topology.face_begin, topology.face_vertices,
                topology.edges, {},      {},      Vec3::Zero(),        inner_radius,
                outer_radius,   nullptr, true};
    }
};

// A convex shape as it is held against one triangle after another.
class Guest {
public:
    // center: what its side of a triangle is told by, in the mesh's frame.
    Guest(const PairInput<double>& in, const Vec3& center)
        : shapes_(in.shapes), shape_(in.b), pose_(in.b_in_a), margin_(in.speculative_margin),
          center_(center), to_own_(pose_.orientation.toRotationMatrix().transpose())
    {
        switch (shape_.kind) {
        case ShapeKind::sphere:
            radius_ = shapes_.spheres[shape_.index].radius;
            extents_ = Vec3::Constant(radius_);
            break;
        case ShapeKind::capsule:
            radius_ = shapes_.capsules[shape_.index].radius;
            half_length_ = shapes_.capsules[shape_.index].half_length;
            extents_ = {radius_, radius_, radius_ + half_length_};
            break;
        case ShapeKind::cylinder:
            radius_ = shapes_.cylinders[shape_.index].radius;
            half_length_ = shapes_.cylinders[shape_.index].half_length;
            extents_ = {radius_, radius_, half_length_};
            break;
        case ShapeKind::box:
            extents_ = shapes_.boxes[shape_.index].half_extents;
            polytope_.emplace(shapes_, shape_);
            break;
        case ShapeKind::hull:
            extents_ = Vec3::Constant(shapes_.hulls[shape_.index].outer_radius);
            polytope_.emplace(shapes_, shape_);
            break;
        default:
            THRONG_CHECK(false, "a mesh collides with convex shapes of some volume");
        }
    }

    // Where it touches, or soon will.
    void collide(const MeshTriangle& triangle, bool through, LocalManifold<double>& out) const
    {
        out.count = 0;
        // Nothing pushes from behind.
        if (!through && triangle.height(center_) < 0) return;
        if (through || !is_beside(triangle)) touch(triangle, through, out);
        if (out.count == 0 && !through) meet_ahead(triangle, out);
    }

private:
    bool is_too_far(double distance, double extent) const
    {
        return distance - extent > margin_ + kRounding * extent;
    }

    // The corners of a triangle in its own axes, from its center.
    using SeenCorners = std::array<Vec3, 3>;

    // Whether it is plain to see that the triangle is out of reach: by the box about its axes, by
    // the plane across the way to the nearest point, by a face of a hull.
    bool is_beside(const MeshTriangle& triangle) const
    {
        SeenCorners seen;
        for (std::size_t k = 0; k < 3; ++k) seen[k] = to_own_ * (triangle.corners[k] - center_);
        const Vec3 least = seen[0].cwiseMin(seen[1]).cwiseMin(seen[2]);
        const Vec3 most = seen[0].cwiseMax(seen[1]).cwiseMax(seen[2]);
        const Vec3 apart = least.cwiseMax(-most);
        for (int axis = 0; axis < 3; ++axis)
            if (is_too_far(apart[axis], extents_[axis])) return true;
        // Of others little is left, or it is found out soon.
        if (shape_.kind != ShapeKind::cylinder && shape_.kind != ShapeKind::hull) return false;
        const Vec3 nearest =
            closest_on_triangle<double>(Vec3::Zero(), seen[0], seen[1], seen[2]).point;
        return is_parted_along(nearest, seen)
            || (shape_.kind == ShapeKind::hull && is_beyond_face(seen));
    }

    bool is_parted_along(const Vec3& way, const SeenCorners& seen) const
    {
        const Vec3 direction = way.normalized();
        const double least =
            std::min({direction.dot(seen[0]), direction.dot(seen[1]), direction.dot(seen[2])});
        return is_too_far(least, extent_along(direction));
    }

    // How far a cylinder or a hull reaches from its center, m.
    double extent_along(const Vec3& direction) const
    {
        if (shape_.kind == ShapeKind::cylinder)
            return radius_ * length(direction.x(), direction.y())
                + half_length_ * std::abs(direction.z());
        const Hull& hull = shapes_.hulls[shape_.index];
        double most = 0;
        for (const Vec3& vertex : hull.vertices)
            most = std::max(most, direction.dot(vertex - hull.center));
        return most;
    }

    bool is_beyond_face(const SeenCorners& seen) const
    {
        const Hull& hull = shapes_.hulls[shape_.index];
        for (std::size_t i = 0; i < hull.normals.size(); ++i) {
            const Vec3& normal = hull.normals[i];
            const double least =
                std::min({normal.dot(seen[0]), normal.dot(seen[1]), normal.dot(seen[2])});
            if (is_too_far(least, hull.offsets[i] - normal.dot(hull.center))) return true;
        }
        return false;
    }

    void touch(const MeshTriangle& triangle, bool through, LocalManifold<double>& out) const
    {
        switch (shape_.kind) {
        case ShapeKind::sphere:
            collide_triangle_ball(triangle, pose_.position, radius_, margin_, out, through);
            return;
        case ShapeKind::capsule:
            collide_triangle_capsule(triangle, end(-1), end(1), radius_, margin_, out, through);
            return;
        case ShapeKind::cylinder: {
            const Prism prism(shapes_.cylinders[shape_.index], to_own_ * -triangle.normal);
            collide_triangle_polytope(triangle, prism.view(), pose_, margin_, out, through);
            return;
        }
        default:
            collide_triangle_polytope(triangle, polytope_->view(), pose_, margin_, out, through);
        }
    }

    // Of a shape that has nothing over the triangle.
    void meet_ahead(const MeshTriangle& triangle, LocalManifold<double>& out) const
    {
        if (!triangle.has_concave_edge()) return;
        std::array<Vec3, 4> points;
        std::size_t count = 0;
        switch (shape_.kind) {
        case ShapeKind::sphere:
            points[count++] = pose_.position;
            break;
        case ShapeKind::capsule:
            points[count++] = end(-1);
            points[count++] = end(1);
            break;
        case ShapeKind::cylinder:
            count = lowest_of_cylinder(triangle, points);
            break;
        default: {
            const PolytopeView shape = polytope_->view();
            count = lowest_of(shape.vertices, shape.inner_radius, triangle, points);
        }
        }
        const bool is_core = shape_.kind == ShapeKind::sphere || shape_.kind == ShapeKind::capsule;
        add_points_ahead(triangle, {points.data(), count}, is_core ? radius_ : 0, margin_, out);
    }

    Vec3 end(double side) const { return pose_ * Vec3(0, 0, side * half_length_); }

    // Of some corners those that are lowest over the triangle, four at most.
    std::size_t lowest_of(std::span<const Vec3> corners,
                          double inner_radius,
                          const MeshTriangle& triangle,
                          std::array<Vec3, 4>& lowest) const
    {
        const Vec3 down = to_own_ * -triangle.normal;
        double furthest = -std::numeric_limits<double>::infinity();
        for (const Vec3& corner : corners) furthest = std::max(furthest, down.dot(corner));
        std::size_t count = 0;
        for (const Vec3& corner : corners)
            if (count < 4 && down.dot(corner) > furthest - kAsLow * inner_radius)
                lowest[count++] = pose_ * corner;
        return count;
    }

    // Of its rims four places each, one of them turned to the triangle.
    std::size_t lowest_of_cylinder(const MeshTriangle& triangle, std::array<Vec3, 4>& lowest) const
    {
        const Vec3 down = to_own_ * -triangle.normal;
        const Eigen::Vector2d way = way_round(down);
        const double x = way.x(), y = way.y();
        std::array<Vec3, 8> corners;
        std::size_t count = 0;
        for (const double side : {-1.0, 1.0})
            for (const Eigen::Vector2d& at : {Eigen::Vector2d(x, y), {-y, x}, {-x, -y}, {y, -x}})
                corners[count++] = {radius_ * at.x(), radius_ * at.y(), side * half_length_};
        return lowest_of(corners, std::min(radius_, half_length_), triangle, lowest);
    }

    const Shapes& shapes_;
    ShapeRef shape_;
    const Pose& pose_;
    double margin_;
    Vec3 center_;
    Mat3 to_own_;                  // turns the mesh's axes into the shape's
    Vec3 extents_ = Vec3::Zero();  // half extents of a box about its center in its own axes
    double radius_ = 0;            // of what is round
    double half_length_ = 0;       // of capsules and cylinders
    std::optional<PolytopeShape> polytope_;
};

// What the side of a shape is told by.
Vec3 center_of(const Shapes& shapes, ShapeRef shape, const Pose& pose)
{
    if (shape.kind != ShapeKind::hull) return pose.position;
    return pose * shapes.hulls[shape.index].center;
}

// The point of a manifold that is nearest or deepest, on the triangle.
Vec3 nearest_of(const LocalManifold<double>& found)
{
    const auto* const end = found.points.data() + found.count;
    const auto* const least =
        std::min_element(found.points.data(), end,
                         [](const auto& x, const auto& y) { return x.separation < y.separation; });
    return least->position - found.normal * (least->separation / 2);
}

// A solid tells inside from outside by other means: its triangles have their fronts alone.
void collide_triangles(const PairInput<double>& in,
                       std::span<const std::uint32_t> near,
                       std::span<const std::uint32_t> held,
                       std::vector<PartManifold>& out)
{
    const auto& [shapes, mesh, b, pose, speculative_margin] = in;
    const Mesh& surface = *mesh_of(shapes, mesh);
    const Vec3 center = center_of(shapes, b, pose);
    const MeshSides sides(surface, near, held, center, inner_extent(shapes, b));
    const bool sided = mesh.kind == ShapeKind::mesh;
    const Guest guest(in, center);
    for (const std::uint32_t index : near) {
        const MeshSides::Approach from = sided ? sides.approach(index) : MeshSides::Approach{};
        if (!from.any) continue;
        PartManifold& found = out.emplace_back();
        found.part = from.behind ? index | kBehind : index;
        guest.collide({surface, index, from.behind}, from.through, found.manifold);
        const auto is_hidden = [&] {
            return from.behind && !from.known && sides.is_hidden(nearest_of(found.manifold), index);
        };
        if (found.manifold.count == 0 || is_hidden()) out.pop_back();
    }
}

// What was pressed all the way through is beyond what it touched, and is pushed back all the same.
void keep_held(std::span<const std::uint32_t> held, std::vector<std::uint32_t>& near)
{
    for (const std::uint32_t one : held) {
        const std::uint32_t triangle = one & ~kBehind;
        const auto place = std::lower_bound(near.begin(), near.end(), triangle);
        if (place == near.end() || *place != triangle) near.insert(place, triangle);
    }
}

}  // namespace

void collide_mesh(const PairInput<double>& in,
                  std::span<const std::uint32_t> held,
                  std::vector<std::uint32_t>& near,
                  std::vector<PartManifold>& out)
{
    keep_held(held, near);
    collide_triangles(in, near, held, out);
}

void collide_mesh(const PairInput<double>& in, std::vector<PartManifold>& out)
{
    thread_local NearTriangles near;
    near.clear();
    near.add(in);
    near.find();
    collide_mesh(in, {}, near.of(0), out);
}

}  // namespace throng
