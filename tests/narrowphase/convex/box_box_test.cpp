#include "cost/hard_cases/broken_pairs.hpp"
#include "kernels/geometry/separating_axes.hpp"
#include "narrowphase/manifold/contact_points.hpp"
#include "tests/support/polyhedra.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

template <class Real>
LocalManifold<Real>
boxes(const Vec3& half_a, const Vec3& half_b, const Pose& pose, double speculative_margin = 0)
{
    return run<Real>(box_box<Real>, two_boxes(half_a, half_b), kBoxA, kBoxB, pose,
                     speculative_margin);
}

double truth(const Vec3& half_a, const Vec3& half_b, const Pose& pose, Vec3* normal = nullptr)
{
    const BoxPolytope a(half_a), b(half_b);
    return polytope_separation(a.view(), b.view(), pose, normal);
}

// By how much a face may be worse than the best axis and still lead.
double face_bias(const Vec3& half_a, const Vec3& half_b)
{
    return 1e-3 * (half_a.minCoeff() + half_b.minCoeff());
}

// Turns about a fixed axis by a small angle, without a cosine.
Quat tilt(const Vec3& axis, double angle)
{
    const Vec3 part = axis.normalized() * (angle / 2);
    return Quat(std::sqrt(1 - part.squaredNorm()), part.x(), part.y(), part.z());
}

// Whether the figure is the truth, or comes of a face that the bias let lead.
void expect_depth(double found, double expected, double tolerance, double bias)
{
    EXPECT_GE(found, expected - tolerance - 2 * bias);
    EXPECT_LE(found, expected + tolerance + 2 * bias);
}

}  // namespace

TEST(BoxBox, AgreesWithDirectionSweep)
{
    RandomShapes random(11);
    for (int i = 0; i < 150; ++i) {
        SCOPED_TRACE("seed 11, pair " + std::to_string(i));
        const Vec3 half_a = random.vector(0.2, 1), half_b = random.vector(0.2, 1);
        const Pose pose = random.pose(0.8);
        Vec3 normal;
        const double swept = sweep_directions(extent_of(corners_of(half_a), Pose{}),
                                              extent_of(corners_of(half_b), pose), 12, &normal);
        const auto found = boxes<double>(half_a, half_b, pose);
        if (swept > 0) {
            EXPECT_EQ(found.count, 0);
            continue;
        }
        const double bias = face_bias(half_a, half_b);
        expect_depth(deepest(found), swept, 1e-9, bias);
        // The axis that leads parts them nearly as well as the best one, or is nearly the best one.
        if ((found.normal - normal).norm() < 0.025) continue;
        const auto a = extent_of(corners_of(half_a), Pose{}),
                   b = extent_of(corners_of(half_b), pose);
        EXPECT_NEAR(-b(-found.normal) - a(found.normal), swept, 2 * bias);
    }
}

TEST(BoxBox, FindsTouchExactlyWhereBoxesOverlap)
{
    RandomShapes random(12);
    int overlapping = 0;
    for (int i = 0; i < 6000; ++i) {
        const Vec3 half_a = random.vector(0.05, 1), half_b = random.vector(0.05, 1);
        const Pose pose = random.pose(1.2);
        const double expected = truth(half_a, half_b, pose);
        const auto found = boxes<double>(half_a, half_b, pose);
        const auto rounded = boxes<float>(half_a, half_b, pose);
        ASSERT_EQ(found.count > 0, expected <= 0) << "seed 12, pair " << i;
        ASSERT_TRUE(features_differ(found) && features_differ(rounded)) << "seed 12, pair " << i;
        ASSERT_NEAR(found.normal.norm(), 1, 1e-12);
        if (expected > 0) continue;
        ++overlapping;
        const double bias = face_bias(half_a, half_b);
        ASSERT_GE(deepest(found), expected - 1e-9 - 2 * bias) << "seed 12, pair " << i;
        ASSERT_LE(deepest(found), expected + 1e-9 + 2 * bias) << "seed 12, pair " << i;
        if (expected > -1e-5) continue;
        ASSERT_NEAR(deepest(rounded), expected, 1e-5 + 2 * bias) << "seed 12, pair " << i;
    }
    EXPECT_GT(overlapping, 2400);
}

TEST(BoxBox, AnswersPairsThatBrokeOthers)
{
    for (const BrokenPair& pair : broken_pairs()) {
        for (const double scale : {1e-6, 1.0, 1e6}) {
            SCOPED_TRACE(std::string(pair.name) + ", scale " + std::to_string(scale));
            const Vec3 half_a = pair.a.size * (scale / 2), half_b = pair.b.size * (scale / 2);
            Pose b_in_a = inverse(pair.a.pose) * pair.b.pose;
            b_in_a.position *= scale;
            const double size = std::max(half_a.maxCoeff(), half_b.maxCoeff()) * 2;
            const double expected = pair.separation * scale, bias = face_bias(half_a, half_b);
            const double exact = truth(half_a, half_b, b_in_a);
            if (expected < 0) {
                EXPECT_NEAR(exact, expected, 1e-9 * size);
            } else {
                EXPECT_LE(exact, expected + 1e-9 * size);
                EXPECT_GT(exact, -1e-12 * size);
            }

            const auto found = boxes<double>(half_a, half_b, b_in_a, 1e-9 * size);
            const auto rounded = boxes<float>(half_a, half_b, b_in_a, 1e-5 * size);
            ASSERT_TRUE(all_finite(found) && all_finite(rounded));
            if (expected > 2e-9 * size) {
                EXPECT_EQ(found.count, 0);
                continue;
            }
            ASSERT_GT(found.count, 0);
            ASSERT_GT(rounded.count, 0);
            expect_depth(deepest(found), expected, 1e-9 * size, bias);
            expect_depth(deepest(rounded), expected, 1e-5 * size, bias);

            const auto swapped = boxes<double>(half_b, half_a, inverse(b_in_a), 1e-9 * size);
            expect_depth(deepest(swapped), deepest(found), 1e-9 * size, bias);
        }
    }
}

TEST(BoxBox, RestingBoxesShareFourPoints)
{
    for (const double size : {1e-6, 0.01, 1.0, 1e3, 1e6}) {
        const Vec3 half = Vec3::Constant(size);
        const auto found = boxes<double>(half, half, at(0, 0, 1.999 * size));
        ASSERT_EQ(found.count, 4) << size;
        EXPECT_EQ(found.normal, Vec3::UnitZ());
        for (const auto& point : found.points) {
            EXPECT_NEAR(point.separation, -0.001 * size, 1e-12 * size);
            EXPECT_NEAR(std::abs(point.position.x()), size, 1e-12 * size);
            EXPECT_NEAR(std::abs(point.position.y()), size, 1e-12 * size);
            EXPECT_NEAR(point.position.z(), 0.9995 * size, 1e-12 * size);
        }
        EXPECT_EQ(boxes<float>(half, half, at(0, 0, 1.999 * size)).count, 4);
    }
}

TEST(BoxBox, RestingBoxesKeepTheirFeaturesThroughNoise)
{
    RandomShapes random(13);
    const Vec3 half(0.5, 0.5, 0.5);
    for (const Pose& rest :
         {at(0, 0, 0.9999), at(0.2, 0.1, 0.9999), Pose{{0, 0, 0.9999}, tilt(Vec3::UnitZ(), 0.3)}}) {
        const auto first = boxes<float>(half, half, rest, 0.01);
        ASSERT_EQ(first.count, 4);
        for (int i = 0; i < 200; ++i) {
            Pose noisy = rest;
            noisy.position += random.vector(-1e-5, 1e-5);
            noisy.orientation = tilt(random.vector(-1, 1), 1e-6) * noisy.orientation;
            const auto found = boxes<float>(half, half, noisy, 0.01);
            ASSERT_EQ(found.count, 4);
            int kept = 0;
            for (const auto& x : found.points) {
                for (const auto& y : first.points) kept += x.feature == y.feature;
            }
            ASSERT_GE(kept, rest.orientation.z() > 0 ? 3 : 4) << "seed 13, try " << i;
        }
    }
}

TEST(BoxBox, NormalTurnsNoFasterThanTheBox)
{
    const Vec3 half(0.5, 0.4, 0.3);
    for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(1, 0.3, 0.7)}) {
        for (const double angle : {1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2}) {
            const Pose pose{{0.1, 0.05, 0.599}, tilt(axis, angle)};
            const auto found = boxes<double>(half, half, pose, 0.02);
            EXPECT_GE(found.count, 4) << angle;
            EXPECT_LE((found.normal - Vec3::UnitZ()).norm(), 10 * angle) << angle;
            const auto rounded = boxes<float>(half, half, pose, 0.02);
            EXPECT_GE(rounded.count, 4) << angle;
            EXPECT_LE((rounded.normal - Vec3T<float>::UnitZ()).norm(), 10 * angle + 1e-6) << angle;
        }
    }
}

TEST(BoxBox, SeparationIsContinuousThroughTouch)
{
    RandomShapes random(14);
    for (const double size : {0.01, 0.25, 0.5, 10.0, 1000.0}) {
        const Vec3 half = Vec3::Constant(size / 2);
        for (int turns = 0; turns < 3; ++turns) {
            // Face on face, then a corner on the middle of a's face.
            const Quat turn = turns == 0 ? Quat(Quat::Identity()) : random.turn();
            Vec3 lowest = turn * corners_of(half)[0];
            for (const Vec3& corner : corners_of(half)) {
                if ((turn * corner).x() < lowest.x()) lowest = turn * corner;
            }
            if (turns == 0) lowest = {-half.x(), 0, 0};
            double last = -1;
            for (int k = -15; k <= 15; ++k) {
                const Pose pose{Vec3(half.x() + k * 1e-15 * size, 0, 0) - lowest, turn};
                const auto found = boxes<double>(half, half, pose, 1e-9 * size);
                ASSERT_GT(found.count, 0);
                EXPECT_NEAR(deepest(found), k * 1e-15 * size, 1e-14 * size);
                EXPECT_GE(deepest(found), last - 1e-15 * size);
                last = deepest(found);
            }
        }
    }
}

TEST(BoxBox, NeedlesAndPlatesKeepTheirDepth)
{
    RandomShapes random(15);
    const Vec3 cube = Vec3::Constant(0.5);
    for (const Vec3& half : {Vec3(1000, 0.0005, 0.0005), Vec3(500, 500, 0.0005)}) {
        for (int i = 0; i < 1000; ++i) {
            const Pose pose{random.vector(-0.4, 0.4), random.turn()};
            const auto found = boxes<double>(half, cube, pose);
            ASSERT_TRUE(all_finite(found) && found.count > 0) << "seed 15, pair " << i;
            ASSERT_TRUE(all_finite(boxes<float>(half, cube, pose)));
            const double expected = truth(half, cube, pose), bias = face_bias(half, cube);
            ASSERT_GE(deepest(found), expected - 2 * bias - 5e-10) << "seed 15, pair " << i;
            ASSERT_LE(deepest(found), expected + 2 * bias + 5e-10) << "seed 15, pair " << i;
        }
    }
}

TEST(BoxBox, ConcentricBoxesPartByTheLeastWay)
{
    for (const double ratio : {1.0, 1.5, 10.0, 100.0}) {
        const Vec3 half_a(1, 2, 3), half_b = half_a / ratio;
        const auto found = boxes<double>(half_a, half_b, Pose{});
        ASSERT_GT(found.count, 0);
        EXPECT_NEAR(deepest(found), -(1 + 1 / ratio), 1e-9);
        EXPECT_NEAR(std::abs(found.normal.x()), 1, 1e-12);
        EXPECT_TRUE(all_finite(boxes<float>(half_a, half_b, Pose{})));
    }
}

TEST(BoxBox, SwappingTheBoxesMirrorsTheManifold)
{
    RandomShapes random(16);
    int compared = 0;
    for (int i = 0; i < 3000; ++i) {
        SCOPED_TRACE("seed 16, pair " + std::to_string(i));
        const Vec3 half_a = random.vector(0.2, 1), half_b = random.vector(0.2, 1);
        const Pose pose = random.pose(0.9);
        const auto one = boxes<double>(half_a, half_b, pose);
        const auto two = boxes<double>(half_b, half_a, inverse(pose));
        ASSERT_EQ(one.count > 0, two.count > 0);
        if (one.count == 0) continue;
        const Vec3 back = pose.orientation * -two.normal;
        // Within the bias either box's face may lead.
        if ((back - one.normal).norm() > 1e-9) {
            ASSERT_NEAR(deepest(one), deepest(two), 3 * face_bias(half_a, half_b));
            continue;
        }
        ++compared;
        ASSERT_EQ(one.count, two.count);
        // Of more than four corners each side keeps its own four.
        ASSERT_NEAR(deepest(one), deepest(two),
                    one.count < 4 ? 1e-12 : kDrawn<double> * (half_a + half_b).norm());
        for (int k = 0; one.count < 4 && k < one.count; ++k) {
            double nearest = 1;
            for (int m = 0; m < two.count; ++m) {
                const Vec3 position = pose * two.points[static_cast<std::size_t>(m)].position;
                nearest = std::min(
                    nearest, (position - one.points[static_cast<std::size_t>(k)].position).norm());
            }
            ASSERT_LT(nearest, 1e-9);
        }
    }
    EXPECT_GT(compared, 1000);
}

TEST(BoxBox, RememberingNeverChangesTheAnswer)
{
    RandomShapes random(17);
    for (int i = 0; i < 300; ++i) {
        const Shapes shapes = two_boxes(random.vector(0.2, 1), random.vector(0.2, 1));
        Pose pose = random.pose(1.5);
        PairCache cache;
        for (int step = 0; step < 20; ++step) {
            pose.position += random.vector(-0.1, 0.1);
            LocalManifold<float> warm,
                cold = run<float>(box_box<float>, shapes, kBoxA, kBoxB, pose, 0.02);
            box_box<float>({shapes, kBoxA, kBoxB, cast<float>(pose), 0.02f}, cache, warm);
            ASSERT_EQ(warm.count, cold.count) << "seed 17, pair " << i;
            for (int k = 0; k < warm.count; ++k) {
                const auto at = static_cast<std::size_t>(k);
                ASSERT_EQ(warm.points[at].feature, cold.points[at].feature);
                ASSERT_EQ(warm.points[at].separation, cold.points[at].separation);
            }
        }
    }
}

TEST(BoxBox, ReportsPointsWithinTheMarginBeforeTheyTouch)
{
    const Vec3 half(0.5, 0.5, 0.5);
    const auto near = boxes<double>(half, half, at(0, 0, 1.005), 0.01);
    ASSERT_EQ(near.count, 4);
    EXPECT_NEAR(deepest(near), 0.005, 1e-12);
    EXPECT_EQ(boxes<double>(half, half, at(0, 0, 1.02), 0.01).count, 0);

    // Edge across edge, a hair apart: one point, on the line between the centers.
    const double clearance = 0.004, diagonal = std::sqrt(0.5);
    const Quat about_x(std::sqrt((1 + diagonal) / 2), std::sqrt((1 - diagonal) / 2), 0, 0);
    const Quat about_y(std::sqrt((1 + diagonal) / 2), 0, std::sqrt((1 - diagonal) / 2), 0);
    const Pose a{Vec3::Zero(), about_x}, b{{0, 0, 2 * diagonal + clearance}, about_y};
    const auto edges = boxes<double>(half, half, inverse(a) * b, 0.01);
    ASSERT_EQ(edges.count, 1);
    EXPECT_NEAR(edges.points[0].separation, clearance, 1e-12);
    EXPECT_LT((a * edges.points[0].position - Vec3(0, 0, diagonal + clearance / 2)).norm(), 1e-9);
}

}  // namespace throng
