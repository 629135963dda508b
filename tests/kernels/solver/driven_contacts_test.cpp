// Driven contacts: who is driven walks on what bears it, and the kernel has it as the plain law.
#include "kernels/solver/driven_contacts.hpp"

#include "tests/kernels/solver/random_contacts.hpp"
#include "tests/support/same_bytes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace throng {
namespace {

using given::BlockCase;
using given::BlockWish;

constexpr double kFree = std::numeric_limits<double>::quiet_NaN();

Vec3 walk_of_b(const PrescribedVelocity& wanted, const Vec3& ground, const Vec3& normal)
{
    return walk_of(
        nullptr, &wanted, normal, Vec3::UnitZ(), [](bool) { return false; },
        [&](bool is_b) { return is_b ? Vec3(Vec3::Zero()) : ground; });
}

TEST(DrivenContacts, AWalkHasTheSpeedOfTheDrive)
{
    const PrescribedVelocity wanted = {1.4, 0, kFree};
    EXPECT_EQ(walk_of_b(wanted, Vec3::Zero(), Vec3::UnitZ()), Vec3(1.4, 0, 0));
    EXPECT_EQ(walk_of_b(wanted, Vec3(-2, 1, 0), Vec3::UnitZ()), Vec3(3.4, -1, 0));
    const Vec3 slope(-0.6, 0, 0.8);
    EXPECT_LT((walk_of_b(wanted, Vec3::Zero(), slope) - Vec3(1.4, 0, 1.05)).norm(), 1e-15);
}

TEST(DrivenContacts, NobodyWalksOnWallsCeilingsOrWithoutADrive)
{
    const PrescribedVelocity wanted = {1.4, 0, kFree}, none = {kFree, kFree, kFree};
    EXPECT_TRUE(walk_of_b(wanted, Vec3::Zero(), Vec3(-0.8, 0, 0.6)).isZero(0));
    EXPECT_TRUE(walk_of_b(wanted, Vec3::Zero(), -Vec3::UnitZ()).isZero(0));
    EXPECT_TRUE(walk_of_b(none, Vec3(1, 2, 0), Vec3::UnitZ()).isZero(0));
}

TEST(DrivenContacts, EitherSideWalksAlike)
{
    const PrescribedVelocity wanted = {1.4, kFree, 0};
    const Vec3 normal = Vec3(0.1, 0.2, 0.95).normalized(), ground(0.3, -0.2, 0.1);
    const Vec3 other = walk_of(
        &wanted, nullptr, -normal, Vec3::UnitZ(), [](bool) { return false; },
        [&](bool) { return ground; });
    EXPECT_EQ(other, -walk_of_b(wanted, ground, normal));
    EXPECT_NEAR(other.dot(normal), 0, 1e-15);
}

// What the kernel should tell of a lane.
template <class Real>
Vec3 plain_walk(BlockCase<Real>& made, std::size_t lane, const Vec3& up)
{
    const ContactConstraintWide<Real>& block = made.block();
    PrescribedVelocity prescribed[2];
    const PrescribedVelocity* driven[2] = {nullptr, nullptr};
    const std::int32_t places[2] = {block.a[lane], block.b[lane]};
    for (int side = 0; side < 2; ++side) {
        const Real* const number =
            made.constraints.prescribed[static_cast<std::size_t>(places[side])].number;
        for (int k = 0; k < 3; ++k)
            prescribed[side][static_cast<std::size_t>(k)] =
                number[4 + k] > 0 ? double{number[k]} : kFree;
        if (number[4] + number[5] + number[6] > 0) driven[side] = &prescribed[side];
    }
    const auto rolls = [&](bool is_b) {
        const auto place = static_cast<std::size_t>(places[is_b ? 1 : 0]);
        return (is_b ? block.round_b : block.round_a).at[lane] > 0
            && made.constraints.prescribed[place].number[3] > 0;
    };
    const auto velocity = [&](bool is_b) -> Vec3 {
        const Real* const v = (is_b ? made.body_b(lane) : made.body_a(lane)).motion;
        return Vec3(double{v[0]}, double{v[1]}, double{v[2]})
            + Vec3(double{v[4]}, double{v[5]}, double{v[6]})
                  .cross(in_double(is_b ? block.center_b : block.center_a, lane));
    };
    return walk_of(driven[0], driven[1], in_double(block.normal, lane), up, rolls, velocity);
}

template <class Real>
void drive_some(std::mt19937& random, std::vector<SolverPrescribedVelocity<Real>>& prescribed)
{
    for (std::size_t place = 1; place < prescribed.size() - 1; ++place) {
        if (random() % 4 == 0) continue;
        for (int k = 0; k < 3; ++k) {
            const bool acts = random() % 3 != 0;
            prescribed[place].number[4 + k] = Real(acts);
            prescribed[place].number[k] =
                acts ? static_cast<Real>(given::random_number(random, -2, 2)) : Real(0);
        }
        prescribed[place].number[3] = Real(random() % 2);
    }
}

template <class Real>
void check_kernel(const SolveKernels<Real>& kernels, double tolerance)
{
    for (unsigned seed = 0; seed < 200; ++seed) {
        std::mt19937 random(seed);
        BlockCase<Real> made = given::random_block<Real>(random, BlockWish{});
        made.constraints.surface_velocities.assign(made.constraints.blocks.size(), {});
        made.constraints.prescribed.assign(made.constraints.bodies.size(), {});
        drive_some(random, made.constraints.prescribed);
        const Vec3 up = in_double(made.block().normal, 0);
        const Real up_real[3] = {Real(up.x()), Real(up.y()), Real(up.z())};
        SurfaceVelocityWide<Real>& carried = made.constraints.surface_velocities[given::kPlace];
        for (std::size_t lane = 0; lane < kBlock; ++lane) {
            carried.by_b.at[lane] = 1;
            carried.speed[0].at[lane] = 7;
        }
        BlockCase<Real> narrow = made;
        kernels.walk_surface_velocity(made.view(), given::kPlace, up_real);
        solve_kernels_of<Real>("scalar")->walk_surface_velocity(narrow.view(), given::kPlace,
                                                                up_real);
        ASSERT_TRUE(
            given::same_bytes(narrow.constraints.surface_velocities[given::kPlace], carried));
        for (std::size_t lane = 0; lane < kBlock; ++lane) {
            const Vec3 walk = plain_walk(made, lane, up);
            const bool walks = !walk.isZero(0);
            ASSERT_EQ(carried.by_b.at[lane], Real(!walks)) << seed << ' ' << lane;
            const Vec3 tangent = in_double(made.block().tangent, lane);
            const Vec3 other = in_double(made.block().normal, lane).cross(tangent);
            ASSERT_NEAR(double{carried.speed[0].at[lane]}, walks ? -walk.dot(tangent) : 7,
                        tolerance);
            ASSERT_NEAR(double{carried.speed[1].at[lane]}, -walk.dot(other), tolerance);
        }
    }
}

TEST(DrivenContacts, OfBlocksFollowTheSameLawOnEveryWidth)
{
    for (const char* width : {"scalar", "avx2", "avx512"}) {
        if (const auto* kernels = solve_kernels_of<float>(width)) check_kernel(*kernels, 1e-4);
        if (const auto* kernels = solve_kernels_of<double>(width)) check_kernel(*kernels, 1e-12);
    }
}

}  // namespace
}  // namespace throng
