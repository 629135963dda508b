#include "narrowphase/alternatives/direction_cone.hpp"

#include "kernels/geometry/support.hpp"
#include "tests/support/polyhedra.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

// Differences that all agree with one direction; many in one plane, or the same again.
std::vector<Vec3> agreeing(RandomShapes& random, const Vec3& direction, int kind)
{
    const Vec3 side = any_perpendicular(direction);
    std::vector<Vec3> differences;
    for (int i = 0; i < 24; ++i) {
        Vec3 r = random.vector(-1, 1);
        if (kind == 1) r = (direction * random.number(-1, 1) + side * random.number(-1, 1));
        if (kind == 2)
            for (double& x : r) x = std::round(1.4 * x);
        if (kind == 3 && i > 3) r = differences[static_cast<std::size_t>(i % 4)];
        // Some of them nearly across the direction.
        if (kind == 4) r -= direction * r.dot(direction) * (1 - 1e-9);
        if (r.dot(direction) < 0) r = -r;
        if (r.norm() > 0 && r.normalized().dot(direction) > 1e-11)
            differences.push_back(r.normalized());
    }
    return differences;
}

bool leave_nothing(const std::vector<Vec3>& differences)
{
    DirectionCone cone;
    for (const Vec3& r : differences)
        if (!cone.add(r)) return true;
    return false;
}

}  // namespace

TEST(DirectionCone, HoldsWhatAllDifferencesAgreeWith)
{
    RandomShapes random(81);
    for (int i = 0; i < 5000; ++i) {
        SCOPED_TRACE("seed 81, case " + std::to_string(i));
        Vec3 direction = random.vector(-1, 1).normalized();
        if (i % 5 == 2) direction = Vec3(3, 2, 1).normalized();
        DirectionCone cone;
        for (const Vec3& r : agreeing(random, direction, i % 5)) {
            ASSERT_TRUE(cone.add(r));
            ASSERT_TRUE(cone.holds(direction));
            ASSERT_TRUE(cone.holds(cone.middle()));
            ASSERT_NEAR(cone.middle().norm(), 1, 1e-12);
        }
        EXPECT_FALSE(cone.holds(-direction));
    }
}

TEST(DirectionCone, IsEmptyOnceADifferenceOpposesAMixOfOthers)
{
    RandomShapes random(82);
    for (int i = 0; i < 5000; ++i) {
        SCOPED_TRACE("seed 82, case " + std::to_string(i));
        Vec3 direction = random.vector(-1, 1).normalized();
        if (i % 5 == 2) direction = Vec3(3, 2, 1).normalized();
        std::vector<Vec3> differences = agreeing(random, direction, i % 5);
        if (differences.size() < 3) continue;
        DirectionCone cone;
        Vec3 mix = Vec3::Zero();
        for (const Vec3& r : differences) {
            ASSERT_TRUE(cone.add(r));
            mix += r * random.number(0, 1);
        }
        differences.push_back(-mix.normalized());
        ASSERT_FALSE(cone.add(differences.back()));

        // By itself the witness says the same, if not by less than rounding.
        const DirectionCone::Witness witness = cone.witness();
        ASSERT_GE(witness.count, 2);
        ASSERT_LE(witness.count, 4);
        std::vector<Vec3> named;
        for (int k = 0; k < witness.count; ++k) {
            const int index = witness.differences[static_cast<std::size_t>(k)];
            ASSERT_LT(index, cone.count());
            named.push_back(differences[static_cast<std::size_t>(index)]);
        }
        if (i % 5 == 0) {
            ASSERT_TRUE(leave_nothing(named));
        }
    }
}

TEST(DirectionCone, TakesNoMoreThanItHasRoomFor)
{
    RandomShapes random(83);
    DirectionCone cone;
    for (int i = 0; i < 3 * DirectionCone::kCapacity; ++i) {
        Vec3 r = random.vector(-1, 1);
        r.z() = std::abs(r.z()) + 1;
        ASSERT_TRUE(cone.add(r.normalized()));
    }
    EXPECT_EQ(cone.count(), DirectionCone::kCapacity);
    EXPECT_TRUE(cone.holds(cone.middle()));
}

}  // namespace throng
