// Velocity lag: who goes from flight to contact and back wins nothing by it.
#include "throng/energy_ledger.hpp"
#include "throng/world.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace throng {
namespace {

// A ball that falls half a meter and loses nothing.
Scene bouncing(Integrator integrator)
{
    Scene scene;
    scene.settings.integrator = integrator;
    scene.materials.push_back({"m", 1000, 0, 1, 0});
    scene.shapes.push_back({"floor", PlaneShape{}});
    scene.shapes.push_back({"ball", SphereShape{0.05}});
    BodyDescription floor, ball;
    floor.shape = floor.material = ball.material = 0;
    floor.motion = Motion::static_;
    ball.shape = 1;
    ball.position = Vec3(0, 0, 0.55);
    scene.bodies = {floor, ball};
    return scene;
}

// m, the greatest in the last second of twenty.
double height_after(const Scene& scene)
{
    World world(scene);
    EnergyLedger ledger;
    double highest = 0;
    for (int step = 0; step < 1200; ++step) {
        ledger.before_step(world);
        world.step();
        ledger.after_step(world);
        if (step >= 1140) highest = std::max(highest, world.pose(world.bodies()[1]).position.z());
    }
    EXPECT_LT(ledger.gained(), 1e-3 * ledger.greatest_kinetic());
    return highest;
}

TEST(VelocityLag, WhoBouncesWinsNothingByAnyIntegrator)
{
    for (const Integrator integrator :
         {Integrator::auto_, Integrator::semi_implicit, Integrator::midpoint, Integrator::splitting,
          Integrator::rk4}) {
        Scene scene = bouncing(integrator);
        EXPECT_NEAR(height_after(scene), 0.55, 0.02) << int(integrator);
        scene.bodies[1].linear_drag = 1e-12;
        EXPECT_NEAR(height_after(scene), 0.55, 0.02) << int(integrator) << ", drag";
        scene.attractors.push_back({Vec3(0, 0, 50), 1e-12});
        EXPECT_NEAR(height_after(scene), 0.55, 0.02) << int(integrator) << ", attractor";
    }
}

// What rests is not moved by it: the velocity that contacts leave is that of a body at rest.
TEST(VelocityLag, LeavesWhoRestsAtRest)
{
    for (const Integrator integrator : {Integrator::auto_, Integrator::rk4}) {
        Scene scene = bouncing(integrator);
        scene.materials[0].restitution = 0;
        scene.bodies[1].position.z() = 0.05;
        scene.bodies[1].linear_drag = 0.1;
        World world(scene);
        world.step(60);
        for (int step = 0; step < 60; ++step) {
            world.step();
            EXPECT_LT(world.velocity(world.bodies()[1]).norm(), 1e-4) << int(integrator);
        }
    }
}

// A box at rest that a constant force pulls over the floor: friction has all of its weight at once.
TEST(VelocityLag, WhoIsPulledFromRestIsHeldByAllOfHisWeight)
{
    for (const Integrator integrator :
         {Integrator::auto_, Integrator::semi_implicit, Integrator::midpoint, Integrator::rk4}) {
        Scene scene = bouncing(integrator);
        scene.materials[0] = {"m", 1000, 0.4, 0, 0};
        scene.shapes[1] = {"box", BoxShape{Vec3(1, 1, 0.1)}};
        scene.settings.dt = 0.01;
        BodyDescription& box = scene.bodies[1];
        box.position.z() = 0.1;
        box.mass = 10;
        box.force = Vec3(60, 0, 0);
        World world(scene);
        world.step(60);
        const double speed = 0.6 * (6 - 0.4 * world.gravity().norm());
        EXPECT_NEAR(world.velocity(world.bodies()[1]).x(), speed, 1e-4) << int(integrator);
    }
}

// A heavy ball that rolls off a light one: on it he is solved by finer substeps, of which he is
// half of one behind, and beside it by the usual one.
TEST(VelocityLag, WhoFallsOffWhatIsEscalatedWinsNothing)
{
    Scene scene = bouncing(Integrator::auto_);
    scene.materials[0] = {"m", 1000, 0.3, 0, 0};
    scene.settings.substeps = 1;
    scene.bodies[1].position.z() = 0.05;
    scene.bodies[1].mass = 1;
    scene.bodies.push_back(scene.bodies[1]);
    scene.bodies[2].position = Vec3(0.01, 0, 0.05 + 0.1 * std::sqrt(0.99));
    scene.bodies[2].mass = 10;
    World world(scene);
    EnergyLedger ledger;
    std::size_t escalated = 0;
    for (int step = 0; step < 60; ++step) {
        ledger.before_step(world);
        world.step();
        ledger.after_step(world);
        escalated += world.report().islands_escalated;
    }
    EXPECT_GT(escalated, 5u);
    EXPECT_LT(world.pose(world.bodies()[2]).position.z(), 0.06);
    EXPECT_LT(ledger.gained(), 5e-3 * 10 * world.gravity().norm() * 0.1);
}

// The same falls as far as by the usual substeps, once nothing holds him: by none of them is he
// slower or faster than gravity makes him.
TEST(VelocityLag, WhoFallsBesideWhatIsEscalatedFallsAsAllDo)
{
    Scene scene = bouncing(Integrator::auto_);
    scene.materials[0] = {"m", 1000, 0, 0, 0};
    scene.settings.substeps = 1;
    scene.shapes.push_back({"box", BoxShape{Vec3(0.5, 0.5, 0.5)}});
    for (const int i : {0, 1}) {
        BodyDescription box = scene.bodies[1];
        box.shape = 2;
        box.position = Vec3(0, 0, 0.5 + i);
        box.mass = i == 0 ? 1 : 1000;
        scene.bodies.push_back(box);
    }
    // Along a side, nearer than contacts look ahead, and never on it.
    scene.bodies[1].position = Vec3(0.552, 0, 1.9);
    World world(scene);
    const BodyId ball = world.bodies()[1];
    std::size_t escalated = 0;
    for (int step = 1; step <= 20; ++step) {
        world.step();
        escalated += world.report().islands_escalated;
        EXPECT_NEAR(world.velocity(ball).z(), -world.gravity().norm() * step / 60, 1e-4) << step;
    }
    EXPECT_GT(escalated, 5u);
}

// Who can only turn stays where he is, also when he was solved by finer substeps and all is taken
// off him.
TEST(VelocityLag, WhoCanOnlyTurnDoesNotFallFromEscalation)
{
    Scene scene = bouncing(Integrator::auto_);
    scene.materials[0] = {"m", 1000, 0.5, 0, 0};
    scene.bodies[1].lock_position = true;
    scene.bodies[1].mass = 1;
    scene.shapes.push_back({"box", BoxShape{Vec3(1, 1, 1)}});
    for (const double height : {1.0, 1.1}) {
        BodyDescription& box = scene.bodies.emplace_back(scene.bodies[1]);
        box.lock_position = false;
        box.shape = 2;
        box.mass = 1000;
        box.position = Vec3(0, 0, height == 1.0 ? 1 : 3.1);
    }
    scene.bodies[1].position = Vec3(0, 0, 2.05);
    World world(scene);
    const BodyId ball = world.bodies()[1];
    std::size_t escalated = 0;
    for (int step = 0; step < 60; ++step) {
        world.step();
        escalated += world.report().islands_escalated;
    }
    EXPECT_GT(escalated, 5u);
    world.set_pose(world.bodies()[2], {Vec3(10, 0, 1), Quat::Identity()});
    world.set_pose(world.bodies()[3], {Vec3(20, 0, 1), Quat::Identity()});
    world.step(60);
    EXPECT_EQ(world.pose(ball).position, Vec3(0, 0, 2.05));
    EXPECT_EQ(world.velocity(ball), Vec3(Vec3::Zero()));
}

}  // namespace
}  // namespace throng
