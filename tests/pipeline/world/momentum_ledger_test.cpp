// Momentum ledger: momentum that nothing gave is told, and nothing else.
#include "throng/momentum_ledger.hpp"

#include "tests/support/small_scenes.hpp"
#include "tests/support/watched.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

using given::SceneOf;
using given::watched;

// A ball of 1 kg comes at 4 m/s to one of 3 kg, beside its middle.
SceneOf two_that_meet()
{
    SceneOf made;
    made.scene.gravity = Vec3::Zero();
    made.scene.settings.sleep = false;
    made.ball(0.5, Vec3(0, 0, 0)).mass = 1;
    made.ball(0.5, Vec3(1.2, 0.1, 0)).mass = 3;
    made.scene.bodies[0].velocity = Vec3(4, 0, 0);
    return made;
}

TEST(MomentumLedger, TellsWhatWasPutInAsMade)
{
    SceneOf made = two_that_meet();
    World world(made.scene);
    MomentumLedger ledger;
    for (int step = 0; step < 10; ++step) {
        ledger.before_step(world);
        world.step();
        // Of the other sign every other time: it is no sum of what cancels.
        if (step < 4)
            world.add_impulse(world.bodies()[1], Vec3(0, 0, step % 2 == 0 ? 0.25 : -0.25));
        ledger.after_step(world);
    }
    EXPECT_NEAR(ledger.made(), 1, 1e-5);
    EXPECT_GE(ledger.groups(), 10u);
}

TEST(MomentumLedger, OfImpulsesIsRounding)
{
    EXPECT_LT(watched<MomentumLedger>(two_that_meet().scene, 60).made(), 1e-5);
    SceneOf exact = two_that_meet();
    exact.scene.settings.precision = Precision::double_;
    EXPECT_LT(watched<MomentumLedger>(exact.scene, 60).made(), 1e-13);
}

// Bodies that are put side by side hand on no momentum.
TEST(MomentumLedger, OfKinematicPushesIsWhatTheyLose)
{
    SceneOf made = two_that_meet();
    made.scene.settings.response = Response::kinematic;
    World world(made.scene);
    const Vec3 before = world.measure().momentum;
    const double lost = watched<MomentumLedger>(world, 60).made();
    const double least = Vec3(world.measure().momentum - before).norm();
    EXPECT_GT(least, 0.1);
    EXPECT_GE(lost, 0.999 * least);
}

TEST(MomentumLedger, TakesGravityAndConstantForcesFromIt)
{
    SceneOf made = two_that_meet();
    made.scene.gravity = Vec3(0, 0, -9.81);
    made.scene.bodies[1].force = Vec3(7, 0, 2);
    const MomentumLedger ledger = watched<MomentumLedger>(made.scene, 60);
    EXPECT_LT(ledger.made(), 1e-4);
    EXPECT_GE(ledger.groups(), 60u);
}

TEST(MomentumLedger, LeavesOutWhatIsHeld)
{
    SceneOf lies = two_that_meet(), hung = two_that_meet(), drags = two_that_meet();
    lies.scene.gravity = Vec3(0, 0, -9.81);
    for (BodyDescription& body : lies.scene.bodies) body.position.z() = 0.5;
    lies.floor();
    Spring spring;
    spring.a = 0;
    spring.b = 1;
    spring.stiffness = 10;
    spring.length = 1;
    for (SceneOf* const made : {&hung, &drags}) made->scene.springs.push_back(spring);
    EXPECT_EQ(watched<MomentumLedger>(hung.scene, 20).groups(), 20u) << "on a spring: one group";
    spring.b = kNone;
    hung.scene.springs.push_back(spring);
    for (BodyDescription& body : drags.scene.bodies) body.linear_drag = 0.1;
    EXPECT_EQ(watched<MomentumLedger>(lies.scene, 20).groups(), 0u);
    EXPECT_EQ(watched<MomentumLedger>(hung.scene, 20).groups(), 0u);
    EXPECT_EQ(watched<MomentumLedger>(drags.scene, 20).groups(), 0u);
}

TEST(MomentumLedger, OfBodiesCarriedFromTouchToTouchIsOfAll)
{
    SceneOf made = two_that_meet();
    made.scene.settings.overlap = Overlap::back_up;
    const MomentumLedger alone = watched<MomentumLedger>(made.scene, 30);
    EXPECT_LT(alone.made(), 1e-10);
    EXPECT_EQ(alone.groups(), 30u);
    made.floor();
    EXPECT_EQ(watched<MomentumLedger>(made.scene, 30).groups(), 0u);
}

TEST(MomentumLedger, IsTheSameBitsOnAnyNumberOfThreads)
{
    const Scene scene = given::mixed_scene();
    World one(scene, 1), three(scene, 3);
    const MomentumLedger a = watched<MomentumLedger>(one, 30),
                         b = watched<MomentumLedger>(three, 30);
    EXPECT_GT(a.groups(), 0u);
    EXPECT_EQ(a.made(), b.made());
}

}  // namespace
}  // namespace throng
