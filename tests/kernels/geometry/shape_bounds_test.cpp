#include "kernels/geometry/shape_bounds.hpp"

#include "cooking/hulls/hull.hpp"
#include "cooking/repair/build_mesh.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace throng {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// One shape of each kind that ends somewhere, with points that cover its surface.
struct Sampled {
    ShapeRef shape;
    std::vector<Vec3> points;
};

class ShapeBounds : public testing::Test {
protected:
    ShapeBounds()
    {
        shapes_.spheres.push_back({0.7});
        shapes_.capsules.push_back({0.2, 0.5});
        shapes_.cylinders.push_back({0.4, 0.3});
        shapes_.boxes.push_back({{0.1, 0.2, 0.3}});
        shapes_.planes.push_back({});
        const std::vector<Vec3> corners{{1, 2, 3}, {1.5, 2, 3}, {1, 2.2, 3}, {1, 2, 3.3}};
        shapes_.hulls.push_back(build_hull(corners).hull);
        shapes_.meshes.push_back(build_mesh(corners, {{0, 1, 2}, {0, 2, 3}}).mesh);

        Sampled sphere{{ShapeKind::sphere, 0}, {}}, capsule{{ShapeKind::capsule, 0}, {}},
            cylinder{{ShapeKind::cylinder, 0}, {}}, box{{ShapeKind::box, 0}, {}};
        const int around = 120;
        for (int i = 0; i <= around; ++i)
            for (int j = 0; j <= around; ++j) {
                const double turn = 2 * M_PI * i / around, polar = M_PI * j / around;
                const Vec3 ring(std::cos(turn), std::sin(turn), 0);
                const Vec3 unit = std::sin(polar) * ring + std::cos(polar) * Vec3::UnitZ();
                const double end = unit.z() < 0 ? -1 : 1;
                sphere.points.push_back(0.7 * unit);
                capsule.points.push_back(0.2 * unit + 0.5 * end * Vec3::UnitZ());
                cylinder.points.push_back(0.4 * ring + 0.3 * end * Vec3::UnitZ());
            }
        for (int i = 0; i < 8; ++i)
            box.points.emplace_back(i & 1 ? 0.1 : -0.1, i & 2 ? 0.2 : -0.2, i & 4 ? 0.3 : -0.3);
        sampled_ = {sphere, capsule, cylinder, box, {{ShapeKind::hull, 0}, corners}};
    }

    Shapes shapes_;
    std::vector<Sampled> sampled_;
};

Pose random_pose(unsigned seed)
{
    std::mt19937_64 engine(seed);
    std::uniform_real_distribution<double> unit(-1, 1);
    return {{unit(engine), unit(engine), unit(engine)},
            Quat(unit(engine), unit(engine), unit(engine), unit(engine)).normalized()};
}

TEST_F(ShapeBounds, AreTightRoundSampledPoints)
{
    for (unsigned seed = 0; seed < 10; ++seed)
        for (const Sampled& sampled : sampled_) {
            SCOPED_TRACE("seed " + std::to_string(seed));
            const Pose pose = random_pose(seed);
            Box3 wanted;
            for (const Vec3& point : sampled.points) {
                wanted.lower = wanted.lower.cwiseMin(pose * point);
                wanted.upper = wanted.upper.cwiseMax(pose * point);
            }
            const Box3 box = shape_bounds(shapes_, sampled.shape, pose);
            EXPECT_LE((box.lower - wanted.lower).cwiseAbs().maxCoeff(), 1e-3);
            EXPECT_LE((box.upper - wanted.upper).cwiseAbs().maxCoeff(), 1e-3);
            EXPECT_LE((box.lower - wanted.lower).maxCoeff(), 1e-15);
            EXPECT_GE((box.upper - wanted.upper).minCoeff(), -1e-15);
        }
}

TEST_F(ShapeBounds, OfAMeshHoldItsVertices)
{
    const ShapeRef mesh{ShapeKind::mesh, 0};
    for (unsigned seed = 0; seed < 10; ++seed) {
        const Pose pose = random_pose(seed);
        const Box3 box = shape_bounds(shapes_, mesh, pose);
        for (const Vec3& vertex : shapes_.meshes[0].vertices) {
            EXPECT_LE((box.lower - pose * vertex).maxCoeff(), 1e-15);
            EXPECT_GE((box.upper - pose * vertex).minCoeff(), -1e-15);
        }
    }
    const Box3 upright = shape_bounds(shapes_, mesh, {});
    EXPECT_LE((upright.lower - Vec3(1, 2, 3)).norm(), 1e-15);
    EXPECT_LE((upright.upper - Vec3(1.5, 2.2, 3.3)).norm(), 1e-15);
}

TEST_F(ShapeBounds, OfAPlaneAreAllOfSpace)
{
    const Box3 box = shape_bounds(shapes_, {ShapeKind::plane, 0}, {});
    EXPECT_EQ(box.lower, Vec3::Constant(-kInfinity));
    EXPECT_EQ(box.upper, Vec3::Constant(kInfinity));
    EXPECT_EQ(outer_radius(shapes_, {ShapeKind::plane, 0}), kInfinity);
}

TEST_F(ShapeBounds, OuterRadiusIsThatOfTheFarthestPoint)
{
    for (const Sampled& sampled : sampled_) {
        double farthest = 0;
        for (const Vec3& point : sampled.points) farthest = std::max(farthest, point.norm());
        EXPECT_NEAR(outer_radius(shapes_, sampled.shape), farthest, 1e-3);
    }
    EXPECT_NEAR(outer_radius(shapes_, {ShapeKind::mesh, 0}), Vec3(1, 2, 3.3).norm(), 1e-15);
}

TEST_F(ShapeBounds, InnerExtentIsTheSmallestHalfExtent)
{
    EXPECT_EQ(inner_extent(shapes_, {ShapeKind::sphere, 0}), 0.7);
    EXPECT_EQ(inner_extent(shapes_, {ShapeKind::capsule, 0}), 0.2);
    EXPECT_EQ(inner_extent(shapes_, {ShapeKind::cylinder, 0}), 0.3);
    EXPECT_EQ(inner_extent(shapes_, {ShapeKind::box, 0}), 0.1);
    EXPECT_EQ(inner_extent(shapes_, {ShapeKind::mesh, 0}), 0);
    EXPECT_EQ(inner_extent(shapes_, {ShapeKind::hull, 0}), shapes_.hulls[0].inner_radius);
    EXPECT_EQ(inner_extent(shapes_, {ShapeKind::plane, 0}), kInfinity);
}

TEST_F(ShapeBounds, OfACylinderUprightLoseNothingToRounding)
{
    const Box3 box = shape_bounds(shapes_, {ShapeKind::cylinder, 0}, {});
    EXPECT_EQ(box.upper, Vec3(0.4, 0.4, 0.3));
    EXPECT_EQ(box.lower, Vec3(-0.4, -0.4, -0.3));
}

}  // namespace
}  // namespace throng
