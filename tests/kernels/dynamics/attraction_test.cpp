// Attraction: strength / distance^2 outside the ball, and smoothly nothing in the middle of it.
#include "kernels/dynamics/attraction.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace throng {
namespace {

const AttractorForce kDraws{Vec3::Zero(), 5}, kDrives{Vec3::Zero(), -5};

double force(const AttractorForce& attractor, double distance, double substep)
{
    return attraction_pull(attractor, 2, distance * distance, substep) * distance;
}

TEST(Attraction, OutsideTheBallIsThatOfAPointToTheBit)
{
    for (const double substep : {0.0, 1e-3, 1e-2})
        for (const AttractorForce& attractor : {kDraws, kDrives}) {
            const double edge = std::cbrt(attraction_ball(attractor, substep));
            for (const double distance : {1.0001 * edge + 1e-6, edge + 0.3, edge + 1e6}) {
                const double square = distance * distance;
                EXPECT_EQ(attraction_pull(attractor, 2, square, substep),
                          2 * attractor.strength / (square * std::sqrt(square)));
                EXPECT_EQ(attraction_energy(attractor, 2, distance, substep),
                          2 * attractor.strength / distance);
            }
        }
}

TEST(Attraction, IsTheSlopeOfItsEnergyInAndOutOfTheBall)
{
    for (const AttractorForce& attractor : {kDraws, kDrives}) {
        const double substep = 1e-2, edge = std::cbrt(attraction_ball(attractor, substep));
        const double step = 1e-4 * edge;
        const double scale = std::abs(force(attractor, edge, substep));
        for (double share = 0.01; share < 2; share += 0.01) {
            const double at = share * edge;
            const double slope = (attraction_energy(attractor, 2, at - step, substep)
                                  - attraction_energy(attractor, 2, at + step, substep))
                / (2 * step);
            EXPECT_NEAR(force(attractor, at, substep), slope, 1e-6 * scale) << share;
        }
    }
}

TEST(Attraction, GoesOnSmoothlyAtTheEdgeAndIsNothingInTheMiddle)
{
    const double substep = 1e-2, edge = std::cbrt(attraction_ball(kDraws, substep));
    const double inside = force(kDraws, edge * (1 - 1e-9), substep);
    const double outside = force(kDraws, edge * (1 + 1e-9), substep);
    EXPECT_NEAR(inside / outside, 1, 1e-8);
    const auto slope = [&](double at) {
        return (force(kDraws, at * (1 + 1e-6), substep) - force(kDraws, at, substep)) / at * 1e6;
    };
    EXPECT_NEAR(slope(edge * (1 - 2e-6)) / slope(edge * (1 + 1e-6)), 1, 1e-4);
    EXPECT_LT(force(kDraws, 1e-6 * edge, substep), 1e-5 * outside);
    EXPECT_TRUE(std::isfinite(attraction_energy(kDraws, 2, 0, substep)));
}

// A substep follows it anywhere: nowhere does a swing turn by more than a sixth of a radian in one.
TEST(Attraction, IsNowhereTooSteepForItsSubstep)
{
    for (const double substep : {1e-4, 1e-2, 1.0}) {
        const double edge = std::cbrt(attraction_ball(kDraws, substep));
        for (double share = 0.001; share < 3; share += 0.001) {
            const double at = share * edge, little = 1e-6 * edge;
            const double steep =
                std::abs(force(kDraws, at + little, substep) - force(kDraws, at, substep))
                / (2 * little);
            EXPECT_LT(std::sqrt(steep) * substep, 1.0 / 6);
        }
    }
}

}  // namespace
}  // namespace throng
