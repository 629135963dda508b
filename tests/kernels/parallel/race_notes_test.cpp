// Race notes: the race checker still sees a race of blocks.
#include "kernels/parallel/race_notes.hpp"

#include "kernels/parallel/blocks.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <thread>

namespace throng {
namespace {

#if defined(__SANITIZE_THREAD__)

// Blocks of two threads at least, each of which changes the same number; nothing orders them.
void race_of_blocks()
{
    using Clock = std::chrono::steady_clock;
    const auto deadline = Clock::now() + std::chrono::seconds(10);
    std::atomic<int> arrived{0};
    int shared = 0;
    ThreadPool pool(2);
    pool.run([&](std::size_t, std::size_t, std::size_t) {
        for_each_block(2, 1, [&](std::size_t, std::size_t, std::size_t) {
            arrived.fetch_add(1, std::memory_order_relaxed);
            while (arrived.load(std::memory_order_relaxed) < 2 && Clock::now() < deadline)
                std::this_thread::yield();
            ++shared;
        });
    });
    std::exit(shared == 2 ? 0 : 1);
}

TEST(RaceChecker, SeesARaceOfBlocks)
{
    constexpr int kRaced = 66;  // what it ends a program with
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_EXIT(race_of_blocks(), testing::ExitedWithCode(kRaced), "data race");
}

#else

TEST(RaceNotes, AreNothingInOtherBuildsOfBlocks)
{
    EXPECT_FALSE(kChecksRaces);
    EXPECT_LE(sizeof(TaskNotes), 2u);
}

#endif

}  // namespace
}  // namespace throng
