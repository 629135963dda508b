// Compact: block order, whoever came first.
#include "kernels/parallel/compact.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

// Joins the multiples of 3 that blocks of a loop found.
void join_multiples(BlockLists<int>& lists,
                    std::size_t count,
                    std::size_t grain,
                    std::vector<int>& all)
{
    lists.start(block_count(count, grain));
    for_each_block(count, grain, [&](std::size_t begin, std::size_t end, std::size_t block) {
        for (std::size_t i = begin; i < end; ++i)
            if (i % 3 == 0) lists[block].push_back(static_cast<int>(i));
    });
    lists.append_to(all);
}

TEST(BlockLists, JoinInBlockOrderOnAnyNumberOfThreads)
{
    for (const int threads : {1, 2, 4}) {
        ThreadPool pool(threads);
        const auto body = [](std::size_t, std::size_t, std::size_t) {
            BlockLists<int> lists;
            for (const std::size_t count : {0u, 1u, 100u, 300000u, 7u}) {
                std::vector<int> all = {-1};
                join_multiples(lists, count, 13, all);
                ASSERT_EQ(all.size(), 1 + (count + 2) / 3);
                ASSERT_EQ(all[0], -1);
                for (std::size_t i = 1; i < all.size(); ++i)
                    ASSERT_EQ(all[i], static_cast<int>(3 * (i - 1)));
            }
        };
        pool.run(body);
    }
}

}  // namespace
}  // namespace throng
