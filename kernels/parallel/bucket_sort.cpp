#include "kernels/parallel/bucket_sort.hpp"

#include "kernels/parallel/blocks.hpp"

#include <algorithm>

namespace throng {

std::size_t BucketSort::sort(std::span<const std::uint32_t> bucket,
                             std::span<const std::uint32_t> items,
                             std::size_t buckets,
                             std::vector<std::uint32_t>& begin,
                             std::span<std::uint32_t> sorted)
{
    // Counting many buckets block by block would cost more than looking at the items.
    const std::size_t grain = std::max<std::size_t>(4096, buckets);
    const std::size_t blocks = std::max<std::size_t>(1, block_count(bucket.size(), grain));
    next_.assign(blocks * buckets, 0);
    const auto places_of = [&](std::size_t block) { return next_.data() + block * buckets; };
    for_each_block(bucket.size(), grain, [&](std::size_t from, std::size_t end, std::size_t block) {
        std::uint32_t* const count = places_of(block);
        for (std::size_t i = from; i < end; ++i)
            if (bucket[i] != kNone) ++count[bucket[i]];
    });

    // Counts become places: by bucket first, by block within a bucket.
    begin.resize(buckets + 1);
    std::uint32_t place = 0;
    for (std::size_t b = 0; b < buckets; ++b) {
        begin[b] = place;
        for (std::size_t block = 0; block < blocks; ++block) {
            const std::uint32_t count = places_of(block)[b];
            places_of(block)[b] = place;
            place += count;
        }
    }
    begin[buckets] = place;

    for_each_block(bucket.size(), grain, [&](std::size_t from, std::size_t end, std::size_t block) {
        std::uint32_t* const next = places_of(block);
        for (std::size_t i = from; i < end; ++i)
            if (bucket[i] != kNone)
                sorted[next[bucket[i]]++] =
                    items.empty() ? static_cast<std::uint32_t>(i) : items[i];
    });
    return place;
}

}  // namespace throng
