// Bucket sort: items by small numbers, stable, on the threads of the pool.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace throng {

class BucketSort {
public:
    /// The bucket of an item that is left out.
    static constexpr std::uint32_t kNone = 0xffffffffu;

    /// Sorts the items, keeping their order within each bucket; the result does not depend on
    /// threads.
    ///
    ///   bucket  [items] below `buckets`, or kNone
    ///   items   what is sorted; empty for 0, 1, 2, ...
    ///   begin   [buckets + 1] gets where in `sorted` each bucket begins
    ///   sorted  gets the items that have a bucket; has room for all
    ///
    /// Returns how many that are.
    std::size_t sort(std::span<const std::uint32_t> bucket,
                     std::span<const std::uint32_t> items,
                     std::size_t buckets,
                     std::vector<std::uint32_t>& begin,
                     std::span<std::uint32_t> sorted);

private:
    std::vector<std::uint32_t> next_;  // [blocks * buckets] counts, then places
};

}  // namespace throng
