// Sleep: who may, what it keeps, and what wakes it.
#include "tests/support/small_scenes.hpp"
#include "throng/world.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

using given::SceneOf;

Scene two_towers(bool sleep = true)
{
    SceneOf made;
    made.scene.settings.sleep = sleep;
    made.floor();
    for (int tower = 0; tower < 2; ++tower)
        for (int i = 0; i < 4; ++i) made.box(Vec3(0.5, 0.5, 0.5), Vec3(5.0 * tower, 0, 0.5 + i));
    return made.scene;
}

bool all_asleep(const World& world, std::size_t first, std::size_t last)
{
    for (std::size_t i = first; i < last; ++i)
        if (world.awake(world.bodies()[i])) return false;
    return true;
}

World sleeping_towers()
{
    World world(two_towers());
    world.step(180);
    return world;
}

TEST(Sleep, APileThatRestsFallsAsleepAndNothingOfItChanges)
{
    World world = sleeping_towers();
    ASSERT_TRUE(all_asleep(world, 1, 9));
    EXPECT_EQ(world.report().bodies_awake, 0u);
    const std::string hash = world.state_hash();
    world.step(100);
    EXPECT_EQ(world.state_hash(), hash);
    EXPECT_EQ(given::greatest_speed(world), 0);
}

TEST(Sleep, AWorldThatSleepsIsNotLookedAtUntilSomebodyTouchesIt)
{
    World world = sleeping_towers();
    const std::string hash = world.state_hash();
    world.step(10);
    EXPECT_EQ(world.report().step, 190u);
    EXPECT_EQ(world.report().islands, 0u);
    EXPECT_EQ(world.report().manifolds, 0u);
    for (const StageReport& stage : world.stages()) EXPECT_EQ(stage.time_ms, 0) << stage.name;
    // Neither another step nor a look at the effects disturbs it.
    Settings settings = world.settings();
    settings.dt /= 2;
    world.set_settings(settings);
    world.step(10);
    static_cast<void>(world.effects());
    EXPECT_EQ(world.report().bodies_awake, 0u);
    world.set_velocity(world.bodies()[8], Vec3(0, 0, 3), Vec3::Zero());
    world.step(10);
    EXPECT_EQ(world.report().bodies_awake, 4u);
    EXPECT_NE(world.state_hash(), hash);
}

TEST(Sleep, MovesNobody)
{
    World on(two_towers(true)), off(two_towers(false));
    on.step(600);
    off.step(600);
    EXPECT_EQ(off.report().bodies_awake, 8u);
    for (std::size_t i = 1; i < 9; ++i)
        EXPECT_LE((on.pose(on.bodies()[i]).position - off.pose(off.bodies()[i]).position).norm(),
                  2e-3);
}

TEST(Sleep, AHitWakesTheTowerItHitsAndNoOther)
{
    World world = sleeping_towers();
    SceneOf bullet;
    bullet.ball(0.3, Vec3(-3, 0, 3.5)).velocity = Vec3(8, 0, 2);
    world.add(bullet.scene);
    world.step(30);
    EXPECT_FALSE(all_asleep(world, 1, 5));
    EXPECT_TRUE(all_asleep(world, 5, 9));
}

TEST(Sleep, EveryTouchFromOutsideWakesTheWholeTower)
{
    const auto woken_by = [](auto act) {
        World world = sleeping_towers();
        ASSERT_TRUE(all_asleep(world, 1, 9));
        const std::vector<BodyId> ids = world.bodies();
        act(world, ids[2]);
        for (std::size_t i = 1; i < 5; ++i)
            EXPECT_TRUE(!world.alive(ids[i]) || world.awake(ids[i])) << i;
    };
    woken_by(
        [](World& world, BodyId body) { world.set_velocity(body, Vec3(0.1, 0, 0), Vec3::Zero()); });
    woken_by([](World& world, BodyId body) { world.add_impulse(body, Vec3(1, 0, 0)); });
    woken_by([](World& world, BodyId body) { world.set_pose(body, world.pose(body)); });
    woken_by([](World& world, BodyId body) { world.remove(std::vector{body}); });
    woken_by([](World& world, BodyId) { world.set_gravity(Vec3(0, 0, -5)); });
}

TEST(Sleep, WhatRestedOnARemovedBodyFalls)
{
    World world = sleeping_towers();
    const std::vector<BodyId> ids = world.bodies();
    world.remove(std::vector{ids[1]});
    world.step(120);
    EXPECT_NEAR(world.pose(ids[2]).position.z(), 0.5, 0.01);
    EXPECT_TRUE(all_asleep(world, 4, 8));
    // The same when the floor goes.
    world.remove(std::vector{ids[0]});
    world.step(60);
    EXPECT_LT(world.pose(ids[8]).position.z(), 0);
}

TEST(Sleep, AMovedFloorWakesWhatRestsOnIt)
{
    World world = sleeping_towers();
    world.set_pose(world.bodies()[0], {Vec3(0, 0, -1), Quat::Identity()});
    world.step(90);
    EXPECT_NEAR(world.pose(world.bodies()[1]).position.z(), -0.5, 0.01);
}

TEST(Sleep, EndsForAllWhenItIsSwitchedOff)
{
    World world = sleeping_towers();
    Settings settings = world.settings();
    settings.sleep = false;
    world.set_settings(settings);
    world.step(1);
    EXPECT_EQ(world.report().bodies_awake, 8u);
}

Scene on_a_platform(bool mesh)
{
    SceneOf made;
    if (mesh) {
        MeshShape slab;
        slab.vertices = {Vec3(-3, -3, 0), Vec3(3, -3, 0), Vec3(3, 3, 0), Vec3(-3, 3, 0)};
        slab.triangles = {{0, 1, 2}, {0, 2, 3}};
        made.body(made.shape(slab), Vec3::Zero()).motion = Motion::kinematic;
    } else {
        made.box(Vec3(3, 3, 0.5), Vec3(0, 0, -0.5)).motion = Motion::kinematic;
    }
    made.box(Vec3(0.5, 0.5, 0.5), Vec3(0, 0, 0.5));
    return made.scene;
}

TEST(Sleep, APlatformThatStandsLetsSleepAndOneThatMovesWakes)
{
    for (const bool mesh : {false, true}) {
        World world(on_a_platform(mesh));
        world.step(120);
        const std::vector<BodyId> ids = world.bodies();
        ASSERT_FALSE(world.awake(ids[1])) << (mesh ? "mesh" : "box");
        const std::string hash = world.state_hash();
        world.step(60);
        EXPECT_EQ(world.state_hash(), hash);
        world.set_velocity(ids[0], Vec3(0, 0, 0.5), Vec3::Zero());
        world.step(60);
        EXPECT_TRUE(world.awake(ids[1])) << (mesh ? "mesh" : "box");
        EXPECT_NEAR(world.pose(ids[1]).position.z(), 1.0, 0.01) << (mesh ? "mesh" : "box");
    }
}

}  // namespace
}  // namespace throng
