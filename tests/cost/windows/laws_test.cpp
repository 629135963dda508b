// Laws: what windows tell of runs that break them by as much as is known.
#include "cost/windows/laws.hpp"

#include "cost/windows/windows.hpp"
#include "tests/support/small_scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace throng {
namespace {

using given::SceneOf;

double error_of(const WindowRun& run, Measure measure)
{
    return std::sqrt(of(run.errors, measure));
}

// Two boxes that rest on a floor and one that flies over it.
SceneOf two_lie_and_one_flies()
{
    SceneOf made;
    made.floor();
    made.box(Vec3(0.5, 0.5, 0.25), Vec3(0, 0, 0.25));
    made.box(Vec3(0.5, 0.5, 0.25), Vec3(5, 0, 0.25));
    made.box(Vec3(0.5, 0.5, 0.25), Vec3(9, 0, 500));
    return made;
}

TEST(Laws, AreKeptByWhatLiesAndFlies)
{
    const Scene scene = two_lie_and_one_flies().scene;
    const Windows windows(scene, {1, 0.1, 2, 1}, 0, 20, {});
    const WindowRun run = windows.run(scene, 1);
    EXPECT_LT(error_of(run, Measure::momentum), 1e-6);
    EXPECT_LT(error_of(run, Measure::complementarity), 1e-5);
    EXPECT_LT(error_of(run, Measure::friction_cone), 1e-5);
    EXPECT_LT(error_of(run, Measure::force_error), 1e-2);
    EXPECT_GT(of(run.errors, Measure::force_error), 0) << "somebody rests";
    EXPECT_EQ(of(run.errors, Measure::missed_contacts), 0);
}

// A box that meets nothing is in the floor by the end, and nothing bears its weight: of two that
// should rest one, of two that touch one.
TEST(Laws, TellWhoIsNotFoundAndNotBorne)
{
    const Scene scene = two_lie_and_one_flies().scene;
    const Windows windows(scene, {1, 0.1, 2, 1}, 0, 20, {});
    Scene without = scene;
    without.bodies[1].mask = 0;
    without.settings.sleep = false;
    const WindowRun run = windows.run(without, 1);
    EXPECT_NEAR(error_of(run, Measure::missed_contacts), 0.5, 1e-12);
    EXPECT_NEAR(error_of(run, Measure::force_error), std::sqrt(0.5), 1e-3);
}

TEST(Laws, TellMomentumThatKinematicPushesLose)
{
    SceneOf made;
    made.scene.gravity = Vec3::Zero();
    made.ball(0.5, Vec3(0, 0, 0)).mass = 1;
    made.ball(0.5, Vec3(1.01, 0, 0)).mass = 3;
    made.scene.bodies[0].velocity = Vec3(2, 0, 0);
    // The first window begins with the scene.
    const Windows windows(made.scene, {1e-9, 0.1, 2, 1}, 0, 5, {});
    EXPECT_LT(error_of(windows.run(made.scene, 0), Measure::momentum), 1e-5);
    Scene pushed = made.scene;
    pushed.settings.response = Response::kinematic;
    World world(pushed);
    world.step(6);
    const double lost = (world.measure().momentum - Vec3(2, 0, 0)).norm();
    EXPECT_GT(lost, 0.1);
    EXPECT_GE(error_of(windows.run(pushed, 0), Measure::momentum), 0.999 * lost);
}

// Who slides aslant on a pyramid is held by sqrt(2) times what a cone bears.
TEST(Laws, TellWhatAPyramidHasBeyondTheCone)
{
    SceneOf made;
    made.floor();
    BodyDescription& box = made.box(Vec3(0.5, 0.5, 0.25), Vec3(0, 0, 0.25));
    box.lock_rotation = true;
    box.velocity = Vec3(5, 5, 0);
    const Windows windows(made.scene, {1e-9, 0.1, 2, 1}, 0, 5, {});
    EXPECT_LT(error_of(windows.run(made.scene, 0), Measure::friction_cone), 1e-4);
    Scene by = made.scene;
    by.settings.friction_cone = FrictionCone::pyramid;
    const double beyond = (std::sqrt(2) - 1) * 0.5 * 9.81 / 60;
    EXPECT_NEAR(error_of(windows.run(by, 0), Measure::friction_cone), beyond, 0.02 * beyond);
}

// What penalty forces throw parts as it is pushed, at each of four points by a quarter of what made
// it faster in the last step.
TEST(Laws, TellWhatPushesWhatParts)
{
    SceneOf made;
    made.floor();
    made.box(Vec3(0.5, 0.5, 0.25), Vec3(0, 0, 0.24)).lock_rotation = true;
    const Windows windows(made.scene, {1e-9, 0.1, 2, 1}, 0, 5, {});
    EXPECT_LT(error_of(windows.run(made.scene, 0), Measure::complementarity), 1e-3);
    Scene by = made.scene;
    by.settings.response = Response::penalty;
    by.settings.substeps = 1;
    World world(by);
    world.step(5);
    const double before = world.velocity(world.bodies()[1]).z();
    world.step();
    const double speed = world.velocity(world.bodies()[1]).z();
    const double given = (speed - before + 9.81 / 60) / 4;
    ASSERT_GT(std::min(given, speed), 0.02);
    EXPECT_NEAR(error_of(windows.run(by, 0), Measure::complementarity), std::min(given, speed),
                1e-5);
}

TEST(Laws, OfARunThatKeepsNoContactsAreNotKnown)
{
    const Scene scene = two_lie_and_one_flies().scene;
    const Windows windows(scene, {1, 0.1, 2, 1}, 0, 20, {});
    Scene by = scene;
    by.settings.overlap = throng::Overlap::back_up;
    const WindowRun run = windows.run(by, 1);
    EXPECT_TRUE(std::isinf(error_of(run, Measure::complementarity)));
    EXPECT_TRUE(std::isinf(error_of(run, Measure::friction_cone)));
    EXPECT_FALSE(std::isnan(error_of(run, Measure::missed_contacts)));
    EXPECT_TRUE(std::isfinite(error_of(run, Measure::momentum)));
}

TEST(Laws, CountAPairThatTouchesAndWasNotFound)
{
    const std::vector<BodyPair> touching = {{0, 1}, {0, 2}, {1, 2}, {2, 5}},
                                found = {{0, 1}, {0, 3}, {2, 5}};
    EXPECT_DOUBLE_EQ(missed_share(touching, found), 0.5);
    EXPECT_EQ(missed_share(touching, touching), 0);
    EXPECT_EQ(missed_share({}, found), 0);
}

}  // namespace
}  // namespace throng
