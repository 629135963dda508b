// Rolling and carrying: a side that looks the same however it is turned must not sink for turning;
// a belt carries what lies on it.
#include "throng/world.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace throng {
namespace {

Scene round_body_on_floor(decltype(ShapeDescription::shape) shape, double friction)
{
    Scene scene;
    scene.settings.sleep = false;
    scene.materials.push_back({"rubber", 1000, friction, 0, 0});
    scene.shapes = {{"floor", PlaneShape{}}, {"round", std::move(shape)}};
    BodyDescription floor;
    floor.shape = 0;
    floor.material = 0;
    floor.motion = Motion::static_;
    BodyDescription body;
    body.shape = 1;
    body.material = 0;
    body.position = Vec3(0, 0, 0.5);
    scene.bodies = {floor, body};
    return scene;
}

TEST(Rolling, ABallThatSpinsOnIceStaysOnTopOfIt)
{
    Scene scene = round_body_on_floor(SphereShape{0.5}, 0);
    scene.bodies[1].angular_velocity = Vec3(100, 0, 0);
    World world(scene);
    world.step(60);
    EXPECT_NEAR(world.pose(world.bodies()[1]).position.z(), 0.5, 2e-4);
    EXPECT_NEAR(world.angular_velocity(world.bodies()[1]).x(), 100, 1e-3);
}

TEST(Rolling, AFastBallRestsNoDeeperThanAStillOne)
{
    Scene scene = round_body_on_floor(SphereShape{0.5}, 0.5);
    scene.bodies[1].velocity = Vec3(50, 0, 0);
    scene.bodies[1].angular_velocity = Vec3(0, 100, 0);
    World world(scene);
    world.step(60);
    EXPECT_LT(world.measure().greatest_overlap, 1e-4);
    EXPECT_NEAR(world.velocity(world.bodies()[1]).x(), 50, 1e-2);
}

TEST(Rolling, ALyingCylinderRollsStraight)
{
    Scene scene = round_body_on_floor(CylinderShape{0.5, 0.5}, 0.5);
    scene.bodies[1].orientation = Quat(std::sqrt(0.5), std::sqrt(0.5), 0, 0);
    scene.bodies[1].velocity = Vec3(10, 0, 0);
    scene.bodies[1].angular_velocity = Vec3(0, 20, 0);
    World world(scene);
    world.step(100);
    EXPECT_NEAR(world.pose(world.bodies()[1]).position.y(), 0, 5e-3);
    EXPECT_LT(world.measure().greatest_overlap, 2e-3);
}

TEST(Conveyor, CarriesWhatLiesOnItAndStaysWhereItIs)
{
    Scene scene = round_body_on_floor(BoxShape{Vec3(0.5, 0.5, 0.5)}, 0.5);
    scene.shapes.push_back({"belt", BoxShape{Vec3(50, 2, 0.5)}});
    scene.bodies[0].shape = 2;
    scene.bodies[0].position = Vec3(0, 0, -0.5);
    scene.bodies[0].drive_velocity[0] = 1.4;
    World world(scene);
    world.step(120);
    const std::vector<BodyId> ids = world.bodies();
    EXPECT_NEAR(world.velocity(ids[1]).x(), 1.4, 1e-3);
    EXPECT_NEAR(world.velocity(ids[1]).y(), 0, 1e-3);
    EXPECT_EQ(world.pose(ids[0]).position, Vec3(0, 0, -0.5));
    // From rest at mu g until it runs with the belt: v^2 / (2 mu g) behind it.
    EXPECT_NEAR(world.pose(ids[1]).position.x(), 1.4 * 2 - 1.4 * 1.4 / (2 * 0.5 * 9.81), 2e-2);
}

}  // namespace
}  // namespace throng
