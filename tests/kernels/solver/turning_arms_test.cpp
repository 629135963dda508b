// Turning arms: which contacts follow their bodies within a step, and that they come out where
// geometry has them.
#include "kernels/solver/turning_arms.hpp"

#include "kernels/math/numbers.hpp"
#include "kernels/solver/contact_packing.hpp"
#include "throng/rotation.hpp"

#include <gtest/gtest.h>

#include <memory>

namespace throng {
namespace {

constexpr double kRadius = 0.3, kBelow = 0.1;  // m, of a ball; its center below the middle

// A contact of body 1, a, with body 2 or what never moves, 0.
struct TwoBodies {
    ContactConstraints<double> constraints;
    Contact<double> contact;

    TwoBodies()
    {
        constraints.bodies.resize(3);
        for (SolverBody<double>& body : constraints.bodies) {
            body = {};
            body.delta_pose[7] = 1;
        }
        constraints.blocks.emplace_back();
        constraints.points.resize(4);
        constraints.turning_arms.resize(1);
        ContactConstraintWide<double>& block = constraints.blocks[0] = {};
        block.a[0] = 1;
        block.writes_a = 1;
    }

    ContactConstraintWide<double>& block() { return constraints.blocks[0]; }
    ContactPointWide<double>& point(std::size_t k) { return constraints.points[k]; }
    Vec3 at(const Lane16<double> (&from)[3]) const { return in_double(from, 0); }

    // Its constraint, of points beside the middle of theirs, and what there is to be noted.
    void make(const Vec3& arm_a, std::span<const Vec3> beside, RollsFlat on_rim = RollsFlat::no)
    {
        const Vec3 arm_b = arm_a + contact.center_offset;
        const Vec3 tangent = std::abs(contact.normal.x()) > 0.5 ? Vec3::UnitY() : Vec3::UnitX();
        for (int k = 0; k < 3; ++k) {
            block().normal[k].at[0] = contact.normal[k];
            block().tangent[k].at[0] = tangent[k];
            block().center_a[k].at[0] = arm_a[k];
            block().center_b[k].at[0] = arm_b[k];
        }
        block().round_a.at[0] = contact.round_a;
        block().round_b.at[0] = contact.round_b;
        contact.count = block().points = static_cast<int>(beside.size());
        for (std::size_t k = 0; k < beside.size(); ++k) {
            point(k) = {};
            point(k).lever_arm[0].at[0] = beside[k].dot(contact.normal.cross(tangent));
            point(k).lever_arm[1].at[0] = -beside[k].dot(tangent);
        }
        note_turning_arms(view(), 0, 0, contact, 0.03, on_rim);
    }

    ContactConstraintsView<double> view()
    {
        return ContactConstraintsView<double>::of(constraints);
    }

    void go(std::size_t body, const Vec3& moved, const Quat& turned)
    {
        for (int k = 0; k < 3; ++k) constraints.bodies[body].delta_pose[k] = moved[k];
        for (int k = 0; k < 4; ++k) constraints.bodies[body].delta_pose[4 + k] = turned.coeffs()[k];
    }

    // As the iterations have it: SeparationChange in iteration_lanes.hpp.
    double separation(std::size_t k)
    {
        const auto turn = [&](std::size_t body) {
            const double* const delta = constraints.bodies[body].delta_pose;
            const Quat turned(delta[7], delta[4], delta[5], delta[6]);
            return Vec3(turned.conjugate() * at(block().normal) - at(block().normal));
        };
        const auto moved = [&](std::size_t body) {
            return vector_at(constraints.bodies[body].delta_pose);
        };
        const auto a = static_cast<std::size_t>(block().a[0]),
                   b = static_cast<std::size_t>(block().b[0]);
        const Vec3 normal = at(block().normal), tangent = at(block().tangent);
        const double center = normal.dot(moved(b) - moved(a))
            + turn(b).dot(at(block().center_b) + normal * contact.round_b)
            - turn(a).dot(at(block().center_a) - normal * contact.round_a);
        const Vec3 both = turn(b) - turn(a);
        return point(k).separation.at[0] + center
            + point(k).lever_arm[0].at[0] * both.dot(normal.cross(tangent))
            - point(k).lever_arm[1].at[0] * both.dot(tangent);
    }
};

// On a floor: from its center up to the middle of the ball, and down to the floor.
TwoBodies weighted_ball()
{
    TwoBodies two;
    two.contact.normal = -Vec3::UnitZ();
    two.contact.round_a = kRadius;
    two.contact.center_offset = Vec3(0, 0, kRadius - kBelow);
    const Vec3 beside[] = {Vec3::Zero()};
    two.make(Vec3(0, 0, kBelow - kRadius), beside);
    return two;
}

// A can that stands tilted on its rim, on a floor: its axis leans by this angle in a direction.
constexpr double kLean = 0.4, kHalfLength = 0.2;  // rad, m

Vec3 axis_towards(double direction, double lean)
{
    return {std::sin(lean) * std::cos(direction), std::sin(lean) * std::sin(direction),
            std::cos(lean)};
}

// From the can's center to where it touches.
Vec3 lowest_arm(double direction, double lean)
{
    const Vec3 along(std::cos(direction), std::sin(direction), 0);
    const Vec3 down = axis_towards(direction, lean) * std::sin(lean) - along;
    return down.normalized() * -kRadius - axis_towards(direction, lean) * kHalfLength;
}

TwoBodies tilted_can()
{
    TwoBodies two;
    const Vec3 axis = axis_towards(0, kLean), arm = lowest_arm(0, kLean);
    two.constraints.rims.resize(3);
    two.constraints.rims[1].radius = kRadius;
    two.constraints.rims[1].contacts = 1;
    for (int k = 0; k < 3; ++k) two.constraints.rims[1].axis[k] = axis[k];
    two.contact.normal = -Vec3::UnitZ();
    two.contact.center_offset = -arm;
    two.contact.points[0].anchor_a = arm;
    const Vec3 beside[] = {Vec3::Zero()};
    two.make(arm, beside, RollsFlat::b);
    return two;
}

// A board that lies on a drum along y, which never moves.
TwoBodies board_on_drum(double half_height)
{
    TwoBodies two;
    two.contact.normal = -Vec3::UnitZ();
    two.contact.round_b = kRadius;
    two.contact.center_offset = Vec3(0, 0, half_height + kRadius);
    const Vec3 beside[] = {Vec3(0, 0.2, 0), Vec3(0, -0.2, 0)};
    two.make(Vec3(0, 0, -half_height), beside);
    return two;
}

TEST(TurningArms, AreThoseThatHoldABodyBeyondItsCenter)
{
    const Vec3 down = -Vec3::UnitZ();
    EXPECT_TRUE(is_held_beyond<double>(down * (kRadius - kBelow), down, kRadius));
    EXPECT_FALSE(is_held_beyond<double>(down * kRadius, down, kRadius));
    EXPECT_FALSE(is_held_beyond<double>(down * (kRadius + kBelow), down, kRadius));
    // A box stands on a corner, and hangs on one of a frame.
    EXPECT_FALSE(is_held_beyond<double>(Vec3(0.1, 0, -0.1), down, 0));
    EXPECT_TRUE(is_held_beyond<double>(Vec3(0.1, 0, 0.1), down, 0));
}

TEST(TurningArms, AreThoseOfAFlatSideAlongARoundOne)
{
    Contact<double> contact;
    contact.count = 2;
    contact.round_b = kRadius;
    EXPECT_EQ(rolls_flat(contact, 0.1, true, true), RollsFlat::a);
    EXPECT_EQ(rolls_flat(contact, 0.1, false, true), RollsFlat::no);
    std::swap(contact.round_a, contact.round_b);
    EXPECT_EQ(rolls_flat(contact, 0.1, true, true), RollsFlat::b);
    contact.round_b = kRadius;
    EXPECT_EQ(rolls_flat(contact, 0.1, true, true), RollsFlat::no);
    contact.round_b = 0;
    contact.points[0].separation = contact.points[1].separation = 0.02;
    EXPECT_EQ(rolls_flat(contact, 0.1, true, true), RollsFlat::no);
    contact.points[1].separation = 0.005;
    EXPECT_EQ(rolls_flat(contact, 0.1, true, true), RollsFlat::b);
    contact.count = 1;
    EXPECT_EQ(rolls_flat(contact, 0.1, true, true), RollsFlat::no);
}

TEST(TurningArms, ABallThatRollsTouchesBelowItsMiddle)
{
    TwoBodies two = weighted_ball();
    ASSERT_EQ(two.constraints.turning_arms[0].lanes, 1);
    for (const double angle : {0.0, 0.02, -0.29, 0.2}) {
        const Quat turned = exponential(Vec3(0, angle, 0));
        const Vec3 to_middle = turned * Vec3(0, 0, kBelow);
        two.go(1, Vec3(kRadius * angle, 0, kBelow) - to_middle, turned);
        turn_arms(two.view(), 0, 1, 0, false);
        EXPECT_LT((two.at(two.block().center_a) - (to_middle - Vec3(0, 0, kRadius))).norm(), 1e-15);
        EXPECT_NEAR(two.separation(0), 0, 1e-15) << angle;
    }
}

TEST(TurningArms, ABoardThatRollsOnADrumTouchesWhereItIsLevelWithIt)
{
    const double half_height = 0.03;
    TwoBodies two = board_on_drum(half_height);
    ASSERT_EQ(two.constraints.turning_arms[0].flat_a, 1);
    for (const double angle : {0.0, 0.002, -0.005, 0.009}) {
        // Rolled by that angle: as far along the board as along the drum.
        const Quat turned = exponential(Vec3(0, angle, 0));
        const Vec3 on_drum = turned * Vec3(0, 0, kRadius),
                   arm = turned * Vec3(kRadius * angle, 0, -half_height);
        two.go(1, on_drum - arm - Vec3(0, 0, kRadius + half_height), turned);
        turn_arms(two.view(), 0, 1, 0, false);
        EXPECT_LT((two.at(two.block().normal) + turned * Vec3::UnitZ()).norm(), 1e-15);
        EXPECT_LT((two.at(two.block().center_a) - arm).norm(), 1e-15);
        EXPECT_LT((two.at(two.block().center_b) - on_drum).norm(), 1e-15);
        for (std::size_t k = 0; k < 2; ++k) EXPECT_NEAR(two.separation(k), 0, 1e-15) << angle;
    }
}

// What a contact gave in the last substep acts at the new place, as if it had never been elsewhere.
TEST(TurningArms, TakeAlongWhatContactsGave)
{
    TwoBodies two = weighted_ball();
    SolverBody<double>& ball = two.constraints.bodies[1];
    const double inertia[] = {0.5, 2, 3, 4, 0, 0, 0};
    std::copy(std::begin(inertia), std::end(inertia), ball.inertia);
    two.point(0).impulse.at[0] = 7;
    two.block().friction_impulse[0].at[0] = 1.5;
    const auto spin_of = [&](const Vec3& arm) {
        const Vec3 on_a = -(two.contact.normal * 7 + Vec3::UnitX() * 1.5);
        return Vec3(Vec3(2, 3, 4).cwiseProduct(arm.cross(on_a)));
    };
    const Vec3 begun = spin_of(two.at(two.block().center_a));
    for (int k = 0; k < 3; ++k) ball.motion[4 + k] = begun[k];
    two.go(1, Vec3(0.1, 0, 0), exponential(Vec3(0.1, 0.2, -0.1)));
    turn_arms(two.view(), 0, 1, 0, false);
    EXPECT_LT((vector_at(ball.motion + 4) - spin_of(two.at(two.block().center_a))).norm(), 1e-14);
    EXPECT_LT(vector_at(ball.motion).norm(), 1e-15);
}

TEST(TurningArms, AreThoseOfARimThatRolls)
{
    const TwoBodies two = tilted_can();
    const RoundRim none;
    RoundRim rim = two.constraints.rims[1];
    const auto rolls = [&](const Contact<double>& contact) {
        return rolls_on_rim(contact, rim, none, true, false);
    };
    EXPECT_EQ(rolls(two.contact), RollsFlat::b);
    // Whoever of the two moves; but one of them.
    EXPECT_EQ(rolls_on_rim(two.contact, rim, none, false, true), RollsFlat::b);
    EXPECT_EQ(rolls_on_rim(two.contact, rim, none, false, false), RollsFlat::no);
    EXPECT_EQ(rolls_on_rim(two.contact, none, none, true, true), RollsFlat::no);
    // Not on what is round; nor with the middle of an end; nor standing upright on all of it.
    Contact<double> contact = two.contact;
    contact.round_b = 0.1;
    EXPECT_EQ(rolls(contact), RollsFlat::no);
    contact = two.contact;
    contact.points[0].anchor_a = -axis_towards(0, kLean) * kHalfLength;
    EXPECT_EQ(rolls(contact), RollsFlat::no);
    for (int k = 0; k < 3; ++k) rim.axis[k] = Vec3::UnitZ()[k];
    contact.points[0].anchor_a = Vec3(kRadius, 0, -kHalfLength);
    EXPECT_EQ(rolls(contact), RollsFlat::no);
}

TEST(TurningArms, ACanThatWobblesTouchesWhereItsRimIsLowest)
{
    for (const double direction : {0.0, 0.3, -0.8})
        for (const double lean : {kLean, kLean - 0.1}) {
            TwoBodies two = tilted_can();
            const Vec3 begun = lowest_arm(0, kLean);
            // However it turned about its own axis.
            const Quat lies = exponential(Vec3(0, 0, direction))
                * exponential(Vec3(0, lean - kLean, 0))
                * exponential(Vec3(axis_towards(0, kLean) * 1.7));
            const Vec3 arm = lowest_arm(direction, lean);
            const double deeper = 1e-3;
            two.go(1, Vec3(0, 0, begun.z() - arm.z() - deeper), lies);
            turn_arms(two.view(), 0, 1, 0, false);
            // It goes round, and does not tip.
            const Vec3 round = lowest_arm(direction, kLean);
            EXPECT_LT((two.at(two.block().center_a) - round).norm(), 1e-14) << direction;
            EXPECT_NEAR(two.separation(0), -deeper, 1e-14) << direction;
        }
}

TEST(TurningArms, AFlatSideThatRollsOnARimTouchesItWhereItIsNearest)
{
    // About the can's axis it turns against it as the can would against what stands still.
    const Vec3 axis = axis_towards(0, kLean);
    const Quat turned = exponential(Vec3(axis * 0.04));
    TwoBodies two = tilted_can();
    two.block().b[0] = 2;
    two.go(2, Vec3::Zero(), turned);
    turn_arms(two.view(), 0, 1, 0, false);
    const Vec3 round = turned * lowest_arm(0, kLean);
    EXPECT_LT((two.at(two.block().center_a) - round).norm(), 1e-14);
    EXPECT_LT((two.at(two.block().normal) + turned * Vec3::UnitZ()).norm(), 1e-14);
    // And is told for the middle of the substep.
    const double time = 0.02, rate = 3;  // s, rad/s
    TwoBodies ahead = tilted_can();
    ahead.block().b[0] = 2;
    for (int k = 0; k < 3; ++k) ahead.constraints.bodies[2].motion[4 + k] = axis[k] * rate;
    turn_arms(ahead.view(), 0, 1, time, true);
    const Vec3 arm = exponential(Vec3(axis * (rate * time / 2))) * lowest_arm(0, kLean);
    EXPECT_LT((ahead.at(ahead.block().center_a) - arm).norm(), 1e-14);
}

TEST(TurningArms, ARimThatSpinsRisesFromNothing)
{
    TwoBodies two = tilted_can();
    turn_arms(two.view(), 0, 1, 0, true);
    two.go(1, Vec3(0, 0, -1e-3), exponential(Vec3(axis_towards(0, kLean) * 0.5)));
    EXPECT_GT(two.separation(0), 0.01);  // of the point of it that touched
    place_rims(two.view(), 0, 1);
    EXPECT_NEAR(two.separation(0), -1e-3, 1e-14);
}

TEST(TurningArms, ARimIsToldForTheMiddleOfTheSubstep)
{
    TwoBodies two = tilted_can();
    const double time = 0.02, rate = 9;  // s, rad/s
    two.constraints.bodies[1].motion[6] = rate;
    turn_arms(two.view(), 0, 1, time, true);
    const Vec3 arm = lowest_arm(rate * time / 2, kLean);
    EXPECT_LT((two.at(two.block().center_a) - arm).norm(), 1e-14);
    EXPECT_NEAR(two.separation(0), 0, 1e-14);
    // One that would run round farther than the contact tells of stays where it is.
    two.constraints.bodies[1].motion[6] = 2 * kFarthestRimRun / time * 1.5;
    turn_arms(two.view(), 0, 1, time, false);
    EXPECT_LT((two.at(two.block().center_a) - arm).norm(), 1e-14);
    EXPECT_EQ(two.constraints.turning_arms[0].lanes, 0);
}

// Points beside the middle, and what resists torsion, turn a body too.
TEST(TurningArms, TakeAlongTheCouplesThatContactsGave)
{
    TwoBodies two = board_on_drum(0.03);
    SolverBody<double>& board = two.constraints.bodies[1];
    for (int k = 1; k < 4; ++k) board.inertia[k] = 2;
    two.point(0).impulse.at[0] = 5;
    two.block().torsional_impulse.at[0] = 0.7;
    const auto spin_of = [&] {
        const Vec3 normal = two.at(two.block().normal), tangent = two.at(two.block().tangent);
        const Vec3 beside = normal.cross(tangent) * two.point(0).lever_arm[0].at[0]
            - tangent * two.point(0).lever_arm[1].at[0];
        const Vec3 arm = two.at(two.block().center_a) + beside;
        return Vec3(-2 * (arm.cross(normal) * 5 + normal * 0.7));
    };
    const Vec3 begun = spin_of();
    for (int k = 0; k < 3; ++k) board.motion[4 + k] = begun[k];
    two.go(1, Vec3(0.001, 0, 0), exponential(Vec3(0, 0.004, 0.01)));
    turn_arms(two.view(), 0, 1, 0, false);
    EXPECT_LT((vector_at(board.motion + 4) - spin_of()).norm(), 1e-13);
}

}  // namespace
}  // namespace throng
