// Corners: odd bodies, odd sizes and changes from outside, each with what it must do all the same.
#include "kernels/math/rotation.hpp"
#include "tests/support/small_scenes.hpp"
#include "throng/world.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace throng {
namespace {

using given::SceneOf;

double height_of(const World& world, std::size_t body)
{
    return world.pose(world.bodies()[body]).position.z();
}

TEST(KinematicPlanes, HoldWhatLiesOnThemAndLiftIt)
{
    for (const double tilt : {0.0, 0.01})
        for (const double speed : {0.0, 0.5}) {
            SceneOf made;
            BodyDescription& floor = made.floor();
            floor.motion = Motion::kinematic;
            floor.orientation = exponential(Vec3(tilt, 0, 0));
            floor.velocity = Vec3(0, 0, speed);
            made.box(Vec3(0.5, 0.5, 0.5), Vec3(0, 0, 1));
            World world(made.scene);
            world.step(120);
            EXPECT_NEAR(height_of(world, 1), 0.5 + 2 * speed, 0.01) << tilt << " " << speed;
        }
}

TEST(KinematicPlanes, ReachFromAfarWhoeverDoesNotMove)
{
    SceneOf made;
    made.scene.gravity.setZero();
    BodyDescription& floor = made.floor();
    floor.motion = Motion::kinematic;
    floor.position = Vec3(0, 0, -3);
    floor.velocity = Vec3(0, 0, 1);
    floor.orientation = exponential(Vec3(0.01, 0, 0));
    made.box(Vec3(0.5, 0.5, 0.5), Vec3(0, 0, 1));
    World world(made.scene);
    world.step(360);
    EXPECT_GT(height_of(world, 1), 3.4);
}

TEST(LockedBodies, ABallThatCannotYieldIsNotSpun)
{
    for (const double depth : {0.0, 0.01, 0.1})
        for (const double tilt : {0.0, 0.3}) {
            SceneOf made;
            made.floor().orientation = exponential(Vec3(tilt, tilt / 3, 0));
            BodyDescription& ball = made.ball(0.5, Vec3(0.3, 0.7, 0.5 - depth));
            ball.lock_position = true;
            ball.orientation = exponential(Vec3(0.3, 0.4, 0.5));
            ball.angular_velocity = Vec3(0, 3, 0);
            World world(made.scene);
            for (int i = 0; i < 60; ++i) {
                world.step();
                ASSERT_LT(given::greatest_speed(world), 3 + 1e-6) << depth << " " << tilt;
            }
            EXPECT_FALSE(world.quarantined(world.bodies()[1]));
        }
}

// A box that fell asleep on the floor.
World sleeping_box()
{
    SceneOf made;
    made.floor();
    made.box(Vec3(0.5, 0.5, 0.5), Vec3(0, 0, 0.5));
    made.box(Vec3(0.5, 0.5, 0.5), Vec3(9, 0, 0.5)).motion = Motion::static_;
    World world(made.scene);
    world.step(120);
    return world;
}

TEST(Sleep, WhatIsPutIntoASleeperWakesIt)
{
    const Vec3 into(0.8, 0, 0.5);
    for (const Motion motion : {Motion::static_, Motion::kinematic}) {
        World world = sleeping_box();
        ASSERT_FALSE(world.awake(world.bodies()[1]));
        SceneOf added;
        added.box(Vec3(0.5, 0.5, 0.5), into).motion = motion;
        world.add(added.scene);
        world.step(60);
        EXPECT_NEAR(world.pose(world.bodies()[1]).position.x(), -0.2, 0.01);
    }
    World world = sleeping_box();
    world.set_pose(world.bodies()[2], {into, Quat::Identity()});
    world.step(60);
    EXPECT_NEAR(world.pose(world.bodies()[1]).position.x(), -0.2, 0.01);
}

TEST(Sleep, NobodySleepsInFlight)
{
    SceneOf drifting;
    drifting.scene.gravity.setZero();
    drifting.box(Vec3(0.5, 0.5, 0.5), Vec3::Zero()).velocity = Vec3(0.01, 0, 0);
    drifting.box(Vec3(0.5, 0.5, 0.5), Vec3(50, 0, 0));
    World world(drifting.scene);
    world.step(600);
    EXPECT_NEAR(world.pose(world.bodies()[0]).position.x(), 0.1, 1e-9);
    EXPECT_FALSE(world.awake(world.bodies()[1]));

    // Where gravity is weak the top of a throw takes seconds.
    SceneOf thrown;
    thrown.scene.gravity = Vec3(0, 0, -0.01);
    thrown.floor();
    thrown.ball(0.5, Vec3(0, 0, 1)).velocity = Vec3(0, 0, 0.02);
    World moon(thrown.scene);
    moon.step(1200);
    EXPECT_NEAR(height_of(moon, 1), 0.5, 0.01);
}

TEST(Sleep, AStepOfAnotherLengthLeavesTheForcesOfSleepersAlone)
{
    World world = sleeping_box();
    const double before = world.contact_force(world.bodies()[1]).z();
    ASSERT_GT(before, 0);
    Settings settings = world.settings();
    settings.dt /= 10;
    world.set_settings(settings);
    world.step();
    EXPECT_FALSE(world.awake(world.bodies()[1]));
    EXPECT_NEAR(world.contact_force(world.bodies()[1]).z(), before, 1e-5 * before);
}

TEST(RollingFriction, ActsWithoutSlidingFriction)
{
    SceneOf made;
    made.scene.materials[0].friction = 0;
    made.scene.materials[0].rolling_friction = 0.05;
    made.floor();
    made.ball(0.5, Vec3(0, 0, 0.5)).angular_velocity = Vec3(0, 0, 5);
    World world(made.scene);
    world.step(120);
    EXPECT_LT(world.angular_velocity(world.bodies()[1]).norm(), 1e-3);
}

// A small thing falls further in a step than it is large.
TEST(SmallBodies, LandOnAThinPlateFromEveryHeight)
{
    const double size = 1e-3;
    for (int i = 0; i < 40; ++i) {
        SceneOf made;
        made.box(Vec3(20 * size, 20 * size, 0.2 * size), Vec3(0, 0, -0.2 * size)).motion =
            Motion::static_;
        made.ball(size, Vec3(0, 0, size * (1.05 + 0.2 * i)));
        World world(made.scene);
        world.step(60);
        EXPECT_NEAR(height_of(world, 1), size, 0.1 * size) << i;
    }
}

TEST(Needles, LieStillWhicheverWayTheyPoint)
{
    for (const double thin : {1e-2, 1e-3, 1e-4})
        for (const double yaw : {0.0, 0.6}) {
            SceneOf made;
            made.scene.settings.sleep = false;
            made.floor();
            made.box(Vec3(1, thin, thin), Vec3(0, 0, thin)).orientation =
                exponential(Vec3(0, 0, yaw));
            World world(made.scene);
            double lowest = thin;
            for (int i = 0; i < 120; ++i) {
                world.step();
                lowest = std::min(lowest, height_of(world, 1));
                ASSERT_LT(world.velocity(world.bodies()[1]).norm(), 0.01) << thin << " " << yaw;
            }
            EXPECT_GT(lowest, 0.8 * thin) << yaw;
        }
}

TEST(Effects, BodiesAddedOneByOneDoNotMakeMaterialsAProductOfThemselves)
{
    // Ten thousand default materials would take seconds where each met each.
    World world;
    for (int i = 0; i < 10000; ++i) {
        SceneOf made;
        made.scene.materials.clear();
        BodyDescription& ball = made.ball(0.1, Vec3(i, 0, 0));
        ball.material = kNone;
        world.add(made.scene);
    }
    EXPECT_TRUE(world.effects().on.has(Effect::friction));
}

}  // namespace
}  // namespace throng
