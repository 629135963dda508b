// Blocks: the same cut whatever the threads; loops within loops; threads that really run.
#include "kernels/parallel/blocks.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <set>
#include <thread>
#include <vector>

namespace throng {
namespace {

struct Cut {
    std::size_t begin = 0, end = 0;
    int times = 0;
    bool operator==(const Cut&) const = default;
};

std::vector<Cut> cuts_of(std::size_t count, std::size_t grain, int threads)
{
    ThreadPool pool(threads);
    std::vector<Cut> cuts(block_count(count, grain));
    pool.run([&](std::size_t, std::size_t, std::size_t) {
        for_each_block(count, grain, [&](std::size_t begin, std::size_t end, std::size_t block) {
            cuts[block] = {begin, end, cuts[block].times + 1};
        });
    });
    return cuts;
}

TEST(Blocks, AreCutTheSameWhateverTheThreads)
{
    for (const std::size_t count : {0u, 1u, 7u, 64u, 65u, 1000u})
        for (const std::size_t grain : {1u, 7u, 64u, 5000u}) {
            const std::vector<Cut> wanted = cuts_of(count, grain, 1);
            std::size_t next = 0;
            for (const Cut& cut : wanted) {
                EXPECT_EQ(cut.begin, next);
                EXPECT_GT(cut.end, cut.begin);
                EXPECT_LE(cut.end - cut.begin, grain);
                EXPECT_EQ(cut.times, 1);
                next = cut.end;
            }
            EXPECT_EQ(next, count);
            for (const int threads : {2, 3, 8}) EXPECT_EQ(cuts_of(count, grain, threads), wanted);
        }
}

TEST(Blocks, MayBeCutOutsideAnyPool)
{
    std::atomic<std::size_t> sum{0};
    for_each_block(1000, 10, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t i = begin; i < end; ++i) sum += i;
    });
    EXPECT_EQ(sum, 499500u);
}

TEST(Blocks, MayBeCutWithinBlocks)
{
    for (const int threads : {1, 2, 8}) {
        ThreadPool pool(threads);
        std::vector<std::atomic<int>> hits(40 * 50);
        pool.run([&](std::size_t, std::size_t, std::size_t) {
            for_each_block(40, 3, [&](std::size_t begin, std::size_t end, std::size_t) {
                for (std::size_t i = begin; i < end; ++i)
                    for_each_block(50, 7, [&](std::size_t first, std::size_t last, std::size_t) {
                        for (std::size_t k = first; k < last; ++k) ++hits[50 * i + k];
                    });
            });
        });
        for (const auto& hit : hits) ASSERT_EQ(hit, 1) << threads << " threads";
    }
}

TEST(ThreadPool, MeetsEveryThreadEvenWhereThereAreFewerCores)
{
    for (const int threads : {1, 2, 8}) {
        const ThreadPool pool(threads);
        EXPECT_EQ(pool.threads(), threads);
        EXPECT_EQ(pool.threads_met(), threads);
    }
}

TEST(ThreadPool, OfNoNumberTakesTheMachines)
{
    const ThreadPool pool(0);
    EXPECT_EQ(pool.threads(), std::max(1, static_cast<int>(std::thread::hardware_concurrency())));
}

TEST(ThreadPool, DoesNotHoldAnotherBack)
{
    // A world of one thread beside a world of four.
    const auto begin = std::chrono::steady_clock::now();
    const ThreadPool small(1), two(2), large(4);
    EXPECT_EQ(two.threads_met(), 2);
    EXPECT_EQ(large.threads_met(), 4);
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(2));
}

TEST(ThreadPool, RunsBlocksOnSeveralThreads)
{
    ThreadPool pool(4);
    std::atomic<int> inside{0}, most{0};
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(5);
    pool.run([&](std::size_t, std::size_t, std::size_t) {
        for_each_block(4, 1, [&](std::size_t, std::size_t, std::size_t) {
            const int now = ++inside;
            int seen = most;
            while (seen < now && !most.compare_exchange_weak(seen, now)) { }
            // Waits for company.
            while (most < 2 && std::chrono::steady_clock::now() < deadline)
                std::this_thread::yield();
            --inside;
        });
    });
    EXPECT_GE(most, 2);
}

TEST(ThreadPool, OfOneRunsOnTheCaller)
{
    ThreadPool pool(1);
    std::set<std::thread::id> who;
    pool.run([&](std::size_t, std::size_t, std::size_t) {
        for_each_block(100, 1, [&](std::size_t, std::size_t, std::size_t) {
            who.insert(std::this_thread::get_id());
        });
    });
    EXPECT_EQ(who, std::set<std::thread::id>{std::this_thread::get_id()});
}

TEST(ThreadPool, MayBeMadeAndLeftOften)
{
    for (int i = 0; i < 50; ++i) {
        ThreadPool pool(1 + i % 3);
        std::atomic<int> sum{0};
        pool.run([&](std::size_t, std::size_t, std::size_t) {
            for_each_block(64, 1, [&](std::size_t, std::size_t, std::size_t) { ++sum; });
        });
        ASSERT_EQ(sum, 64);
    }
}

}  // namespace
}  // namespace throng
