#include "kernels/parallel/disjoint_sets.hpp"

#include <atomic>
#include <numeric>
#include <utility>

namespace throng {

namespace {

constexpr auto kRelaxed = std::memory_order_relaxed;

std::atomic_ref<std::uint32_t> shared(std::uint32_t& number)
{
    return std::atomic_ref<std::uint32_t>(number);
}

}  // namespace

void DisjointSets::reset(std::size_t count)
{
    parent_.resize(count);
    std::iota(parent_.begin(), parent_.end(), 0u);
    added_.assign(count, 0);
}

void DisjointSets::reset(std::size_t count, std::span<const std::uint32_t> numbers)
{
    parent_.resize(count);
    added_.resize(count, 0);
    for (const std::uint32_t x : numbers) {
        parent_[x] = x;
        added_[x] = 0;
    }
}

void DisjointSets::add(std::uint32_t x)
{
    std::atomic_ref<std::uint8_t>(added_[x]).store(1, kRelaxed);
}

// A number's parent is never greater than it, so whoever shortens a path while others join sets
// along it can only write an ancestor.
std::uint32_t DisjointSets::find(std::uint32_t x)
{
    std::uint32_t up = shared(parent_[x]).load(kRelaxed);
    while (up != x) {
        const std::uint32_t above = shared(parent_[up]).load(kRelaxed);
        if (above != up) shared(parent_[x]).store(above, kRelaxed);  // halves the path
        x = up;
        up = above;
    }
    return x;
}

void DisjointSets::join(std::uint32_t a, std::uint32_t b)
{
    while (true) {
        a = find(a);
        b = find(b);
        if (a == b) return;
        if (a > b) std::swap(a, b);
        // Only a root may be hung below another, and by now it may have ceased to be one.
        std::uint32_t root = b;
        if (shared(parent_[b]).compare_exchange_strong(root, a, kRelaxed)) return;
    }
}

}  // namespace throng
