// Planted races: what the race checker has to see.
#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

namespace throng::given {

/// Returns once two have come, or after ten seconds. Nothing that they do is ordered by that.
inline void meet_another(std::atomic<int>& come)
{
    using Clock = std::chrono::steady_clock;
    const auto deadline = Clock::now() + std::chrono::seconds(10);
    come.fetch_add(1, std::memory_order_relaxed);
    while (come.load(std::memory_order_relaxed) < 2 && Clock::now() < deadline)
        std::this_thread::yield();
}

/// Changes a number often: two changes at the very same time may both go unseen.
inline void change_often(int& number)
{
    for (int i = 0; i < 1000; ++i) {
        ++number;
        std::this_thread::yield();
    }
}

/// That a function which ends the program has raced by then.
inline void expect_race(void (*races)())
{
    constexpr int kRaced = 66;  // what the checker ends a program with
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_EXIT(races(), testing::ExitedWithCode(kRaced), "data race");
}

}  // namespace throng::given
