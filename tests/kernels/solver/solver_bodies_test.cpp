// Solver bodies: what a substep does to them besides contacts, against the same in double.
#include "kernels/solver/solver_bodies.hpp"

#include "kernels/math/rotation.hpp"
#include "kernels/solver/solve_kernels.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace throng {
namespace {

template <class Real>
SolverBody<Real> body_with(const Vec3& velocity, const Vec3& spin, double inverse_mass)
{
    SolverBody<Real> body = {};
    body.delta_pose[7] = 1;
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
    const double x = normal(random), y = normal(random), z = normal(random);
    return Vec3(x, y, z) * size;
}

// Moves and turns as a step does. Returns how many turned fast.
template <class Real>
std::size_t advance(std::vector<SolverBody<Real>>& bodies, Real time, bool turns = true)
{
    const std::size_t fast =
        solve_kernels<Real>().advance(bodies.data(), nullptr, nullptr, bodies.size(), time, turns);
    if (fast > 0) turn_fast<Real>(bodies, nullptr, time);
    return fast;
}

template <class Real>
void begin(std::vector<SolverBody<Real>>& bodies, const Vec3& gravity, bool first)
{
    Substep<Real> substep;
    for (int k = 0; k < 3; ++k) substep.gravity[k] = static_cast<Real>(gravity[k]);
    substep.time = Real(1) / 256;
    substep.first = first;
    solve_kernels<Real>().begin_substep(bodies.data(), nullptr, nullptr, bodies.size(), substep);
}

TEST(SolverBodies, GravityActsOnWhatHasMassAlone)
{
    std::vector<SolverBody<float>> bodies = {body_with<float>(Vec3(1, 2, 3), Vec3(4, 5, 6), 0.5),
                                             body_with<float>(Vec3(1, 2, 3), Vec3::Zero(), 0)};
    begin(bodies, Vec3(0, 0, -1), true);
    const float falls[8] = {1, 2, 2, 0, 4, 5, 6, 0}, flies[8] = {1, 2, 3, 0, 0, 0, 0, 0};
    for (int k = 0; k < 8; ++k) {
        EXPECT_EQ(bodies[0].motion[k], falls[k]);
        EXPECT_EQ(bodies[1].motion[k], flies[k]);
        EXPECT_EQ(bodies[0].free[k], falls[k]);
        EXPECT_EQ(bodies[1].free[k], flies[k]);
    }
}

TEST(SolverBodies, WhatContactsGaveInASubstepTheyGiveInTheNext)
{
    std::vector<SolverBody<double>> bodies = {body_with<double>(Vec3(0, 0, 4), Vec3(1, 2, 3), 0.5)};
    begin(bodies, Vec3(0, 0, -1), true);
    // Contacts push it up by 2 and spin it by 8.
    bodies[0].motion[2] += 2;
    bodies[0].motion[5] += 8;
    begin(bodies, Vec3(0, 0, -1), false);
    EXPECT_EQ(bodies[0].free[2], 4 - 1 + 2 - 1);
    EXPECT_EQ(bodies[0].motion[2], 4 - 1 + 2 - 1 + 2);
    EXPECT_EQ(bodies[0].free[5], 2 + 8);
    EXPECT_EQ(bodies[0].motion[5], 2 + 8 + 8);
    EXPECT_EQ(bodies[0].motion[4], 1);
}

TEST(SolverBodies, AFirstSubstepAsksNothingOfTheLastStep)
{
    std::vector<SolverBody<double>> bodies = {body_with<double>(Vec3(0, 0, 4), Vec3::Zero(), 1)};
    for (double& number : bodies[0].free) number = std::nan("");
    begin(bodies, Vec3(0, 0, -1), true);
    EXPECT_EQ(bodies[0].motion[2], 3);
    EXPECT_EQ(bodies[0].free[2], 3);
}

template <class Real>
void check_runaways()
{
    // Every place of a register, and what is left over.
    for (std::size_t count = 1; count <= 40; ++count)
        for (const double wrong : {1e17, -1.1e16, HUGE_VAL, -HUGE_VAL, std::nan("")})
            for (const int number : {0, 1, 2, 4, 5, 6}) {
                std::vector<SolverBody<Real>> bodies(
                    count, body_with<Real>(Vec3(1, 2, 3), Vec3(4, 5, 6), 1));
                for (auto& body : bodies) std::copy_n(body.motion, 8, body.free);
                SolverBody<Real>& away = bodies[count / 2];
                away.motion[number] = static_cast<Real>(wrong);
                away.inertia[1] = 1;
                begin(bodies, Vec3(0, 0, -1), false);
                for (auto& body : bodies) {
                    ASSERT_EQ(ran_away(body), &body == &away);
                    ASSERT_EQ(body.motion[2], &body == &away ? 0 : 2);
                }
                // It stands still for the rest of the step, whoever pushes.
                for (const Real x : away.motion) ASSERT_EQ(x, 0);
                for (const Real x : away.inertia) ASSERT_EQ(x, 0);
                begin(bodies, Vec3(0, 0, -1), false);
                advance(bodies, Real(1));
                ASSERT_TRUE(ran_away(away));
                for (const Real x : away.motion) ASSERT_EQ(x, 0);
                for (int k = 0; k < 3; ++k) ASSERT_EQ(away.delta_pose[k], 0);
                ASSERT_EQ(away.delta_pose[7], 1);
            }
}

TEST(SolverBodies, WhoRunsAwayIsStoppedAndNobodyElse)
{
    check_runaways<float>();
    check_runaways<double>();
}

TEST(SolverBodies, WhatIsJustHoldableGoesOn)
{
    std::vector<SolverBody<float>> bodies = {
        body_with<float>(Vec3(9.9e15, -9.9e15, 0), Vec3(0, 0, -9.9e15), 1)};
    begin(bodies, Vec3::Zero(), true);
    EXPECT_FALSE(ran_away(bodies[0]));
    EXPECT_EQ(bodies[0].motion[0], 9.9e15f);
}

TEST(SolverBodies, MoveByTheirVelocity)
{
    std::vector<SolverBody<double>> bodies = {body_with<double>(Vec3(1, -2, 4), Vec3(9, 9, 9), 1)};
    for (int i = 0; i < 4; ++i) EXPECT_EQ(advance(bodies, 0.25, false), 0u);
    EXPECT_EQ(bodies[0].delta_pose[0], 1);
    EXPECT_EQ(bodies[0].delta_pose[1], -2);
    EXPECT_EQ(bodies[0].delta_pose[2], 4);
    EXPECT_EQ(bodies[0].delta_pose[3], 0);
    EXPECT_EQ(turn_of(bodies[0]).coeffs(), Quat::Identity().coeffs());
}

template <class Real>
void check_turns(double tolerance)
{
    std::mt19937 random(1);
    const Real time = Real(1) / 256;
    std::vector<SolverBody<Real>> bodies;
    std::vector<Vec3> spins;
    for (int i = 0; i < 20000; ++i) {
        // From a breath to many turns a substep, across the end of the series.
        const Vec3 spin = random_vector(random, std::pow(10.0, -4 + 8.0 * i / 20000));
        bodies.push_back(body_with<Real>(Vec3(1, 2, 4), spin, 1));
        const Real* w = bodies.back().motion + 4;
        spins.emplace_back(double{w[0]}, double{w[1]}, double{w[2]});
    }
    std::size_t fast = 0, wanted_fast = 0;
    for (int step = 0; step < 4; ++step) fast += advance(bodies, time);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        Quat wanted = Quat::Identity();
        for (int step = 0; step < 4; ++step) wanted = turned(wanted, spins[i], double{time});
        const Quat got = turn_of(bodies[i]);
        const double angle = spins[i].norm() / 64;
        ASSERT_LE((got.coeffs() - wanted.coeffs()).norm(), tolerance * (1 + angle))
            << spins[i].transpose();
        ASSERT_NEAR(got.norm(), 1, tolerance);
        ASSERT_EQ(bodies[i].delta_pose[0], Real(1) / 64);
        ASSERT_EQ(bodies[i].delta_pose[2], Real(4) / 64);
        wanted_fast += angle / 4 >= kFastTurn ? 4 : 0;
    }
    EXPECT_EQ(fast, wanted_fast);
    EXPECT_GT(fast, 1000u);
}

TEST(SolverBodies, TurnByTheExponentialMapHoweverFast)
{
    check_turns<float>(5e-7);
    check_turns<double>(1e-15);
}

// Each turn is done by one of the two, at the border too.
template <class Real>
void check_border()
{
    std::vector<SolverBody<Real>> bodies;
    const auto border = static_cast<Real>(kFastTurn);
    for (const Real spin :
         {std::nextafter(border, Real(0)), border, std::nextafter(border, Real(1))})
        bodies.push_back(body_with<Real>(Vec3::Zero(), Vec3(0, 0, double{spin}), 1));
    EXPECT_EQ(advance(bodies, Real(1)), 2u);
    for (const auto& body : bodies)
        EXPECT_NEAR(double{body.delta_pose[6]}, std::sin(kFastTurn / 2),
                    2 * double{std::numeric_limits<Real>::epsilon()});
}

TEST(SolverBodies, NoTurnIsLeftOutOrDoneTwice)
{
    check_border<float>();
    check_border<double>();
}

template <class Real>
void check_order_of_turns(double tolerance)
{
    // From a turn that is there already, slow and fast.
    std::mt19937 random(2);
    for (const double size : {1.0, 200.0})
        for (int i = 0; i < 100; ++i) {
            const Quat before = exponential(random_vector(random, 1));
            std::vector<SolverBody<Real>> bodies = {
                body_with<Real>(Vec3::Zero(), random_vector(random, size), 1)};
            for (int k = 0; k < 4; ++k)
                bodies[0].delta_pose[4 + k] = static_cast<Real>(before.coeffs()[k]);
            const Real* const w = bodies[0].motion + 4;
            const Vec3 spin(double{w[0]}, double{w[1]}, double{w[2]});
            advance(bodies, Real(1) / 64);
            const Quat wanted = exponential(spin / 64) * before;
            ASSERT_LE((turn_of(bodies[0]).coeffs() - wanted.coeffs()).norm(), tolerance);
        }
}

TEST(SolverBodies, TurnAboutTheAxesOfTheWorld)
{
    check_order_of_turns<float>(1e-6);
    check_order_of_turns<double>(2e-15);
}

TEST(SolverBodies, WhatDoesNotSpinKeepsItsTurnToTheLastBit)
{
    std::vector<SolverBody<float>> bodies = {body_with<float>(Vec3(1, 1, 1), Vec3::Zero(), 1)};
    bodies[0].delta_pose[4] = 0.6f;
    bodies[0].delta_pose[7] = 0.8f;
    advance(bodies, 1.0f);
    EXPECT_EQ(bodies[0].delta_pose[4], 0.6f);
    EXPECT_EQ(bodies[0].delta_pose[7], 0.8f);
}

TEST(SolverBodies, WhatIsNotFiniteStaysSo)
{
    // The stage that takes bodies back counts on seeing it.
    for (const double spin : {1e25, HUGE_VAL, std::nan("")}) {
        std::vector<SolverBody<float>> bodies = {
            body_with<float>(Vec3::Zero(), Vec3(spin, 0, 0), 1)};
        EXPECT_EQ(advance(bodies, 1.0f / 256), 1u);
        const Quat q = turn_of(bodies[0]);
        EXPECT_TRUE(!q.coeffs().allFinite() || std::abs(q.norm() - 1) < 1e-6) << spin;
    }
}

}  // namespace
}  // namespace throng
