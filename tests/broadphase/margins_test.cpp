// Margins: a fat box holds what it promises, and is not absurd.
#include "broadphase/margins.hpp"

#include "tests/broadphase/random_boxes.hpp"

#include <gtest/gtest.h>

namespace throng::test {
namespace {

Box3 moved(const Box3& box, const Vec3& by) { return {box.lower + by, box.upper + by}; }

TEST(Margins, ContainTheWholeNextStepAtAnySpeedAndScale)
{
    for (std::uint64_t seed = 1; seed <= 20000; ++seed) {
        Dice dice(seed);
        const double scale = std::pow(10, dice.between(-6, 6));
        const Vec3 center = dice.point(dice.chance(0.5) ? 1e7 : scale);
        const Box3 tight = box_around(center, scale * (Vec3::Ones() + dice.point(1)) / 2);
        const Vec3 velocity = dice.point(scale * std::pow(10, dice.between(-3, 6)));
        const double dt = 1.0 / 60;
        const Box3 fat = fattened(tight, velocity, scale, dt);
        for (const double part : {0.0, 0.3, 0.5, 1.0})
            ASSERT_TRUE(fat.contains(moved(tight, velocity * (dt * part)))) << "seed " << seed;
    }
}

TEST(Margins, ContainEightStepsOfASlowBody)
{
    const Box3 tight = box_around(Vec3::Zero(), Vec3::Ones());
    const Vec3 velocity(0.5, -1, 0);
    const double dt = 1.0 / 60;
    EXPECT_TRUE(fattened(tight, velocity, 1, dt).contains(moved(tight, 8 * dt * velocity)));
    EXPECT_FALSE(fattened(tight, velocity, 1, dt).contains(moved(tight, 16 * dt * velocity)));
}

TEST(Margins, LookAheadOnOneSideOnly)
{
    const Box3 tight = box_around(Vec3::Zero(), Vec3::Ones());
    const Box3 fat = fattened(tight, Vec3(1, 0, -1), 2, 0.01);
    const double base = MarginRule().base * 2;
    EXPECT_NEAR(fat.upper.x(), 1 + base + 0.08, 1e-12);
    EXPECT_NEAR(fat.lower.x(), -1 - base, 1e-12);
    EXPECT_NEAR(fat.upper.y(), 1 + base, 1e-12);
    EXPECT_NEAR(fat.lower.y(), -1 - base, 1e-12);
    EXPECT_NEAR(fat.upper.z(), 1 + base, 1e-12);
    EXPECT_NEAR(fat.lower.z(), -1 - base - 0.08, 1e-12);
}

TEST(Margins, OfAFastBodyAreOneStepAndNoMore)
{
    const Box3 tight = box_around(Vec3::Zero(), Vec3::Constant(0.1));
    const Box3 fat = fattened(tight, Vec3(1000, 0, 0), 0.1, 0.01);
    EXPECT_NEAR(fat.upper.x(), 0.1 + 10 + MarginRule().base * 0.1, 1e-9);
}

TEST(Margins, StretchWherePairsAreFew)
{
    EXPECT_EQ(stretch_for(0, 0), 1);
    EXPECT_EQ(stretch_for(10, 1000), 4);
    EXPECT_EQ(stretch_for(500, 1000), 2);
    EXPECT_EQ(stretch_for(1000, 1000), 1);
}

TEST(Margins, AreLooseOnceTheBodyHasSlowedDownAndNotWhenJustMade)
{
    const double dt = 1.0 / 60;
    const Box3 tight = box_around(Vec3(7, -3, 2), Vec3::Ones());
    for (const double speed : {0.0, 1.0, 10.0, 1000.0}) {
        const Vec3 velocity(speed, 0, -speed);
        const Box3 fat = fattened(tight, velocity, 1, dt);
        EXPECT_FALSE(loose(fat, tight, velocity, 1, dt)) << speed;
        EXPECT_FALSE(loose(fat, tight, -velocity, 1, dt)) << speed;
        EXPECT_EQ(loose(fat, tight, Vec3::Zero(), 1, dt), speed > 6) << speed;
    }
    const Box3 everywhere = box_around(Vec3::Zero(), Vec3::Constant(HUGE_VAL));
    EXPECT_TRUE(loose(everywhere, tight, Vec3::Zero(), 1, dt));
}

TEST(Margins, BadVelocityLeavesTheBase)
{
    const Box3 tight = box_around(Vec3::Zero(), Vec3::Ones());
    const Box3 fat = fattened(tight, Vec3(std::nan(""), HUGE_VAL, 0), 1, 0.01);
    EXPECT_TRUE(fat.lower.allFinite() && fat.upper.allFinite());
    EXPECT_TRUE(fat.contains(tight));
}

TEST(Margins, OfAPlaneStayInfinite)
{
    Box3 plane = box_around(Vec3::Zero(), Vec3::Constant(HUGE_VAL));
    plane.lower = Vec3::Constant(-HUGE_VAL);
    plane.upper = Vec3(HUGE_VAL, HUGE_VAL, 0);
    const Box3 fat = fattened(plane, Vec3(1, 1, 1), 1, 0.01);
    EXPECT_TRUE(fat.contains(plane));
    EXPECT_LT(fat.upper.z(), 1);
}

}  // namespace
}  // namespace throng::test
