#include "kernels/parallel/sort_keys.hpp"

#include "kernels/parallel/blocks.hpp"

#include <algorithm>
#include <array>
#include <bit>

namespace throng {
namespace {

constexpr int kDigitBits = 8;
constexpr std::size_t kDigits = std::size_t{1} << kDigitBits;
constexpr std::size_t kGrain = 1 << 15;
// Below this a comparison sort needs no second array and loses little.
constexpr std::size_t kFewKeys = 512;

using Counts = std::array<std::uint32_t, kDigits>;

// Bits in which some two keys differ.
std::uint64_t varying_bits(const std::vector<std::uint64_t>& keys)
{
    std::uint64_t ones = 0, zeros = 0;
    for (const std::uint64_t key : keys) {
        ones |= key;
        zeros |= ~key;
    }
    return ones & zeros;
}

// One stable pass: keys in the order of the digit at `shift`.
void spread(const std::vector<std::uint64_t>& from,
            std::vector<std::uint64_t>& to,
            int shift,
            std::vector<Counts>& counts)
{
    const auto digit = [&](std::uint64_t key) { return (key >> shift) & (kDigits - 1); };
    for_each_block(from.size(), kGrain, [&](std::size_t begin, std::size_t end, std::size_t block) {
        counts[block].fill(0);
        for (std::size_t i = begin; i < end; ++i) ++counts[block][digit(from[i])];
    });

    // Counts become starts: by digit first, by block within a digit.
    std::uint32_t start = 0;
    for (std::size_t d = 0; d < kDigits; ++d)
        for (Counts& of_block : counts) {
            const std::uint32_t count = of_block[d];
            of_block[d] = start;
            start += count;
        }

    for_each_block(from.size(), kGrain, [&](std::size_t begin, std::size_t end, std::size_t block) {
        for (std::size_t i = begin; i < end; ++i) to[counts[block][digit(from[i])]++] = from[i];
    });
}

}  // namespace

void sort_keys(std::vector<std::uint64_t>& keys, std::vector<std::uint64_t>& scratch)
{
    if (keys.size() < kFewKeys || keys.size() > 0xffffffffu) {
        std::sort(keys.begin(), keys.end());
        return;
    }
    scratch.resize(keys.size());
    std::vector<Counts> counts(block_count(keys.size(), kGrain));
    // Lowest digits first; each pass starts at the lowest varying bit that is left.
    std::uint64_t left = varying_bits(keys);
    while (left != 0) {
        const int shift = std::countr_zero(left);
        spread(keys, scratch, shift, counts);
        keys.swap(scratch);
        left &= shift + kDigitBits >= 64 ? 0 : ~std::uint64_t{0} << (shift + kDigitBits);
    }
}

}  // namespace throng
