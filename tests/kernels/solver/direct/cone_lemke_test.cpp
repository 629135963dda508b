#include "kernels/solver/direct/cone_lemke.hpp"

#include "tests/kernels/solver/direct/direct_problems.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace throng::test {
namespace {

double residual_of(const ContactCones& island)
{
    std::vector<BodySix> scratch;
    return island.residual(scratch);
}

ContactCones island_of(const Problem& problem)
{
    ContactCones island;
    EXPECT_TRUE(island.take(problem.bodies, problem.points));
    return island;
}

// Friction is off its way by half a side's width at most, which misses the law by its sine.
TEST(ConeLemke, HeapsAreOffByASidesWidth)
{
    Dice dice(31);
    for (const double friction : {0.3, 0.6, 0.9})
        for (int round = 0; round < 10; ++round) {
            ContactCones island = island_of(heap(dice, 8, friction));
            ASSERT_TRUE(ConeLemke(island).run(0));
            double load = 0;
            for (const ContactCone& cone : island.cones) {
                EXPECT_LE(width(cone.impulse), cone.impulse[0] * (1 + 1e-12));
                load = std::max(load, cone.impulse[0]);
            }
            const double half_a_side = std::numbers::pi / 8;
            EXPECT_LT(residual_of(island), load * std::sin(half_a_side));
        }
}

TEST(ConeLemke, WithoutFrictionTheyAreExact)
{
    Dice dice(32);
    for (int round = 0; round < 10; ++round) {
        ContactCones island = island_of(heap(dice, 20, 0));
        ASSERT_TRUE(ConeLemke(island).run(0));
        // What rows are set apart by, times a share of how ill the problem is.
        EXPECT_LT(residual_of(island), 1e-6);
    }
}

TEST(ConeLemke, PointsToldTwiceAndFacesThatBearAlikeAreNoTrouble)
{
    Problem problem = stack(4);
    const std::vector<DirectPoint> once = problem.points;
    problem.points.insert(problem.points.end(), once.begin(), once.end());
    ContactCones island = island_of(problem);
    ASSERT_TRUE(ConeLemke(island).run(0));
    EXPECT_LT(residual_of(island), 1e-6);
}

// What slides at one point and cannot turn slides straight on, against its friction.
TEST(ConeLemke, CloserSidesComeCloser)
{
    for (int k = 0; k < 40; ++k) {
        const double angle = 0.157 * k, half_a_side = std::numbers::pi / 8;
        Problem problem;
        problem.bodies.push_back(box(1, Vec3::Ones()));
        problem.bodies[0].inverse_inertia = {};
        problem.bodies[0].velocity += Vec3(std::cos(angle), std::sin(angle), 0);
        problem.points.resize(1);
        problem.points[0].b = 0;
        problem.points[0].friction = 0.1;
        ContactCones island = island_of(problem);
        const auto off = [&] {
            const ContactCone& cone = island.cones[0];
            double along = 0;
            for (std::size_t i = 1; i < 3; ++i) along -= cone.free[i] * cone.impulse[i];
            return std::acos(std::min(1.0, along / (width(cone.free) * width(cone.impulse))));
        };
        ConeLemke pivots(island);
        ASSERT_TRUE(pivots.run(0));
        EXPECT_LT(off(), half_a_side * (1 + 1e-6));
        for (const int closer : {1, 2, 3, 4}) ASSERT_TRUE(pivots.run(closer));
        EXPECT_LT(off(), half_a_side / 4);
    }
}

TEST(ConeLemke, FrictionOfTurningIsSidedToo)
{
    Problem problem = stack(2);
    problem.bodies[1].spin = Vec3(0.1, 0.05, 0.2);
    for (DirectPoint& point : problem.points) point.rolling = 0.1;
    ContactCones island = island_of(problem);
    ASSERT_TRUE(ConeLemke(island).run(0));
    for (const ContactCone& cone : island.cones)
        EXPECT_LE(width(cone.impulse), cone.impulse[0] * (1 + 1e-12));
    for (const ContactCone& cone : island.cones) EXPECT_TRUE(std::isfinite(cone.impulse[0]));
    EXPECT_LT(residual_of(island), 0.5);
}

TEST(ConeLemke, TooManyPointsAreLeftAsTheyWere)
{
    ContactCones island = island_of(stack(60));
    for (ContactCone& cone : island.cones) cone.impulse = {0.25};
    EXPECT_FALSE(ConeLemke(island).run(0));
    for (const ContactCone& cone : island.cones) EXPECT_EQ(cone.impulse[0], 0.25);
}

}  // namespace
}  // namespace throng::test
