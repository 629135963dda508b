// Solver bodies: what a substep does to them, against the same in double.
#include "kernels/motion/solver_bodies.hpp"

#include "kernels/math/rotation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace throng {
namespace {

template <class Real>
SolverBody<Real> body_with(const Vec3& velocity, const Vec3& spin, double inverse_mass)
{
    SolverBody<Real> body = {};
    body.drift[7] = 1;
    for (int k = 0; k < 3; ++k) {
        body.motion[k] = static_cast<Real>(velocity[k]);
        body.motion[4 + k] = static_cast<Real>(spin[k]);
    }
    body.inertia[0] = static_cast<Real>(inverse_mass);
    return body;
}

Vec3 random_vector(std::mt19937& random, double size)
{
    std::normal_distribution<double> normal;
    return Vec3(normal(random), normal(random), normal(random)) * size;
}

TEST(SolverBodies, GravityActsOnWhatHasMassAlone)
{
    std::vector<SolverBody<float>> bodies = {body_with<float>(Vec3(1, 2, 3), Vec3::Zero(), 0.5),
                                             body_with<float>(Vec3(1, 2, 3), Vec3::Zero(), 0)};
    add_velocity<float>(bodies, Vec3(0, 0, -1));
    EXPECT_EQ(bodies[0].motion[2], 2);
    EXPECT_EQ(bodies[0].motion[3], 0);
    EXPECT_EQ(bodies[1].motion[2], 3);
}

TEST(SolverBodies, MoveByTheirVelocity)
{
    std::vector<SolverBody<double>> bodies = {body_with<double>(Vec3(1, -2, 4), Vec3(9, 9, 9), 1)};
    for (int i = 0; i < 4; ++i) move_bodies<double>(bodies, 0.25);
    EXPECT_EQ(bodies[0].drift[0], 1);
    EXPECT_EQ(bodies[0].drift[1], -2);
    EXPECT_EQ(bodies[0].drift[2], 4);
    EXPECT_EQ(turn_of(bodies[0]).coeffs(), Quat::Identity().coeffs());
}

template <class Real>
void check_turns(double tolerance)
{
    std::mt19937 random(1);
    for (int i = 0; i < 20000; ++i) {
        // From a breath to many turns a substep, across the end of the series.
        const Vec3 spin = random_vector(random, std::pow(10.0, -4 + 8.0 * i / 20000));
        std::vector<SolverBody<Real>> bodies = {body_with<Real>(Vec3::Zero(), spin, 1)};
        const Vec3 rounded(double{bodies[0].motion[4]}, double{bodies[0].motion[5]},
                           double{bodies[0].motion[6]});
        Quat wanted = Quat::Identity();
        const Real time = Real(1) / 256;
        for (int step = 0; step < 4; ++step) {
            turn_bodies<Real>(bodies, time);
            wanted = turned(wanted, rounded, double{time});
        }
        const Quat got = turn_of(bodies[0]);
        const double angle = rounded.norm() / 64;
        ASSERT_LE((got.coeffs() - wanted.coeffs()).norm(), tolerance * (1 + angle))
            << spin.transpose();
        ASSERT_NEAR(got.norm(), 1, tolerance);
    }
}

TEST(SolverBodies, TurnByTheExponentialMapHoweverFast)
{
    check_turns<float>(5e-7);
    check_turns<double>(1e-15);
}

TEST(SolverBodies, WhatDoesNotSpinKeepsItsTurnToTheLastBit)
{
    std::vector<SolverBody<float>> bodies = {body_with<float>(Vec3(1, 1, 1), Vec3::Zero(), 1)};
    bodies[0].drift[4] = 0.6f;
    bodies[0].drift[7] = 0.8f;
    turn_bodies<float>(bodies, 1.0f);
    EXPECT_EQ(bodies[0].drift[4], 0.6f);
    EXPECT_EQ(bodies[0].drift[7], 0.8f);
}

TEST(SolverBodies, WhatIsNotFiniteStaysSo)
{
    // The stage that takes bodies back counts on seeing it.
    for (const double spin : {1e25, HUGE_VAL, std::nan("")}) {
        std::vector<SolverBody<float>> bodies = {
            body_with<float>(Vec3::Zero(), Vec3(spin, 0, 0), 1)};
        turn_bodies<float>(bodies, 1.0f / 256);
        const Quat q = turn_of(bodies[0]);
        EXPECT_TRUE(!q.coeffs().allFinite() || std::abs(q.norm() - 1) < 1e-6) << spin;
    }
}

}  // namespace
}  // namespace throng
