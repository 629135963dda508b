// Parting: bodies made deep inside one another move apart, and get no speed by it.
#include "kernels/math/rotation.hpp"
#include "scene/catalog/closed_meshes.hpp"
#include "tests/support/small_scenes.hpp"
#include "tests/support/watched.hpp"
#include "throng/catalog.hpp"
#include "throng/energy_ledger.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace throng {
namespace {

using given::greatest_speed;
using given::hash_after;
using given::SceneOf;

// A heap of boxes of 1 m, each a quarter inside its neighbors.
SceneOf heap(int side, Precision precision = Precision::float_)
{
    SceneOf made;
    made.scene.settings.sleep = false;
    made.scene.settings.precision = precision;
    for (int x = 0; x < side; ++x)
        for (int y = 0; y < side; ++y)
            for (int z = 0; z < side; ++z)
                made.box(Vec3::Constant(0.5), 0.75 * Vec3(x, y, z) + Vec3(0, 0, 0.5)).mass = 1;
    return made;
}

TEST(SplitImpulses, BodiesAtRestStayAtRestAndComeApart)
{
    for (const Precision precision : {Precision::float_, Precision::double_}) {
        SceneOf made = heap(3, precision);
        made.scene.gravity = Vec3::Zero();
        World world(made.scene);
        const double limit = world.settings().push_limit;
        double fastest = 0, shrank = 0, overlap = world.measure().greatest_overlap;
        Vec3 middle = Vec3::Zero(), after = Vec3::Zero();
        for (const BodyId body : world.bodies()) middle += world.pose(body).position;
        for (int step = 0; step < 600; ++step) {
            world.step();
            fastest = std::max(fastest, greatest_speed(world));
            const double now = world.measure().greatest_overlap;
            shrank = std::max(shrank, (overlap - now) / world.settings().dt);
            overlap = now;
        }
        for (const BodyId body : world.bodies()) after += world.pose(body).position;
        EXPECT_LT(fastest, 1e-3);
        EXPECT_LE(shrank, limit * (1 + 1e-6));
        EXPECT_LT(overlap, 1e-3);
        EXPECT_LT((after - middle).norm(), 1e-3);
    }
}

TEST(SplitImpulses, OnAFloorAHeapSettlesWithoutFlyingUp)
{
    SceneOf made = heap(3);
    made.floor();
    World world(made.scene);
    double highest = 0;
    for (int step = 0; step < 600; ++step) {
        world.step();
        for (const BodyId body : world.bodies())
            highest = std::max(highest, world.pose(body).position.z());
    }
    // Three boxes and what they were inside one another, and no more than a corner above that.
    EXPECT_LT(highest, 2.5 + 0.4);
    EXPECT_LT(world.measure().greatest_overlap, 5e-3);
    EXPECT_LT(greatest_speed(world), 1e-2);
}

TEST(SplitImpulses, BodiesThatMoveTogetherKeepTheirVelocity)
{
    SceneOf made = heap(2, Precision::double_);
    made.scene.gravity = Vec3::Zero();
    const Vec3 velocity(3, -2, 1);
    for (BodyDescription& body : made.scene.bodies) body.velocity = velocity;
    World world(made.scene);
    for (int step = 0; step < 300; ++step) {
        world.step();
        for (const BodyId body : world.bodies())
            ASSERT_LT((world.velocity(body) - velocity).norm(), 1e-3);
    }
    EXPECT_LT(world.measure().greatest_overlap, 1e-3);
}

// As many at one point as there are, without gravity.
SceneOf crowd(int count, bool boxes, bool sleep)
{
    SceneOf made;
    made.scene.gravity = Vec3::Zero();
    made.scene.settings.sleep = sleep;
    for (int i = 0; i < count; ++i)
        (boxes ? made.box(Vec3::Constant(0.5), Vec3::Zero()) : made.ball(0.5, Vec3::Zero())).mass =
            1;
    return made;
}

Vec3 extent_of(const World& world)
{
    Vec3 low = Vec3::Constant(1e9), high = -low;
    for (const BodyId body : world.bodies()) {
        low = low.cwiseMin(world.pose(body).position);
        high = high.cwiseMax(world.pose(body).position);
    }
    return high - low;
}

TEST(SplitImpulses, ACrowdAtOnePointPartsInAllDirections)
{
    for (const bool boxes : {true, false}) {
        World world(crowd(50, boxes, false).scene);
        double fastest = 0;
        for (int step = 0; step < 400; ++step) {
            world.step();
            fastest = std::max(fastest, greatest_speed(world));
        }
        EXPECT_LT(fastest, 1e-3);
        EXPECT_LT(world.measure().greatest_overlap, 1e-3);
        // Four by four by four are 3 m from center to center; a line would be 49.
        EXPECT_GT(extent_of(world).minCoeff(), 2);
        EXPECT_LT(extent_of(world).maxCoeff(), 8);
    }
}

TEST(SplitImpulses, WhoIsPutIntoAnotherLaterPartsFromIt)
{
    SceneOf made = heap(2);
    made.scene.gravity = Vec3::Zero();
    made.box(Vec3::Constant(0.5), Vec3(5, 0, 0)).mass = 1;
    World world(made.scene);
    world.step(300);
    const BodyId body = world.bodies().back();
    world.set_pose(body, world.pose(world.bodies().front()));
    for (int step = 0; step < 300; ++step) {
        world.step();
        ASSERT_LT(greatest_speed(world), 1e-3);
    }
    EXPECT_LT(world.measure().greatest_overlap, 1e-3);
}

// A flat six-sided frame that falls several times its thickness in a step: contacts of two that
// have come through one another push to all sides.
TEST(SplitImpulses, ThinSolidsThatAFallHasDrivenThroughOneAnotherGetNoSpeedByIt)
{
    struct Setting {
        const char* name;
        NonConvex way;
        int substeps;
        Solver solver = Solver::soft_step;
    };
    for (const Setting& setting :
         {Setting{"voxels", NonConvex::voxels, 4}, Setting{"voxels, finer", NonConvex::voxels, 32},
          Setting{"spheres", NonConvex::spheres, 4},
          Setting{"spheres, pgs", NonConvex::spheres, 4, Solver::pgs}}) {
        Scene scene = find_scene("knots")->make_of(12, 1, torus_mesh(0.4, 0.015, 6, 4));
        scene.settings.nonconvex = setting.way;
        scene.settings.voxel_size = 0.012;
        scene.settings.substeps = setting.substeps;
        scene.settings.solver = setting.solver;
        const auto ledger = given::watched<EnergyLedger>(scene, 90);
        EXPECT_LE(ledger.gained(), 3e-2 * ledger.greatest_kinetic()) << setting.name;
    }
}

// A small T of two boxes under three that are twenty times its size, a little turned, all of them
// falling: between the floor and the lowest it bears blows of thousands of times its mass.
Scene crushed(int substeps, int draw)
{
    SceneOf made;
    made.floor();
    made.scene.settings.substeps = substeps;
    const auto tee = [&](double half) {
        const std::uint32_t bar = made.shape(BoxShape{Vec3(2, 1, 1) * half}),
                            cross = made.shape(BoxShape{Vec3(1, 2.5, 1) * half});
        return made.shape(
            CompoundShape{{{bar, Pose{}}, {cross, {Vec3(2 * half, 0, 0), Quat::Identity()}}}});
    };
    constexpr double kSmall = 5.5e-3, kBig = 20 * kSmall;
    const auto some = [&](int i) { return std::sin(5.0 * draw + 3.0 * i); };
    const auto add = [&](std::uint32_t shape, const Vec3& position, int i) {
        made.body(shape, position).orientation =
            exponential(0.15 * Vec3(some(i), some(i + 1), some(i + 2)));
    };
    add(tee(kSmall), {0, 0, 3 * kSmall}, 0);
    const std::uint32_t big = tee(kBig);
    for (int i = 0; i < 3; ++i)
        add(big, {0.3 * some(i) * kBig, 0, 6 * kSmall + (2.7 + 6 * i) * kBig}, i);
    return made.scene;
}

TEST(SplitImpulses, WhoIsCrushedBetweenHeavyOnesIsNotThrown)
{
    for (const int substeps : {1, 2, 4})
        for (int draw = 0; draw < 30; ++draw) {
            const auto ledger = given::watched<EnergyLedger>(crushed(substeps, draw), 120);
            EXPECT_LE(ledger.gained(), 3e-2 * ledger.greatest_kinetic()) << substeps << ' ' << draw;
        }
}

TEST(SplitImpulses, NobodyFallsAsleepBeforeTheyAreApart)
{
    World world(crowd(8, true, true).scene);
    world.step(600);
    EXPECT_LT(world.measure().greatest_overlap, 1e-3);
    for (const BodyId body : world.bodies()) EXPECT_FALSE(world.awake(body));
}

TEST(SplitImpulses, WhatHasNoRoomStopsAndFallsAsleep)
{
    SceneOf made;
    made.scene.gravity = Vec3::Zero();
    made.box(Vec3::Constant(0.5), Vec3::Zero());
    for (const double side : {-1.0, 1.0})
        made.box(Vec3(0.5, 2, 2), Vec3(0.7 * side, 0, 0)).motion = Motion::static_;
    World world(made.scene);
    const BodyId wedged = world.bodies()[0];
    world.step(900);
    EXPECT_TRUE(world.awake(wedged));
    world.step(300);
    EXPECT_FALSE(world.awake(wedged));
    // Both sides push alike, but for who is last in a substep.
    const Settings& settings = world.settings();
    EXPECT_LT(world.pose(wedged).position.norm(),
              settings.push_limit * settings.dt / settings.substeps);
}

TEST(SplitImpulses, UnderALoadAHeapComesFlatAndGoesOnAsUsual)
{
    SceneOf made = heap(4);
    made.floor();
    made.scene.settings.sleep = true;
    World world(made.scene);
    world.step(480);
    for (const BodyId body : world.bodies()) EXPECT_FALSE(world.awake(body));
}

TEST(SplitImpulses, HasTheSameBitsOnAnyNumberOfThreadsAndRunInOrder)
{
    for (const FrictionAt at : {FrictionAt::manifold, FrictionAt::points}) {
        SceneOf made = heap(4);
        made.scene.settings.friction_at = at;
        made.scene.materials[0].rolling_friction = 0.01;
        made.scene.materials[0].restitution = 0.3;
        made.floor();
        const std::string wanted = hash_after(made.scene, 1, 60);
        EXPECT_EQ(hash_after(made.scene, 2, 60), wanted);
        EXPECT_EQ(hash_after(made.scene, 3, 60), wanted);
        EXPECT_EQ(hash_after(made.scene, 1, 60, true), wanted);
    }
}

}  // namespace
}  // namespace throng
