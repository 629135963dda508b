// What overlap=subdivide keeps to, through the public door.
#include "tests/pipeline/event_driven/carried_scenes.hpp"
#include "tests/support/dice.hpp"
#include "throng/dials.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

using given::box_on_a_lift;
using given::carried;
using given::energy_of;
using given::greatest_speed;
using given::hash_after;
using given::heap_of_balls;
using given::least_separation;
using given::place_of;
using given::row_of_balls;
using given::SceneOf;
using given::stack_of_boxes;
using given::tumbling_boxes;
using given::velocity_of;

constexpr double kGravity = 9.81, kTolerance = 1e-4;

SceneOf divided(double friction, double restitution)
{
    return carried(Overlap::subdivide, friction, restitution);
}

// m/s: nobody in these heaps falls further.
double fall_speed(double height) { return std::sqrt(2 * kGravity * height); }

// The bound that is stated: the tolerance, and what two close in the shortest piece.
double bound_of(const Settings& settings, double size, double closing)
{
    const int halvings = settings.halvings > 0 ? settings.halvings : 12;
    return settings.toi_tolerance * size
        + closing * settings.dt / settings.substeps / std::pow(2, halvings);
}

// The deepest that balls come that are let fall from many heights, one at a time.
double deepest_of_falls(int halvings)
{
    double deepest = 0;
    for (int i = 0; i < 40; ++i) {
        SceneOf made = divided(0, 0.5);
        made.scene.settings.halvings = halvings;
        made.floor();
        made.ball(0.1, Vec3(0, 0, 0.5 + 0.0137 * i));
        World world(made.scene);
        world.step(45);
        deepest = std::max(deepest, world.report().deepest);
        EXPECT_LE(world.report().deepest, bound_of(made.scene.settings, 0.1, fall_speed(1.1)));
        EXPECT_LT(velocity_of(world, 1).norm(), fall_speed(1.1));
    }
    return deepest;
}

TEST(Subdivide, OverlapFallsWithTheHalvings)
{
    // Each two are a quarter: the bound is, and over so many falls the deepest comes near it.
    double before = 1;
    for (const int halvings : {2, 4, 6, 8}) {
        const double deepest = deepest_of_falls(halvings);
        EXPECT_GT(deepest, kTolerance * 0.1) << halvings;
        EXPECT_LT(deepest, before / 2) << halvings;
        before = deepest;
    }
    EXPECT_LE(deepest_of_falls(14), kTolerance * 0.1);
}

TEST(Subdivide, TellsWherePiecesEndTooDeep)
{
    for (const int halvings : {1, 14}) {
        SceneOf made = divided(0, 0.5);
        made.scene.settings.halvings = halvings;
        made.floor();
        made.ball(0.1, Vec3(0, 0, 1));
        World world(made.scene);
        world.step(30);
        EXPECT_EQ(world.report().fallbacks > 0, halvings == 1);
        EXPECT_EQ(world.report().deepest > kTolerance * 0.1, halvings == 1);
    }
}

// The last piece ends up to 5e-5 m past the touch, and the line of the centers has turned by then.
TEST(Subdivide, TwoFastBallsLeaveByTheLineOfTheirTouch)
{
    const double radius = 0.01, aside = 0.012, speed = 50;
    const double along = aside / (2 * radius);
    const Vec3 normal(std::sqrt(1 - along * along), along, 0);
    for (const double restitution : {1.0, 0.5, 0.0}) {
        SceneOf made = divided(0, restitution);
        made.scene.gravity = Vec3::Zero();
        BodyDescription& one = made.ball(radius, Vec3(-1, 0, 0));
        one.mass = 1;
        one.velocity = Vec3(speed, 0, 0);
        BodyDescription& other = made.ball(radius, Vec3(1, aside, 0));
        other.mass = 1;
        other.velocity = Vec3(-speed, 0, 0);
        World world(made.scene);
        world.step(3);
        const double impulse = (1 + restitution) * speed * normal.x();
        const Vec3 after = Vec3(speed, 0, 0) - normal * impulse;
        EXPECT_LT((velocity_of(world, 0) - after).norm(), 1e-6 * speed) << restitution;
        EXPECT_LT((velocity_of(world, 1) + after).norm(), 1e-6 * speed) << restitution;
    }
}

TEST(Subdivide, ElasticBallKeepsItsEnergyWhereItsFlightDoes)
{
    SceneOf made = divided(0, 1);
    made.scene.settings.integrator = Integrator::midpoint;
    made.scene.settings.dt = 0.01;
    made.floor();
    made.ball(0.1, Vec3(0, 0, 1));
    World world(made.scene);
    const double before = energy_of(world);
    double least = 1;
    for (int step = 0; step < 500; ++step) {
        world.step();
        least = std::min(least, least_separation(world, 1, 0.1));
        ASSERT_NEAR(energy_of(world), before, 1e-9 * before);
    }
    EXPECT_LT(least, 0.05);  // it does come down
}

TEST(Subdivide, ImpactsFollowImpactsInAStep)
{
    World world(row_of_balls(Overlap::subdivide));
    world.step();
    // Each impact is up to the tolerance, or the shortest piece, early or late.
    const double off = 2 * (kTolerance * 0.5 + 100 * 0.1 / 4096);
    for (std::size_t i = 0; i < 3; ++i) {
        const double wanted = i == 0 ? 1 : i == 1 ? 3 : 12;
        EXPECT_NEAR(place_of(world, i).x(), wanted, off);
        EXPECT_NEAR(velocity_of(world, i).x(), i == 2 ? 100 : 0, 1e-9);
    }
}

TEST(Subdivide, BallsKeepTheirBoundAndGainNoEnergy)
{
    for (const double restitution : {0.0, 0.5}) {
        const Scene scene = heap_of_balls(Overlap::subdivide, restitution);
        World world(scene);
        const double bound = bound_of(scene.settings, 0.1, 2 * fall_speed(0.7));
        double energy = energy_of(world);
        for (int step = 0; step < 60; ++step) {
            world.step();
            ASSERT_GT(least_separation(world, 1, 0.1), -bound) << "step " << step;
            ASSERT_LT(energy_of(world), energy * (1 + 1e-6));
        }
        EXPECT_LE(world.report().deepest, bound);
        EXPECT_GT(world.report().deepest, 0);
        EXPECT_LT(energy_of(world), 0.9 * energy);
    }
}

TEST(Subdivide, BoxesThatTumbleKeepTheirBound)
{
    const Scene scene = tumbling_boxes(Overlap::subdivide);
    World world(scene);
    // Falls of 3 m, and corners half a meter out at twice the greatest spin that those leave.
    const double bound = bound_of(scene.settings, 0.1, 2 * fall_speed(3) + 0.5 * 30);
    for (int step = 0; step < 150; ++step) {
        world.step();
        ASSERT_LE(world.measure().greatest_overlap, bound) << "step " << step;
    }
    EXPECT_LE(world.report().deepest, bound);
    EXPECT_EQ(world.report().fallbacks, 0u);
    EXPECT_LT(place_of(world, 1).z(), 0.5);  // it has come down
}

TEST(Subdivide, StackStandsStillAndApart)
{
    World world(stack_of_boxes(Overlap::subdivide, 4));
    world.step(120);
    EXPECT_EQ(world.measure().overlapping_pairs, 0u);
    EXPECT_LT(greatest_speed(world), 1e-6);
    for (std::size_t i = 1; i <= 4; ++i)  // each half of 1e-4 times 0.5 m over the one below
        EXPECT_NEAR(place_of(world, i).z(), static_cast<double>(i) * (1 + 2.5e-5) - 0.5, 1e-5);
    EXPECT_EQ(world.report().fallbacks, 0u);
}

TEST(Subdivide, MomentumIsKept)
{
    SceneOf made = divided(0.4, 0.3);
    made.scene.gravity = Vec3::Zero();
    made.scene.settings.integrator = Integrator::splitting;  // which keeps it in flight
    test::Dice dice(7);
    for (int i = 0; i < 6; ++i) {
        const Vec3 at(i % 2, i / 2 % 2, i / 4);
        BodyDescription& box = made.box(Vec3(0.2, 0.15, 0.1), at);
        box.velocity = Vec3(0.5, 0.5, 0.5) - at + dice.point(0.1);
        box.angular_velocity = Vec3(0, 1, 0) + dice.point(1);
    }
    World world(made.scene);
    const Measures before = world.measure();
    world.step(90);
    const Measures after = world.measure();
    EXPECT_GT(world.report().deepest, 0);  // they did meet
    EXPECT_EQ(world.report().fallbacks, 0u);
    EXPECT_LT((after.momentum - before.momentum).norm(), 1e-9 * 6 * 24);
    // Friction acts half a gap, or half an overlap, off each surface.
    const double arm = bound_of(made.scene.settings, 0.1, 5);
    EXPECT_LT((after.angular_momentum - before.angular_momentum).norm(), arm * 6 * 24);
    EXPECT_LT(after.kinetic_energy, before.kinetic_energy);
}

TEST(Subdivide, IsAllowWhereNothingTouches)
{
    Pose allowed;
    for (const Overlap overlap : {Overlap::allow, Overlap::subdivide}) {
        SceneOf made = carried(overlap, 0.5, 0);
        made.scene.settings.substeps = 4;
        made.floor();
        for (int i = 0; i < 3; ++i) {
            BodyDescription& box = made.box(Vec3(0.3, 0.2, 0.1), Vec3(2 * i, 0, 20));
            box.angular_velocity = Vec3(1, 2, 3);
        }
        World world(made.scene);
        world.step(60);
        EXPECT_EQ(world.report().deepest, 0);
        const Pose end = world.pose(world.bodies().back());
        if (overlap == Overlap::allow) allowed = end;
        // Two ways to add up the same: 240 substeps of rounding.
        EXPECT_LT((end.position - allowed.position).norm(), 1e-12 * 20);
        EXPECT_LT(end.orientation.angularDistance(allowed.orientation), 1e-7);
        EXPECT_LT((velocity_of(world, 3) - Vec3(0, 0, -kGravity)).norm(), 1e-12);
    }
}

TEST(Subdivide, NothingPassesThroughAThinWall)
{
    for (const double speed : {20.0, 100.0, 700.0}) {
        SceneOf made = divided(0, 0);
        made.scene.gravity = Vec3::Zero();
        made.box(Vec3(0.005, 1, 1), Vec3::Zero()).motion = Motion::static_;
        made.ball(0.02, Vec3(-1.23, 0, 0)).velocity = Vec3(speed, 0, 0);
        World world(made.scene);
        world.step(10);
        EXPECT_LT(place_of(world, 1).x(), 0) << speed;
    }
}

TEST(Subdivide, WhatIsJammedIsToldAndTakesBoundedWork)
{
    SceneOf made = divided(0.5, 0);
    made.scene.settings.dt = 0.01;
    made.box(Vec3(0.1, 1, 1), Vec3(-0.35, 0, 0)).motion = Motion::static_;
    made.box(Vec3(0.2, 0.2, 0.2), Vec3::Zero());
    BodyDescription& press = made.box(Vec3(0.1, 1, 1), Vec3(0.35, 0, 0));
    press.motion = Motion::kinematic;
    press.velocity = Vec3(-1, 0, 0);
    made.scene.gravity = Vec3::Zero();
    World world(made.scene);
    world.step(12);
    EXPECT_GT(world.report().fallbacks, 0u);
    EXPECT_GT(world.report().deepest, 1e-3);
    EXPECT_LT(place_of(world, 1).norm(), 0.2);  // and it is not thrown out
    EXPECT_EQ(world.report().bodies_quarantined, 0u);
}

TEST(Subdivide, SameBitsForAnyNumberOfThreads)
{
    const Scene scene = heap_of_balls(Overlap::subdivide, 0.5);
    const std::string wanted = hash_after(scene, 1, 30);
    EXPECT_EQ(hash_after(scene, 2, 30), wanted);
    EXPECT_EQ(hash_after(scene, 3, 30), wanted);
}

TEST(Subdivide, PlatformCarriesWhatRestsOnIt)
{
    World world(box_on_a_lift(Overlap::subdivide));
    world.step(100);
    EXPECT_EQ(world.measure().overlapping_pairs, 0u);
    EXPECT_LT((velocity_of(world, 1) - Vec3(0.2, 0, 1)).norm(), 1e-6);
}

TEST(Subdivide, SaysWhichDialsItLeaves)
{
    SceneOf made = divided(0.5, 0);
    made.floor();
    made.ball(0.1, Vec3(0, 0, 0.2));
    made.scene.dials_set = {"overlap", "halvings", "solver"};
    ASSERT_EQ(unused_dials(made.scene).size(), 1u);
    EXPECT_EQ(unused_dials(made.scene)[0],
              "solver: unused, overlap subdivide solves contacts in its own way");
    made.scene.settings.overlap = Overlap::back_up;
    made.scene.dials_set = {"halvings"};
    ASSERT_EQ(unused_dials(made.scene).size(), 1u);
    EXPECT_EQ(unused_dials(made.scene)[0], "halvings: unused, overlap back_up divides no step");
}

}  // namespace
}  // namespace throng
