#include "kernels/geometry/separating_axes.hpp"

#include "tests/support/polyhedra.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

// Every pair of edges, whether or not their arcs cross.
double every_axis(const PolytopeView& a, const PolytopeView& b, const Pose& pose)
{
    const std::vector<Vec3> points_a(a.vertices.begin(), a.vertices.end());
    const std::vector<Vec3> points_b(b.vertices.begin(), b.vertices.end());
    const Extent extent_a = extent_of(points_a, Pose{}), extent_b = extent_of(points_b, pose);
    double best = -1e300;
    const auto offer = [&](const Vec3& n) {
        if (!(n.norm() > 1e-9)) return;
        for (const Vec3& unit : {Vec3(n.normalized()), Vec3(-n.normalized())}) {
            best = std::max(best, -extent_b(-unit) - extent_a(unit));
        }
    };
    for (const Vec3& normal : a.normals) offer(normal);
    for (const Vec3& normal : b.normals) offer(pose.orientation * normal);
    for (const Hull::Edge& x : a.edges) {
        for (const Hull::Edge& y : b.edges) {
            const Vec3 along_b = pose.orientation * (b.vertices[y.to] - b.vertices[y.from]);
            offer((a.vertices[x.to] - a.vertices[x.from]).cross(along_b));
        }
    }
    return best;
}

}  // namespace

TEST(SeparatingAxes, LeavingOutEdgesThatDoNotCrossChangesNothing)
{
    RandomShapes random(61);
    for (int i = 0; i < 150; ++i) {
        SCOPED_TRACE("seed 61, pair " + std::to_string(i));
        const Hull a = random.hull(5 + i % 12, 0.5), b = random.hull(5 + i % 9, 0.5);
        const Pose pose = random.pose(0.5);
        const double all = every_axis(view_of(a), view_of(b), pose);
        Vec3 normal;
        const double found = polytope_separation(view_of(a), view_of(b), pose, &normal);
        ASSERT_NEAR(normal.norm(), 1, 1e-12);
        ASSERT_EQ(found > 0, all > 0);
        if (all > 0) continue;
        ASSERT_NEAR(found, all, 1e-12);
    }
}

TEST(SeparatingAxes, AgreesWithDirectionSweep)
{
    RandomShapes random(62);
    for (int i = 0; i < 60; ++i) {
        SCOPED_TRACE("seed 62, pair " + std::to_string(i));
        const Hull a = random.hull(16, 0.5);
        const BoxPolytope b(random.vector(0.2, 0.6));
        const Pose pose = random.pose(0.5);
        const double swept =
            sweep_directions(extent_of(a.vertices, Pose{}),
                             extent_of({b.vertices.begin(), b.vertices.end()}, pose), 16, nullptr);
        const double found = polytope_separation(view_of(a), b.view(), pose, nullptr);
        ASSERT_LE(found, swept + 1e-12);
        if (swept > 0) continue;
        ASSERT_NEAR(found, swept, 1e-9);
    }
}

TEST(SeparatingAxes, ATriangleIsAThinPolytope)
{
    RandomShapes random(63);
    for (int i = 0; i < 60; ++i) {
        SCOPED_TRACE("seed 63, pair " + std::to_string(i));
        const Vec3 v0 = random.vector(-1, 1), v1 = random.vector(-1, 1), v2 = random.vector(-1, 1);
        const TrianglePolytope triangle(v0, v1, v2, (v1 - v0).cross(v2 - v0).normalized());
        const BoxPolytope box(random.vector(0.2, 0.6));
        const Pose pose = random.pose(0.5);
        const double swept = sweep_directions(
            extent_of({v0, v1, v2}, Pose{}),
            extent_of({box.vertices.begin(), box.vertices.end()}, pose), 16, nullptr);
        const double found = polytope_separation(triangle.view(), box.view(), pose, nullptr);
        if (swept > 0) continue;
        ASSERT_NEAR(found, swept, 1e-9);
    }
}

TEST(SeparatingAxes, KeepsTheThicknessOfNeedles)
{
    // A needle lying in a slab's face: the depth is known whatever the length.
    const BoxPolytope needle({1000, 0.0005, 0.0005}), slab({500, 500, 0.5});
    for (const double sunk : {1e-9, 1e-6, 1e-4, 9e-4}) {
        const Pose pose{{3, 2, 0.5005 - sunk}, Quat::Identity()};
        EXPECT_NEAR(polytope_separation(slab.view(), needle.view(), pose, nullptr), -sunk,
                    1e-9 * 0.001);
    }
}

}  // namespace throng
