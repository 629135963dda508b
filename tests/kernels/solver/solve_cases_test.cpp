// Solve cases: contacts so simple that what an iteration does to them is known beforehand.
#include "kernels/solver/solve_kernels.hpp"
#include "tests/kernels/solver/random_contacts.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

using given::BlockCase;

// A body of 2 kg that a still one holds from below at one point, on the axis through its center.
template <class Real>
BlockCase<Real> on_one_point(const Vec3& velocity, double arm, const ContactParameters<Real>& terms)
{
    BlockCase<Real> made;
    given::make_points(1, {.rolls = false}, made);
    made.block().b[0] = 1;
    made.block().writes_b = 1;
    SolverBody<Real> still = {};
    still.delta_pose[7] = 1;
    SolverBody<Real> body = still;
    for (int k = 0; k < 3; ++k) body.motion[k] = static_cast<Real>(velocity[k]);
    body.inertia[0] = Real(0.5);
    for (int k = 1; k < 4; ++k) body.inertia[k] = 5;
    made.constraints.bodies = {still, body};
    Contact<Real> contact;
    contact.count = 1;
    contact.points[0].anchor_a.setZero();
    contact.center_offset = Vec3T<Real>(0, 0, static_cast<Real>(-arm));
    made.contacts = {contact};
    made.terms = {terms};
    made.prepare(solve_kernels<Real>());
    return made;
}

BlockCase<double> falling_ball(double speed, double restitution)
{
    return on_one_point<double>(Vec3(0, 0, -speed), 0.1,
                                {0.5, restitution, 0.0, softness<double>(40, 10, 1.0 / 240), 0});
}

template <class Real>
SolverIteration<Real> plain_iteration()
{
    SolverIteration<Real> iteration;
    iteration.inverse_substep = 240;
    return iteration;
}

TEST(SolveCases, AnIterationWithoutBiasStopsABallDead)
{
    for (const double speed : {0.1, 3.0, 1000.0}) {
        BlockCase<double> made = falling_ball(speed, 0);
        made.solve(solve_kernels<double>(), plain_iteration<double>());
        EXPECT_NEAR(made.constraints.bodies[1].motion[2], 0, 1e-13 * speed);
        EXPECT_NEAR(made.point(0).impulse.at[0], 2 * speed, 1e-13 * speed);
    }
}

template <class Real>
SolverIteration<Real> visit_of_impact()
{
    SolverIteration<Real> iteration = plain_iteration<Real>();
    iteration.restitution_threshold = Real(0.5);
    return iteration;
}

TEST(SolveCases, ABallLeavesWithItsShareOfTheSpeedItCameWith)
{
    for (const double share : {0.25, 0.5, 1.0}) {
        BlockCase<double> made = falling_ball(3, share);
        EXPECT_TRUE(made.apply_restitution(solve_kernels<double>(), visit_of_impact<double>()));
        EXPECT_NEAR(made.constraints.bodies[1].motion[2], 3 * share, 1e-12);
        EXPECT_NEAR(made.constraints.restitutions[given::kPlace].impulse[0].at[0],
                    2 * 3 * (1 + share), 1e-12);
    }
}

TEST(SolveCases, ABallThatComesSlowlyOrDoesNotTouchYetDoesNotBounce)
{
    const auto& kernels = solve_kernels<double>();
    BlockCase<double> slow = falling_ball(0.4, 1);
    EXPECT_FALSE(slow.apply_restitution(kernels, visit_of_impact<double>()));
    EXPECT_EQ(slow.constraints.bodies[1].motion[2], -0.4);
    BlockCase<double> far = falling_ball(3, 1);
    for (const double substeps : {1.01, 0.99}) {
        far.point(0).separation.at[0] = substeps * 3 / 240;
        EXPECT_EQ(far.apply_restitution(kernels, visit_of_impact<double>()), substeps < 1);
        EXPECT_NEAR(far.constraints.bodies[1].motion[2], substeps < 1 ? 3 : -3, 1e-12);
    }
}

TEST(SolveCases, WhatFallsRisesAgainAsHigh)
{
    // As fast as it was in the middle of a substep before, whatever gravity adds in one.
    BlockCase<double> made = falling_ball(3, 1);
    SolverIteration<double> iteration = visit_of_impact<double>();
    iteration.gravity_step[2] = -0.04;
    made.apply_restitution(solve_kernels<double>(), iteration);
    EXPECT_NEAR(made.constraints.bodies[1].motion[2] - 0.02, 3 + 0.02, 1e-12);
}

TEST(SolveCases, WhatContactsGaveIsNotTakenForAnImpact)
{
    BlockCase<double> made = falling_ball(3, 1);
    const SolverBody<double> before = made.constraints.bodies[1];
    made.apply_restitution(solve_kernels<double>(), visit_of_impact<double>());
    const SolverBody<double>& after = made.constraints.bodies[1];
    for (int k = 0; k < 8; ++k)
        EXPECT_NEAR(after.motion[k] - after.free[k], before.motion[k] - before.free[k], 1e-12);
}

TEST(SolveCases, OnlyPushingStopsWhatIsAboutToBounce)
{
    for (const bool push : {false, true}) {
        BlockCase<double> made = falling_ball(3, 1);
        SolverIteration<double> iteration = visit_of_impact<double>();
        iteration.use_bias = push;
        made.solve(solve_kernels<double>(), iteration);
        EXPECT_NEAR(made.constraints.bodies[1].motion[2], push ? 0 : -3, 0.2);
    }
}

TEST(SolveCases, AnImpactRubsByAllThatItLoads)
{
    // Friction 0.5: of a ball of 2 kg and 0.2 kg m2, that grips once 3.5 of the speed are lost.
    for (const double share : {0.2, 0.8})
        for (const double slides : {1.0, 20.0}) {
            BlockCase<double> made = falling_ball(3, share);
            made.constraints.bodies[1].motion[0] = slides;
            made.apply_restitution(solve_kernels<double>(), visit_of_impact<double>());
            const double most = 0.5 * (1 + share) * 3;
            const double answer = 1.0 / 2 + 5 * 0.1 * 0.1;  // 1/kg
            const double point_frictions = slides / (answer * 2);
            EXPECT_NEAR(made.constraints.bodies[1].motion[0],
                        slides - std::min(most, point_frictions), 1e-12);
        }
}

// A ball that has rolled half a turn lies as deep as it did; a box that tips does not.
TEST(SolveCases, OnlyWhatLiesWithinARoundSideTurnsWithTheBody)
{
    for (const double round : {0.0, 0.06, 0.1}) {
        BlockCase<double> made = falling_ball(3, 0);
        made.contacts[0].round_b = round;
        made.prepare(solve_kernels<double>());
        const double angle = 0.7;
        made.constraints.bodies[1].delta_pose[0] = 5;
        made.constraints.bodies[1].delta_pose[2] = 0.002;
        made.constraints.bodies[1].delta_pose[4] = std::sin(angle / 2);
        made.constraints.bodies[1].delta_pose[7] = std::cos(angle / 2);
        SolverIteration<double> iteration;
        iteration.inverse_substep = 1;
        made.solve(solve_kernels<double>(), iteration);
        // It may close what is open, and no more.
        const double open = 0.002 + (0.1 - round) * (1 - std::cos(angle));
        EXPECT_NEAR(made.constraints.bodies[1].motion[2], -open, 1e-14) << round;
    }
}

TEST(SolveCases, APointWithoutALeverArmSpinsNobodyWhoCannotBeMoved)
{
    // Next to below the axle of a wheel that is held there.
    for (const double off : {0.0, 1e-4, 1e-3, 0.05}) {
        BlockCase<double> made = falling_ball(3, 0);
        made.constraints.bodies[1].inertia[0] = 0;
        made.constraints.bodies[1].motion[4] = -1;
        made.contacts[0].points[0].anchor_a = Vec3(0, off, 0);
        made.prepare(solve_kernels<double>());
        made.solve(solve_kernels<double>(), plain_iteration<double>());
        EXPECT_LE(std::abs(made.constraints.bodies[1].motion[4]), off > 0.02 ? 61.0 : 1.0) << off;
        EXPECT_EQ(made.point(0).impulse.at[0] > 0, off > 0.02) << off;
        EXPECT_EQ(made.constraints.bodies[1].motion[2], -3);
    }
}

// A box of 2 kg comes down on its face, its points in any order.
BlockCase<double> box_on_its_face(double speed, bool turned)
{
    BlockCase<double> made = falling_ball(speed, 0);
    given::make_points(4, {.rolls = false}, made);
    made.block().b[0] = 1;
    made.block().writes_b = 1;
    Contact<double>& contact = made.contacts[0];
    contact.count = 4;
    for (int k = 0; k < 4; ++k) {
        const int corner = turned ? 3 - k : k;
        contact.points[static_cast<std::size_t>(k)].anchor_a =
            Vec3(corner % 2 == 0 ? 0.1 : -0.1, corner < 2 ? 0.1 : -0.1, 0);
    }
    made.prepare(solve_kernels<double>());
    return made;
}

TEST(SolveCases, AFaceThatComesDownFlatStaysFlatAfterOneIteration)
{
    for (const bool turned : {false, true}) {
        BlockCase<double> made = box_on_its_face(1, turned);
        SolverIteration<double> iteration = plain_iteration<double>();
        iteration.use_bias = true;
        made.solve(solve_kernels<double>(), iteration);
        for (int k = 4; k < 7; ++k) EXPECT_NEAR(made.constraints.bodies[1].motion[k], 0, 1e-14);
        // A face gives way by a little, and the sweeps after it take most of that away.
        EXPECT_NEAR(made.constraints.bodies[1].motion[2], 0, 0.02);
        for (int k = 0; k < 4; ++k) EXPECT_NEAR(made.point(k).impulse.at[0], 0.5, 0.01);
    }
}

// Sizes from a micrometre to a thousand kilometres: the same numbers, in other units.
TEST(SolveCases, FrictionHoldsItsConeAtEverySizeInFloat)
{
    for (const double size : {1e-6, 1e-3, 1.0, 1e3, 1e6}) {
        const double mass = 1000 * size * size * size;
        // It slides across at a meter a second and presses with a tenth of that.
        BlockCase<float> made = on_one_point<float>(Vec3(1, 0, -0.1), 0, {0.5f, 0, 0, {}, 0});
        for (float& number : made.constraints.bodies[1].inertia) number = 0;
        made.constraints.bodies[1].inertia[0] = static_cast<float>(1 / mass);
        made.prepare(solve_kernels<float>());
        made.solve(solve_kernels<float>(), plain_iteration<float>());
        EXPECT_NEAR(made.constraints.bodies[1].motion[2], 0, 1e-6) << size << " m";
        EXPECT_NEAR(made.constraints.bodies[1].motion[0], 0.95, 1e-6) << size << " m slides";

        made.constraints.bodies[1].motion[0] = 0.02f;
        made.constraints.bodies[1].motion[2] = -0.1f;
        for (auto& impulse : made.block().friction_impulse) impulse.at[0] = 0;
        made.point(0).impulse.at[0] = 0;
        made.solve(solve_kernels<float>(), plain_iteration<float>());
        EXPECT_NEAR(made.constraints.bodies[1].motion[0], 0, 1e-7) << size << " m sticks";
    }
}

}  // namespace
}  // namespace throng
