// Error estimate: what it tells of steps whose error is known, and who has the worst of it.
#include "throng/error_estimate.hpp"

#include "tests/support/small_scenes.hpp"
#include "tests/support/watched.hpp"

#include <gtest/gtest.h>

#include <span>

namespace throng {
namespace {

using given::SceneOf;
using given::watched;

TEST(ErrorEstimate, TellsNothingBeforeAStepAndOfNobody)
{
    EXPECT_EQ(ErrorEstimate().last().step, 0u);
    EXPECT_EQ(ErrorEstimate().rms(), 0);
    SceneOf made;
    made.floor();
    const ErrorEstimate estimate = watched<ErrorEstimate>(made.scene, 3);
    EXPECT_EQ(estimate.last().step, 3u);
    EXPECT_EQ(estimate.last().greatest, 0);
    EXPECT_EQ(estimate.last().worst.index, kNone);
}

TEST(ErrorEstimate, OfUniformMotionIsNothing)
{
    SceneOf made;
    made.scene.gravity = Vec3::Zero();
    made.ball(0.5, Vec3(1, 2, 3)).velocity = Vec3(3, 0, 1);
    EXPECT_LE(watched<ErrorEstimate>(made.scene, 10).rms(), 1e-14);
}

// What falls is put g dt h / 2 too low, h a substep: a kick first, then the way.
TEST(ErrorEstimate, OfFallingIsNoLessThanItsError)
{
    for (const double dt : {1.0 / 30, 1.0 / 60, 1.0 / 240})
        for (const int substeps : {1, 4}) {
            SceneOf made;
            made.scene.settings.dt = dt;
            made.scene.settings.substeps = substeps;
            made.ball(0.5, Vec3(0, 0, 100));
            const double error = 9.81 * dt * dt / substeps / 2;
            const double told = watched<ErrorEstimate>(made.scene, 5).rms();
            EXPECT_GE(told, error) << dt << ' ' << substeps;
            EXPECT_LE(told, 10 * error) << dt << ' ' << substeps;
        }
}

// By an integrator of second order the error of a step goes with the cube of its length.
TEST(ErrorEstimate, OfASwingFallsWithTheStep)
{
    const auto told = [](double dt, int substeps) {
        SceneOf made;
        made.scene.settings.dt = dt;
        made.scene.settings.substeps = substeps;
        made.scene.gravity = Vec3::Zero();
        made.ball(0.1, Vec3(1.5, 0, 0)).mass = 1;
        Spring spring;
        spring.a = 0;
        spring.b = kNone;
        spring.stiffness = 100;
        spring.length = 1;
        made.scene.springs.push_back(spring);
        return watched<ErrorEstimate>(made.scene, static_cast<int>(1 / dt)).rms();
    };
    EXPECT_NEAR(told(1.0 / 120, 4) / told(1.0 / 240, 4), 8, 0.8);
    EXPECT_GT(told(1.0 / 120, 2), 3 * told(1.0 / 120, 4));
}

TEST(ErrorEstimate, NamesWhoIsStruck)
{
    SceneOf made;
    made.floor();
    for (int i = 0; i < 5; ++i) made.ball(0.5, Vec3(3.0 * i, 0, 0.5));
    made.scene.bodies[4].position.z() = 0.62;
    made.scene.bodies[4].velocity = Vec3(0, 0, -8);
    World world(made.scene);
    const ErrorEstimate estimate = watched<ErrorEstimate>(world, 2);
    EXPECT_EQ(estimate.worst().worst, world.bodies()[4]);
    EXPECT_GT(estimate.worst().greatest, 0.01);
    EXPECT_GE(estimate.worst().greatest, estimate.worst().rms);
}

TEST(ErrorEstimate, IsTheSameBitsOnAnyNumberOfThreads)
{
    const Scene scene = given::mixed_scene();
    World one(scene, 1), three(scene, 3);
    const ErrorEstimate a = watched<ErrorEstimate>(one, 30), b = watched<ErrorEstimate>(three, 30);
    EXPECT_GT(a.rms(), 0);
    EXPECT_EQ(a.rms(), b.rms());
    EXPECT_EQ(a.worst().greatest, b.worst().greatest);
    EXPECT_EQ(a.worst().worst, b.worst().worst);
}

TEST(ErrorEstimate, LeavesOutWhoComesAndGoes)
{
    SceneOf made;
    made.scene.gravity = Vec3::Zero();
    made.ball(0.5, Vec3::Zero());
    made.ball(0.5, Vec3(5, 0, 0));
    World world(made.scene);
    ErrorEstimate estimate;
    estimate.before_step(world);
    const BodyId gone = world.bodies()[0];
    world.remove(std::span(&gone, 1));
    SceneOf later;
    later.ball(0.5, Vec3(0, 0, 9)).velocity = Vec3(90, 0, 0);
    world.add(later.scene);
    world.step();
    estimate.after_step(world);
    EXPECT_EQ(estimate.last().greatest, 0);
}

}  // namespace
}  // namespace throng
