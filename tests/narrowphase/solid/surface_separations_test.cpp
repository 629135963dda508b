#include "narrowphase/solid/surface_separations.hpp"

#include "kernels/geometry/closest_points.hpp"
#include "narrowphase/ccd/impact_of_surfaces.hpp"
#include "tests/support/closed_meshes.hpp"
#include "tests/support/moving_pairs.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

constexpr ShapeRef kRing{ShapeKind::solid, 0}, kLump{ShapeKind::solid, 1},
    kBox{ShapeKind::solid, 2};
constexpr ShapeRef kPlane{ShapeKind::plane, 0};

const Shapes& shapes()
{
    static const Shapes made = [] {
        Shapes all;
        for (const TriangleSoup& soup : {torus_mesh(0.35, 0.15, 10, 6), noisy_ball(7, 0.4, 0.1),
                                         box_mesh(Vec3(0.5, 0.4, 0.3))}) {
            all.solids.emplace_back();
            all.solids.back().mesh = closed(soup);
        }
        all.planes = {{Vec3(1, 2, 2) / 3, 0.1}};
        return all;
    }();
    return made;
}

const Mesh& mesh_of(ShapeRef solid) { return shapes().solids[solid.index].mesh; }

std::array<Vec3, 3> corners_of(const Mesh& mesh, const std::array<std::uint32_t, 3>& triangle)
{
    return {mesh.vertices[triangle[0]], mesh.vertices[triangle[1]], mesh.vertices[triangle[2]]};
}

// m, of surfaces that do not cross, the plain way: corners and faces, edges and edges.
double plain_distance(const Mesh& a, const Mesh& b, const Pose& b_in_a)
{
    double least = std::numeric_limits<double>::infinity();
    const auto corners_on = [&](const Mesh& one, const Mesh& other, const Pose& one_in_other) {
        for (const Vec3& vertex : one.vertices)
            least = std::min(least, nearest_on_mesh(other, one_in_other * vertex).distance);
    };
    corners_on(b, a, b_in_a);
    corners_on(a, b, b_in_a.inverse());
    for (const auto& p : a.triangles)
        for (const auto& q : b.triangles) {
            const auto of_a = corners_of(a, p);
            auto of_b = corners_of(b, q);
            for (Vec3& corner : of_b) corner = b_in_a * corner;
            for (std::size_t i = 0; i < 3; ++i)
                for (std::size_t k = 0; k < 3; ++k) {
                    const auto near = closest_points<double>({of_a[i], of_a[(i + 1) % 3]},
                                                             {of_b[k], of_b[(k + 1) % 3]});
                    least = std::min(least, (near.on_a - near.on_b).norm());
                }
        }
    return least;
}

struct Told {
    double least = std::numeric_limits<double>::infinity();
    std::size_t count = 0;
};

Told ask(ShapeRef a, ShapeRef b, const Pose& b_in_a, double speculative_margin)
{
    std::vector<LocalManifold<double>> found;
    find_surface_separations({shapes(), a, b, b_in_a, speculative_margin}, found);
    Told told;
    told.count = found.size();
    for (const auto& manifold : found) {
        EXPECT_NEAR(manifold.normal.norm(), 1, 1e-12);
        for (int k = 0; k < manifold.count; ++k)
            told.least =
                std::min(told.least, manifold.points[static_cast<std::size_t>(k)].separation);
    }
    return told;
}

TEST(SurfaceSeparations, TheLeastIsTheDistance)
{
    RandomShapes random(51);
    int within = 0, beyond = 0, crossing = 0;
    for (int i = 0; i < 100; ++i) {
        const Pose pose = random.pose(1);
        const ShapeRef other = i % 2 == 0 ? kLump : kBox;
        const double speculative_margin = 0.1;
        const Told told = ask(kRing, other, pose, speculative_margin);
        if (told.least <= 0) {
            ++crossing;
            continue;
        }
        const double truth = plain_distance(mesh_of(kRing), mesh_of(other), pose);
        if (truth <= speculative_margin) {
            ++within;
            ASSERT_NEAR(told.least, truth, 1e-12);
            EXPECT_NEAR(ask(other, kRing, pose.inverse(), speculative_margin).least, truth, 1e-12);
        } else {
            ++beyond;
            EXPECT_EQ(told.count, 0u);
        }
    }
    EXPECT_GT(within, 8);
    EXPECT_GT(beyond, 15);
    EXPECT_GT(crossing, 15);
}

// However coarsely the two are seen: what is behind the far side of one is not as deep in it.
TEST(SurfaceSeparations, TwoThatHardlyCrossAreAsDeepAsTheyCross)
{
    Shapes coarse = shapes();
    for (Solid& solid : coarse.solids) solid.error = 0.05;
    const double depth = 1e-4;
    // A corner of the ring's rim goes into the end of the box.
    const Pose pose{Vec3(-1 + depth, 0.013, 0.017), Quat::Identity()};
    for (const bool swapped : {false, true}) {
        std::vector<LocalManifold<double>> found;
        const std::size_t looked_at = swapped
            ? find_surface_separations({coarse, kBox, kRing, pose.inverse(), 0}, found)
            : find_surface_separations({coarse, kRing, kBox, pose, 0}, found);
        ASSERT_EQ(found.size(), 1u);
        EXPECT_NEAR(found[0].points[0].separation, -depth, 1e-12);
        EXPECT_NEAR(found[0].normal.x(), swapped ? 1 : -1, 1e-9);
        EXPECT_GT(looked_at, 0u);
    }
}

// Where one lies on the other all that bears it is told of.
TEST(SurfaceSeparations, FacesOnFacesAreHeldAtTheCornersOfWhatTheyShare)
{
    // Quarter turned: corners of neither are over the other.
    const Pose pose{Vec3(0, 0, 0.6 + 1e-4), Quat(std::sqrt(0.5), 0, 0, std::sqrt(0.5))};
    std::vector<LocalManifold<double>> found;
    find_surface_separations({shapes(), kBox, kBox, pose, 1e-3}, found);
    Box3 places;
    for (const auto& manifold : found) {
        EXPECT_NEAR(manifold.points[0].separation, 1e-4, 1e-12);
        EXPECT_NEAR((manifold.normal - Vec3::UnitZ()).norm(), 0, 1e-9);
        places.lower = places.lower.cwiseMin(manifold.points[0].position);
        places.upper = places.upper.cwiseMax(manifold.points[0].position);
    }
    EXPECT_GE(found.size(), 4u);
    EXPECT_NEAR((places.upper - Vec3(0.4, 0.4, 0.3 + 5e-5)).norm(), 0, 1e-9);
    EXPECT_NEAR((places.lower - Vec3(-0.4, -0.4, 0.3 + 5e-5)).norm(), 0, 1e-9);
}

// A face that leans is told of at its other corners too, each as far as it is.
TEST(SurfaceSeparations, AFaceThatLeansByLessThanTheMarginIsHeldAtAllItsCorners)
{
    constexpr double kLean = 5e-4, kApart = 1e-4, kMargin = 1e-3;  // rad, m
    const Quat lean(Eigen::AngleAxisd(kLean, Vec3(0.6, 0.8, 0)));
    double lowest = 1;
    for (const Vec3& vertex : mesh_of(kRing).vertices)
        lowest = std::min(lowest, (lean * vertex).z());
    const Pose pose{Vec3(0, 0, 0.3 + kApart - lowest), lean};
    std::vector<LocalManifold<double>> found;
    find_surface_separations({shapes(), kBox, kRing, pose, kMargin}, found);
    Box3 places;
    for (const auto& manifold : found) {
        const auto& point = manifold.points[0];
        EXPECT_NEAR((manifold.normal - Vec3::UnitZ()).norm(), 0, 2 * kLean);
        // The point is midway between the face of the box and the corner.
        EXPECT_NEAR(point.position.z() - 0.3, point.separation / 2, 2 * kLean * kMargin);
        places.lower = places.lower.cwiseMin(point.position);
        places.upper = places.upper.cwiseMax(point.position);
    }
    EXPECT_GE(found.size(), 20u);  // two rings of ten
    EXPECT_GT((places.upper - places.lower).head<2>().minCoeff(), 0.6);
}

TEST(SurfaceSeparations, OfAPlaneAreThoseOfTheCorners)
{
    RandomShapes random(52);
    int within = 0;
    for (int i = 0; i < 100; ++i) {
        const Pose pose = random.pose(0.7);
        double truth = std::numeric_limits<double>::infinity();
        const Plane& plane = shapes().planes[0];
        for (const Vec3& vertex : mesh_of(kLump).vertices)
            truth = std::min(truth, plane.normal.dot(pose.to_local(vertex)) - plane.offset);
        const Told told = ask(kLump, kPlane, pose, 0.05);
        EXPECT_LE(told.count, kMostSurfaceSeparations);
        if (truth > 0.05) {
            EXPECT_EQ(told.count, 0u);
            continue;
        }
        ++within;
        EXPECT_NEAR(told.least, truth, 1e-12);
    }
    EXPECT_GT(within, 20);
}

TEST(ImpactOfSurfaces, IsNeverLateAndNeverEarlierThanTheTolerance)
{
    const double tolerance = 1e-3;
    test::Dice dice(53);
    int met = 0, missed = 0;
    for (const ToiMethod method : test::kToiMethods)
        for (int i = 0; i < 12; ++i) {
            MovingShape a, b;
            a.shape = kRing;
            b.shape = i % 2 == 0 ? kLump : kBox;
            a.pieces = b.pieces = true;
            a.trajectory = {
                {dice.point(0.3), dice.turn()}, Vec3(2, 0, 0) + dice.point(1), dice.point(2)};
            b.trajectory = {{Vec3(1.8, 0, 0), dice.turn()}, dice.point(0.5), dice.point(2)};
            const Impact impact =
                time_of_impact(shapes(), a, b, 0, 1, impact_rule(method, tolerance));
            const auto separation_at = [&](double time) {
                const Pose at_a = a.trajectory.at(time), at_b = b.trajectory.at(time);
                return std::min(1.0,
                                ask(a.shape, b.shape,
                                    {at_a.to_local(at_b.position),
                                     at_a.orientation.conjugate() * at_b.orientation},
                                    0.05)
                                    .least);
            };
            const bool meets = impact.state == ToiState::hit;
            (meets ? met : missed) += 1;
            for (int k = 0; k <= 30; ++k)
                ASSERT_GT(separation_at(impact.time * k / 30), tolerance * 0.49);
            if (meets && !impact.cut_short) {
                EXPECT_LE(separation_at(impact.time), tolerance * 1.01);
            }
        }
    EXPECT_GT(met, 10);
    EXPECT_GT(missed, 1);
}

}  // namespace
}  // namespace throng
