// Disjoint sets: named by their smallest member, whoever joins and when.
#include "kernels/parallel/disjoint_sets.hpp"

#include "kernels/parallel/blocks.hpp"

#include <gtest/gtest.h>

#include <random>

namespace throng {
namespace {

TEST(DisjointSets, AreNamedByTheirSmallestMember)
{
    DisjointSets sets;
    sets.reset(6);
    sets.join(5, 3);
    sets.join(4, 5);
    EXPECT_EQ(sets.find(5), 3u);
    sets.join(1, 4);
    EXPECT_EQ(sets.find(3), 1u);
    EXPECT_EQ(sets.find(0), 0u);
    sets.reset(6);
    EXPECT_EQ(sets.find(5), 5u);
}

TEST(DisjointSets, HoldWhatWasAdded)
{
    DisjointSets sets;
    sets.reset(3);
    sets.add(1);
    EXPECT_TRUE(sets.holds(1));
    EXPECT_FALSE(sets.holds(2));
    sets.reset(3);
    EXPECT_FALSE(sets.holds(1));
}

// All threads hang long chains below one another at once.
TEST(DisjointSets, MayBeJoinedByAllThreadsAtOnce)
{
    constexpr std::size_t kCount = 20'000;
    ThreadPool pool(4);
    for (unsigned seed = 0; seed < 20; ++seed) {
        std::mt19937 random(seed);
        std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs(kCount);
        for (auto& [a, b] : pairs) {
            a = static_cast<std::uint32_t>(random() % kCount);
            b = seed % 2 == 0 ? static_cast<std::uint32_t>((a + 1) % kCount)
                              : static_cast<std::uint32_t>(random() % kCount);
        }
        DisjointSets wanted, got;
        wanted.reset(kCount);
        for (const auto& [a, b] : pairs) wanted.join(a, b);
        got.reset(kCount);
        pool.run([&](std::size_t, std::size_t, std::size_t) {
            for_each_block(kCount, 100, [&](std::size_t begin, std::size_t end, std::size_t) {
                for (std::size_t i = begin; i < end; ++i) got.join(pairs[i].first, pairs[i].second);
            });
        });
        for (std::uint32_t x = 0; x < kCount; ++x)
            ASSERT_EQ(got.find(x), wanted.find(x)) << "seed " << seed;
    }
}

}  // namespace
}  // namespace throng
