// Shape distance: agrees with the nearest point outside, and with the ball that fits inside.
#include "narrowphase/solid/shape_distance.hpp"

#include "cooking/hulls/hull.hpp"
#include "kernels/geometry/nearest_point.hpp"
#include "tests/narrowphase/small_solids.hpp"

#include <gtest/gtest.h>

namespace throng::test {
namespace {

Shapes some_shapes(double size)
{
    Shapes shapes;
    shapes.spheres = {{0.7 * size}};
    shapes.capsules = {{0.4 * size, 0.8 * size}};
    shapes.cylinders = {{0.6 * size, 0.5 * size}};
    shapes.boxes = {{Vec3(0.5, 1.1, 0.8) * size}};
    shapes.planes = {{Vec3(0.6, 0, 0.8), 0.3 * size}};
    Dice dice(80);
    std::vector<Vec3> points;
    for (int i = 0; i < 20; ++i) points.push_back(dice.point(1).normalized() * size);
    shapes.hulls = {build_hull(points).hull};
    return shapes;
}

constexpr ShapeKind kKinds[] = {ShapeKind::sphere, ShapeKind::capsule, ShapeKind::cylinder,
                                ShapeKind::box,    ShapeKind::hull,    ShapeKind::plane};

TEST(ShapeDistance, TheWayOutLeadsToTheNearestPointOfTheSurface)
{
    for (const double size : {1e-3, 1.0, 1e3}) {
        const Shapes shapes = some_shapes(size);
        for (const ShapeKind kind : kKinds) {
            Dice dice(81);
            for (int i = 0; i < 1000; ++i) {
                Vec3 point = dice.point(2 * size);
                if (i % 7 == 0) point[i % 3] = 0;
                if (i % 50 == 0) point = Vec3(0, 0, i % 100 == 0 ? 0 : 0.2 * size);
                const SurfaceDistance here = distance_to(shapes, {kind, 0}, point);
                ASSERT_NEAR(here.outward.norm(), 1, 1e-12);
                const Vec3 surface = point - here.outward * here.distance;
                ASSERT_NEAR(distance_to(shapes, {kind, 0}, surface).distance, 0, 1e-12 * size)
                    << static_cast<int>(kind) << " point " << i << " of seed 81";
                const double outside = nearest_point(shapes, {kind, 0}, point, 1e300).distance;
                ASSERT_NEAR(std::max(here.distance, 0.0), outside, 1e-12 * size);
            }
        }
    }
}

TEST(ShapeDistance, InsideABallOfItsSizeFitsIn)
{
    const Shapes shapes = some_shapes(1);
    for (const ShapeKind kind : kKinds) {
        Dice dice(82);
        int inside = 0;
        for (int i = 0; i < 3000; ++i) {
            const Vec3 point = dice.point(0.8);
            const double depth = -distance_to(shapes, {kind, 0}, point).distance;
            if (!(depth > 0)) continue;
            ++inside;
            const Vec3 other = point + depth * dice.point(1).normalized();
            ASSERT_LT(distance_to(shapes, {kind, 0}, other).distance, 1e-14);
        }
        EXPECT_GT(inside, 300);
    }
}

}  // namespace
}  // namespace throng::test
