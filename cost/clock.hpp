// Clock: what patience and times are taken by.
#pragma once

#include <chrono>

namespace throng {

using WallClock = std::chrono::steady_clock;

/// s
inline double seconds_since(WallClock::time_point begin)
{
    return std::chrono::duration<double>(WallClock::now() - begin).count();
}

/// s of simulated time, for which times are told.
inline constexpr double kFrame = 1.0 / 60;

}  // namespace throng
