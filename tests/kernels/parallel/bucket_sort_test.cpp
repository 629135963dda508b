// Bucket sort: the same as a stable sort, on any number of threads.
#include "kernels/parallel/bucket_sort.hpp"

#include "kernels/parallel/blocks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace throng {
namespace {

struct Sorted {
    std::vector<std::uint32_t> begin, items;
};

Sorted sorted_by_definition(const std::vector<std::uint32_t>& bucket,
                            const std::vector<std::uint32_t>& items,
                            std::size_t buckets)
{
    std::vector<std::uint32_t> order;
    for (std::uint32_t i = 0; i < bucket.size(); ++i)
        if (bucket[i] != BucketSort::kNone) order.push_back(i);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return bucket[a] < bucket[b]; });
    Sorted sorted;
    for (std::size_t b = 0; b <= buckets; ++b)
        sorted.begin.push_back(static_cast<std::uint32_t>(
            std::count_if(order.begin(), order.end(), [&](auto i) { return bucket[i] < b; })));
    for (const std::uint32_t i : order) sorted.items.push_back(items.empty() ? i : items[i]);
    return sorted;
}

TEST(BucketSort, IsAStableSort)
{
    ThreadPool pool(3);
    BucketSort sort;
    for (unsigned seed = 0; seed < 60; ++seed) {
        std::mt19937 random(seed);
        const std::size_t count = seed < 40 ? random() % 50 : random() % 20'000;
        const std::size_t buckets = 1 + random() % (seed % 2 == 0 ? 5 : 6000);
        std::vector<std::uint32_t> bucket(count), items(seed % 3 == 0 ? 0 : count);
        for (auto& at : bucket)
            at = random() % 10 == 0 ? BucketSort::kNone
                                    : static_cast<std::uint32_t>(random() % buckets);
        for (auto& item : items) item = static_cast<std::uint32_t>(random());
        Sorted got;
        got.items.resize(count);
        pool.run([&](std::size_t, std::size_t, std::size_t) {
            got.items.resize(sort.sort(bucket, items, buckets, got.begin, got.items));
        });
        const Sorted wanted = sorted_by_definition(bucket, items, buckets);
        ASSERT_EQ(got.begin, wanted.begin) << "seed " << seed;
        ASSERT_EQ(got.items, wanted.items) << "seed " << seed;
    }
}

}  // namespace
}  // namespace throng
