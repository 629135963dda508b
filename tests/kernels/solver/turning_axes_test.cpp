// Turning axes: what contacts are told of bodies that roll while their axes turn.
#include "kernels/math/rotation.hpp"
#include "kernels/solver/solver_bodies.hpp"
#include "tests/kernels/solver/random_contacts.hpp"
#include "tests/support/same_bytes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace throng {
namespace {

using given::BlockCase;
using given::BlockWish;

constexpr double kHalf = 1.0 / 48000;  // s: what is of the third order in it is rounding

// Turned by an angle since the step began, and symmetric about some axis.
template <class Real>
void turn_body(std::mt19937& random,
               double angle,
               SolverBody<Real>& body,
               GyroscopicInertia<Real>& inertia)
{
    const Quat turn = exponential(Vec3(angle * given::random_vector(random, 1).normalized()));
    for (int k = 0; k < 4; ++k) body.delta_pose[4 + k] = static_cast<Real>(turn.coeffs()[k]);
    const Vec3 axis = given::random_vector(random, 1).normalized();
    for (int k = 0; k < 3; ++k) inertia.axis[k] = static_cast<Real>(axis[k]);
    inertia.share[6] = 1;
    inertia.axis[3] = Real(0.7);
}

// The velocity that a spin gives a side at its center, turned with its axis to the middle of the
// substep, less what it is as the spin stands.
template <class Real>
Vec3 plain_turn_of_axis(const SolverBody<Real>& body,
                        const GyroscopicInertia<Real>& inertia,
                        const Vec3& arm)
{
    const Quat axes = spin_frame(body, &inertia);
    const Vec3 first = vector_at(inertia.axis), axis = axes * first;
    if (first.dot(axis) < 1 - kFarthestAxisTurn * kFarthestAxisTurn / 2) return Vec3::Zero();
    const Vec3 spin = vector_at(body.motion + 4), still = spin.cross(arm), in_world = axes * spin;
    const Vec3 rate = in_world - axis * axis.dot(in_world);
    return exponential(Vec3(rate * kHalf)) * Vec3(axes * still) - still;
}

template <class Real>
void check_kernel(const SolveKernels<Real>& kernels, double tolerance)
{
    int turned = 0;
    for (unsigned seed = 0; seed < 50; ++seed) {
        std::mt19937 random(seed);
        BlockCase<Real> made = given::random_block<Real>(random, BlockWish{});
        auto& constraints = made.constraints;
        constraints.surface_velocities.assign(constraints.blocks.size(), {});
        constraints.inertias.assign(constraints.bodies.size(), {});
        SurfaceVelocityWide<Real>& surface = constraints.surface_velocities[given::kPlace];
        for (std::size_t i = 1; i < constraints.bodies.size(); ++i)
            turn_body(random, i % 4 == 0 ? 1.0 : 0.15, constraints.bodies[i],
                      constraints.inertias[i]);
        ContactConstraintWide<Real>& block = made.block();
        block.axis_turns_a = 0b0101'0101'0011'1001;
        block.axis_turns_b = 0b1001'0101'1100'1100;
        // Of who walks: where no axis turns it stays.
        for (Lane16<Real>& speed : surface.speed)
            for (Real& lane : speed.at) lane = Real(5);
        BlockCase<Real> narrow = made;
        kernels.update_surface_velocity(made.view(), given::kPlace, given::kPlace + 1,
                                        static_cast<Real>(kHalf));
        solve_kernels_of<Real>("scalar")->update_surface_velocity(
            narrow.view(), given::kPlace, given::kPlace + 1, static_cast<Real>(kHalf));
        ASSERT_TRUE(
            given::same_bytes(narrow.constraints.surface_velocities[given::kPlace], surface));
        for (std::size_t lane = 0; lane < kBlock; ++lane) {
            const auto turn_of_axis = [&](std::int32_t body, const Vec3& arm) {
                const auto place = static_cast<std::size_t>(body);
                return plain_turn_of_axis(constraints.bodies[place], constraints.inertias[place],
                                          arm);
            };
            Vec3 slip = Vec3::Zero();
            const bool by_a = (block.axis_turns_a >> lane & 1) != 0,
                       by_b = (block.axis_turns_b >> lane & 1) != 0;
            if (by_b) slip += turn_of_axis(block.b[lane], in_double(block.center_b, lane));
            if (by_a) slip -= turn_of_axis(block.a[lane], in_double(block.center_a, lane));
            turned += slip.norm() > 0.05 ? 1 : 0;
            const Vec3 normal = in_double(block.normal, lane);
            const Vec3 tangent = in_double(block.tangent, lane);
            const bool turns = by_a || by_b;
            ASSERT_NEAR(double{surface.speed[0].at[lane]}, turns ? tangent.dot(slip) : 5.0,
                        tolerance);
            ASSERT_NEAR(double{surface.speed[1].at[lane]},
                        turns ? normal.cross(tangent).dot(slip) : 5.0, tolerance);
        }
    }
    EXPECT_GT(turned, 50);
}

TEST(TurningAxes, FollowTheSameLawOnEveryWidth)
{
    for (const char* width : {"scalar", "avx2", "avx512"}) {
        if (const auto* kernels = solve_kernels_of<float>(width)) check_kernel(*kernels, 3e-5);
        if (const auto* kernels = solve_kernels_of<double>(width)) check_kernel(*kernels, 1e-10);
    }
}

// Whose axis is seen to turn: of who can be moved, by the part of its spin that turns its axis.
TEST(TurningAxes, AreSeenByWhatTurnsTheirAxes)
{
    SolverBody<double> body = {};
    body.inertia[0] = body.motion[4] = 1;
    GyroscopicInertia<double> inertia = {};
    inertia.share[6] = 1;
    EXPECT_FALSE(axis_turns(body, inertia, 0.1));
    inertia.axis[2] = inertia.axis[3] = 1;
    EXPECT_TRUE(axis_turns(body, inertia, 0.1));
    EXPECT_FALSE(axis_turns(body, inertia, 1e-4));
    EXPECT_FALSE(axis_turns(body, inertia, 0.5));
    body.inertia[0] = 0;
    EXPECT_FALSE(axis_turns(body, inertia, 0.1));
    body.inertia[0] = body.motion[6] = 1;
    body.motion[4] = 0;
    EXPECT_FALSE(axis_turns(body, inertia, 0.1));
}

// Who rolls: who is pushed below its axis, and across rather than along it.
TEST(TurningAxes, AreOfWhoIsPushedBelowItsAxis)
{
    GyroscopicInertia<double> inertia = {};
    inertia.axis[0] = 1;
    EXPECT_TRUE(rolls_on_axis(inertia, Vec3::UnitZ(), Vec3(0.1, 0, -1)));
    EXPECT_FALSE(rolls_on_axis(inertia, Vec3::UnitZ(), Vec3(0.1, 0.1, -1)));
    EXPECT_TRUE(rolls_on_axis(inertia, Vec3(0.6, 0, 0.8), Vec3(0.1, 0, -1)));
    EXPECT_FALSE(rolls_on_axis(inertia, Vec3(0.96, 0, 0.28), Vec3(0.1, 0, -1)));
}

}  // namespace
}  // namespace throng
