#include "narrowphase/solid/sphere_separations.hpp"

#include "tests/support/closed_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace throng {
namespace {

constexpr ShapeRef kRing{ShapeKind::solid, 0}, kLump{ShapeKind::solid, 1};

const Shapes& shapes()
{
    static const Shapes made = [] {
        Shapes all;
        all.solids.push_back(in_spheres(torus_mesh(0.35, 0.15, 24, 12)));
        all.solids.push_back(in_spheres(noisy_ball(7, 0.4, 0.1)));
        const Vec3 half(0.5, 0.4, 0.3);
        all.boxes = {{half}};
        all.spheres = {{0.3}};
        all.capsules = {{0.2, 0.3}};
        all.cylinders = {{0.2, 0.3}};
        all.hulls.push_back(build_hull(corners_of(half)).hull);
        all.planes = {{Vec3(1, 2, 2) / 3, 0.1}};
        all.meshes = {closed(box_mesh(half))};
        return all;
    }();
    return made;
}

const std::vector<SphereTree::Node>& spheres_of(ShapeRef solid)
{
    return shapes().solids[solid.index].spheres.levels.back().nodes;
}

std::vector<double>
separations(ShapeRef solid, ShapeRef other, const Pose& pose, double speculative_margin)
{
    std::vector<LocalManifold<double>> found;
    find_sphere_separations({shapes(), solid, other, pose, speculative_margin}, found);
    std::vector<double> all;
    for (const auto& manifold : found) {
        EXPECT_EQ(manifold.count, 1);
        EXPECT_NEAR(manifold.normal.norm(), 1, 1e-12);
        all.push_back(manifold.points[0].separation);
    }
    std::sort(all.begin(), all.end());
    return all;
}

// Every sphere of the one against every one of the other.
std::vector<double> plain(const Pose& pose, double speculative_margin)
{
    std::vector<double> all;
    for (const auto& p : spheres_of(kRing))
        for (const auto& q : spheres_of(kLump)) {
            const Vec3 apart = pose * q.center.cast<double>() - p.center.cast<double>();
            const double separation = apart.norm() - double{p.radius} - double{q.radius};
            if (separation <= speculative_margin) all.push_back(separation);
        }
    std::sort(all.begin(), all.end());
    return all;
}

TEST(SphereSeparations, AreThoseOfAllPairsOrTheNearest)
{
    RandomShapes random(31);
    int few = 0, cut = 0;
    for (int i = 0; i < 100; ++i) {
        const Pose pose = random.pose(1);
        std::vector<double> wanted = plain(pose, 0.01);
        (wanted.size() > kMostSphereSeparations ? cut : few) += wanted.empty() ? 0 : 1;
        if (wanted.size() > kMostSphereSeparations) wanted.resize(kMostSphereSeparations);
        const std::vector<double> found = separations(kRing, kLump, pose, 0.01);
        ASSERT_EQ(found.size(), wanted.size());
        for (std::size_t k = 0; k < found.size(); ++k) EXPECT_NEAR(found[k], wanted[k], 1e-12);
    }
    EXPECT_GT(few, 5);
    EXPECT_GT(cut, 5);
}

TEST(SphereSeparations, OfOtherShapesAreEachSpheres)
{
    RandomShapes random(32);
    for (const ShapeKind kind : {ShapeKind::sphere, ShapeKind::capsule, ShapeKind::cylinder,
                                 ShapeKind::box, ShapeKind::hull, ShapeKind::plane}) {
        const ShapeRef other{kind, 0};
        std::size_t count = 0;
        for (int i = 0; i < 40; ++i) {
            const Pose pose = random.pose(1);
            std::vector<double> wanted;
            for (const auto& node : spheres_of(kRing)) {
                const Vec3 place = pose.to_local(node.center.cast<double>());
                const double separation =
                    distance_from(shapes(), other, place, 1) - double{node.radius};
                if (separation <= 0.01) wanted.push_back(separation);
            }
            std::sort(wanted.begin(), wanted.end());
            const std::vector<double> found = separations(kRing, other, pose, 0.01);
            ASSERT_EQ(found.size(), std::min(wanted.size(), kMostSphereSeparations));
            for (std::size_t k = 0; k < found.size(); ++k) EXPECT_NEAR(found[k], wanted[k], 1e-12);
            count += found.size();
        }
        EXPECT_GT(count, 20U);
    }
}

// A closed mesh of a box, seen from its front, is that box.
TEST(SphereSeparations, OfAMeshAreThoseOfTheBoxThatItIs)
{
    RandomShapes random(33);
    int touching = 0;
    for (int i = 0; i < 200; ++i) {
        const Pose pose = random.pose(1);
        const auto box = separations(kLump, {ShapeKind::box, 0}, pose, 0.01);
        const auto mesh = separations(kLump, {ShapeKind::mesh, 0}, pose, 0.01);
        if (box.empty() || box.front() < -0.02) continue;  // behind a face there is no telling
        ASSERT_FALSE(mesh.empty());
        EXPECT_NEAR(mesh.front(), box.front(), 1e-12);
        ++touching;
    }
    EXPECT_GT(touching, 3);
}

}  // namespace
}  // namespace throng
