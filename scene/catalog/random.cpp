#include "scene/catalog/random.hpp"

#include "kernels/check.hpp"

#include <algorithm>
#include <bit>

namespace throng {

namespace {

// The linear congruence that fills the state before the key is stirred in.
constexpr std::uint32_t kFirstWord = 19650218u;
constexpr std::uint32_t kFill = 1812433253u;

// How far ahead the recurrence looks, and the last row of its matrix.
constexpr std::size_t kAhead = 397;
constexpr std::uint32_t kMatrix = 0x9908b0dfu;

std::uint32_t folded(std::uint32_t word) { return word ^ (word >> 30); }

// Evens out the bits of a word of state on its way out.
std::uint32_t tempered(std::uint32_t word)
{
    word ^= word >> 11;
    word ^= (word << 7) & 0x9d2c5680u;
    word ^= (word << 15) & 0xefc60000u;
    return word ^ (word >> 18);
}

}  // namespace

Random::Random(std::uint64_t seed)
{
    // Python's key is the seed in words of 32 bits, the low one first, without leading zeros.
    const std::array<std::uint32_t, 2> key = {static_cast<std::uint32_t>(seed),
                                              static_cast<std::uint32_t>(seed >> 32)};
    spread_key(std::span(key).first(key[1] != 0 ? 2 : 1));
}

void Random::spread_key(std::span<const std::uint32_t> key)
{
    words_[0] = kFirstWord;
    for (std::size_t i = 1; i < kWords; ++i)
        words_[i] = kFill * folded(words_[i - 1]) + static_cast<std::uint32_t>(i);

    // Word 0 is left out of the rounds and only mirrors the last one.
    std::size_t at = 1;
    const auto advance = [&] {
        if (++at < kWords) return;
        words_[0] = words_[kWords - 1];
        at = 1;
    };
    for (std::size_t round = 0; round < kWords; ++round) {
        const std::size_t k = round % key.size();
        words_[at] = (words_[at] ^ (folded(words_[at - 1]) * 1664525u)) + key[k]
            + static_cast<std::uint32_t>(k);
        advance();
    }
    for (std::size_t round = 1; round < kWords; ++round) {
        words_[at] =
            (words_[at] ^ (folded(words_[at - 1]) * 1566083941u)) - static_cast<std::uint32_t>(at);
        advance();
    }
    words_[0] = 0x80000000u;  // never all zero
    next_ = kWords;
}

void Random::renew()
{
    for (std::size_t i = 0; i < kWords; ++i) {
        const std::uint32_t joined =
            (words_[i] & 0x80000000u) | (words_[(i + 1) % kWords] & 0x7fffffffu);
        words_[i] = words_[(i + kAhead) % kWords] ^ (joined >> 1) ^ (joined & 1 ? kMatrix : 0);
    }
    next_ = 0;
}

std::uint32_t Random::bits(int count)
{
    THRONG_CHECK(count >= 1 && count <= 32, "a word has 1 to 32 bits to give");
    if (next_ == kWords) renew();
    return tempered(words_[next_++]) >> (32 - count);
}

double Random::unit()
{
    const double high = bits(27);
    const double low = bits(26);
    return (high * 0x1p26 + low) * 0x1p-53;
}

double Random::uniform(double low, double high) { return low + (high - low) * unit(); }

std::uint32_t Random::below(std::uint32_t count)
{
    THRONG_CHECK(count >= 1, "nothing to choose from");
    // Refuse what lies beyond, so that no number is favored; fewer than two tries on average.
    const int width = static_cast<int>(std::bit_width(count));
    std::uint32_t drawn = bits(width);
    while (drawn >= count) drawn = bits(width);
    return drawn;
}

}  // namespace throng
