// Block watch: who is watched, and that nobody else is.
#include "kernels/parallel/block_watch.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <vector>

namespace throng {
namespace {

constexpr std::size_t kCount = 1000, kGrain = 10, kBlocks = kCount / kGrain;

class Counter final : public BlockWatch {
public:
    void run_block(const BlockBody& block,
                   std::size_t begin,
                   std::size_t end,
                   std::size_t number) override
    {
        ++seen[number];
        block(begin, end, number);
    }
    std::vector<std::atomic<int>> seen = std::vector<std::atomic<int>>(kBlocks);
};

TEST(BlockWatch, SeesEveryBlockOnceOnAnyNumberOfThreads)
{
    for (const int threads : {1, 3}) {
        ThreadPool pool(threads);
        Counter counter;
        std::vector<std::atomic<int>> ran(kCount);
        pool.run([&](std::size_t, std::size_t, std::size_t) {
            const BlockWatchScope watched(&counter);
            for_each_block(kCount, kGrain, [&](std::size_t begin, std::size_t end, std::size_t) {
                for (std::size_t i = begin; i < end; ++i) ++ran[i];
            });
        });
        for (const auto& times : counter.seen) EXPECT_EQ(times, 1);
        for (const auto& times : ran) EXPECT_EQ(times, 1);
    }
}

TEST(BlockWatch, SeesLoopsWithinLoops)
{
    ThreadPool pool(2);
    Counter counter;
    pool.run([&](std::size_t, std::size_t, std::size_t) {
        const BlockWatchScope watched(&counter);
        for_each_block(4, 1, [&](std::size_t, std::size_t, std::size_t) {
            for_each_block(kCount, kGrain, [](std::size_t, std::size_t, std::size_t) {});
        });
    });
    // The first four numbers are those of the outer loop's blocks, too.
    for (std::size_t i = 0; i < kBlocks; ++i) EXPECT_EQ(counter.seen[i], i < 4 ? 5 : 4) << i;
}

TEST(BlockWatch, SeesNothingOnceItsScopeHasEnded)
{
    ThreadPool pool(2);
    Counter counter;
    pool.run([&](std::size_t, std::size_t, std::size_t) {
        {
            const BlockWatchScope watched(&counter);
        }
        EXPECT_EQ(block_watch(), nullptr);
        for_each_block(kCount, kGrain, [](std::size_t, std::size_t, std::size_t) {
            EXPECT_EQ(block_watch(), nullptr);
        });
    });
    for (const auto& times : counter.seen) EXPECT_EQ(times, 0);
}

}  // namespace
}  // namespace throng
