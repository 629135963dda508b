#include "kernels/solver/direct/direct.hpp"

#include "kernels/solver/direct/contact_cones.hpp"
#include "tests/kernels/solver/direct/direct_problems.hpp"
#include "tests/kernels/solver/direct/plain_gauss_seidel.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace throng::test {
namespace {

double greatest_speed(const Problem& problem)
{
    double speed = 0;
    for (const DirectBody& body : problem.bodies)
        speed = std::max({speed, body.velocity.norm(), body.spin.norm()});
    return speed;
}

// What an answer has to keep, seen without the solver's own measure: no point closes faster than it
// may nor pulls, one that parts bears nothing, friction is in its cone and full against sliding.
void expect_law(const Problem& given, double tolerance)
{
    Problem problem = given;
    PlainSweeps look(problem.bodies, problem.points);
    for (const DirectPoint& point : given.points) {
        const Vec3 speed = look.speed(point);
        const double separating_speed = point.normal.dot(speed) - point.least;
        const double load = point.normal.dot(point.impulse);
        const Vec3 held = point.impulse - load * point.normal;
        const Vec3 slip = speed - point.normal * point.normal.dot(speed);
        EXPECT_GT(separating_speed, -tolerance);
        EXPECT_GT(load, -tolerance);
        EXPECT_LT(std::min(separating_speed, load), tolerance);
        EXPECT_LT(held.norm(), point.friction * load + tolerance);
        if (slip.norm() < 1e-4) continue;
        EXPECT_LT((held + point.friction * load * slip.normalized()).norm(), 10 * tolerance);
    }
}

TEST(Direct, StacksStandStillHoweverHighAndHeavy)
{
    for (const auto& [high, mass] : {std::pair(1, 1.0), std::pair(10, 1.0), std::pair(100, 1.0),
                                     std::pair(2, 1e2), std::pair(2, 1e4), std::pair(10, 1e4)}) {
        Problem problem = stack(high, mass);
        const DirectAnswer answer = problem.solve();
        EXPECT_LE(answer.residual, 1e-11) << high << ' ' << mass;
        EXPECT_LT(greatest_speed(problem), 1e-11) << high << ' ' << mass;
        double load = 0;
        for (int k = 0; k < 4; ++k) load += problem.points[static_cast<std::size_t>(k)].impulse.z();
        const double weight = (high - 1 + mass) * kFall;
        EXPECT_NEAR(load, weight, 1e-10 * weight);
    }
}

TEST(Direct, PointsOfOneFaceBearAlike)
{
    Problem problem = stack(3);
    problem.solve();
    for (std::size_t k = 0; k < 12; ++k)
        EXPECT_NEAR(problem.points[k].impulse.z(), problem.points[k / 4 * 4].impulse.z(), 1e-9);
}

void expect_plain_sweeps_agree(std::uint64_t seed, double friction)
{
    Dice dice(seed);
    for (int round = 0; round < 12; ++round) {
        Problem problem = heap(dice, 8, friction), plain = problem;
        EXPECT_LE(problem.solve().residual, kDirectResidual);
        PlainSweeps(plain.bodies, plain.points).run(20000);
        for (std::size_t i = 0; i < problem.bodies.size(); ++i) {
            EXPECT_LT((problem.bodies[i].velocity - plain.bodies[i].velocity).norm(), 1e-6);
            EXPECT_LT((problem.bodies[i].spin - plain.bodies[i].spin).norm(), 1e-6);
        }
    }
}

TEST(Direct, AgreesWithPlainSweepsWithoutFriction) { expect_plain_sweeps_agree(11, 0); }

TEST(Direct, AgreesWithPlainSweepsWithFriction) { expect_plain_sweeps_agree(12, 0.3); }

TEST(Direct, KeepsTheLawOfContactInHeaps)
{
    Dice dice(13);
    for (int round = 0; round < 30; ++round) {
        Problem problem = heap(dice, 30, round % 3 == 0 ? 0.6 : 0.4);
        EXPECT_LE(problem.solve().residual, kDirectResidual) << round;
        expect_law(problem, 1e-7);
    }
}

TEST(Direct, HeapsInMotionAreSolvedHoweverRough)
{
    for (const double friction : {0.7, 0.9})
        for (const auto& [bodies, rounds] : {std::pair(10, 30), std::pair(60, 6)}) {
            Dice dice(77);
            for (int round = 0; round < rounds; ++round) {
                Problem problem = heap(dice, bodies, friction);
                EXPECT_LE(problem.solve().residual, kDirectResidual) << friction << ' ' << round;
                expect_law(problem, 1e-7);
            }
        }
}

// Going nearer step by step, all but pivots are caught where there once was an answer: with a
// little less friction there is.
TEST(Direct, WhereAnAnswerCeasedAnotherIsFound)
{
    for (const auto& [bodies, friction, seed, which] :
         {std::tuple(10, 0.7, 79, 4), std::tuple(30, 0.9, 77, 34)}) {
        Dice dice(static_cast<std::uint64_t>(seed));
        Problem problem;
        for (int round = 0; round <= which; ++round) problem = heap(dice, bodies, friction);
        EXPECT_LE(problem.solve().residual, kDirectResidual);
        expect_law(problem, 1e-7);
    }
}

// The same, where no more is wanted than can be had soon: what was nearest is taken.
TEST(Direct, WithoutPivotsItStopsAtWhatWasNearest)
{
    Dice dice(79);
    Problem problem;
    for (int round = 0; round <= 4; ++round) problem = heap(dice, 10, 0.7);
    const DirectAnswer answer = problem.solve({.pivots = false});
    EXPECT_GT(answer.residual, kDirectResidual);
    EXPECT_LT(answer.residual, 0.1);
    for (const DirectPoint& point : problem.points) EXPECT_GE(point.impulse.z(), 0);
}

TEST(Direct, WhatIsEnoughTakesFewerStepsThanWhatIsBest)
{
    Dice dice(21);
    int soon = 0, late = 0;
    for (int round = 0; round < 20; ++round) {
        Problem rough = heap(dice, 20, 0.6), best = rough;
        const DirectAnswer answer = rough.solve({.enough = 1e-3});
        EXPECT_LE(answer.residual, 1e-3);
        soon += answer.steps;
        late += best.solve().steps;
    }
    EXPECT_LT(soon, late);
}

// Each point a second time, in the very same place.
TEST(Direct, PointsToldTwiceChangeNothing)
{
    Dice dice(16);
    for (int round = 0; round < 10; ++round) {
        Problem once = heap(dice, 10, 0.6), twice = once;
        for (const DirectPoint& point : once.points) twice.points.push_back(point);
        EXPECT_LE(once.solve().residual, kDirectResidual);
        EXPECT_LE(twice.solve().residual, kDirectResidual);
        for (std::size_t i = 0; i < once.bodies.size(); ++i) {
            EXPECT_LT((once.bodies[i].velocity - twice.bodies[i].velocity).norm(), 1e-7);
            EXPECT_LT((once.bodies[i].spin - twice.bodies[i].spin).norm(), 1e-7);
        }
    }
}

// Logs along y, of radius 0.5: two on the ground and one on them. Each meets another in the two
// ends of a line, which are nearly as far apart as they should be.
Problem three_logs(Dice& dice, double error, double friction_on_ground)
{
    Problem problem;
    DirectBody log;
    log.inverse_mass = 1;
    log.inverse_inertia = {2.53, 8, 2.53};
    log.velocity = Vec3(0, 0, -kFall);
    problem.bodies.assign(3, log);
    const auto add_line = [&](int a, int b, const Vec3& normal, double friction) {
        for (const double end : {-1, 1}) {
            DirectPoint point;
            point.a = a;
            point.b = b;
            point.normal = (normal + dice.point(error)).normalized();
            point.arm_a = 0.5 * normal + Vec3(0, end, 0) + dice.point(error);
            point.arm_b = -0.5 * normal + Vec3(0, end, 0) + dice.point(error);
            point.friction = friction;
            point.least = kFall * dice.between(-10, 10) * error;
            problem.points.push_back(point);
        }
    };
    for (const int log_below : {0, 1}) add_line(-1, log_below, Vec3::UnitZ(), friction_on_ground);
    for (const int log_below : {0, 1}) {
        const double side = log_below == 0 ? 0.5 : -0.5;
        add_line(log_below, 2, Vec3(side, 0, std::sqrt(0.75)), 0.5);
    }
    return problem;
}

TEST(Direct, EndsOfALineThatContradictOneAnotherAreSolved)
{
    Dice dice(17);
    const double limit = std::tan(std::atan(1.0) / 3) / 3;  // of logs that stay where they are
    // A little above it logs that roll on keep the law as well as those that stand.
    for (const double friction : {0.97 * limit, 1.5 * limit})
        for (const double error : {0.0, 1e-12, 1e-10, 1e-8, 1e-6})
            for (int round = 0; round < 10; ++round) {
                Problem problem = three_logs(dice, error, friction);
                EXPECT_LE(problem.solve().residual, kDirectResidual) << friction << ' ' << error;
                expect_law(problem, 1e-7);
                const double fall = -problem.bodies[2].velocity.z();
                EXPECT_EQ(fall > 1e-4, friction < limit) << error;
            }
}

TEST(Direct, LegsOfUnequalLengthAreSolved)
{
    Dice dice(18);
    for (const double error : {1e-12, 1e-10, 1e-8, 1e-6, 1e-4})
        for (int round = 0; round < 10; ++round) {
            Problem problem = stack(5);
            for (DirectPoint& point : problem.points) {
                point.arm_b += dice.point(error);
                point.least = kFall * error * dice.between(-1, 1);
            }
            EXPECT_LE(problem.solve().residual, kDirectResidual) << error;
            expect_law(problem, 1e-7);
        }
}

// Of all masses and gaps. Where masses differ by more than 16 digits can tell it may miss.
TEST(Direct, HeapsOfAllMassesAndSeparationsAreSolved)
{
    Dice dice(19);
    for (const double digits : {2, 6})
        for (int round = 0; round < 150; ++round) {
            Problem problem = heap(dice, 1 + round % 6, dice.between(0, 1));
            for (DirectBody& body : problem.bodies) {
                const double light = std::pow(10, dice.between(-digits, digits));
                const Sym3& of = body.inverse_inertia;
                body.inverse_mass *= light;
                body.inverse_inertia = {of.xx * light, of.yy * light, of.zz * light};
            }
            for (DirectPoint& point : problem.points)
                point.least = -std::pow(10, dice.between(-12, 6));
            const DirectAnswer answer = problem.solve();
            EXPECT_TRUE(std::isfinite(greatest_speed(problem))) << round;
            if (digits > 2) continue;
            EXPECT_LE(answer.residual, kDirectResidual) << round;
        }
}

TEST(ContactCones, ResidualOfImpulsesThatAreNoNumbersIsInfinite)
{
    const Problem problem = stack(2);
    ContactCones cones;
    ASSERT_TRUE(cones.take(problem.bodies, problem.points));
    std::vector<BodySix> scratch;
    EXPECT_TRUE(std::isfinite(cones.residual(scratch)));
    cones.cones[3].impulse[1] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(cones.residual(scratch), std::numeric_limits<double>::infinity());
}

TEST(Direct, ProblemsOfNumbersThatAreNotFiniteAreRefused)
{
    const double none = std::numeric_limits<double>::quiet_NaN();
    const double infinite = std::numeric_limits<double>::infinity();
    const auto refuses = [](const auto& spoil) {
        Problem problem = stack(3);
        spoil(problem);
        const DirectAnswer answer = problem.solve();
        EXPECT_EQ(answer.residual, std::numeric_limits<double>::infinity());
        for (const DirectPoint& point : problem.points)
            EXPECT_EQ(point.impulse, Vec3(Vec3::Zero()));
        EXPECT_TRUE(problem.bodies[0].velocity.allFinite());
    };
    refuses([&](Problem& problem) { problem.bodies[1].velocity.x() = none; });
    refuses([&](Problem& problem) { problem.bodies[2].spin.y() = infinite; });
    refuses([&](Problem& problem) { problem.points[5].normal.z() = none; });
    refuses([&](Problem& problem) { problem.points[5].least = none; });
    refuses([&](Problem& problem) { problem.points[6].friction = infinite; });
    Problem guessed = stack(3);
    guessed.points[2].impulse.z() = none;  // a bad guess is none
    EXPECT_LE(guessed.solve().residual, 1e-11);
}

// Closed in on from both sides by what does not move, and told to part from both.
TEST(Direct, WhatCannotBeSolvedIsToldInBoundedWork)
{
    Problem problem;
    problem.bodies.push_back(box(1, Vec3::Ones()));
    for (const double side : {-1, 1}) {
        DirectPoint point;
        point.b = 0;
        point.normal = Vec3(side, 0, 0);
        point.arm_b = -0.5 * point.normal;
        point.friction = 0.5;
        point.least = 0.1;
        problem.points.push_back(point);
    }
    const DirectAnswer answer = problem.solve();
    EXPECT_GT(answer.residual, kDirectResidual);
    EXPECT_LE(answer.steps, kDirectSteps);
    EXPECT_LT(greatest_speed(problem), 10);
}

TEST(Direct, BoxOnASlopeSticksAtExactlyTheTangentAndSlidesBelow)
{
    const double angle = std::atan(0.5);
    const auto drop = [&](double friction) {
        Problem problem;
        problem.bodies.push_back(box(1, Vec3(1, 1, 0.5)));
        // In the slope's own axes: gravity leans downhill, which is x.
        problem.bodies[0].velocity = kFall * Vec3(std::sin(angle), 0, -std::cos(angle));
        add_face(problem, -1, 0, 0.25, friction);
        EXPECT_LE(problem.solve().residual, kDirectResidual) << friction;
        return problem.bodies[0].velocity;
    };
    EXPECT_LT(drop(0.75).norm(), 1e-13);
    EXPECT_LT(drop(0.5).norm(), 1e-9);
    const double wanted = kFall * (std::sin(angle) - 0.49 * std::cos(angle));
    EXPECT_LT((drop(0.49) - Vec3(wanted, 0, 0)).norm(), 1e-12);
}

// A ball that stays where it is, and turns, between the floor and a slab. Towards the floor neither
// gives way, but for the rounding of a lever arm: taken for one it would be the measure of all
// speeds.
TEST(Direct, WhoCanOnlyTurnIsSpunByNoLeverArmOfRounding)
{
    Dice dice(31);
    for (int i = 0; i < 200; ++i) {
        const Vec3 normal = dice.direction();
        const double radius = 0.05, half = 0.1;
        Problem problem;
        DirectBody ball;
        ball.inverse_inertia = {2000, 2000, 2000};
        ball.spin = 1e-5 * dice.direction();
        DirectBody slab = box(500, Vec3(1, 1, 0.2));
        slab.velocity = -kFall * normal;
        problem.bodies = {ball, slab};
        DirectPoint below, above;
        below.b = above.a = 0;
        above.b = 1;
        below.normal = above.normal = normal;
        below.arm_b = -radius * normal + 1e-17 * dice.direction();
        above.arm_a = radius * normal + 1e-17 * dice.direction();
        above.arm_b = -half * normal;
        below.friction = above.friction = 0.5;
        below.least = dice.between(-1e-4, 1e-4);
        problem.points = {below, above};

        EXPECT_LE(problem.solve().residual, kDirectResidual);
        EXPECT_LE(problem.bodies[0].spin.norm(), 1.001 * ball.spin.norm());
        EXPECT_NEAR(problem.bodies[1].velocity.dot(normal), 0, 1e-6 * kFall);
    }
}

TEST(Direct, FrictionSlowsASlidingBallAndTurnsIt)
{
    Problem problem;
    DirectBody ball;
    ball.inverse_mass = 1;
    ball.inverse_inertia = {2.5, 2.5, 2.5};  // of radius 1
    ball.velocity = Vec3(3, 4, -kFall);
    problem.bodies.push_back(ball);
    DirectPoint point;
    point.b = 0;
    point.arm_b = -Vec3::UnitZ();
    point.friction = 0.2;
    problem.points.push_back(point);
    EXPECT_LE(problem.solve().residual, kDirectResidual);
    const double lost = 0.2 * kFall;
    EXPECT_LT((problem.bodies[0].velocity - Vec3(3, 4, 0) * (1 - lost / 5)).norm(), 1e-12);
    EXPECT_LT((problem.bodies[0].spin - 2.5 * lost * Vec3(-0.8, 0.6, 0)).norm(), 1e-12);
}

TEST(Direct, RollingFrictionStopsWhatRollsSlowly)
{
    Problem problem;
    DirectBody ball;
    ball.inverse_mass = 1;
    ball.inverse_inertia = {2.5, 2.5, 2.5};
    ball.velocity = Vec3(0.001, 0, -kFall);
    ball.spin = Vec3(0, 0.001, 0.001);
    problem.bodies.push_back(ball);
    DirectPoint point;
    point.b = 0;
    point.arm_b = -Vec3::UnitZ();
    point.friction = 0.5;
    point.rolling = 0.1;
    problem.points.push_back(point);
    EXPECT_LE(problem.solve().residual, kDirectResidual);
    EXPECT_LT(greatest_speed(problem), 1e-12);
}

TEST(Direct, MomentumIsKept)
{
    Dice dice(14);
    Problem problem = heap(dice, 10, 0.5);
    Vec3 wanted = Vec3::Zero(), got = Vec3::Zero();
    const auto sum_up = [&](Vec3& sum) {
        for (const DirectBody& body : problem.bodies) sum += body.velocity / body.inverse_mass;
    };
    sum_up(wanted);
    problem.solve();
    for (const DirectPoint& point : problem.points)
        if (point.a < 0) wanted += point.impulse;
    sum_up(got);
    EXPECT_LT((got - wanted).norm(), 1e-11);
}

TEST(Direct, WhatItFoundBeforeIsFoundAgainAtOnce)
{
    Problem problem = stack(20);
    const Problem before = problem;
    EXPECT_GT(problem.solve().steps, 3);
    problem.bodies = before.bodies;
    const DirectAnswer again = problem.solve();
    EXPECT_LE(again.steps, 1);
    EXPECT_LE(again.residual, 1e-12);
}

TEST(Direct, TakesNoMoreStepsThanAllowedAndTellsWhatIsMissing)
{
    Dice dice(15);
    Problem problem = heap(dice, 30, 0.4);
    const DirectAnswer answer = problem.solve({.steps = 2});
    EXPECT_LE(answer.steps, 2);
    EXPECT_GT(answer.residual, kDirectResidual);
    EXPECT_TRUE(std::isfinite(greatest_speed(problem)));
}

double kinetic_energy(const Problem& problem)
{
    double energy = 0;
    for (const DirectBody& body : problem.bodies)
        energy += 0.5 * body.velocity.squaredNorm() / body.inverse_mass
            + 0.5 * body.spin.dot(body.inverse_inertia.matrix().inverse() * body.spin);
    return energy;
}

// What is left along its path would give energy.
TEST(Direct, WhereStepsRunOutNoEnergyIsGiven)
{
    Dice dice(15);
    for (int round = 0; round < 200; ++round) {
        Problem problem = heap(dice, 12, round % 2 == 0 ? 0.3 : 0.7);
        const double before = kinetic_energy(problem);
        problem.solve({.steps = 1 + round % 4, .pivots = false});
        EXPECT_LE(kinetic_energy(problem), before) << round;
    }
}

TEST(Direct, NothingToStopNeedsNoImpulse)
{
    Problem problem = stack(2);
    for (DirectBody& body : problem.bodies) body.velocity = Vec3(0, 0, 1);
    problem.points.resize(4);  // the lower one's alone
    EXPECT_EQ(problem.solve().residual, 0);
    for (const DirectPoint& point : problem.points) EXPECT_EQ(point.impulse, Vec3(Vec3::Zero()));
    Problem none;
    EXPECT_EQ(none.solve().residual, 0);
}

}  // namespace
}  // namespace throng::test
