#include "narrowphase/solid/sphere_separations.hpp"

#include "kernels/check.hpp"
#include "kernels/geometry/mesh.hpp"
#include "kernels/geometry/mesh_distance.hpp"
#include "narrowphase/mesh/triangle_contacts.hpp"
#include "narrowphase/solid/shape_distance.hpp"
#include "narrowphase/solid/sphere_walk.hpp"

#include <algorithm>

namespace throng {
namespace {

using Manifold = LocalManifold<double>;
using Node = SphereTree::Node;

Vec3 center_of(const Node& node) { return node.center.cast<double>(); }

// The nearest of what is found, in the order found where all are kept.
class NearestSeparations {
public:
    /// Between a ball about `center` and what is `separation` from it along the unit normal.
    void add(const Vec3& center, double radius, const Vec3& normal, double separation)
    {
        Manifold found;
        found.normal = normal;
        found.add(center + normal * (radius + separation / 2), separation, 0);
        add(found);
    }
    void add(const Manifold& found)
    {
        found_.push_back(found);
        if (found_.size() >= 8 * kMostSphereSeparations) cut();
    }
    void append_to(std::vector<Manifold>& out)
    {
        if (found_.size() > kMostSphereSeparations) cut();
        out.insert(out.end(), found_.begin(), found_.end());
    }

private:
    void cut()
    {
        std::stable_sort(found_.begin(), found_.end(), [](const Manifold& p, const Manifold& q) {
            return p.points[0].separation < q.points[0].separation;
        });
        found_.resize(kMostSphereSeparations);
    }

    std::vector<Manifold> found_;
};

void find_between_trees(const SphereTree& a,
                        const SphereTree& b,
                        const Pose& b_in_a,
                        double speculative_margin,
                        NearestSeparations& separations)
{
    const Mat3 turn = b_in_a.orientation.toRotationMatrix();
    const auto between = [&](const Node& p, const Node& q) {
        return Vec3(turn * center_of(q) + b_in_a.position - center_of(p));
    };
    visit_sphere_pairs(
        a, b,
        [&](const Node& p, const Node& q) {
            const double limit = double{p.bound} + double{q.bound} + speculative_margin;
            return between(p, q).squaredNorm() <= limit * limit;
        },
        [&](const Node& p, const Node& q) {
            const Vec3 apart = between(p, q);
            const double distance = apart.norm();
            const double separation = distance - double{p.radius} - double{q.radius};
            if (!(separation <= speculative_margin)) return;
            const Vec3 normal = distance > 0 ? Vec3(apart / distance) : Vec3(Vec3::UnitZ());
            separations.add(center_of(p), double{p.radius}, normal, separation);
        });
}

// Of a ball and the triangles of a mesh, each for itself.
void find_on_mesh(const Mesh& mesh,
                  const Node& node,
                  const Pose& mesh_pose,
                  double speculative_margin,
                  NearestSeparations& separations)
{
    const Vec3 center = mesh_pose.to_local(center_of(node));
    const auto radius = double{node.radius};
    const Vec3 wide = Vec3::Constant(radius + speculative_margin);
    thread_local std::vector<std::uint32_t> triangles;
    triangles.clear();
    find_triangles(mesh, {center - wide, center + wide}, triangles);
    for (const std::uint32_t triangle : triangles) {
        Manifold found;
        collide_triangle_ball(MeshTriangle(mesh, triangle), center, radius, speculative_margin,
                              found);
        if (found.count == 0) continue;
        found.normal = mesh_pose.orientation * -found.normal;
        found.points[0].position = mesh_pose * found.points[0].position;
        separations.add(found);
    }
}

}  // namespace

double distance_from(const Shapes& shapes, ShapeRef shape, const Vec3& place, double limit)
{
    if (const Mesh* const mesh = mesh_of(shapes, shape))
        return nearest_on_mesh(*mesh, place, limit).distance;
    return distance_to(shapes, shape, place).distance;
}

void find_sphere_separations(const PairInput<double>& in, std::vector<LocalManifold<double>>& out)
{
    // Not as structured bindings: clang 14 cannot capture these.
    const Shapes& shapes = in.shapes;
    const ShapeRef solid = in.a, other = in.b;
    const Pose& other_in_solid = in.b_in_a;
    const double speculative_margin = in.speculative_margin;
    THRONG_CHECK(solid.kind == ShapeKind::solid, "spheres stand for a solid");
    const SphereTree& tree = shapes.solids[solid.index].spheres;
    NearestSeparations separations;
    if (other.kind == ShapeKind::solid && !shapes.solids[other.index].spheres.levels.empty()) {
        const SphereTree& beyond = shapes.solids[other.index].spheres;
        find_between_trees(tree, beyond, other_in_solid, speculative_margin, separations);
        separations.append_to(out);
        return;
    }
    const Mesh* const mesh = mesh_of(shapes, other);
    const auto reached = [&](const Node& node) {
        const double limit = double{node.bound} + speculative_margin;
        const Vec3 place = other_in_solid.to_local(center_of(node));
        return distance_from(shapes, other, place, limit) <= limit;
    };
    visit_spheres(tree, reached, [&](const Node& node, std::uint32_t) {
        if (mesh != nullptr) {
            find_on_mesh(*mesh, node, other_in_solid, speculative_margin, separations);
            return;
        }
        const Vec3 center = center_of(node);
        const SurfaceDistance there = distance_to(shapes, other, other_in_solid.to_local(center));
        const double separation = there.distance - double{node.radius};
        if (!(separation <= speculative_margin)) return;
        separations.add(center, double{node.radius}, -(other_in_solid.orientation * there.outward),
                        separation);
    });
    separations.append_to(out);
}

}  // namespace throng
