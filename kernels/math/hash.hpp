// Hash: a fingerprint of a state, so that two runs can be compared to the last bit.
#pragma once

#include "throng/math.hpp"

#include <bit>
#include <cstdint>
#include <string>

namespace throng {

/// Folds numbers into 64 bits, in order. Equal states give equal hashes; a change of any bit of any
/// number, or of their order, gives another with all but certainty.
///
/// Source: the finalizer of Steele, Lea and Flood, Fast Splittable Pseudorandom Number Generators
///         (2014), chained.
class Hash {
public:
    void add(std::uint64_t value) { state_ = mixed(state_ ^ mixed(value + 0x9e3779b97f4a7c15u)); }
    void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
    void add(float value) { add(std::uint64_t{std::bit_cast<std::uint32_t>(value)}); }

    std::uint64_t value() const { return state_; }
    /// As 16 hex digits.
    std::string text() const
    {
        std::string digits(16, '0');
        for (int i = 0; i < 16; ++i)
            digits[static_cast<std::size_t>(i)] = "0123456789abcdef"[state_ >> (60 - 4 * i) & 15];
        return digits;
    }

private:
    static std::uint64_t mixed(std::uint64_t z)
    {
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }
    std::uint64_t state_ = 0;
};

/// Somewhere in the cube from -1 to 1, each number at a spot of its own: what lies together is told
/// apart by it, the same way on every run.
inline Vec3 spot_of(std::uint64_t number)
{
    Hash hash;
    hash.add(number);
    const auto part = [&](int k) {
        return static_cast<double>(hash.value() >> 21 * k & 0x1fffff) / 0x100000 - 1;
    };
    return {part(0), part(1), part(2)};
}

}  // namespace throng
