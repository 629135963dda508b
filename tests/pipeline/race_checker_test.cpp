// Race checker: it sees a race of stages, and only where none waits for the other.
#include "kernels/parallel/blocks.hpp"
#include "kernels/parallel/race_notes.hpp"
#include "pipeline/step_graph.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <thread>

namespace throng {
namespace {

std::atomic<int> begun{0};
int shared = 0;  // what no stage says that it changes

// Waits until another stage has begun, for a while; nothing is ordered by that.
void change_shared(bool wait)
{
    using Clock = std::chrono::steady_clock;
    const auto deadline = Clock::now() + std::chrono::seconds(10);
    begun.fetch_add(1, std::memory_order_relaxed);
    while (wait && begun.load(std::memory_order_relaxed) < 2 && Clock::now() < deadline)
        std::this_thread::yield();
    ++shared;
}

[[maybe_unused]] void change_pairs(Pairs&) { change_shared(true); }
[[maybe_unused]] void change_bounds(Bounds&) { change_shared(true); }
void change_poses(Poses&) { change_shared(false); }
void read_poses(const Poses&, Velocities&) { change_shared(false); }

void run_stages(std::vector<Stage<float>> stages)
{
    StepData<float> data;
    ThreadPool pool(2);
    pool.run([&](std::size_t, std::size_t, std::size_t) {
        StepGraph<float>(std::move(stages), data).run();
    });
}

TEST(RaceChecker, IsContentWithAStepGraphInWhichTheyWait)
{
    shared = 0;
    run_stages({stage<float, change_poses>("change_poses", {}),
                stage<float, read_poses>("read_poses", {})});
    EXPECT_EQ(shared, 2);
}

#if defined(__SANITIZE_THREAD__)

void race_of_stages()
{
    run_stages({stage<float, change_pairs>("change_pairs", {}),
                stage<float, change_bounds>("change_bounds", {})});
    std::exit(shared == 2 ? 0 : 1);
}

TEST(RaceChecker, SeesARaceInTheStepGraph)
{
    constexpr int kRaced = 66;  // what it ends a program with
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_EXIT(race_of_stages(), testing::ExitedWithCode(kRaced), "data race");
}

#endif

}  // namespace
}  // namespace throng
