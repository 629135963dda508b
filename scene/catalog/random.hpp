// Random: the numbers that scenes are made from, the same on every machine.
//
// The Mersenne Twister with the seeding and the conversions of Python's `random` module, so that a
// scene made here and one made by a Python script from the same seed are the same scene, number by
// number. The standard library's engine would do for the bits, but its distributions differ from
// vendor to vendor.
//
// Source: Matsumoto and Nishimura, Mersenne Twister: A 623-Dimensionally Equidistributed Uniform
//         Pseudorandom Number Generator (1998); seeding by a key, their revision of 2002.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace throng {

class Random {
public:
    explicit Random(std::uint64_t seed);

    /// The next `count` random bits, 1 to 32, as a number.
    std::uint32_t bits(int count);

    /// In [0, 1), a multiple of 2^-53.
    double unit();

    /// Between low and high.
    double uniform(double low, double high);

    /// One of 0, 1, ..., count - 1, each as likely as the others. count must be at least 1.
    std::uint32_t below(std::uint32_t count);

private:
    static constexpr std::size_t kWords = 624;

    void spread_key(std::span<const std::uint32_t> key);
    void renew();

    std::array<std::uint32_t, kWords> words_;
    std::size_t next_ = kWords;  // words before this one have been handed out
};

}  // namespace throng
