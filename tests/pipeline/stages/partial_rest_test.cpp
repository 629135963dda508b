// Partial rest: who rests while others of its island go on, what it notices, and what it does not.
#include "tests/support/small_scenes.hpp"
#include "throng/catalog.hpp"
#include "throng/rotation.hpp"
#include "throng/version.hpp"
#include "throng/world.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace throng {
namespace {

using given::SceneOf;

void rest_by_force(Scene& scene, bool rests = true)
{
    scene.settings.sleep = false;
    scene.settings.partial_rest = rests;
}

// A tower and a ball that rolls on, both on one raft, so that all are one island.
Scene raft()
{
    SceneOf made;
    rest_by_force(made.scene);
    made.floor();
    made.box(Vec3(10, 5, 0.5), Vec3(0, 0, 0.5));
    for (int i = 0; i < 4; ++i) made.box(Vec3(0.5, 0.5, 0.5), Vec3(6, 0, 1.5 + i));
    BodyDescription& ball = made.ball(0.3, Vec3(-9, 3, 1.3));
    ball.velocity = Vec3(1, 0, 0);
    ball.angular_velocity = Vec3(0, 1 / 0.3, 0);
    return made.scene;
}

TEST(PartialRest, ComesWhileOthersOfTheIslandGoOn)
{
    World world(raft());
    world.step(240);
    const std::vector<BodyId> ids = world.bodies();
    for (std::size_t i = 1; i < 6; ++i) EXPECT_FALSE(world.awake(ids[i])) << i;
    EXPECT_TRUE(world.awake(ids[6]));
    EXPECT_EQ(world.report().bodies_awake, 1u);
    EXPECT_NEAR(world.velocity(ids[6]).x(), 1, 0.02);
    // What is at rest presses as before.
    EXPECT_NEAR(world.contact_force(ids[0]).z(), -(2e5 + 4e3 + 113.1) * 9.81, 4e3);
}

TEST(PartialRest, IsOffWhereNobodyAsks)
{
    Scene scene = raft();
    scene.settings.partial_rest = false;
    World world(scene);
    world.step(240);
    EXPECT_EQ(world.report().bodies_awake, 6u);
}

TEST(PartialRest, OfAWholeWorldIsNotLookedAt)
{
    Scene scene = make_scene("stacks", 20);
    rest_by_force(scene);
    World world(scene);
    world.step(240);
    ASSERT_EQ(world.report().bodies_awake, 0u);
    const std::string hash = world.state_hash();
    world.step(10);
    for (const StageReport& stage : world.stages()) EXPECT_EQ(stage.time_ms, 0) << stage.name;
    EXPECT_EQ(world.state_hash(), hash);
}

Scene tower(bool rests, int boxes = 8)
{
    SceneOf made;
    rest_by_force(made.scene, rests);
    made.floor();
    for (int i = 0; i < boxes; ++i) made.box(Vec3(0.5, 0.5, 0.5), Vec3(0, 0, 0.5 + i));
    return made.scene;
}

// Steps until a body is so much lower; 1000 for never.
int steps_until_lower(World& world, BodyId body, double by)
{
    const double height = world.pose(body).position.z();
    int steps = 0;
    while (steps < 1000 && world.pose(body).position.z() > height - by) {
        world.step();
        ++steps;
    }
    return steps;
}

TEST(PartialRest, EndsAsWhatItRestsOnIsRemoved)
{
    int steps[2] = {};
    for (const bool rests : {false, true}) {
        World world(tower(rests));
        world.step(180);
        const std::vector<BodyId> ids = world.bodies();
        EXPECT_EQ(world.awake(ids[8]), !rests);
        world.remove(std::span(&ids[1], 1));
        steps[rests ? 1 : 0] = steps_until_lower(world, ids[8], 0.5);
        world.step(240);
        EXPECT_NEAR(world.pose(ids[8]).position.z(), 6.5, 0.02);
        EXPECT_EQ(world.awake(ids[8]), !rests);
    }
    EXPECT_NEAR(steps[0], steps[1], 1);
}

// A support that goes without an edit: a ball is shot away from under a beam's end.
TEST(PartialRest, EndsAsASupportIsKnockedAway)
{
    int steps[2] = {};
    for (const bool rests : {false, true}) {
        SceneOf made;
        rest_by_force(made.scene, rests);
        made.floor();
        made.box(Vec3(0.2, 0.2, 0.5), Vec3(-1, 0, 0.5));
        made.box(Vec3(0.2, 0.2, 0.5), Vec3(1, 0, 0.5));
        made.box(Vec3(1.5, 0.2, 0.1), Vec3(0, 0, 1.1));
        made.box(Vec3(0.2, 0.2, 0.2), Vec3(-1, 0, 1.4));
        World world(made.scene);
        world.step(120);
        const std::vector<BodyId> ids = world.bodies();
        ASSERT_EQ(world.awake(ids[3]), !rests);
        SceneOf shot;
        shot.ball(0.2, Vec3(4, 0, 0.5)).velocity = Vec3(-15, 0, 0);
        shot.scene.bodies[0].mass = 300;
        world.add(shot.scene);
        steps[rests ? 1 : 0] = steps_until_lower(world, ids[3], 0.3);
    }
    EXPECT_LT(steps[0], 120);
    EXPECT_NEAR(steps[0], steps[1], 1);
}

TEST(PartialRest, NoticesALoadThatGrowsByLess)
{
    World world(tower(true, 3));
    world.step(120);
    const BodyId lowest = world.bodies()[1];
    ASSERT_FALSE(world.awake(lowest));
    // Each is a hundredth of what the lowest one bears.
    bool woke = false;
    for (int i = 0; i < 30; ++i) {
        SceneOf plate;
        plate.box(Vec3(0.5, 0.5, 0.01), Vec3(0, 0, 3.01 + 0.02 * i)).mass = 50;
        world.add(plate.scene);
        for (int k = 0; k < 60; ++k) {
            world.step();
            woke = woke || world.awake(lowest);
        }
    }
    EXPECT_TRUE(woke);
    // No more is hidden than the tolerance, of what it bears below and above.
    EXPECT_NEAR(world.contact_force(lowest).z(), 1000 * 9.81,
                world.settings().rest_force * 2 * 4500 * 9.81);
}

// A plank on a ridge: how many weights it takes at one end until it tips over.
int weights_until_it_tips(bool rests)
{
    SceneOf made;
    rest_by_force(made.scene, rests);
    made.floor();
    made.box(Vec3(0.1, 0.5, 0.5), Vec3(0, 0, 0.5)).motion = Motion::static_;
    made.box(Vec3(2, 0.3, 0.05), Vec3(0, 0, 1.05)).mass = 100;
    made.box(Vec3(0.2, 0.2, 0.2), Vec3(-1.5, 0, 1.3)).mass = 15;
    made.box(Vec3(0.2, 0.2, 0.01), Vec3(1.5, 0, 1.11)).mass = 10;
    World world(made.scene);
    world.step(60);
    int weights = 0;
    for (; weights < 30; ++weights) {
        SceneOf weight;
        weight.box(Vec3(0.2, 0.2, 0.01), Vec3(1.5, 0, 1.131 + 0.02 * weights)).mass = 2;
        world.add(weight.scene);
        world.step(60);
        if (world.pose(world.bodies()[2]).orientation.y() > 0.02) break;
    }
    return weights;
}

TEST(PartialRest, LetsASeesawTipByTheSameWeight)
{
    const int free = weights_until_it_tips(false), at_rest = weights_until_it_tips(true);
    EXPECT_LT(free, 20);
    // What is not noticed is the tolerance times what the plank bears, kg, as far as it reaches.
    const double hidden = Settings{}.rest_force * (150 + 50) * 2.03;
    EXPECT_NEAR(free, at_rest, hidden / (1.5 * 2));
}

TEST(PartialRest, EveryTouchFromOutsideEndsIt)
{
    const auto woken_by = [](auto act) {
        World world(tower(true));
        world.step(180);
        const std::vector<BodyId> ids = world.bodies();
        ASSERT_FALSE(world.awake(ids[3]));
        act(world, ids[3]);
        EXPECT_TRUE(!world.alive(ids[3]) || world.awake(ids[3]));
        world.step(2);
        EXPECT_TRUE(world.awake(ids[4]));
    };
    woken_by(
        [](World& world, BodyId body) { world.set_velocity(body, Vec3(1, 0, 0), Vec3::Zero()); });
    woken_by([](World& world, BodyId body) { world.set_pose(body, world.pose(body)); });
    woken_by([](World& world, BodyId body) { world.remove(std::vector{body}); });
    woken_by([](World& world, BodyId) { world.set_gravity(Vec3(0, 0, -5)); });
    woken_by([](World& world, BodyId) { world.set_settings(world.settings()); });
}

TEST(PartialRest, IsNotForWhomAPlatformOrABeltCarries)
{
    SceneOf made;
    rest_by_force(made.scene);
    BodyDescription& platform = made.box(Vec3(3, 3, 0.5), Vec3(0, 0, -0.5));
    platform.motion = Motion::kinematic;
    platform.velocity = Vec3(0.01, 0, 0);
    made.box(Vec3(0.5, 0.5, 0.5), Vec3(0, 0, 0.5));
    World world(made.scene);
    world.step(180);
    const std::vector<BodyId> ids = world.bodies();
    EXPECT_TRUE(world.awake(ids[1]));
    world.set_velocity(ids[0], Vec3::Zero(), Vec3::Zero());
    world.step(90);
    EXPECT_FALSE(world.awake(ids[1]));
    world.set_velocity(ids[0], Vec3(0, 0, 0.5), Vec3::Zero());
    world.step(60);
    EXPECT_TRUE(world.awake(ids[1]));
    EXPECT_NEAR(world.pose(ids[1]).position.z(), 1.0, 0.01);
}

TEST(PartialRest, AnImpactIsPassedOnThroughThoseAtRest)
{
    // A row of balls that touch: the last one flies.
    SceneOf made;
    rest_by_force(made.scene);
    made.scene.materials[0] = {.name = "steel", .friction = 0, .restitution = 1};
    made.floor();
    for (int i = 0; i < 5; ++i) made.ball(0.5, Vec3(i, 0, 0.5));
    BodyDescription& plate = made.box(Vec3(9, 2, 0.1), Vec3(0, 0, -3));
    plate.motion = Motion::static_;
    double first[2] = {}, last[2] = {};
    for (const bool rests : {false, true}) {
        made.scene.settings.partial_rest = rests;
        World world(made.scene);
        world.step(90);
        EXPECT_EQ(world.report().bodies_awake, rests ? 0u : 5u);
        SceneOf shot;
        shot.scene.materials[0] = made.scene.materials[0];
        shot.ball(0.5, Vec3(-3, 0, 0.5)).velocity = Vec3(3, 0, 0);
        world.add(shot.scene);
        world.step(120);
        const std::vector<BodyId> ids = world.bodies();
        first[rests ? 1 : 0] = world.velocity(ids.back()).x();
        last[rests ? 1 : 0] = world.velocity(ids[5]).x();
    }
    EXPECT_NEAR(first[0], first[1], 0.05);
    EXPECT_NEAR(last[0], last[1], 0.05);
    EXPECT_GT(last[1], 1.5);
}

// A heap that settles and is pushed at, so that many rest and wake.
std::string hash_of_pushed_heap(int threads, bool hashed = false, int balls = 200)
{
    Scene scene = make_scene("pile", balls);
    rest_by_force(scene);
    World world(scene, threads);
    const std::vector<BodyId> ids = world.bodies();
    std::size_t at_rest = 0;
    for (int step = 0; step < 480; ++step) {
        if (hashed) static_cast<void>(world.state_hash());
        if (step > 240 && step % 40 == 0) {
            const BodyId body = ids[ids.size() - 1 - static_cast<std::size_t>(step / 8)];
            world.set_velocity(body, Vec3(0.6, 0.5, 0.6), Vec3::Zero());
        }
        world.step();
        at_rest += static_cast<std::size_t>(balls) - world.report().bodies_awake;
    }
    EXPECT_GT(at_rest, static_cast<std::size_t>(20 * balls));
    return world.state_hash();
}

TEST(PartialRest, LeavesTheSameBitsOnAnyNumberOfThreads)
{
    const std::string wanted = hash_of_pushed_heap(1);
    EXPECT_EQ(hash_of_pushed_heap(2), wanted);
    EXPECT_EQ(hash_of_pushed_heap(3), wanted);
    // Neither does a look at all pairs change any.
    EXPECT_EQ(hash_of_pushed_heap(1, true), wanted);
}

TEST(PartialRest, LeavesTheSameBitsAtAnyWidthOfLanes)
{
    const std::string own = lane_width(), wanted = hash_of_pushed_heap(1);
    for (const char* const lanes : {"scalar", "avx2", "avx512"}) {
        if (!machine_has_lanes(lanes)) continue;
        take_lanes(lanes);
        EXPECT_EQ(hash_of_pushed_heap(1), wanted) << lanes;
    }
    take_lanes(own.c_str());
}

}  // namespace
}  // namespace throng
