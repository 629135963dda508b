// Quad truth: the answer sheet of the convex cases, against published values and closed forms; and
// the certified pairs against it.
#include "cost/hard_cases/quad_truth.hpp"

#include "cost/hard_cases/broken_pairs.hpp"
#include "cost/hard_cases/certified_pairs.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace throng {
namespace {

QuadSolid as_given(const PlacedBox& box)
{
    return quad_box(box.size / 2,
                    box.turn ? QuadPose(*box.turn, box.pose.position) : QuadPose(box.pose));
}
QuadSolid made_unit(const PlacedBox& box) { return quad_box(box.size / 2, QuadPose(box.pose)); }

TEST(QuadTruth, GivesThePublishedValuesOfBrokenPairs)
{
    ASSERT_EQ(broken_pairs().size(), 15u);
    for (const BrokenPair& pair : broken_pairs()) {
        const double size = std::max(pair.a.size.norm(), pair.b.size.norm()) / 2;
        const QuadSolid a = as_given(pair.a), b = as_given(pair.b);
        // Sixteen digits were published; turns given as quaternions were made unit in double there.
        EXPECT_NEAR(quad_truth(a, b).separation, pair.separation, 3e-16 * size) << pair.name;
        EXPECT_NEAR(quad_truth(b, a).separation, pair.separation, 3e-16 * size) << pair.name;
        // Made unit, the shapes are others by what the published turns lack.
        EXPECT_NEAR(quad_truth(made_unit(pair.a), made_unit(pair.b)).separation, pair.separation,
                    1e-9 * size)
            << pair.name;
        if (pair.separation < -1e-12) {
            EXPECT_NEAR(quad_separation_along(a, b, pair.normal), pair.separation, 2e-9 * size)
                << pair.name;
        }
    }
}

TEST(QuadTruth, KnowsDistancesOfFacesEdgesAndCorners)
{
    const Vec3 half(0.5, 0.5, 0.5);
    const QuadSolid a = quad_box(half, QuadPose(Pose{}));
    const auto distance = [&](const Vec3& shift) {
        return quad_truth(a, quad_box(half, QuadPose(Pose{shift, Quat::Identity()}))).separation;
    };
    EXPECT_EQ(distance({1.25, 0.1, 0.2}), 0.25);
    EXPECT_EQ(distance({1.3, -1.4, 0.2}), std::hypot(1.3 - 1, 1.4 - 1));
    EXPECT_NEAR(distance({1.5, 1.5, -1.5}), std::sqrt(0.75), 1e-16);
    EXPECT_EQ(distance({0.75, 0, 0}), -0.25);
    EXPECT_EQ(distance({0, 0, 0}), -1);
    EXPECT_EQ(distance({1, 1, 0}), 0);
    // Two edges that cross in the air: each a half diagonal from its cube's center.
    const Quat eighth(std::cos(M_PI / 8), std::sin(M_PI / 8), 0, 0);
    const Quat other(std::cos(M_PI / 8), 0, std::sin(M_PI / 8), 0);
    const double crossed = quad_truth(quad_box(half, QuadPose(Pose{Vec3::Zero(), eighth})),
                                      quad_box(half, QuadPose(Pose{Vec3(0, 0, 2), other})))
                               .separation;
    EXPECT_NEAR(crossed, 2 - std::sqrt(2.0), 1e-15);
}

TEST(QuadTruth, ACloudOfCornersIsTheBox)
{
    Random random(71);
    for (int i = 0; i < 40; ++i) {
        const Vec3 half(0.3, 0.5, 0.7);
        std::vector<Vec3> corners;
        for (unsigned k = 0; k < 8; ++k)
            corners.push_back(
                half.cwiseProduct(Vec3(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1)));
        const Pose pose{Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)),
                        random_turn(random)};
        const QuadSolid other = quad_box(Vec3(0.4, 0.2, 0.3), QuadPose(pose));
        const QuadTruth cloud = quad_truth(quad_cloud(corners, QuadPose(Pose{})), other);
        const QuadTruth box = quad_truth(quad_box(half, QuadPose(Pose{})), other);
        EXPECT_NEAR(cloud.separation, box.separation, 1e-16) << "seed 71, pair " << i;
    }
}

TEST(QuadTruth, SaysHowFarAPointIsOutside)
{
    const QuadSolid box = quad_box(Vec3(1, 2, 3), QuadPose(Pose{Vec3(1, 0, 0), Quat::Identity()}));
    EXPECT_EQ(quad_outside(box, Vec3(2.5, 0, 0)), 0.5);
    EXPECT_EQ(quad_outside(box, Vec3(1, 1.75, 0)), -0.25);
    EXPECT_EQ(quad_outside(box, Vec3(2, 0, 0)), 0);
}

TEST(CertifiedPairs, AreWhatTheyAreCertifiedToBe)
{
    Random random(72);
    int touching = 0, apart = 0;
    for (int i = 0; i < 300; ++i) {
        const Hull a = random_hull(random, 4 + i % 4), b = random_hull(random, 4 + i % 3);
        const CertifiedPair pair = certified_pair(a, b, random);
        const double found = quad_truth(quad_cloud(a.vertices, QuadPose(Pose{})),
                                        quad_cloud(b.vertices, QuadPose(pair.b_in_a)))
                                 .separation;
        const double noise = 1e-14 * certified_size(a, b);
        if (pair.touching) {
            EXPECT_LE(found, noise - pair.separation) << "seed 72, pair " << i;
        } else {
            EXPECT_GE(found, pair.separation - noise) << "seed 72, pair " << i;
        }
        ++(pair.touching ? touching : apart);
    }
    EXPECT_GT(std::min(touching, apart), 100);
}

}  // namespace
}  // namespace throng
