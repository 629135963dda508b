// Work count: threads that had a share, and no others.
#include "kernels/parallel/work_count.hpp"

#include "kernels/parallel/blocks.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>

namespace throng {
namespace {

TEST(WorkCount, ThreadsThatHadNothingToDoAreNotCounted)
{
    ThreadPool pool(4);
    WorkCount one, all, none;
    EXPECT_EQ(one.threads(), 0);
    pool.run([&](std::size_t, std::size_t, std::size_t) {
        const WorkCountScope counted(&one);
        for_each_block(10, 100, [](std::size_t, std::size_t, std::size_t) {});
        for_each_block(100, 100, [](std::size_t, std::size_t, std::size_t) {});
    });
    EXPECT_EQ(one.threads(), 1);
    // Nobody goes on before all have come.
    pool.run([&](std::size_t, std::size_t, std::size_t) {
        const WorkCountScope counted(&all);
        std::atomic<int> arrived{0};
        for_each_block(4, 1, [&](std::size_t, std::size_t, std::size_t) {
            ++arrived;
            const auto late = std::chrono::steady_clock::now() + std::chrono::seconds(5);
            while (arrived < 4 && std::chrono::steady_clock::now() < late)
                std::this_thread::yield();
        });
        EXPECT_EQ(arrived, 4);
    });
    EXPECT_EQ(all.threads(), 4);
    pool.run([&](std::size_t, std::size_t, std::size_t) {
        const WorkCountScope counted(&none);
        const WorkCountScope nobody(nullptr);
        for_each_block(4, 1, [](std::size_t, std::size_t, std::size_t) {});
    });
    EXPECT_EQ(none.threads(), 1);
    EXPECT_EQ(work_count(), nullptr);
}

}  // namespace
}  // namespace throng
