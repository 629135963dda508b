// What a step keeps to with solver=direct, through the public door.
#include "throng/catalog.hpp"
#include "throng/world.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

constexpr double kGravity = 9.81;

Scene empty_scene(Precision precision)
{
    Scene scene;
    scene.settings.solver = Solver::direct;
    scene.settings.precision = precision;
    scene.settings.sleep = false;
    scene.materials.resize(1);
    scene.materials[0].name = "stone";
    scene.materials[0].friction = 0.5;
    scene.shapes.push_back({"floor", PlaneShape{Vec3::UnitZ(), 0}});
    scene.shapes.push_back({"cube", BoxShape{Vec3::Constant(0.5)}});
    scene.shapes.push_back({"ball", SphereShape{0.5}});
    BodyDescription floor;
    floor.shape = 0;
    floor.material = 0;
    floor.motion = Motion::static_;
    scene.bodies.push_back(floor);
    return scene;
}

BodyDescription& add(Scene& scene, std::uint32_t shape, const Vec3& at)
{
    BodyDescription body;
    body.shape = shape;
    body.material = 0;
    body.mass = 1;
    body.position = at;
    scene.bodies.push_back(body);
    return scene.bodies.back();
}

Scene stack(Precision precision, int high, double sunk = 0)
{
    Scene scene = empty_scene(precision);
    for (int k = 0; k < high; ++k) add(scene, 1, Vec3(0, 0, 0.5 + k - sunk));
    return scene;
}

double greatest_speed(const World& world)
{
    double speed = 0;
    for (const BodyId body : world.bodies()) speed = std::max(speed, world.velocity(body).norm());
    return speed;
}

// Under a lid that is held fast two cubes have no room to part: that they are asked to in vain is
// no contact that misses its law.
TEST(DirectStep, WhoIsWedgedAtRestMissesNoLaw)
{
    for (const Precision precision : {Precision::float_, Precision::double_}) {
        Scene scene = empty_scene(precision);
        add(scene, 1, Vec3(0, 0, 0.499));
        add(scene, 1, Vec3(0, 0, 1.495));
        BodyDescription& lid = add(scene, 1, Vec3(0, 0.3, 2.49));
        lid.lock_position = lid.lock_rotation = true;
        World world(scene);
        world.step(2);
        EXPECT_GT(world.measure().greatest_overlap, 1e-3);
        EXPECT_LT(greatest_speed(world), 1e-9);
        EXPECT_LT(world.report().direct_residual, 1e-8);
    }
}

TEST(DirectStep, StackStandsStillAndWeighsWhatItWeighs)
{
    for (const Precision precision : {Precision::float_, Precision::double_}) {
        World world(stack(precision, 10));
        world.step(120);
        EXPECT_LT(greatest_speed(world), 1e-9);
        EXPECT_LT(world.measure().greatest_overlap, 1e-6);
        const Vec3 force = world.contact_force(world.bodies().front());
        EXPECT_NEAR(force.z(), -10 * kGravity, 1e-5);
        EXPECT_LT(world.report().direct_residual, 1e-8);
        EXPECT_EQ(world.report().fallbacks, 0u);
    }
}

TEST(DirectStep, OverlapIsTakenApartWithoutGivingSpeed)
{
    for (const Precision precision : {Precision::float_, Precision::double_}) {
        World world(stack(precision, 1, 0.01));
        for (int step = 0; step < 60; ++step) {
            world.step();
            ASSERT_LT(greatest_speed(world), 1e-9);
        }
        EXPECT_LT(world.measure().greatest_overlap, 1e-6);
    }
}

TEST(DirectStep, PushLimitIsTheFastestThatOverlapIsTakenApart)
{
    Scene scene = stack(Precision::double_, 1, 0.4);
    scene.settings.push_limit = 0.5;
    World world(scene);
    const double before = world.pose(world.bodies().back()).position.z();
    world.step(6);
    const double moved = world.pose(world.bodies().back()).position.z() - before;
    EXPECT_NEAR(moved, 0.5 * 6 / 60, 1e-9);
}

// Every step begins from the impulses of the one before. What of their force or torque got lost on
// the way would come back multiplied: here until the cards no longer held, after a hundred steps.
TEST(DirectStep, WhatRestsIsHandedOnWholeFromStepToStep)
{
    Scene scene = make_scene("card_house", 3);
    scene.settings = empty_scene(Precision::double_).settings;
    scene.settings.substeps = 1;
    World world(scene);
    std::vector<Vec3> first;
    for (const BodyId body : world.bodies()) first.push_back(world.pose(body).position);
    world.step(200);
    // Ten times what the solver takes for solved, and what that is of a step's fall.
    EXPECT_LT(world.report().direct_residual, 1e-10);
    for (std::size_t i = 0; i < first.size(); ++i)
        EXPECT_LT((world.pose(world.bodies()[i]).position - first[i]).norm(), 1e-11);
}

TEST(DirectStep, IslandsBeyondTheLimitAreLeftToTheDefaultAndCounted)
{
    Scene scene = stack(Precision::float_, 10);
    for (int k = 0; k < 3; ++k) add(scene, 1, Vec3(5, 0, 0.5 + k));
    scene.settings.direct_limit = 5;
    World world(scene);
    world.step(7);
    EXPECT_EQ(world.report().fallbacks, 7u);
    Scene soft = stack(Precision::float_, 10);
    soft.settings.solver = Solver::soft_step;
    World other(soft);
    other.step(7);
    for (std::size_t i = 1; i <= 10; ++i)
        EXPECT_EQ(world.pose(world.bodies()[i]).position, other.pose(other.bodies()[i]).position);
}

TEST(DirectStep, BouncesByTheCoefficient)
{
    Scene scene = empty_scene(Precision::double_);
    scene.gravity = Vec3::Zero();
    scene.materials[0].restitution = 0.8;
    add(scene, 2, Vec3(0, 0, 0.6)).velocity = Vec3(0, 0, -4);
    World world(scene);
    world.step(10);
    EXPECT_NEAR(world.velocity(world.bodies().back()).z(), 3.2, 1e-12);
}

TEST(DirectStep, GivesTheSameBitsOnAnyNumberOfThreads)
{
    for (const ImpactLaw law : {ImpactLaw::sequential, ImpactLaw::simultaneous})
        for (const Precision precision : {Precision::float_, Precision::double_}) {
            Scene scene = empty_scene(precision);
            scene.settings.impact_law = law;
            scene.materials[0].restitution = 0.5;
            for (int k = 0; k < 24; ++k)
                add(scene, k % 2 == 0 ? 1 : 2, Vec3(k % 6 * 1.3, k % 5 * 1.1, 1 + k / 6 * 1.2));
            World one(scene, 1), three(scene, 3);
            one.step(40);
            three.step(40);
            EXPECT_EQ(one.state_hash(), three.state_hash());
        }
}

TEST(DirectStep, BeltsCarryAndTurntablesTurnWhatLiesOnThem)
{
    Scene scene = empty_scene(Precision::double_);
    add(scene, 1, Vec3(0, 0, -0.5)).motion = Motion::kinematic;
    scene.bodies.back().mass.reset();
    scene.bodies.back().velocity = Vec3(0.2, 0, 0);
    scene.bodies.front().position = Vec3(0, 0, -3);
    add(scene, 2, Vec3(0, 0, 0.5)).lock_rotation = true;
    World world(scene);
    world.step(60);
    EXPECT_NEAR(world.velocity(world.bodies().back()).x(), 0.2, 1e-9);
}

}  // namespace
}  // namespace throng
