// Pivots: bodies that turn about a point that stays.
#include "tests/pipeline/forces/force_scenes.hpp"
#include "throng/world.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace throng {
namespace {

using test::add_body;
using test::add_crate;
using test::add_floor;
using test::empty_scene;
using test::energy;

TEST(Pivot, APendulumSwingsByItsMomentAboutThePivot)
{
    for (const Integrator integrator : {Integrator::semi_implicit, Integrator::midpoint,
                                        Integrator::splitting, Integrator::rk4}) {
        Scene scene = empty_scene(integrator);
        scene.gravity = Vec3(0, 0, -10);
        scene.settings.substeps = 10;
        BodyDescription& body = add_body(scene);
        body.pivot = Vec3(0, 0, 0.5);
        const double tilt = 1e-3;
        body.orientation = Quat(std::cos(0.5 * tilt), std::sin(0.5 * tilt), 0, 0);
        World world(scene);
        const BodyId id = world.bodies()[0];
        const Vec3 hung = world.pose(id) * Vec3(0, 0, 0.5);
        // A quarter of the period 2 pi sqrt((I + m l2) / (m g l)): at the lowest point.
        const double quarter =
            0.5 * std::numbers::pi * std::sqrt((0.1 + 2 * 0.25) / (2 * 10 * 0.5));
        world.step(static_cast<int>(std::lround(quarter / 1e-2)));
        const double angle = 2 * world.pose(id).orientation.x();
        const double wanted =
            tilt * std::cos(std::round(quarter / 1e-2) * 1e-2 / quarter * 0.5 * std::numbers::pi);
        EXPECT_NEAR(angle, wanted, 5e-3 * tilt);
        EXPECT_LT((world.pose(id) * Vec3(0, 0, 0.5) - hung).norm(), 1e-15);
        const Vec3 arm = world.pose(id).orientation * Vec3(0, 0, -0.5);
        EXPECT_LT((world.velocity(id) - world.angular_velocity(id).cross(arm)).norm(), 1e-15);
    }
}

// Three moments, and axes that are not those of the body: nothing about it is symmetric.
Quat after_swinging(Integrator integrator, Rotation rotation, double substep)
{
    Scene scene = empty_scene(integrator);
    scene.gravity = Vec3(0, 0, -10);
    scene.settings.rotation = rotation;
    scene.settings.substeps = static_cast<int>(std::lround(scene.settings.dt / substep));
    BodyDescription& body = add_body(scene);
    body.pivot = Vec3(0.1, 0.2, 0.5);
    body.angular_velocity = Vec3(3, -2, 15);
    World world(scene);
    world.step(100);
    return world.pose(world.bodies()[0]).orientation;
}

TEST(Pivot, WhatIsNotSymmetricSwingsAsExactlyAsEachMethodsOrder)
{
    const Quat wanted = after_swinging(Integrator::rk4, Rotation::quaternion, 1e-4);
    for (const Rotation rotation :
         {Rotation::quaternion, Rotation::rotation_vector, Rotation::matrix})
        for (const auto& [integrator, order] :
             {std::pair(Integrator::midpoint, 2), std::pair(Integrator::splitting, 2),
              std::pair(Integrator::rk4, 4)}) {
            const auto error = [&, by = integrator](double substep) {
                return wanted.angularDistance(after_swinging(by, rotation, substep));
            };
            const double coarse = error(2e-3), fine = error(1e-3);
            EXPECT_LT(fine, order == 2 ? 1e-3 : 1e-6) << int(integrator);
            EXPECT_NEAR(std::log2(coarse / fine), order, 0.2) << int(integrator);
        }
}

TEST(Pivot, AContactTurnsTheBodyAboutIt)
{
    // A beam on a pivot in its middle; a crate that falls on one end brings that end down.
    Scene scene = empty_scene(Integrator::semi_implicit);
    scene.gravity = Vec3(0, 0, -10);
    add_floor(scene, 0.5);
    scene.shapes.push_back({"beam", BoxShape{Vec3(2, 0.5, 0.1)}});
    BodyDescription beam;
    beam.shape = 2;
    beam.material = 0;
    beam.mass = 5;
    beam.position = Vec3(0, 0, 3);
    beam.pivot = Vec3::Zero();
    scene.bodies.push_back(beam);
    add_crate(scene, Vec3(1.4, 0, 3.5));
    World world(scene);
    world.step(60);
    const BodyId id = world.bodies()[1];
    EXPECT_LT((world.pose(id) * Vec3(1, 0, 0)).z(), 2.95);
    EXPECT_LT((world.pose(id).position - Vec3(0, 0, 3)).norm(), 1e-12);
}

TEST(Pivot, RulesOutAVelocityOfItsOwn)
{
    Scene scene = empty_scene();
    BodyDescription& body = add_body(scene);
    body.pivot = Vec3(0, 0, 1);
    body.velocity = Vec3(1, 0, 0);
    EXPECT_THROW(World{scene}, std::invalid_argument);
}

// A pendulum whose side slides along a smooth wall swings as it does in the air.
TEST(Pivot, OfWhatTouchesSomethingMakesNoEnergy)
{
    Scene scene = empty_scene(Integrator::semi_implicit);
    scene.gravity = Vec3(0, 0, -10);
    scene.materials.push_back({"m", 1000, 0, 0, 0});
    scene.shapes.push_back({"wall", PlaneShape{Vec3::UnitY(), -0.1}});
    scene.shapes.push_back({"bar", BoxShape{Vec3(0.1, 0.1, 0.5)}});
    BodyDescription wall;
    wall.shape = wall.material = 0;
    wall.motion = Motion::static_;
    scene.bodies.push_back(wall);
    BodyDescription& bar = add_crate(scene, Vec3(0.5, 0, 1));
    bar.orientation = Quat(std::sqrt(0.5), 0, std::sqrt(0.5), 0);
    bar.pivot = Vec3(0, 0, -0.5);
    World world(scene);
    const double first = energy(world);
    double most = first;
    for (int i = 0; i < 1000; ++i) {
        world.step(1);
        most = std::max(most, energy(world));
    }
    EXPECT_GT(world.report().contacts, 0u);
    EXPECT_LT(most - first, 0.1);  // of 10 J that it swings by
    EXPECT_GT(energy(world) - first, -0.3);
}

// Two beams in a row, made overlapping end to end: they have next to no lever arm to part by.
TEST(Pivot, OfBeamsThatOverlapMakesNoEnergy)
{
    for (const bool locked : {false, true}) {
        Scene scene;
        scene.materials.push_back({"m", 1000, 0.3, 0, 0});
        scene.shapes.push_back({"beam", BoxShape{Vec3(1.6, 0.6, 0.6)}});
        for (const double x : {0.0, 3.0}) {
            BodyDescription& beam = scene.bodies.emplace_back();
            beam.shape = beam.material = 0;
            beam.position = Vec3(x, 0, 0);
            beam.lock_position = locked;
            if (!locked) beam.pivot = Vec3(0, 0, 1e-3);
        }
        World world(scene);
        double fastest = 0;
        for (int i = 0; i < 240; ++i) {
            world.step(1);
            for (const BodyId id : world.bodies())
                fastest = std::max(fastest, world.angular_velocity(id).norm());
        }
        EXPECT_LT(fastest, 0.3) << locked;
    }
}

// A plate that moves by itself runs into a capsule and over its pivot; turned as fast as that asks,
// the capsule is held at its times of impact.
TEST(Pivot, StaysWhereItIsWhateverRunsOverIt)
{
    for (const int substeps : {1, 4}) {
        Scene scene;
        scene.settings.substeps = substeps;
        scene.materials.push_back({"m", 7000, 0.7, 0, 0});
        scene.shapes.push_back({"capsule", CapsuleShape{0.034, 0.026}});
        scene.shapes.push_back({"plate", BoxShape{Vec3(0.12, 0.2, 0.2)}});
        scene.bodies.resize(2);
        BodyDescription &capsule = scene.bodies[0], &plate = scene.bodies[1];
        capsule.shape = capsule.material = plate.material = 0;
        capsule.orientation = Quat(0.87, -0.46, 0.01, 0.17).normalized();
        capsule.pivot = Vec3(0, 0, 0.06);
        plate.shape = 1;
        plate.motion = Motion::kinematic;
        plate.position = Vec3(0.21, 0, -0.06);
        plate.velocity = Vec3(-0.7, 0, 0);
        World world(scene);
        const BodyId id = world.bodies()[0];
        const Vec3 hung = world.pose(id) * Vec3(0, 0, 0.06);
        for (int i = 0; i < 120; ++i) {
            world.step(1);
            ASSERT_LT((world.pose(id) * Vec3(0, 0, 0.06) - hung).norm(), 1e-12) << substeps << i;
        }
        EXPECT_LT(world.pose(world.bodies()[1]).position.x(), -1);
    }
}

}  // namespace
}  // namespace throng
