// Disjoint sets: numbers that were joined, by any threads in any order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace throng {

/// Sets of numbers below a count. The representative of a set is its smallest number, whatever the
/// order of joining. Threads may add, join and find at the same time.
///
/// Source: Anderson & Woll, Wait-free Parallel Algorithms for the Union-Find Problem (1991).
class DisjointSets {
public:
    /// Every number below `count` alone, and none of them added.
    void reset(std::size_t count);
    /// The same of these numbers below `count`; all others stay as they were, and who is new is not
    /// added.
    void reset(std::size_t count, std::span<const std::uint32_t> numbers);
    void add(std::uint32_t x);
    bool holds(std::uint32_t x) const { return added_[x] != 0; }
    void join(std::uint32_t a, std::uint32_t b);
    std::uint32_t find(std::uint32_t x);

private:
    std::vector<std::uint32_t> parent_;
    std::vector<std::uint8_t> added_;
};

}  // namespace throng
