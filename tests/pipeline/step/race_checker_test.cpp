// Race checker: it sees a race of stages, and only where none waits for the other.
#include "kernels/parallel/blocks.hpp"
#include "kernels/parallel/race_notes.hpp"
#include "pipeline/step/step_graph.hpp"
#include "tests/support/planted_races.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>

namespace throng {
namespace {

int shared = 0;  // NOLINT: what no stage says that it changes

void change_poses(Poses&) { ++shared; }
void read_poses(const Poses&, Velocities&) { ++shared; }

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
    run_stages({stage<float, change_poses>({}), stage<float, read_poses>({})});
    EXPECT_EQ(shared, 2);
}

#if defined(__SANITIZE_THREAD__)

std::atomic<int> begun{0};

void change_pairs(Pairs&)
{
    given::meet_another(begun);
    given::change_often(shared);
}

void change_bounds(Bounds&)
{
    given::meet_another(begun);
    given::change_often(shared);
}

void race_of_stages()
{
    run_stages({stage<float, change_pairs>({}), stage<float, change_bounds>({})});
    std::exit(0);
}

TEST(RaceChecker, SeesARaceInTheStepGraph) { given::expect_race(race_of_stages); }

#endif

}  // namespace
}  // namespace throng
