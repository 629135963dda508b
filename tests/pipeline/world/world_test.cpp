// World: bodies that come and go, what may be done to them from outside, and what physics owes
// them.
#include "throng/world.hpp"

#include "tests/support/small_scenes.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace throng {
namespace {

using given::greatest_speed;
using given::mixed_scene;
using given::SceneOf;

constexpr double kG = 9.81;

Scene box_on_floor(double height = 0.5)
{
    SceneOf made;
    made.floor();
    made.box(Vec3(0.5, 0.5, 0.5), Vec3(0, 0, height)).name = "crate";
    return made.scene;
}

Scene one_box(const Vec3& position)
{
    SceneOf made;
    made.box(Vec3(0.5, 0.5, 0.5), position);
    return made.scene;
}

TEST(World, GivesIdsInTheScenesOrderBodiesThenInstances)
{
    Scene scene = box_on_floor();
    Instances group;
    group.common.shape = 1;
    for (int i = 0; i < 3; ++i) {
        const double record[13] = {3.0 + 2 * i, 0, 0.5, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0};
        group.records.insert(group.records.end(), record, record + 13);
    }
    scene.instances.push_back(group);
    World world(Settings{});
    const std::vector<BodyId> ids = world.add(scene);
    ASSERT_EQ(ids.size(), 5u);
    for (std::uint32_t i = 0; i < 5; ++i) EXPECT_EQ(ids[i].index, i);
    EXPECT_EQ(world.pose(ids[4]).position.x(), 7);
    EXPECT_EQ(world.name(ids[1]), "crate");
    EXPECT_EQ(world.name(ids[3]), "");
    EXPECT_EQ(world.body_count(), 5u);
    EXPECT_EQ(world.bodies(), ids);
}

TEST(World, InstancesWithSizesOfTheirOwnWeighThat)
{
    SceneOf made;
    Instances group;
    group.common.shape = made.shape(BoxShape{Vec3(1, 1, 1)});
    group.own_sizes = true;
    for (int i = 1; i <= 3; ++i) {
        const double record[16] = {5.0 * i, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0.1 * i, 0.2, 0.3};
        group.records.insert(group.records.end(), record, record + 16);
    }
    made.scene.instances.push_back(group);
    World world(made.scene);
    for (std::uint32_t i = 0; i < 3; ++i)
        EXPECT_NEAR(world.mass(world.bodies()[i]), 1000 * 8 * 0.1 * (i + 1) * 0.2 * 0.3, 1e-9);
}

TEST(World, AStaleIdThrows)
{
    World world(box_on_floor());
    const BodyId crate = world.bodies()[1];
    world.remove(std::vector{crate});
    EXPECT_FALSE(world.alive(crate));
    EXPECT_EQ(world.body_count(), 1u);
    EXPECT_THROW(world.pose(crate), std::invalid_argument);
    EXPECT_THROW(world.set_velocity(crate, Vec3::Zero(), Vec3::Zero()), std::invalid_argument);
    EXPECT_THROW(world.remove(std::vector{crate}), std::invalid_argument);
    EXPECT_THROW(world.pose(BodyId{77, 0}), std::invalid_argument);
    // Whoever takes the place is somebody else.
    const BodyId next = world.add(one_box(Vec3(0, 0, 5)))[0];
    EXPECT_EQ(next.index, crate.index);
    EXPECT_NE(next.generation, crate.generation);
    EXPECT_FALSE(world.alive(crate));
    EXPECT_THROW(world.name(crate), std::invalid_argument);
    EXPECT_EQ(world.name(next), "");
}

TEST(World, RemovesNothingWhenOneOfTheIdsIsStale)
{
    World world(box_on_floor());
    const std::vector<BodyId> ids = world.bodies();
    EXPECT_THROW(world.remove(std::vector{ids[1], BodyId{9, 9}}), std::invalid_argument);
    EXPECT_TRUE(world.alive(ids[1]));
    // The same one twice is one.
    world.remove(std::vector{ids[1], ids[1]});
    EXPECT_EQ(world.body_count(), 1u);
}

TEST(World, ReusesTheLeastFreePlaceFirst)
{
    World world(Settings{});
    std::vector<BodyId> ids;
    for (int i = 0; i < 5; ++i) ids.push_back(world.add(one_box(Vec3(3.0 * i, 0, 0)))[0]);
    world.remove(std::vector{ids[3], ids[1]});
    EXPECT_EQ(world.add(one_box(Vec3(50, 0, 0)))[0].index, 1u);
    EXPECT_EQ(world.add(one_box(Vec3(60, 0, 0)))[0].index, 3u);
    EXPECT_EQ(world.add(one_box(Vec3(70, 0, 0)))[0].index, 5u);
}

TEST(World, MayLoseBodiesOneAfterAnotherBetweenSteps)
{
    SceneOf made;
    made.floor();
    for (int i = 0; i < 10; ++i) made.box(Vec3(0.5, 0.5, 0.5), Vec3(0, 0, 0.5 + i));
    World world(made.scene);
    world.step(10);
    const std::vector<BodyId> ids = world.bodies();
    for (std::size_t i = 1; i < 8; ++i) world.remove(std::vector{ids[i]});
    world.set_pose(ids[9], {Vec3(0, 0, 8.5), Quat::Identity()});
    EXPECT_GE(world.contact_force(ids[9]).norm(), 0);
    world.step(240);
    EXPECT_NEAR(world.pose(ids[8]).position.z(), 0.5, 0.01);
    EXPECT_NEAR(world.pose(ids[9]).position.z(), 1.5, 0.01);
}

TEST(World, ANewBodyInAnOldPlaceInheritsNothing)
{
    // The same box again, at once: as good as a world that never had the first.
    World world(box_on_floor());
    world.step(60);
    world.remove(std::vector{world.bodies()[1]});
    EXPECT_EQ(world.add(one_box(Vec3(0, 0, 0.5)))[0].index, 1u);
    World fresh(box_on_floor());
    fresh.step(1);
    world.step(1);
    EXPECT_EQ(world.pose(world.bodies()[1]).position, fresh.pose(fresh.bodies()[1]).position);
    EXPECT_EQ(world.velocity(world.bodies()[1]), fresh.velocity(fresh.bodies()[1]));
}

TEST(World, AMeshThatGoesTakesItsContactsWithIt)
{
    Scene scene = mixed_scene();
    World world(scene);
    world.step(60);
    std::vector<BodyId> meshes;
    for (const BodyId body : world.bodies())
        if (std::holds_alternative<MeshShape>(scene.shapes[scene.bodies[body.index].shape].shape))
            meshes.push_back(body);
    ASSERT_EQ(meshes.size(), 1u);
    world.remove(meshes);
    world.step(60);
    EXPECT_FALSE(world.effects().on.has(Effect::mesh_contact));
    for (const BodyId body : world.bodies()) EXPECT_TRUE(world.pose(body).position.allFinite());
}

TEST(World, AShapeOfAnotherKindMayTakeThePlaceOfAMesh)
{
    SceneOf made;
    MeshShape mesh;
    mesh.vertices = {Vec3(-3, -3, 0), Vec3(3, -3, 0), Vec3(3, 3, 0), Vec3(-3, 3, 0)};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    made.body(made.shape(mesh), Vec3::Zero()).motion = Motion::static_;
    made.box(Vec3(0.5, 0.5, 0.5), Vec3(0, 0, 0.5));
    World world(made.scene);
    world.step(5);
    world.remove(std::vector{world.bodies()[0]});
    SceneOf slab;
    slab.box(Vec3(3, 3, 0.5), Vec3(0, 0, -0.5)).motion = Motion::static_;
    EXPECT_EQ(world.add(slab.scene)[0].index, 0u);
    world.step(60);
    EXPECT_NEAR(world.pose(world.bodies()[1]).position.z(), 0.5, 0.005);
}

TEST(World, AnEmptyOrLonelyWorldSteps)
{
    World empty(Settings{});
    empty.step(3);
    EXPECT_EQ(empty.report().step, 3u);
    World floor_alone([] {
        SceneOf made;
        made.floor();
        return made.scene;
    }());
    floor_alone.step(3);
    World world(box_on_floor());
    world.step(3);
    world.remove(world.bodies());
    world.step(3);
    EXPECT_EQ(world.body_count(), 0u);
    EXPECT_EQ(world.report().contacts, 0u);
    EXPECT_EQ(world.report().pairs, 0u);
    EXPECT_EQ(world.report().islands, 0u);
}

TEST(World, WhatIsLockedStaysLocked)
{
    SceneOf made;
    made.scene.gravity = Vec3(0, 0, -kG);
    made.box(Vec3(0.5, 0.5, 0.5), Vec3(0, 0, 5)).lock_position = true;
    made.box(Vec3(0.5, 0.5, 0.5), Vec3(0, 5, 5)).lock_rotation = true;
    // Something falls on the rim of each.
    made.ball(0.2, Vec3(0.4, 0, 6));
    made.ball(0.2, Vec3(0.4, 5, 6));
    World world(made.scene);
    const std::vector<BodyId> ids = world.bodies();
    world.set_velocity(ids[0], Vec3(1, 2, 3), Vec3::Zero());
    world.set_velocity(ids[1], Vec3::Zero(), Vec3(1, 2, 3));
    world.step(60);
    EXPECT_EQ(world.pose(ids[0]).position, Vec3(0, 0, 5));
    EXPECT_GT(world.angular_velocity(ids[0]).norm(), 0.01);
    EXPECT_EQ(world.pose(ids[1]).orientation.coeffs(), Quat::Identity().coeffs());
    EXPECT_LT(world.pose(ids[1]).position.z(), 4.9);
}

TEST(World, StaticBodiesTakeNoVelocity)
{
    World world(box_on_floor());
    world.set_velocity(world.bodies()[0], Vec3(1, 0, 0), Vec3(0, 0, 1));
    EXPECT_EQ(world.velocity(world.bodies()[0]), Vec3(Vec3::Zero()));
}

TEST(World, ACompoundTurnsAboutItsCenterOfMassAndIsPlacedByItsFrame)
{
    // A dumbbell of two balls, one eight times as heavy, its frame at the light one.
    SceneOf made;
    made.scene.gravity.setZero();
    const std::uint32_t light = made.shape(SphereShape{0.1}), heavy = made.shape(SphereShape{0.2});
    CompoundShape dumbbell;
    dumbbell.parts = {{light, Pose{}}, {heavy, Pose{Vec3(0.9, 0, 0), Quat::Identity()}}};
    BodyDescription& body = made.body(made.shape(dumbbell), Vec3(1, 2, 3));
    body.velocity = Vec3(0, 0, 1);
    body.angular_velocity = Vec3(0, 0, 2);
    World world(made.scene);
    const BodyId id = world.bodies()[0];
    const double volume = 4.0 / 3 * 3.14159265358979323846 * (0.001 + 0.008);
    EXPECT_NEAR(world.mass(id), 1000 * volume, 1e-9);
    EXPECT_LE((world.center_of_mass(id) - Vec3(1.8, 2, 3)).norm(), 1e-12);
    EXPECT_LE((world.pose(id).position - Vec3(1, 2, 3)).norm(), 1e-12);
    world.step(60);
    // The center flies straight; the frame goes round it.
    EXPECT_LE((world.center_of_mass(id) - Vec3(1.8, 2, 4)).norm(), 1e-9);
    const Vec3 arm(-0.8 * std::cos(2.0), -0.8 * std::sin(2.0), 0);
    EXPECT_LE((world.pose(id).position - (Vec3(1.8, 2, 4) + arm)).norm(), 1e-9);
    EXPECT_LE((world.velocity(id) - Vec3(0, 0, 1)).norm(), 1e-12);
}

TEST(World, RefusesScenesThatCannotBe)
{
    const auto refused = [](auto change) {
        Scene scene = box_on_floor();
        change(scene);
        EXPECT_THROW(World{scene}, std::invalid_argument);
    };
    refused([](Scene& s) { s.bodies[1].mass = -1; });
    refused([](Scene& s) { s.bodies[1].shape = 77; });
    refused([](Scene& s) { s.bodies[1].material = 77; });
    refused([](Scene& s) { s.bodies[1].position.x() = std::nan(""); });
    refused([](Scene& s) { s.bodies[1].orientation = Quat(2, 0, 0, 0); });
    refused([](Scene& s) { s.bodies[0].motion = Motion::dynamic; });
    refused([](Scene& s) { s.shapes[1].shape = BoxShape{Vec3(1, 0, 1)}; });
    refused([](Scene& s) { s.settings.dt = 0; });
    refused([](Scene& s) { s.settings.substeps = 0; });
    refused([](Scene& s) { s.gravity.x() = std::nan(""); });
}

TEST(World, RefusesSettingsThatCannotBe)
{
    Settings settings;
    settings.dt = -1;
    EXPECT_THROW(World{settings}, std::invalid_argument);
    World world(box_on_floor());
    EXPECT_THROW(world.set_settings(settings), std::invalid_argument);
    settings = {};
    settings.precision = Precision::double_;
    EXPECT_THROW(world.set_settings(settings), std::invalid_argument);
    EXPECT_THROW(world.set_gravity(Vec3(0, 0, std::nan(""))), std::invalid_argument);
    const BodyId crate = world.bodies()[1];
    EXPECT_THROW(world.set_velocity(crate, Vec3(HUGE_VAL, 0, 0), Vec3::Zero()),
                 std::invalid_argument);
    EXPECT_THROW(world.add_impulse(crate, Vec3(std::nan(""), 0, 0)), std::invalid_argument);
    EXPECT_THROW(world.set_pose(crate, {Vec3::Zero(), Quat(0, 0, 0, 0)}), std::invalid_argument);
}

TEST(World, ABadSceneLeavesTheWorldAsItWas)
{
    World world(box_on_floor());
    world.step(5);
    const std::string before = world.state_hash();
    Scene bad = one_box(Vec3(0, 0, 3));
    bad.bodies[0].mass = -1;
    EXPECT_THROW(world.add(bad), std::invalid_argument);
    EXPECT_EQ(world.body_count(), 2u);
    EXPECT_EQ(world.state_hash(), before);
}

TEST(World, ABodyTooFastToHoldIsQuarantinedAndItsNeighborsGoOn)
{
    for (const Precision precision : {Precision::float_, Precision::double_})
        for (const double speed : {1e17, 1e30, 1e100, 1e300}) {
            SceneOf made;
            made.scene.settings.precision = precision;
            made.floor();
            for (int i = 0; i < 5; ++i) made.box(Vec3(0.5, 0.5, 0.5), Vec3(0, 0, 0.5 + i));
            World world(made.scene);
            world.step(10);
            const std::vector<BodyId> ids = world.bodies();
            world.set_velocity(ids[3], Vec3(speed, 0, speed), Vec3(0, speed, 0));
            world.step(60);
            EXPECT_TRUE(world.quarantined(ids[3])) << speed;
            EXPECT_EQ(world.report().bodies_quarantined, 1u) << speed;
            EXPECT_EQ(world.velocity(ids[3]), Vec3(Vec3::Zero()));
            for (std::size_t i = 1; i < 6; ++i) {
                EXPECT_NEAR(world.pose(ids[i]).position.z(), static_cast<double>(i) - 0.5, 0.02);
                EXPECT_EQ(world.quarantined(ids[i]), i == 3);
            }
            EXPECT_TRUE(std::isfinite(world.measure().kinetic_energy));
        }
}

TEST(World, ABodyThatLeavesEverythingBehindIsQuarantinedInTheEnd)
{
    SceneOf made;
    made.scene.gravity = Vec3(0, 0, -1e14);
    made.ball(0.5, Vec3(0, 0, 0));
    World world(made.scene);
    world.step(60 * 200);
    EXPECT_TRUE(world.quarantined(world.bodies()[0]));
    EXPECT_TRUE(world.pose(world.bodies()[0]).position.allFinite());
}

TEST(World, APlatformThatTurnsCarriesABox)
{
    SceneOf made;
    BodyDescription& platform = made.box(Vec3(2, 2, 0.1), Vec3(0, 0, 0));
    platform.motion = Motion::kinematic;
    platform.angular_velocity = Vec3(0, 0, 0.5);
    made.box(Vec3(0.2, 0.2, 0.2), Vec3(1, 0, 0.3));
    World world(made.scene);
    world.step(120);
    const BodyId box = world.bodies()[1];
    // 0.25 m/s2 holds it on its circle, a twentieth of what friction could give: after two seconds
    // it has gone a radian.
    const Vec3 at = world.pose(box).position;
    EXPECT_NEAR(at.x(), std::cos(1.0), 0.05);  // it slipped while it was set going
    EXPECT_NEAR(at.y(), std::sin(1.0), 0.05);
    EXPECT_NEAR(at.z(), 0.3, 0.003);
    EXPECT_NEAR(world.angular_velocity(box).z(), 0.5, 0.02);
}

TEST(World, APlaneThatMovesCarriesABox)
{
    SceneOf made;
    BodyDescription& lift = made.floor();
    lift.motion = Motion::kinematic;
    lift.velocity = Vec3(0, 0, 1);
    made.box(Vec3(0.5, 0.5, 0.5), Vec3(0, 0, 0.5));
    World world(made.scene);
    world.step(60);
    EXPECT_NEAR(world.pose(world.bodies()[1]).position.z(), 1.5, 0.002);
}

TEST(World, ADrivenBodyKeepsItsSpeedWhateverItPushes)
{
    SceneOf made;
    made.floor();
    BodyDescription& pusher = made.box(Vec3(0.5, 0.5, 0.5), Vec3(0, 0, 0.5));
    pusher.drive_velocity = {0.5, std::nullopt, std::nullopt};
    pusher.lock_rotation = true;
    made.box(Vec3(0.2, 0.2, 0.2), Vec3(0.8, 0, 0.2));
    World world(made.scene);
    world.step(120);
    // Friction slows it within a step, by at most 0.5 g dt.
    EXPECT_NEAR(world.pose(world.bodies()[1]).position.x(), 1.0, 0.17);
    EXPECT_GT(world.pose(world.bodies()[2]).position.x(), 1.5);
}

TEST(World, TheContactForceOfARestingBoxIsItsWeight)
{
    for (const bool sleep : {true, false}) {
        Scene scene = box_on_floor();
        scene.settings.sleep = sleep;
        World world(scene);
        world.step(240);
        const BodyId box = world.bodies()[1];
        const double weight = kG * world.mass(box);
        EXPECT_NEAR(world.contact_force(box).z(), weight, 0.005 * weight) << sleep;
        EXPECT_NEAR(world.contact_force(world.bodies()[0]).z(), -weight, 0.005 * weight) << sleep;
        EXPECT_LE(world.contact_force(box).head<2>().norm(), 0.005 * weight);
    }
}

TEST(World, FreeFlightKeepsMomentumAndEnergy)
{
    SceneOf made;
    made.scene.gravity.setZero();
    for (int i = 0; i < 5; ++i) {
        BodyDescription& body = made.box(Vec3(0.5, 0.3, 0.2 + 0.1 * i), Vec3(10.0 * i, 0, 0));
        body.velocity = Vec3(1, i, -2);
        body.angular_velocity = Vec3(0.1 * i, 0, 3);
    }
    World world(made.scene);
    const Measures before = world.measure();
    world.step(240);
    const Measures after = world.measure();
    EXPECT_LE((after.momentum - before.momentum).norm(), 1e-9 * before.momentum.norm());
    // The gyroscopic torque loses energy by first order, and never gains.
    EXPECT_LE(after.kinetic_energy, before.kinetic_energy * (1 + 1e-12));
    EXPECT_GE(after.kinetic_energy, before.kinetic_energy * 0.9999);
}

TEST(World, AFallIsTheParabolaOfItsSubsteps)
{
    World world(one_box(Vec3(0, 0, 100)));
    world.step(60);
    // v = v - g h, then x = x + v h, 240 times.
    const double h = 1 / 240.0;
    EXPECT_NEAR(world.pose(world.bodies()[0]).position.z(), 100 - kG * h * h * 240 * 241 / 2, 1e-9);
    EXPECT_NEAR(world.velocity(world.bodies()[0]).z(), -kG, 1e-11);
}

TEST(World, ABoxAtRestNeverGainsEnergy)
{
    Scene scene = box_on_floor();
    scene.settings.sleep = false;
    World world(scene);
    world.step(30);
    double least = HUGE_VAL;
    for (int i = 0; i < 300; ++i) {
        world.step(1);
        const Measures now = world.measure();
        const double energy = now.kinetic_energy + now.potential_energy;
        EXPECT_LE(energy, least + 1e-3);  // J, of some 5000
        least = std::min(least, energy);
    }
    EXPECT_LT(greatest_speed(world), 1e-4);
}

TEST(World, ABallRollsDownAnInclineByFiveSeventhsOfGravity)
{
    SceneOf made;
    const double tilt = 0.2;
    BodyDescription& slope =
        made.body(made.shape(PlaneShape{Vec3(std::sin(tilt), 0, std::cos(tilt)), 0}), Vec3::Zero());
    slope.motion = Motion::static_;
    made.ball(0.5, Vec3(0.5 * std::sin(tilt), 0, 0.5 * std::cos(tilt)));
    World world(made.scene);
    world.step(120);
    const double wanted = 5.0 / 7 * kG * std::sin(tilt) * 2;
    EXPECT_NEAR(world.velocity(world.bodies()[1]).norm(), wanted, 0.01 * wanted);
    EXPECT_NEAR(world.angular_velocity(world.bodies()[1]).norm(), wanted / 0.5,
                0.01 * wanted / 0.5);
}

TEST(World, BallsLeaveACollisionAsRestitutionSays)
{
    for (const double restitution : {0.0, 0.5, 1.0}) {
        SceneOf made;
        made.scene.gravity.setZero();
        made.scene.materials[0].restitution = restitution;
        made.scene.materials[0].friction = 0;
        made.ball(0.5, Vec3(0, 0, 0)).velocity = Vec3(2, 0, 0);
        made.ball(0.5, Vec3(2, 0, 0)).mass = 200.0;
        made.scene.bodies[0].mass = 100.0;
        World world(made.scene);
        world.step(60);
        // 100 kg at 2 m/s against 200 kg at rest.
        const double together = 2.0 / 3;
        const double a = together - restitution * 2 * 2.0 / 3, b = together + restitution * 2.0 / 3;
        EXPECT_NEAR(world.velocity(world.bodies()[0]).x(), a, 2e-3) << restitution;
        EXPECT_NEAR(world.velocity(world.bodies()[1]).x(), b, 2e-3) << restitution;
        EXPECT_LE((world.measure().momentum - Vec3(200, 0, 0)).norm(), 1e-3);
    }
}

TEST(World, AFaceThatMeetsAFaceLeavesItWhole)
{
    for (const double restitution : {0.3, 1.0}) {
        SceneOf made;
        made.scene.gravity.setZero();
        made.scene.materials[0].restitution = restitution;
        made.scene.materials[0].friction = 0;
        made.box(Vec3(0.1, 3, 3), Vec3(2, 0, 0)).motion = Motion::static_;
        made.box(Vec3(0.3, 0.5, 0.4), Vec3(0.1, 0.2, -0.1)).velocity = Vec3(10, 0, 0);
        World world(made.scene);
        world.step(60);
        const BodyId box = world.bodies()[1];
        EXPECT_NEAR(world.velocity(box).x(), -10 * restitution, 1e-2) << restitution;
        EXPECT_LT(world.angular_velocity(box).norm(), 1e-2) << restitution;
    }
}

TEST(World, AStackOfTenBoxesRests)
{
    SceneOf made;
    made.floor();
    for (int i = 0; i < 10; ++i) made.box(Vec3(0.5, 0.5, 0.5), Vec3(0, 0, 0.5 + i));
    made.scene.settings.sleep = false;
    World world(made.scene);
    world.step(600);
    EXPECT_LT(world.measure().greatest_overlap, 0.003);
    EXPECT_LT(greatest_speed(world), 1e-3);
    for (std::uint32_t i = 1; i <= 10; ++i)
        EXPECT_NEAR(world.pose(world.bodies()[i]).position.head<2>().norm(), 0, 1e-3);
}

TEST(World, ABoxRestsFarFromTheOriginAsItDoesThere)
{
    for (const Vec3& place : {Vec3(0, 0, 0), Vec3(1e5, -1e5, 0), Vec3(1e7, 1e7, 0)}) {
        SceneOf made;
        made.floor();
        made.box(Vec3(0.5, 0.5, 0.5), place + Vec3(0, 0, 0.5));
        made.box(Vec3(0.5, 0.5, 0.5), place + Vec3(0.1, 0, 1.5));
        World world(made.scene);
        world.step(180);
        EXPECT_LE((world.pose(world.bodies()[1]).position - place - Vec3(0, 0, 0.5)).norm(), 2e-3)
            << place.transpose();
        EXPECT_LE((world.pose(world.bodies()[2]).position - place - Vec3(0.1, 0, 1.5)).norm(), 3e-3)
            << place.transpose();
        EXPECT_LT(greatest_speed(world), 1e-3);
    }
}

}  // namespace
}  // namespace throng
