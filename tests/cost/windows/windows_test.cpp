// Windows: cut from scenes whose answers are known.
#include "cost/windows/windows.hpp"

#include "cost/clock.hpp"
#include "throng/catalog.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

namespace throng {
namespace {

Scene scene_of(std::string_view word)
{
    const ParsedScene parsed = parse_scene(word);
    return parsed.entry->make(parsed.size, 1);
}

Scene falling_ball()
{
    Scene scene;
    scene.shapes.push_back({"ball", SphereShape{0.5}});
    BodyDescription body;
    body.shape = 0;
    scene.bodies.push_back(body);
    scene.gravity = Vec3(0, 0, -9.81);
    return scene;
}

// Where nothing touches, a window ends where the parabola does; semi-implicit steps are off by
// g h t / 2, and by twice that with twice the step.
TEST(Windows, OfAFallTellTheErrorOfTheRule)
{
    const Scene scene = falling_ball();
    const Windows windows(scene, {1, 0.1, 3, 1}, 0, 5, {});
    EXPECT_TRUE(windows.reference().settles);
    for (std::size_t k = 0; k < windows.size(); ++k) {
        const Window& window = windows[k];
        const double t = windows.length();
        const Vec3 end =
            window.start[0].center + window.start[0].velocity * t + 0.5 * t * t * scene.gravity;
        EXPECT_LT((window.reference[0].center - end).norm(), 1e-9);
    }
    for (const double dt : {1.0 / 60, 1.0 / 30}) {
        Scene by = scene;
        by.settings.dt = dt;
        by.settings.substeps = 1;
        by.settings.integrator = Integrator::semi_implicit;
        const double drift = std::sqrt(of(windows.run(by, 1).errors, Measure::drift));
        EXPECT_NEAR(drift, 9.81 * dt * windows.length() / 2, 1e-3 * drift);
    }
}

TEST(Windows, OfAStackAtRestAreSolvedExactly)
{
    const Windows windows(scene_of("stacks:10"), {1, 0.1, 2, 1}, 0, 20, {});
    EXPECT_TRUE(windows.reference().settles);
    EXPECT_LT(std::sqrt(of(windows.reference().remaining, Measure::drift)), 1e-6);
    EXPECT_NE(windows.reference().settings.find("solver=direct"), std::string::npos);
}

TEST(Windows, ErrorsAreTheSameBitsOnAnyNumberOfThreads)
{
    const Scene scene = scene_of("pile:10");
    const Windows one(scene, {2, 0.1, 2, 1}, 1, 1000, {}),
        three(scene, {2, 0.1, 2, 3}, 1, 1000, {});
    for (std::size_t k = 0; k < one.size(); ++k) {
        EXPECT_EQ(one.run(scene, k).errors, three.run(scene, k).errors) << k;
    }
}

TEST(Windows, LieWithinTheSecondsAndHoldWholeSteps)
{
    Scene scene = falling_ball();
    scene.settings.dt = 1.0 / 50;
    const Windows windows(scene, {1, 0.1, 8, 1}, 1, 1, {});
    EXPECT_NEAR(windows.length(), 0.1, 1e-12);
    EXPECT_TRUE(windows.holds_whole_steps(1.0 / 100));
    EXPECT_FALSE(windows.holds_whole_steps(1.0 / 25)) << "two and a half of them";
    for (std::size_t k = 0; k < windows.size(); ++k) {
        EXPECT_LE(windows[k].begin, 1);
        if (k > 0) {
            EXPECT_GT(windows[k].begin, windows[k - 1].begin);
        }
    }
}

TEST(Windows, EndWhereSomebodyWantsThemTo)
{
    const Watch watch{{}, [] { return true; }};
    EXPECT_THROW(Windows(falling_ball(), {1, 0.1, 2, 1}, 0, 1, watch), Interrupted);
}

TEST(Windows, TimeEachStageOfTheStep)
{
    const Scene scene = scene_of("pile:10");
    const Windows windows(scene, {2, 0.1, 2, 1}, 1, 1000, {});
    const std::vector<StageTime> stages = windows.stage_times(scene);
    for (const char* name : {"find_pairs", "collide_convex", "solve_soft_step"}) {
        const auto found = std::find_if(stages.begin(), stages.end(),
                                        [&](const StageTime& each) { return each.name == name; });
        ASSERT_NE(found, stages.end()) << name;
        EXPECT_GT(found->time_ms, 0) << name;
    }
}

// A thread that waits does no work; who waits for others does not know whether they do.
TEST(WorkClock, OfOneThreadStandsStillWhileItWaits)
{
    const WorkClock one(1), two(2);
    const double begin_one = one.now(), begin_two = two.now();
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    EXPECT_LT(one.since(begin_one), 0.1);
    EXPECT_GE(two.since(begin_two), 0.2);
}

}  // namespace
}  // namespace throng
