// Orientation: the ways to hold it say the same, and what each promises of its numbers.
#include "kernels/dynamics/orientation.hpp"

#include "kernels/math/rotation.hpp"
#include "tests/support/dice.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace throng {
namespace {

constexpr Rotation kAll[] = {Rotation::quaternion,   Rotation::rotation_vector,
                             Rotation::matrix,       Rotation::quaternion_euler,
                             Rotation::matrix_euler, Rotation::matrix_euler_repaired};

double between(const Quat& a, const Quat& b) { return 2 * (a.conjugate() * b).vec().norm(); }

TEST(Orientation, IsReadAsItWasWritten)
{
    test::Dice dice(71);
    for (int i = 0; i < 500; ++i) {
        const Quat turn = dice.turn();
        for (const Rotation rotation : kAll) {
            const OrientationNumbers numbers = write_orientation(rotation, turn);
            EXPECT_LT(between(turn, read_orientation(rotation, numbers.data())), 1e-14);
            EXPECT_LT((matrix_of(rotation, numbers.data()) - turn.toRotationMatrix()).norm(),
                      1e-14);
        }
    }
}

TEST(Orientation, OfHalfATurnAndOfNoneIsARotationVectorToo)
{
    for (const Vec3& turn : {Vec3(0, 0, 0), Vec3(3.141592653589793, 0, 0), Vec3(1e-12, 0, 0),
                             Vec3(0, -3.1415926535, 0)}) {
        const OrientationNumbers numbers =
            write_orientation(Rotation::rotation_vector, exponential(turn));
        EXPECT_LT(
            between(exponential(turn), read_orientation(Rotation::rotation_vector, numbers.data())),
            1e-15);
    }
}

TEST(Orientation, TurnedOnByAVectorIsTheProductOfBoth)
{
    test::Dice dice(72);
    for (int i = 0; i < 200; ++i) {
        const Quat start = dice.turn();
        const Vec3 turn = dice.point(9);
        for (const Rotation rotation :
             {Rotation::quaternion, Rotation::rotation_vector, Rotation::matrix}) {
            OrientationNumbers numbers = write_orientation(rotation, start);
            turn_on(rotation, turn, numbers.data());
            EXPECT_LT(
                between(start * exponential(turn), read_orientation(rotation, numbers.data())),
                1e-14);
        }
    }
}

TEST(Orientation, RatesAreThoseOfSmallTurns)
{
    test::Dice dice(73);
    constexpr double kSmall = 1e-6;
    for (const Rotation rotation : {Rotation::quaternion_euler, Rotation::matrix_euler}) {
        const Quat start = dice.turn();
        const Vec3 velocity(0.3, -1.2, 0.7);
        const OrientationNumbers numbers = write_orientation(rotation, start);
        double rates[9] = {};
        rates_of(rotation, numbers.data(), velocity, rates);
        const OrientationNumbers after =
            write_orientation(rotation, start * exponential(kSmall * velocity));
        for (std::size_t k = 0; k < static_cast<std::size_t>(numbers_of(rotation)); ++k)
            EXPECT_NEAR((after[k] - numbers[k]) / kSmall, rates[k], 2e-6);
    }
}

TEST(Orientation, OfAMatrixThatStrayedIsTheNearestRotation)
{
    // Euler's step of a matrix is the rotation by atan(turn), stretched across the axis.
    const Vec3 axis = Vec3(1, 2, 3) / std::sqrt(14.0);
    for (const double turn : {0.1, 1.0, 100.0}) {
        OrientationNumbers numbers = write_orientation(Rotation::matrix_euler, Quat::Identity());
        double rates[9] = {};
        rates_of(Rotation::matrix_euler, numbers.data(), turn * axis, rates);
        for (std::size_t k = 0; k < 9; ++k) numbers[k] += rates[k];
        const Quat wanted = exponential(std::atan(turn) * axis);
        EXPECT_LT(between(wanted, read_orientation(Rotation::matrix_euler, numbers.data())), 1e-13);
    }
    OrientationNumbers lost = {};  // no rotation at all
    lost[0] = lost[4] = 1;
    EXPECT_TRUE(read_orientation(Rotation::matrix_euler, lost.data()).coeffs().allFinite());
}

// The series must be that of the exponential map's own derivative, to the order it states.
TEST(RateOfTurn, CarriesATurnAlongItsVelocity)
{
    const Vec3 turn(0.04, -0.03, 0.02), velocity(0.7, 1.1, -0.4);
    constexpr double kSmall = 1e-5;
    const auto ahead = [&](double time) {
        return Quat(exponential(turn) * exponential(time * velocity));
    };
    const Vec3 rate = rate_of_turn(turn, velocity);
    EXPECT_LT(between(ahead(kSmall), exponential(turn + kSmall * rate)), 2e-10);
    EXPECT_GT(between(ahead(kSmall), exponential(turn + kSmall * velocity)), 1e-7);
}

}  // namespace
}  // namespace throng
