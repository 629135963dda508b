// Contact rows: effective masses against brute force, what carries over, how contacts give way.
#include "tests/kernels/solve/random_contacts.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

using testing::random_block;
using testing::random_number;
using testing::random_vector;

// The change of relative velocity at two arms when a unit impulse acts there along a direction:
// done to two bodies, not computed.
Vec3 answer_to(const Vec3& impulse,
               const Vec3& arm_a,
               const Vec3& arm_b,
               const SolverBody<double>& a,
               const SolverBody<double>& b)
{
    const auto change = [](const SolverBody<double>& body, const Vec3& p, const Vec3& arm) {
        const Sym3 inverse{body.inertia[1], body.inertia[2], body.inertia[3],
                           body.inertia[4], body.inertia[5], body.inertia[6]};
        const Vec3 spin = inverse.matrix() * arm.cross(p);
        return Vec3(body.inertia[0] * p + spin.cross(arm));
    };
    return change(b, impulse, arm_b) - change(a, -impulse, arm_a);
}

TEST(ContactRows, EffectiveMassesAreThoseOfBruteForce)
{
    for (unsigned seed = 0; seed < 100; ++seed) {
        std::mt19937 random(seed);
        const auto made = random_block<double>(random, {});
        for (std::size_t lane = 0; lane < kBlock; ++lane) {
            const auto& contact = made.contacts[lane];
            const auto& a = made.bodies[static_cast<std::size_t>(made.block.a[lane])];
            const auto& b = made.bodies[static_cast<std::size_t>(made.block.b[lane])];
            Vec3 center_a = Vec3::Zero(), center_b = Vec3::Zero();
            for (int k = 0; k < contact.count; ++k) {
                const auto& point = contact.points[static_cast<std::size_t>(k)];
                const double answer =
                    contact.normal.dot(answer_to(contact.normal, point.from_a, point.from_b, a, b));
                ASSERT_NEAR(made.block.point[k].mass.at[lane] * answer, 1, 1e-12);
                center_a += point.from_a / contact.count;
                center_b += point.from_b / contact.count;
            }
            // Friction stops any slip across the normal, and the sliding mass never overshoots.
            const Vec3 t(made.block.tangent[0].at[lane], made.block.tangent[1].at[lane],
                         made.block.tangent[2].at[lane]);
            const Vec3 u = contact.normal.cross(t);
            ASSERT_NEAR(t.dot(contact.normal), 0, 1e-15);
            ASSERT_NEAR(t.norm(), 1, 1e-15);
            const double m11 = made.block.friction_mass[0].at[lane],
                         m22 = made.block.friction_mass[1].at[lane],
                         m12 = made.block.friction_mass[2].at[lane];
            const double x = random_number(random, -1, 1), y = random_number(random, -1, 1);
            const Vec3 impulse = t * (m11 * x + m12 * y) + u * (m12 * x + m22 * y);
            const Vec3 got = answer_to(impulse, center_a, center_b, a, b);
            ASSERT_NEAR(got.dot(t), x, 1e-11);
            ASSERT_NEAR(got.dot(u), y, 1e-11);
            double greatest = 0;
            for (int i = 0; i < 360; ++i) {
                const Vec3 along = std::cos(i * 0.0174532925) * t + std::sin(i * 0.0174532925) * u;
                greatest =
                    std::max(greatest, along.dot(answer_to(along, center_a, center_b, a, b)));
            }
            ASSERT_NEAR(made.block.sliding_mass.at[lane] * greatest, 1, 1e-3);
            ASSERT_NEAR(made.block.sliding_mass.at[lane] * made.block.sliding_answer.at[lane], 1,
                        1e-12);
        }
    }
}

TEST(ContactRows, WhatNothingCanMoveHasNoMass)
{
    ContactBlock<float> block;
    std::memset(static_cast<void*>(&block), 0, sizeof(block));
    block.points = 4;
    clear_lane(block, 3, 7);
    EXPECT_EQ(block.a[3], 7);
    EXPECT_EQ(block.b[3], 7);
    for (const auto& point : block.point) EXPECT_EQ(point.mass.at[3], 0);
    EXPECT_EQ(block.friction_mass[0].at[3], 0);
    EXPECT_EQ(block.sliding_mass.at[3], 0);
    EXPECT_EQ(block.twist_mass.at[3], 0);
    EXPECT_EQ(block.rolling_mass.at[3], 0);
}

TEST(ContactRows, AClearedLaneForgetsWhatItHeld)
{
    std::mt19937 random(1);
    auto made = random_block<float>(random, {.points = 4});
    made.block.points = 4;
    clear_lane(made.block, 2, 0);
    for (const auto& point : made.block.point) {
        EXPECT_EQ(point.mass.at[2], 0);
        EXPECT_EQ(point.impulse.at[2], 0);
    }
    EXPECT_EQ(made.block.twist_impulse.at[2], 0);
    EXPECT_EQ(made.block.friction_impulse[1].at[2], 0);
}

TEST(ContactRows, ImpulsesComeBackAsTheyWentIn)
{
    std::mt19937 random(2);
    const auto made = random_block<double>(random, {});
    for (int lane = 0; lane < kBlock; ++lane) {
        const auto& before = made.contacts[static_cast<std::size_t>(lane)];
        Contact<double> after = before;
        after.friction.setZero();
        after.rolling.setZero();
        after.twist = 0;
        for (auto& point : after.points) point.impulse = -1;
        store_impulses(made.block, lane, after);
        for (std::size_t k = 0; k < static_cast<std::size_t>(before.count); ++k)
            EXPECT_EQ(after.points[k].impulse, before.points[k].impulse);
        EXPECT_LE((after.friction - before.friction).norm(), 1e-15);
        EXPECT_EQ(after.rolling, before.rolling);
        EXPECT_EQ(after.twist, before.twist);
    }
}

// A contact of features 1, 2, ... each with its feature as impulse.
Contact<double> numbered(std::initializer_list<std::uint32_t> features)
{
    Contact<double> contact;
    for (const std::uint32_t feature : features) {
        auto& point = contact.points[static_cast<std::size_t>(contact.count++)];
        point.feature = feature;
        point.impulse = feature;
    }
    contact.friction = Vec3(0.5, 0, 0);
    contact.twist = 0.25;
    contact.rolling = Vec3(0, 0.125, 0);
    return contact;
}

Contact<double> fresh(std::initializer_list<std::uint32_t> features)
{
    Contact<double> contact = numbered(features);
    for (auto& point : contact.points) point.impulse = 0;
    contact.friction.setZero();
    contact.rolling.setZero();
    contact.twist = 0;
    return contact;
}

TEST(CarryImpulses, GoesByFeatureWhateverTheOrder)
{
    Contact<double> contact = fresh({3, 9, 1});
    carry_impulses<double>(numbered({1, 2, 3}), 1.0, 1.0, contact);
    EXPECT_EQ(contact.points[0].impulse, 3);
    EXPECT_EQ(contact.points[1].impulse, 0);
    EXPECT_EQ(contact.points[2].impulse, 1);
    EXPECT_EQ(contact.friction, Vec3(0.5, 0, 0));
    EXPECT_EQ(contact.twist, 0.25);
    EXPECT_EQ(contact.rolling, Vec3(0, 0.125, 0));
}

TEST(CarryImpulses, GivesEachImpulseOnce)
{
    Contact<double> contact = fresh({5, 5});
    carry_impulses<double>(numbered({5}), 1.0, 1.0, contact);
    EXPECT_EQ(contact.points[0].impulse, 5);
    EXPECT_EQ(contact.points[1].impulse, 0);
}

TEST(CarryImpulses, ScalesWithTheSubstep)
{
    Contact<double> contact = fresh({2, 4});
    carry_impulses<double>(numbered({2, 4}), 1.0, 0.5, contact);
    EXPECT_EQ(contact.points[0].impulse, 1);
    EXPECT_EQ(contact.points[1].impulse, 2);
    EXPECT_EQ(contact.friction, Vec3(0.25, 0, 0));
    EXPECT_EQ(contact.twist, 0.125);
}

TEST(CarryImpulses, TurnsFrictionIntoTheNewPlaneAndCutsItToTheCone)
{
    Contact<double> contact = fresh({1, 2});
    contact.normal = Vec3(1, 0, 1).normalized();
    Contact<double> before = numbered({1, 2});
    before.friction = Vec3(1, 1, 0);
    carry_impulses<double>(before, 0.1, 1.0, contact);
    EXPECT_NEAR(contact.friction.dot(contact.normal), 0, 1e-15);
    EXPECT_NEAR(contact.friction.norm(), 0.3, 1e-15);
}

TEST(CarryImpulses, WithoutNormalImpulsesThereIsNoFriction)
{
    Contact<double> contact = fresh({7, 8});
    carry_impulses<double>(numbered({1, 2}), 1.0, 1.0, contact);
    EXPECT_EQ(contact.friction, Vec3(Vec3::Zero()));
    EXPECT_EQ(contact.twist, 0);
    EXPECT_EQ(contact.rolling, Vec3(Vec3::Zero()));
}

TEST(CarryImpulses, ASinglePointTakesNoTwist)
{
    // Nothing would ever let go of it again: blocks of single points hold no twist.
    Contact<double> contact = fresh({1});
    carry_impulses<double>(numbered({1, 2, 3}), 1.0, 1.0, contact);
    EXPECT_EQ(contact.points[0].impulse, 1);
    EXPECT_EQ(contact.twist, 0);
}

TEST(Softness, IsADampedSpringIntegratedImplicitly)
{
    // One mass on a spring and a damper, by implicit Euler on paper: v' = (v - h w^2 x) / (1 + 2 z
    // h w
    // + h^2 w^2). The solver's form: v' = v - (1 - leak) (v + bias x) - leak * impulse, impulse 0.
    for (const double rate : {5.0, 30.0, 100.0})
        for (const double damping : {0.5, 1.0, 10.0})
            for (const double h : {1 / 60.0, 1 / 240.0}) {
                const auto soft = softness<double>(rate, damping, h);
                const double w = 2 * 3.14159265358979323846 * rate;
                const double x = -0.01, v = -0.3;
                const double wanted =
                    (v - h * w * w * x) / (1 + 2 * damping * h * w + h * h * w * w);
                const double got = v - (1 - soft.impulse_scale) * (v + soft.bias_rate * x);
                EXPECT_NEAR(got, wanted, 1e-13);
                EXPECT_GT(soft.impulse_scale, 0);
                EXPECT_LT(soft.impulse_scale, 1);
            }
}

}  // namespace
}  // namespace throng
