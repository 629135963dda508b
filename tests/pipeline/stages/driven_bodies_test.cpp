// Driven bodies: they reach their speed under friction, and push no harder than their drive and
// what bears them do.
#include "tests/support/small_scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace throng {
namespace {

using given::SceneOf;

constexpr double kSpeed = 1.4, kMass = 80, kFriction = 0.5;

// Who walks along x.
BodyDescription& walker(SceneOf& made, const Vec3& position)
{
    BodyDescription& body = made.body(made.shape(CapsuleShape{0.3, 0.6}), position);
    body.mass = kMass;
    body.lock_rotation = true;
    body.drive_velocity = {kSpeed, 0.0, std::nullopt};
    return body;
}

BodyDescription& static_box(SceneOf& made, const Vec3& half, const Vec3& position)
{
    BodyDescription& body = made.box(half, position);
    body.motion = Motion::static_;
    return body;
}

// A plane that rises along x, and who walks up it.
Scene slope_of(double angle)
{
    SceneOf made;
    made.body(made.shape(PlaneShape{Vec3(-std::sin(angle), 0, std::cos(angle)), 0}), Vec3::Zero())
        .motion = Motion::static_;
    walker(made, Vec3(0, 0, 0.6 + 0.3 / std::cos(angle)));
    return made.scene;
}

struct Way {
    const char* name;
    Settings settings;
};

std::vector<Way> ways()
{
    std::vector<Way> all;
    const auto add = [&](const char* name, auto set) {
        all.push_back({name, {}});
        set(all.back().settings);
    };
    add("default", [](Settings&) {});
    add("1/240", [](Settings& s) { s.dt = 1.0 / 240; });
    add("1e-3, double", [](Settings& s) { s.dt = 1e-3, s.precision = Precision::double_; });
    add("substeps 1", [](Settings& s) { s.substeps = 1; });
    add("substeps 16", [](Settings& s) { s.substeps = 16; });
    add("pgs", [](Settings& s) { s.solver = Solver::pgs; });
    add("pgs, substeps 1", [](Settings& s) { s.solver = Solver::pgs, s.substeps = 1; });
    add("direct", [](Settings& s) { s.solver = Solver::direct; });
    add("direct, substeps 1", [](Settings& s) { s.solver = Solver::direct, s.substeps = 1; });
    add("penalty", [](Settings& s) { s.response = Response::penalty; });
    add("kinematic", [](Settings& s) { s.response = Response::kinematic; });
    add("back_up", [](Settings& s) { s.overlap = Overlap::back_up; });
    add("subdivide", [](Settings& s) { s.overlap = Overlap::subdivide; });
    add("points", [](Settings& s) { s.friction_at = FrictionAt::points; });
    add("pyramid", [](Settings& s) { s.friction_cone = FrictionCone::pyramid; });
    return all;
}

// A world of so many seconds later.
World world_of(Scene scene, const Way& way, double time)
{
    scene.settings = way.settings;
    World world(scene);
    world.step(static_cast<int>(std::lround(time / way.settings.dt)));
    return world;
}

TEST(Driven, AWalkerHasItsSpeedUnderFriction)
{
    SceneOf made;
    made.floor();
    walker(made, Vec3(0, 0, 0.9));
    for (const Way& way : ways()) {
        const World world = world_of(made.scene, way, 1);
        const BodyId body = world.bodies()[1];
        EXPECT_LT((world.velocity(body) - Vec3(kSpeed, 0, 0)).norm(), 1e-4) << way.name;
        EXPECT_LT((world.pose(body).position - Vec3(kSpeed, 0, 0.9)).norm(), 1e-3) << way.name;
    }
}

TEST(Driven, AWalkerGoesUpASlope)
{
    const double angle = 10 * std::numbers::pi / 180;
    const Vec3 wanted(kSpeed, 0, kSpeed * std::tan(angle));
    for (const Way& way : ways()) {
        if (way.settings.response == Response::kinematic) continue;  // conserves nothing
        const World world = world_of(slope_of(angle), way, 1);
        EXPECT_LT((world.velocity(world.bodies()[1]) - wanted).norm(), 1e-3) << way.name;
    }
}

TEST(Driven, AWallIsNotClimbed)
{
    const double angle = 70 * std::numbers::pi / 180;
    for (const Way& way : ways()) {
        const Scene scene = slope_of(angle);
        const World world = world_of(scene, way, 2);
        EXPECT_LT(world.pose(world.bodies()[1]).position.z(), scene.bodies[1].position.z() + 5e-3)
            << way.name;
    }
}

TEST(Driven, AWallIsPressedNoHarderThanByTheDriveAndFriction)
{
    SceneOf made;
    made.floor();
    static_box(made, Vec3(1, 5, 5), Vec3(1.5, 0, 5));
    walker(made, Vec3(0, 0, 0.9));
    for (const Way& way : ways()) {
        World world = world_of(made.scene, way, 1);
        const std::vector<BodyId> ids = world.bodies();
        const double dt = way.settings.dt, drive = kMass * kSpeed / dt;
        for (double now = 1; now < 2; now += dt) {
            world.step(1);
            const double borne = -world.contact_force(ids[0]).z();
            ASSERT_LT(world.contact_force(ids[1]).x(), drive + 1.01 * kFriction * borne)
                << way.name;
            ASSERT_NEAR(world.pose(ids[2]).position.z(), 0.9, 2e-3) << way.name;
            ASSERT_LT(world.velocity(ids[2]).norm(), 1e-2) << way.name;
        }
    }
}

TEST(Driven, TwoHeadOnStandAndNeitherRises)
{
    SceneOf made;
    made.floor();
    walker(made, Vec3(-0.5, 0, 0.9));
    walker(made, Vec3(0.5, 0, 0.9)).drive_velocity[0] = -kSpeed;
    for (const Way& way : ways()) {
        const World world = world_of(made.scene, way, 2);
        for (const BodyId body : {world.bodies()[1], world.bodies()[2]}) {
            EXPECT_NEAR(world.pose(body).position.z(), 0.9, 3e-3) << way.name;
            EXPECT_LT(world.velocity(body).norm(), 1e-3) << way.name;
        }
    }
}

TEST(Driven, AWalkerHasItsSpeedOnWhatGoesItsOwnWay)
{
    SceneOf belt;
    static_box(belt, Vec3(50, 2, 0.5), Vec3(0, 0, -0.5)).drive_velocity[0] = -2;
    walker(belt, Vec3(0, 0, 0.9));
    SceneOf plate;
    BodyDescription& disc = plate.body(plate.shape(CylinderShape{10, 0.5}), Vec3(0, 0, -0.5));
    disc.motion = Motion::kinematic;
    disc.angular_velocity = Vec3(0, 0, 1);
    walker(plate, Vec3(-2, 2, 0.9));
    for (const Way& way : ways())
        for (const SceneOf* made : {&belt, &plate}) {
            const World world = world_of(made->scene, way, 2);
            const Vec3 velocity = world.velocity(world.bodies()[1]);
            EXPECT_LT((velocity - Vec3(kSpeed, 0, 0)).norm(), 1e-3)
                << way.name << (made == &belt ? ", belt" : ", plate");
        }
}

// What is on ice goes with any force: none is left.
TEST(Driven, WhatBearsAWalkerIsNotDraggedAlong)
{
    SceneOf made;
    made.scene.materials.push_back({.name = "ice", .friction = 0});
    made.floor().material = 1;
    made.box(Vec3(20, 1, 0.5), Vec3(15, 0, 0.5)).mass = 200;
    walker(made, Vec3(0, 0, 1.9));
    for (const Way& way : ways()) {
        const World world = world_of(made.scene, way, 2);
        const std::vector<BodyId> ids = world.bodies();
        EXPECT_NEAR(world.velocity(ids[1]).x(), 0, 1e-2) << way.name;
        EXPECT_NEAR(world.velocity(ids[2]).x(), kSpeed, 1e-3) << way.name;
    }
}

TEST(Driven, ACartCarriesWhatLiesOnIt)
{
    SceneOf made;
    made.floor();
    made.box(Vec3(1, 1, 0.25), Vec3(0, 0, 0.25)).drive_velocity = {kSpeed, 0.0, std::nullopt};
    made.box(Vec3(0.2, 0.2, 0.2), Vec3(0, 0, 0.7));
    for (const Way& way : ways()) {
        const World world = world_of(made.scene, way, 2);
        const std::vector<BodyId> ids = world.bodies();
        EXPECT_NEAR(world.velocity(ids[1]).x(), kSpeed, 1e-3) << way.name;
        EXPECT_NEAR(world.velocity(ids[2]).x(), kSpeed, 1e-3) << way.name;
    }
}

TEST(Driven, ABallRolls)
{
    SceneOf made;
    made.floor();
    made.ball(0.5, Vec3(0, 0, 0.5)).drive_velocity[0] = kSpeed;
    for (const Way& way : ways()) {
        if (way.settings.response == Response::kinematic) continue;  // nothing turns
        const World world = world_of(made.scene, way, 2);
        EXPECT_NEAR(world.velocity(world.bodies()[1]).x(), kSpeed, 1e-3) << way.name;
        EXPECT_NEAR(world.angular_velocity(world.bodies()[1]).y(), kSpeed / 0.5, 1e-2) << way.name;
    }
}

}  // namespace
}  // namespace throng
