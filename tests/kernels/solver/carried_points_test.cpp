// Carried points: the law of one point, and the wide kernel against it.
#include "kernels/solver/carried_points.hpp"

#include "kernels/solver/solver_bodies.hpp"
#include "tests/kernels/solver/random_contacts.hpp"
#include "tests/support/same_bytes.hpp"

#include <gtest/gtest.h>

#include <string>

namespace throng {
namespace {

using given::BlockCase;
using given::BlockWish;

// A point that a plate carries from the start of each substep to its end, by the velocity that the
// plate has where the point is in the middle: how far from the plate's axis it then is.
double radius_after_a_turn(double angle_of_a_step)
{
    const int steps = static_cast<int>(std::lround(6.283185307179586 / angle_of_a_step));
    DirectBody plate, rider;
    plate.spin = Vec3(0, 0, 1);
    rider.velocity = Vec3(0, 1, 0);
    Vec3 at(1, 0, 0);
    for (int step = 0; step < steps; ++step) {
        // Arms as they are: of the plate to the point, of the rider to what it stands on.
        DirectPoint point;
        point.a = 0, point.b = 1;
        point.arm_a = at;
        const double half = angle_of_a_step / 2;
        carry_arms(carried_side(Vec3::Zero(), Quat::Identity(), plate, point.arm_a, half),
                   carried_side(Vec3::Zero(), Quat::Identity(), rider, point.arm_b, half), 1,
                   point);
        rider.velocity = plate.spin.cross(point.arm_a);
        at += rider.velocity * angle_of_a_step;
    }
    return std::sqrt(at.squaredNorm());
}

TEST(CarriedPoints, StayAtTheirRadius)
{
    // Arms of the beginning lead out by pi times the angle in a turn.
    EXPECT_NEAR(radius_after_a_turn(0.1), 1, 2e-2);
    EXPECT_NEAR(radius_after_a_turn(0.01), 1, 2e-4);
    EXPECT_NEAR(radius_after_a_turn(0.001), 1, 2e-6);
}

TEST(CarriedPoints, NeverTellMoreThanTheSpeedOfTheRim)
{
    for (const double spin : {1.0, 1e2, 1e4, 1e6}) {
        DirectBody wheel;
        wheel.spin = Vec3(0, 0, spin);
        const Vec3 arm(1, 0, 0);
        const CarriedSide side =
            carried_side(Vec3::Zero(), Quat::Identity(), wheel, arm, 1.0 / 480);
        EXPECT_NEAR((arm + side.material).norm(), 1, 1e-12);
    }
}

TEST(CarriedPoints, AreThoseOfWhatTurnsByItselfOrIsHeavy)
{
    const Vec3 spin(0, 0, 2), sway(0, 0, 1e-3), none = Vec3::Zero();
    const InverseMass driven{0, 0}, one{1, 6}, heavy{0.1, 0.6}, half{0.5, 3};
    EXPECT_TRUE(carries(spin, driven, one, 0.01));
    EXPECT_TRUE(carries(sway, driven, driven, 0.01));
    EXPECT_FALSE(carries(none, driven, one, 0.01));
    EXPECT_TRUE(carries(spin, heavy, one, 0.01));
    EXPECT_FALSE(carries(spin, half, one, 0.01));
    EXPECT_FALSE(carries(sway, heavy, one, 0.01));
    // On an axle it is how hard it is to turn that counts.
    EXPECT_TRUE(carries(sway, {0, 0.6}, one, 0.01));
    EXPECT_FALSE(carries(spin, {0, 3}, one, 0.01));
}

TEST(CarriedPoints, GoWithTheRounderSide)
{
    EXPECT_EQ(goes_with_b(0, 0.1, true), 1);
    EXPECT_EQ(goes_with_b(0.1, 0, true), 0);
    EXPECT_EQ(goes_with_b(0, 0, true), 1);
    EXPECT_EQ(goes_with_b(0, 0, false), 0);
    EXPECT_DOUBLE_EQ(goes_with_b(3, 1, false), 0.75);
}

struct PlainSide {
    DirectBody body;
    CarriedSide goes;

    template <class Real>
    PlainSide(const SolverBody<Real>& from, const Vec3& core, double half)
    {
        body.velocity = vector_at(from.motion);
        body.spin = vector_at(from.motion + 4);
        const Real* const inertia = from.inertia;
        body.inverse_inertia.xx = double{inertia[1]};
        body.inverse_inertia.yy = double{inertia[2]};
        body.inverse_inertia.zz = double{inertia[3]};
        const Quat turn(double{from.delta_pose[7]}, double{from.delta_pose[4]},
                        double{from.delta_pose[5]}, double{from.delta_pose[6]});
        goes = carried_side(vector_at(from.delta_pose), turn, body, core, half);
    }
};

// What the kernel should tell of a lane, by the law of one point.
template <class Real>
Vec3 plain_slip(BlockCase<Real>& made, std::size_t lane, double half)
{
    const ContactConstraintWide<Real>& block = made.block();
    const Vec3 normal = in_double(block.normal, lane);
    const Vec3 arm_a = in_double(block.center_a, lane), arm_b = in_double(block.center_b, lane);
    const PlainSide a(made.body_a(lane), arm_a - normal * double{block.round_a.at[lane]}, half);
    const PlainSide b(made.body_b(lane), arm_b + normal * double{block.round_b.at[lane]}, half);
    DirectPoint point;
    point.a = 0, point.b = 1;
    point.arm_a = arm_a;
    point.arm_b = arm_b;
    const DirectBody bodies[2] = {a.body, b.body};
    const Vec3 before = relative_velocity(point, bodies);
    carry_arms(a.goes, b.goes,
               double{made.constraints.surface_velocities[given::kPlace].by_b.at[lane]}, point);
    return relative_velocity(point, bodies) - before;
}

// Of who turns as freely as the kernel is told, and of who is the surface that nothing turns.
template <class Real>
void carry(BlockCase<Real>& made, std::size_t lane, double share)
{
    SurfaceVelocityWide<Real>& carried = made.constraints.surface_velocities[given::kPlace];
    carried.by_a.at[lane] = static_cast<Real>(1 - share);
    carried.by_b.at[lane] = static_cast<Real>(share);
    carried.carries = true;
    const Real arm_a = static_cast<Real>(in_double(made.block().center_a, lane).squaredNorm());
    const Real arm_b = static_cast<Real>(in_double(made.block().center_b, lane).squaredNorm());
    carried.range_a.at[lane] = range_of(arm_a, inverse_mass_of(made.body_a(lane)).angular > 0);
    carried.range_b.at[lane] = range_of(arm_b, inverse_mass_of(made.body_b(lane)).angular > 0);
}

template <class Real>
void check_kernel(const SolveKernels<Real>& kernels, double tolerance)
{
    const double half = 1.0 / 480;
    for (unsigned seed = 0; seed < 50; ++seed) {
        std::mt19937 random(seed);
        BlockCase<Real> made = given::random_block<Real>(random, BlockWish{});
        made.constraints.surface_velocities.assign(made.constraints.blocks.size(), {});
        SurfaceVelocityWide<Real>& carried = made.constraints.surface_velocities[given::kPlace];
        for (std::size_t lane = 0; lane < kBlock; ++lane) {
            const double share = given::random_number(random, 0, 1);
            if (lane % 3 != 0) carry(made, lane, share);
            // Some have left.
            if (lane % 4 == 0) made.body_b(lane).delta_pose[0] += Real(3);
        }
        BlockCase<Real> narrow = made;
        kernels.update_surface_velocity(made.view(), given::kPlace, given::kPlace + 1,
                                        static_cast<Real>(half));
        solve_kernels_of<Real>("scalar")->update_surface_velocity(
            narrow.view(), given::kPlace, given::kPlace + 1, static_cast<Real>(half));
        ASSERT_TRUE(
            given::same_bytes(narrow.constraints.surface_velocities[given::kPlace], carried));
        for (std::size_t lane = 0; lane < kBlock; ++lane) {
            const Vec3 slip = lane % 3 == 0 ? Vec3(Vec3::Zero()) : plain_slip(made, lane, half);
            const Vec3 normal = in_double(made.block().normal, lane);
            const Vec3 tangent = in_double(made.block().tangent, lane);
            ASSERT_NEAR(double{carried.speed[0].at[lane]}, tangent.dot(slip), tolerance);
            ASSERT_NEAR(double{carried.speed[1].at[lane]}, normal.cross(tangent).dot(slip),
                        tolerance);
        }
    }
}

TEST(CarriedPoints, OfBlocksFollowTheSameLawOnEveryWidth)
{
    for (const char* width : {"scalar", "avx2", "avx512"}) {
        if (const auto* kernels = solve_kernels_of<float>(width)) check_kernel(*kernels, 3e-6);
        if (const auto* kernels = solve_kernels_of<double>(width)) check_kernel(*kernels, 1e-13);
    }
}

TEST(CarriedPoints, LetGoOfWhoHasLeft)
{
    DirectBody wheel, driven, ball;
    wheel.spin = driven.spin = Vec3(0, 0, 20);
    wheel.inverse_inertia.zz = 1;
    const Vec3 arm(1, 0, 0), off(-0.1, 0, 0);
    // What of a wheel's two arms is told for a ball that has gone some way since.
    const auto told = [&](const DirectBody& carrier, double way) {
        DirectPoint point;
        point.arm_a = arm, point.arm_b = off;
        carry_arms(carried_side(Vec3::Zero(), Quat::Identity(), carrier, arm, 0),
                   carried_side(Vec3(way, 0, 0), Quat::Identity(), ball, off, 0), 1, point);
        return Vec3(point.arm_a - arm).norm();
    };
    EXPECT_DOUBLE_EQ(told(wheel, 0.5), 0.5);
    EXPECT_EQ(told(wheel, 1.5), 0);
    // What nothing turns is slowed by nothing that it does.
    EXPECT_DOUBLE_EQ(told(driven, 1.5), 1.5);
}

// What slides by the carried speed and no other is brought to rest against it.
TEST(CarriedPoints, FrictionAimsAtThem)
{
    for (const bool friction_at_points : {false, true}) {
        std::mt19937 random(7);
        BlockWish wish;
        wish.points = 1;
        wish.restitutions = wish.rolls = false;
        wish.friction_at_points = friction_at_points;
        BlockCase<double> made = given::random_block<double>(random, wish);
        BlockCase<double> other = made;
        made.constraints.surface_velocities.assign(made.constraints.blocks.size(), {});
        for (Lane16<double>& speed : made.constraints.surface_velocities[given::kPlace].speed)
            for (double& lane : speed.at) lane = 1e-3;
        SolverIteration<double> iteration;
        iteration.inverse_substep = 240;
        iteration.push_limit = 3;
        const SolveKernels<double>& kernels = *solve_kernels_of<double>("scalar");
        made.solve(kernels, iteration);
        other.solve(kernels, iteration);
        int changed = 0;
        for (std::size_t lane = 0; lane < kBlock; ++lane)
            changed += made.block().friction_impulse[0].at[lane]
                    != other.block().friction_impulse[0].at[lane]
                ? 1
                : 0;
        EXPECT_GT(changed, 3);
    }
}

}  // namespace
}  // namespace throng
