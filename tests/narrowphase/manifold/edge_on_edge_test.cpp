// Edge on edge: boxes and hulls that lean on one another, as every way to collide them sees it.
#include "narrowphase/manifold/edge_on_edge.hpp"

#include "cooking/hulls/hull.hpp"
#include "narrowphase/convex/pair_functions.hpp"
#include "narrowphase/convex/wide/box_pairs.hpp"
#include "tests/support/polyhedra.hpp"
#include "throng/rotation.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace throng {
namespace {

constexpr ShapeRef kHullA{ShapeKind::hull, 0}, kHullB{ShapeKind::hull, 1};
constexpr double kMargin = 2e-3;

// A plank that leans by an angle from upright to one side, its upper inner edge at x = z = 0.
Pose leaning(const Vec3& half, double lean, double side)
{
    const double sin = std::sin(lean), cos = std::cos(lean);
    return {Vec3(side * (half.x() * sin + half.z() * cos), 0, half.z() * sin - half.x() * cos),
            exponential(Vec3(0, -side * lean - std::numbers::pi / 2, 0))};
}

Shapes two_hulls(const Vec3& half_a, const Vec3& half_b)
{
    Shapes shapes;
    shapes.hulls = {build_hull(corners_of(half_a)).hull, build_hull(corners_of(half_b)).hull};
    return shapes;
}

LocalManifold<float> many_boxes(const Vec3& half_a, const Vec3& half_b, const Pose& pose)
{
    const PoseT<float> rounded{pose.position.cast<float>(), pose.orientation.cast<float>()};
    const BoxPair pair =
        box_pair(rounded, half_a.cast<float>(), half_b.cast<float>(), static_cast<float>(kMargin));
    LocalManifold<float> out;
    collide_boxes({&pair, 1}, {&out, 1});
    return out;
}

// As every function sees the pair.
std::vector<LocalManifold<double>>
all_ways(const Vec3& half_a, const Vec3& half_b, const Pose& pose)
{
    const Shapes boxes = two_boxes(half_a, half_b), hulls = two_hulls(half_a, half_b);
    return {run<double>(box_box<double>, boxes, kBoxA, kBoxB, pose, kMargin),
            run<float>(box_box<float>, boxes, kBoxA, kBoxB, pose, kMargin).cast<double>(),
            many_boxes(half_a, half_b, pose).cast<double>(),
            run<double>(hull_hull<double>, hulls, kHullA, kHullB, pose, kMargin),
            run<float>(hull_hull<float>, hulls, kHullA, kHullB, pose, kMargin).cast<double>()};
}

// Level with one another or a little off, a hair apart or in one another.
TEST(EdgeOnEdge, PlanksThatLeanPressStraightAcross)
{
    for (const double lean : {0.3, 0.5, 0.75})
        for (const double thickness : {0.01, 0.1})
            for (const double apart : {-5e-5, -1e-6, 0.0, 1e-6, 5e-5})
                for (const double lift : {0.0, 2e-5, -2e-5}) {
                    SCOPED_TRACE(testing::Message()
                                 << "lean " << lean << ", thickness " << thickness << ", apart "
                                 << apart << ", lift " << lift);
                    const Vec3 half(0.5, 0.2, thickness), other(0.4, 0.1, thickness);
                    const Pose a = leaning(half, lean, -1);
                    Pose b = leaning(other, lean, 1);
                    b.position += Vec3(apart, 0.05, lift);
                    for (const auto& found : all_ways(half, other, inverse(a) * b)) {
                        ASSERT_EQ(found.count, 2);
                        const Vec3 normal = a.orientation * found.normal;
                        EXPECT_GT(normal.x(), 0);
                        EXPECT_NEAR(normal.z(), 0, std::abs(lift) / (0.05 * thickness) + 1e-3);
                        double low = 1, high = -1;
                        for (std::size_t i = 0; i < 2; ++i) {
                            const Vec3 at = a * found.points[i].position;
                            EXPECT_NEAR(at.x(), apart / 2, 1e-6);
                            low = std::min(low, at.y());
                            high = std::max(high, at.y());
                            EXPECT_NEAR(found.points[i].separation, apart, 2e-6);
                        }
                        EXPECT_NEAR(low, -0.05, 1e-6) << "what the two have side by side";
                        EXPECT_NEAR(high, 0.15, 1e-6);
                        EXPECT_NE(found.points[0].feature, found.points[1].feature);
                    }
                }
}

TEST(EdgeOnEdge, AnEdgeThatLeansOnAFacePressesOnTheFace)
{
    // Its edge on the other's top, a fifth of a metre from the side.
    const Vec3 floor(1, 1, 0.1), half(0.5, 0.2, 0.05);
    Pose b = leaning(half, 0.4, 1);
    b = Pose{Vec3::Zero(), exponential(Vec3(std::numbers::pi, 0, 0))} * b;
    b.position += Vec3(0.8, 0, 0.1 - 1e-5);
    for (const auto& found : all_ways(floor, half, b)) {
        ASSERT_GE(found.count, 2);
        EXPECT_NEAR(found.normal.z(), 1, 1e-6);
    }
}

TEST(EdgeOnEdge, ABeamThatIsBorneByAnInchIsBorneStraight)
{
    const Vec3 pillar(0.2, 0.2, 1), beam(1, 0.2, 0.1);
    for (const double borne : {0.002, 0.006, 0.025})
        for (const double tilt : {0.0, 0.01, -0.01}) {
            const Quat turn = exponential(Vec3(0, tilt, 0));
            // Its lower corner is over the pillar's edge by so much.
            const Vec3 corner(-beam.x(), 0, -beam.z());
            const Pose pose{Vec3(0.2 - borne, 0, 1 - 1e-5) - turn * corner, turn};
            for (const auto& found : all_ways(pillar, beam, pose)) {
                ASSERT_GE(found.count, 2) << borne << " " << tilt;
                EXPECT_GT(found.normal.z(), 0.999) << borne << " " << tilt;
            }
        }
}

TEST(EdgeOnEdge, CubesOfAWallDoNotWedgeTheirNeighbours)
{
    // Up and to the side, corner to corner, sunk by a hair.
    const Vec3 half = Vec3::Constant(0.5);
    for (const double beside : {0.0, 1e-5, -1e-5})
        for (const auto& found :
             all_ways(half, half, {Vec3(1 + beside, 0, 1 - 1e-4), Quat::Identity()})) {
            const Vec3 sizes = found.normal.cwiseAbs();
            EXPECT_TRUE(found.count == 0 || sizes.x() > 0.999 || sizes.z() > 0.999) << beside;
        }
}

TEST(EdgeOnEdge, IsOfTheEdgesAndNotOfTheOrder)
{
    const Vec3 half(0.5, 0.2, 0.01), other(0.4, 0.15, 0.03);
    const Pose a = leaning(half, 0.4, -1), b = leaning(other, 0.6, 1);
    const auto one = all_ways(half, other, inverse(a) * b);
    const auto turned = all_ways(other, half, inverse(b) * a);
    for (std::size_t i = 0; i < one.size(); ++i) {
        ASSERT_EQ(one[i].count, 2);
        ASSERT_EQ(turned[i].count, 2);
        EXPECT_LT((a.orientation * one[i].normal + b.orientation * turned[i].normal).norm(), 1e-4);
        EXPECT_LT((one[i].normal - one[0].normal).norm(), 1e-4) << "by whatever function";
    }
}

}  // namespace
}  // namespace throng
