#include "kernels/solver/direct/cones.hpp"

#include "tests/support/dice.hpp"

#include <gtest/gtest.h>

namespace throng::test {
namespace {

ConeVector inner_vector(Dice& dice, std::size_t rows)
{
    ConeVector a{};
    for (std::size_t k = 1; k < rows; ++k) a[k] = dice.between(-1, 1);
    a[0] = width(a) + dice.between(0.01, 1);
    return a;
}

ConeVector any_vector(Dice& dice, std::size_t rows)
{
    ConeVector a{};
    for (std::size_t k = 0; k < rows; ++k) a[k] = dice.between(-1, 1);
    return a;
}

void expect_same(const ConeVector& a, const ConeVector& b, double tolerance)
{
    for (std::size_t k = 0; k < kConeRows; ++k) EXPECT_NEAR(a[k], b[k], tolerance);
}

constexpr std::size_t kRows[] = {1, 3, 4, 6};

TEST(Cones, QuotientUndoesTheProduct)
{
    Dice dice(1);
    for (int i = 0; i < 200; ++i)
        for (const std::size_t rows : kRows) {
            const ConeVector a = inner_vector(dice, rows), b = any_vector(dice, rows);
            expect_same(quotient(product(a, b), a), b, 1e-11);
        }
}

TEST(Cones, ScalingTakesSpeedAndImpulseToOnePoint)
{
    Dice dice(2);
    for (int i = 0; i < 200; ++i)
        for (const std::size_t rows : kRows) {
            const ConeVector speed = inner_vector(dice, rows), impulse = inner_vector(dice, rows);
            const ConeScaling scaling(speed, impulse);
            expect_same(scaling.map(impulse), scaling.inverse(speed), 1e-11);
            const ConeVector other = any_vector(dice, rows);
            expect_same(scaling.inverse(scaling.map(other)), other, 1e-11);
            ConeVector squared{};
            for (std::size_t k = 0; k < rows; ++k)
                squared[k] = dot(scaling.inverse_squared(k, rows), other);
            const ConeVector twice = scaling.inverse(scaling.inverse(other));
            expect_same(squared, twice, 1e-9 * (1 + std::abs(twice[0])));
        }
}

TEST(Cones, LongestStepEndsOnTheBoundary)
{
    Dice dice(3);
    int ended = 0;
    for (int i = 0; i < 400; ++i)
        for (const std::size_t rows : kRows) {
            const ConeVector from = inner_vector(dice, rows), step = any_vector(dice, rows);
            const double t = longest_step(from, step);
            ASSERT_GE(t, 0);
            ASSERT_LE(t, 1);
            for (const double share : {0.25, 0.5, 0.75, 0.999}) {
                const ConeVector on_the_way = sum(from, step, share * t);
                EXPECT_GE(on_the_way[0], width(on_the_way) - 1e-12);
            }
            if (t == 1) continue;
            ++ended;
            const ConeVector end = sum(from, step, t);
            EXPECT_NEAR(end[0], width(end), 1e-9);
        }
    EXPECT_GT(ended, 100);
}

TEST(Cones, ProjectionIsInTheConeAndSquareToWhatItTookAway)
{
    Dice dice(4);
    for (int i = 0; i < 200; ++i)
        for (const std::size_t rows : kRows) {
            const ConeVector a = any_vector(dice, rows), b = projected(a);
            const ConeVector taken = sum(b, a, -1);  // lies in the cone as well, which is its dual
            EXPECT_GE(b[0], width(b) - 1e-12);
            EXPECT_GE(taken[0], width(taken) - 1e-12);
            EXPECT_NEAR(dot(taken, b), 0, 1e-12);
        }
}

}  // namespace
}  // namespace throng::test
