// Rotation: sine and cosine against long double; turning against the closed form; the gyroscopic
// torque against what it may never do.
#include "kernels/math/rotation.hpp"

#include "kernels/math/turn_between.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace throng {
namespace {

constexpr double kPi = 3.14159265358979323846;

// How many units in the last place of the true value an answer is off.
double ulps_off(double answer, long double truth)
{
    int exponent = 0;
    std::frexp(static_cast<double>(truth), &exponent);
    return static_cast<double>(std::abs(static_cast<long double>(answer) - truth)
                               / std::ldexp(1.0L, exponent - 53));
}

double worst_over(double least, double most, int count, unsigned seed)
{
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> angles(least, most);
    double worst = 0;
    for (int i = 0; i < count; ++i) {
        const double angle = angles(random);
        const SinCos both = sin_cos(angle);
        worst = std::max({worst, ulps_off(both.sin, std::sin(static_cast<long double>(angle))),
                          ulps_off(both.cos, std::cos(static_cast<long double>(angle)))});
    }
    return worst;
}

Vec3 random_vector(std::mt19937_64& random, double size)
{
    std::normal_distribution<double> normal;
    return Vec3(normal(random), normal(random), normal(random)) * size;
}

Quat random_turn(std::mt19937_64& random)
{
    std::normal_distribution<double> normal;
    Quat q(normal(random), normal(random), normal(random), normal(random));
    q.coeffs() /= q.norm();
    return q;
}

// Moments that some body can have: of a box.
Sym3 random_inertia(std::mt19937_64& random, double thinnest)
{
    std::uniform_real_distribution<double> size(thinnest, 1.0);
    const double x = size(random), y = size(random), z = size(random);
    return {y * y + z * z, x * x + z * z, x * x + y * y, 0, 0, 0};
}

double energy(const Vec3& spin, const Sym3& inertia, const Quat& orientation)
{
    return 0.5 * spin.dot(in_world_axes(inertia, orientation).matrix() * spin);
}

TEST(SinCos, IsWithinTwoAndAHalfUnitsInTheLastPlace)
{
    EXPECT_LE(worst_over(-kPi / 4, kPi / 4, 200000, 1), 1.0);
    EXPECT_LE(worst_over(-10, 10, 200000, 2), 2.0);
    EXPECT_LE(worst_over(-1e3, 1e3, 200000, 3), 2.0);
    EXPECT_LE(worst_over(-1e5, 1e5, 200000, 4), 2.5);
}

TEST(SinCos, HoldsNextToEveryQuarterTurn)
{
    // The worst place of a reduction: nearly all digits cancel.
    double worst = 0;
    for (int quarters = -60000; quarters <= 60000; ++quarters) {
        const double angle = quarters * (kPi / 2);
        const SinCos both = sin_cos(angle);
        const auto exact = static_cast<long double>(angle);
        worst = std::max({worst, std::abs(both.sin - static_cast<double>(std::sin(exact))),
                          std::abs(both.cos - static_cast<double>(std::cos(exact)))});
    }
    EXPECT_LE(worst, 2.3e-16);
}

TEST(SinCos, OfZeroIsExact)
{
    EXPECT_EQ(sin_cos(0).sin, 0);
    EXPECT_EQ(sin_cos(0).cos, 1);
    EXPECT_EQ(sin_cos(1e-300).sin, 1e-300);
}

TEST(SinCos, StaysOnTheCircleHoweverFarTheAngle)
{
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> powers(0, 308);
    for (int i = 0; i < 100000; ++i) {
        const double angle = std::pow(10.0, powers(random)) * (i % 2 == 0 ? 1 : -1);
        const SinCos both = sin_cos(angle);
        ASSERT_NEAR(both.sin * both.sin + both.cos * both.cos, 1, 1e-12) << angle;
    }
}

TEST(SinCos, OfWhatIsNotFiniteIsNotFinite)
{
    for (const double angle : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
        EXPECT_FALSE(std::isfinite(sin_cos(angle).sin)) << angle;
        EXPECT_FALSE(std::isfinite(sin_cos(angle).cos)) << angle;
    }
}

TEST(Exponential, AgreesWithTheAxisAndAngle)
{
    std::mt19937_64 random(6);
    for (int i = 0; i < 20000; ++i) {
        const double size = std::pow(10.0, -12 + 14.0 * i / 20000);
        const Vec3 turn = random_vector(random, size);
        const Quat q = exponential(turn);
        const double half = turn.norm() / 2;
        ASSERT_NEAR(q.norm(), 1, 4e-16) << size;
        ASSERT_NEAR(q.w(), std::cos(half), 4e-16) << size;
        const Vec3 wanted = turn.normalized() * std::sin(half);
        ASSERT_LE((q.vec() - wanted).norm(),
                  1e-15 * std::min(1.0, half) + 1e-15 * std::abs(std::sin(half)) + 2e-16 * half)
            << size;
    }
}

TEST(Exponential, OfNothingIsNoTurn)
{
    const Quat q = exponential(Vec3::Zero());
    EXPECT_EQ(q.w(), 1);
    EXPECT_EQ(q.vec(), Vec3(Vec3::Zero()));
}

TEST(Turned, IsExactForAConstantSpinHoweverFast)
{
    std::mt19937_64 random(7);
    for (int i = 0; i < 2000; ++i) {
        const Vec3 spin = random_vector(random, std::pow(10.0, -3 + i % 7));
        const Quat start = random_turn(random);
        const double time = 0.25;
        // Once, and in 16 pieces.
        const Quat once = turned(start, spin, time);
        Quat pieces = start;
        for (int k = 0; k < 16; ++k) pieces = turned(pieces, spin, time / 16);
        const double angle = spin.norm() * time;
        ASSERT_LE((once.coeffs() - pieces.coeffs()).norm(), 1e-14 + 4e-16 * angle);
        // And by rotation matrices from Eigen.
        const Mat3 wanted = Eigen::AngleAxisd(angle, spin.normalized()).toRotationMatrix()
            * start.toRotationMatrix();
        ASSERT_LE((once.toRotationMatrix() - wanted).norm(), 1e-14 + 4e-16 * angle);
    }
}

TEST(Turned, KeepsUnitLengthOverAMillionTurns)
{
    std::mt19937_64 random(8);
    Quat q = random_turn(random);
    const Vec3 spin = random_vector(random, 20);
    for (int i = 0; i < 1000000; ++i) q = turned(q, spin, 1.0 / 240);
    EXPECT_NEAR(q.norm(), 1, 3e-16);
}

TEST(TurnBetween, TakesOneToTheOtherByTheLeastTurnHoweverOppositeTheyAre)
{
    std::mt19937_64 random(9);
    for (int i = 0; i < 2000; ++i) {
        const Vec3 from = random_vector(random, 1);
        // Anything; then ever nearer to the same and to the opposite direction, and those
        // themselves.
        Vec3 to = random_vector(random, 2);
        if (i % 4 != 0) {
            const double off = i % 40 < 4 ? 0 : std::pow(10.0, -(i % 20));
            to = (i % 2 == 0 ? from : -from) + off * to;
        }
        const Quat turn = turn_between(from, to);
        const Vec3 a = from.normalized(), b = to.normalized();
        ASSERT_NEAR(turn.squaredNorm(), 1, 2e-15) << i;
        ASSERT_LE((turn * a - b).norm(), 1e-14) << i;
        // The axis is across both and the angle at most half a turn: no other turn is less.
        ASSERT_LE(std::abs(turn.vec().dot(a)), 1e-15) << i;
        ASSERT_GE(turn.w(), 0) << i;
    }
}

TEST(InWorldAxes, AgreesWithTheBodySeenFromInside)
{
    std::mt19937_64 random(9);
    for (int i = 0; i < 1000; ++i) {
        const Sym3 inertia{2, 3, 4, 0.1, -0.2, 0.3};
        const Quat q = random_turn(random);
        const Vec3 spin = random_vector(random, 3);
        const Vec3 inside = q * Vec3(inertia.matrix() * (q.conjugate() * spin));
        ASSERT_LE((in_world_axes(inertia, q).matrix() * spin - inside).norm(), 4e-14);
    }
}

TEST(InWorldAxes, OfABallOrACubeStaysAsItIs)
{
    std::mt19937_64 random(11);
    for (int i = 0; i < 100; ++i) {
        const Quat q = random_turn(random);
        const double moment = std::ldexp(1.0 + 1e-3 * i, i - 50);
        const Sym3 turned = in_world_axes({moment, moment, moment, 0, 0, 0}, q);
        for (const double diagonal : {turned.xx, turned.yy, turned.zz}) ASSERT_EQ(diagonal, moment);
        for (const double off : {turned.xy, turned.xz, turned.yz}) ASSERT_EQ(off, 0);
    }
}

double momentum(const Vec3& spin, const Sym3& inertia, const Quat& orientation)
{
    return Vec3(in_world_axes(inertia, orientation).matrix() * spin).norm();
}

TEST(GyroscopicTorque, KeepsMomentumOrEnergyAndGainsNeither)
{
    std::mt19937_64 random(10);
    for (int i = 0; i < 200000; ++i) {
        const Sym3 inertia = random_inertia(random, i % 3 == 0 ? 1e-3 : 0.1);
        const Quat q = random_turn(random);
        const double time = 1.0 / 240;
        const Vec3 before = random_vector(random, std::pow(10.0, i % 5 - 1));
        const Vec3 after = after_gyroscopic_torque(before, inertia, q, time);
        ASSERT_TRUE(after.allFinite());
        const double energy_left = energy(after, inertia, q) / energy(before, inertia, q);
        const double momentum_left = momentum(after, inertia, q) / momentum(before, inertia, q);
        ASSERT_LE(energy_left, 1 + 1e-12) << "trial " << i << " spin " << before.transpose();
        ASSERT_LE(momentum_left, 1 + 1e-12) << "trial " << i << " spin " << before.transpose();
        // Of what turns by radians in this time a step may lose more than is made up for.
        if (before.norm() * time < 0.5) {
            ASSERT_GE(std::max(energy_left, momentum_left), 1 - 1e-12)
                << "trial " << i << " spin " << before.transpose();
        }
    }
}

TEST(GyroscopicTorque, LeavesTheSlowestSpinAlone)
{
    // Its squares are nothing, or have lost their digits.
    for (const double speed : {0.0, 1e-300, 1e-162, 1e-158}) {
        const Vec3 spin(speed, 2 * speed, -speed);
        const Sym3 inertia{1, 2, 2.5, 0, 0, 0};
        const Vec3 after = after_gyroscopic_torque(spin, inertia, Quat::Identity(), 0.01);
        EXPECT_LE((after - spin).norm(), 1e-15 * spin.norm()) << speed;
    }
}

TEST(GyroscopicTorque, LosesEnergyInTheThirdOrderOfTime)
{
    // A flying plate for a second: half the step loses an eighth as much.
    const auto lost = [](int steps) {
        const Sym3 inertia{1, 2, 2.9, 0, 0, 0};
        Quat q = Quat::Identity();
        Vec3 spin(0.3, 4, 0.2);
        const double before = energy(spin, inertia, q), time = 1.0 / steps;
        for (int i = 0; i < steps; ++i) {
            spin = after_gyroscopic_torque(spin, inertia, q, time);
            q = turned(q, spin, time);
        }
        return 1 - energy(spin, inertia, q) / before;
    };
    EXPECT_GT(lost(1000), 0);
    EXPECT_LT(lost(1000), 1e-4);
    EXPECT_NEAR(lost(1000) / lost(2000), 8, 0.8);
}

TEST(GyroscopicTorque, LeavesASpinAboutAPrincipalAxisAlone)
{
    const Sym3 inertia{1, 2, 3, 0, 0, 0};
    const Vec3 spin(0, 7, 0);
    EXPECT_EQ(after_gyroscopic_torque(spin, inertia, Quat::Identity(), 0.01), spin);
    EXPECT_EQ(after_explicit_gyroscopic_torque(spin, inertia, Quat::Identity(), 0.01), spin);
}

TEST(GyroscopicTorque, ExplicitAndImplicitAgreeForShortTimes)
{
    std::mt19937_64 random(11);
    for (int i = 0; i < 1000; ++i) {
        const Sym3 inertia = random_inertia(random, 0.3);
        const Quat q = random_turn(random);
        const Vec3 spin = random_vector(random, 2);
        const double time = 1e-6;
        const Vec3 a = after_gyroscopic_torque(spin, inertia, q, time);
        const Vec3 b = after_explicit_gyroscopic_torque(spin, inertia, q, time);
        // They differ in the second order of time.
        ASSERT_LE((a - b).norm(), 1e4 * time * time);
    }
}

}  // namespace
}  // namespace throng
