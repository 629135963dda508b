// Dice: random numbers, places and turns for tests, the same on every machine.
#pragma once

#include "throng/math.hpp"

#include <random>
#include <utility>

namespace throng::test {

/// Without the library's distributions, which differ between libraries.
class Dice {
public:
    explicit Dice(std::uint64_t seed) : engine_(seed) { }
    double between(double low, double high)
    {
        return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
    }
    std::uint32_t below(std::uint32_t count)
    {
        return static_cast<std::uint32_t>(engine_() % count);
    }
    bool chance(double share) { return between(0, 1) < share; }
    /// In a cube of that half side.
    Vec3 point(double half)
    {
        const double x = between(-half, half), y = between(-half, half);
        return {x, y, between(-half, half)};
    }
    Vec3 direction() { return (point(1) + Vec3(1e-3, 0, 0)).normalized(); }
    Quat turn()
    {
        const Vec3 axis = point(1);
        return Quat(between(-1, 1), axis.x(), axis.y(), axis.z()).normalized();
    }
    template <class List>
    void shuffle(List& list)
    {
        for (std::size_t left = list.size(); left > 1; --left)
            std::swap(list[left - 1], list[below(static_cast<std::uint32_t>(left))]);
    }

private:
    std::mt19937_64 engine_;
};

}  // namespace throng::test
