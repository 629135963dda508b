// Swinging spins: what contacts are told of bodies whose spins go along with their axes.
#include "kernels/math/rotation.hpp"
#include "kernels/solver/solver_bodies.hpp"
#include "tests/kernels/solver/random_contacts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

namespace throng {
namespace {

using given::BlockCase;
using given::BlockWish;

constexpr double kHalf = 1.0 / 48000;  // s: what is of the third order in it is rounding

Vec3 random_unit(std::mt19937& random)
{
    std::normal_distribution<double> normal;
    const double x = normal(random), y = normal(random), z = normal(random);
    return Vec3(x, y, z).normalized();
}

template <class Real>
Vec3 vector_of(const Real* numbers)
{
    return {double{numbers[0]}, double{numbers[1]}, double{numbers[2]}};
}

template <class Real>
Vec3 vector_of(const Lane16<Real> (&numbers)[3], std::size_t lane)
{
    return {double{numbers[0].at[lane]}, double{numbers[1].at[lane]}, double{numbers[2].at[lane]}};
}

// Turned by an angle since the step began, and symmetric about some axis.
template <class Real>
void turn_body(std::mt19937& random,
               double angle,
               SolverBody<Real>& body,
               GyroscopicInertia<Real>& inertia)
{
    const Quat turn = exponential(angle * random_unit(random));
    for (int k = 0; k < 4; ++k) body.delta_pose[4 + k] = static_cast<Real>(turn.coeffs()[k]);
    const Vec3 axis = random_unit(random);
    for (int k = 0; k < 3; ++k) inertia.axis[k] = static_cast<Real>(axis[k]);
    inertia.share[6] = 1;
    inertia.axis[3] = Real(0.7);
}

// The velocity that a spin gives a side at its center, turned with its axis to the middle of the
// substep, less what it is as the spin stands.
template <class Real>
Vec3 plain_swing(const SolverBody<Real>& body,
                 const GyroscopicInertia<Real>& inertia,
                 const Vec3& arm)
{
    const Quat axes = spin_frame(body, &inertia);
    const Vec3 first = vector_of(inertia.axis), axis = axes * first;
    if (first.dot(axis) < 0.98) return Vec3::Zero();
    const Vec3 spin = vector_of(body.motion + 4), still = spin.cross(arm), in_world = axes * spin;
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
        block.swings_a = 0b0101'0101'0011'1001;
        block.swings_b = 0b1001'0101'1100'1100;
        // Of who walks: what does not swing keeps it.
        for (Lane16<Real>& speed : surface.speed)
            for (Real& lane : speed.at) lane = Real(5);
        BlockCase<Real> narrow = made;
        kernels.update_surface_velocity(made.view(), given::kPlace, given::kPlace + 1,
                                        static_cast<Real>(kHalf));
        solve_kernels_of<Real>("scalar")->update_surface_velocity(
            narrow.view(), given::kPlace, given::kPlace + 1, static_cast<Real>(kHalf));
        ASSERT_EQ(std::memcmp(&narrow.constraints.surface_velocities[given::kPlace], &surface,
                              sizeof surface),
                  0);
        for (std::size_t lane = 0; lane < kBlock; ++lane) {
            const auto swing_of = [&](std::int32_t body, const Vec3& arm) {
                const auto place = static_cast<std::size_t>(body);
                return plain_swing(constraints.bodies[place], constraints.inertias[place], arm);
            };
            Vec3 slip = Vec3::Zero();
            const bool by_a = (block.swings_a >> lane & 1) != 0,
                       by_b = (block.swings_b >> lane & 1) != 0;
            if (by_b) slip += swing_of(block.b[lane], vector_of(block.center_b, lane));
            if (by_a) slip -= swing_of(block.a[lane], vector_of(block.center_a, lane));
            turned += slip.norm() > 0.05 ? 1 : 0;
            const Vec3 normal = vector_of(block.normal, lane);
            const Vec3 tangent = vector_of(block.tangent, lane);
            const bool swings = by_a || by_b;
            ASSERT_NEAR(double{surface.speed[0].at[lane]}, swings ? tangent.dot(slip) : 5.0,
                        tolerance);
            ASSERT_NEAR(double{surface.speed[1].at[lane]},
                        swings ? normal.cross(tangent).dot(slip) : 5.0, tolerance);
        }
    }
    EXPECT_GT(turned, 50);
}

TEST(SwingingSpins, FollowTheSameLawOnEveryWidth)
{
    for (const char* width : {"scalar", "avx2", "avx512"}) {
        if (const auto* kernels = solve_kernels_of<float>(width)) check_kernel(*kernels, 3e-5);
        if (const auto* kernels = solve_kernels_of<double>(width)) check_kernel(*kernels, 1e-10);
    }
}

// Who is seen to swing: who can be moved, by the part of its spin that turns its axis.
TEST(SwingingSpins, AreSeenByWhatTurnsTheirAxes)
{
    SolverBody<double> body = {};
    body.inertia[0] = body.motion[4] = 1;
    GyroscopicInertia<double> inertia = {};
    inertia.share[6] = 1;
    EXPECT_FALSE(spin_swings(body, inertia, 0.1));
    inertia.axis[2] = inertia.axis[3] = 1;
    EXPECT_TRUE(spin_swings(body, inertia, 0.1));
    EXPECT_FALSE(spin_swings(body, inertia, 1e-4));
    EXPECT_FALSE(spin_swings(body, inertia, 0.5));
    body.inertia[0] = 0;
    EXPECT_FALSE(spin_swings(body, inertia, 0.1));
    body.inertia[0] = body.motion[6] = 1;
    body.motion[4] = 0;
    EXPECT_FALSE(spin_swings(body, inertia, 0.1));
}

// Who rolls: who is pushed below its axis, and across rather than along it.
TEST(SwingingSpins, AreOfWhoIsPushedBelowItsAxis)
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
