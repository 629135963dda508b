// Free rotation: what is kept, and how near the parts come to what they stand for.
#include "kernels/dynamics/free_rotation.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace throng {
namespace {

struct Turning {
    Quat orientation = Quat::Identity();
    Vec3 momentum;
};

Turning after(const Vec3& moments, const Vec3& momentum, double span, int parts)
{
    Turning out{Quat::Identity(), momentum};
    turn_freely(free_rotation(moments), span, parts, out.momentum,
                [&](const Vec3& turn) { out.orientation = out.orientation * exponential(turn); });
    return out;
}

TEST(FreeRotation, TellsTheMiddleMoment)
{
    EXPECT_EQ(free_rotation(Vec3(1, 2, 3)).middle, 1);
    EXPECT_EQ(free_rotation(Vec3(3, 1, 2)).middle, 2);
    EXPECT_EQ(free_rotation(Vec3(2, 3, 1)).middle, 0);
    // Of two alike it is one of them.
    for (const Vec3& moments : {Vec3(1, 1, 2), Vec3(1, 2, 1), Vec3(2, 1, 1), Vec3(1, 2, 2)}) {
        const FreeRotation rotation = free_rotation(moments);
        EXPECT_EQ(rotation.outer * rotation.inner, 0) << moments.transpose();
    }
}

// A symmetric body: in parts or as one, it is where precession and spin have it.
TEST(FreeRotation, IsExactWithAnAxisOfSymmetry)
{
    for (const double along : {0.001, 0.5, 1.9}) {
        const Vec3 moments(1, 1, along), momentum(0.3, -0.2, 4);
        const double span = 0.7;
        const Turning one = after(moments, momentum, span, 1);
        const Turning many = after(moments, momentum, span, 8);
        EXPECT_LE(one.orientation.angularDistance(many.orientation), 1e-7) << along;
        const Quat wanted = exponential(span * momentum)
            * exponential(Vec3(0, 0, span * momentum.z() * (1 / along - 1)));
        EXPECT_LE(one.orientation.angularDistance(wanted), 1e-7) << along;
    }
}

TEST(FreeRotation, KeepsMomentumInSpaceAndIsOfSecondOrder)
{
    const Vec3 moments(1, 2, 3), momentum(1, 4, 9);
    const Turning exact = after(moments, momentum, 1, 20000);
    double error[2];
    for (int k = 0; k < 2; ++k) {
        const Turning now = after(moments, momentum, 1, k == 0 ? 50 : 100);
        EXPECT_LE((now.orientation * now.momentum - momentum).norm(), 1e-13);
        error[k] = now.orientation.angularDistance(exact.orientation);
    }
    EXPECT_NEAR(std::log2(error[0] / error[1]), 2, 0.02);
}

TEST(FreeRotation, AsksForMorePartsTheFasterItNods)
{
    const FreeRotation rotation = free_rotation(Vec3(1, 2, 3));
    EXPECT_EQ(parts_of(rotation, 0, 1, 100), 1);
    EXPECT_EQ(parts_of(rotation, 100, 0.1, 100), 29);  // sqrt(1 / 12) 10 / 0.1
    EXPECT_EQ(parts_of(rotation, 1e4, 0.1, 100), 0);
    EXPECT_EQ(parts_of(rotation, NAN, 0.1, 100), 0);
    EXPECT_EQ(parts_of(free_rotation(Vec3(1, 1, 3)), 1e9, 1, 100), 1);
}

}  // namespace
}  // namespace throng
