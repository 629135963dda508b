// Follow: items at their new places, as a second list would have it.
#include "kernels/parallel/follow.hpp"

#include <gtest/gtest.h>

#include <random>

namespace throng {
namespace {

// Places of a list of which each item stays with one chance and each gap takes new ones with
// another.
std::vector<std::uint32_t> places(std::size_t count, double stays, double comes, std::uint64_t seed)
{
    std::mt19937_64 dice(seed);
    const auto chance = [&](double of) { return static_cast<double>(dice() >> 11) < of * 0x1p53; };
    std::vector<std::uint32_t> from;
    for (std::uint32_t i = 0; i < count; ++i) {
        while (chance(comes)) from.push_back(kNewItem);
        if (chance(stays)) from.push_back(i);
    }
    while (chance(comes)) from.push_back(kNewItem);
    return from;
}

void check(const std::vector<std::uint32_t>& from, std::size_t before)
{
    std::vector<std::size_t> items(before), wanted, wanted_lost;
    for (std::size_t i = 0; i < before; ++i) items[i] = 3 * i;
    std::size_t fresh = 0, next = 0;
    for (const std::uint32_t place : from) {
        wanted.push_back(place == kNewItem ? 3 * fresh++ + 1 : 3 * std::size_t{place});
        if (place == kNewItem) continue;
        for (; next < place; ++next) wanted_lost.push_back(3 * next);
        next = place + std::size_t{1};
    }
    for (; next < before; ++next) wanted_lost.push_back(3 * next);

    std::vector<std::size_t> lost;
    follow(
        from, items, [](std::size_t n) { return 3 * n + 1; },
        [&](std::size_t item) { lost.push_back(item); });
    EXPECT_EQ(items, wanted);
    EXPECT_EQ(lost, wanted_lost);
}

TEST(Follow, AgreesWithASecondList)
{
    std::uint64_t seed = 0;
    for (const std::size_t count : {0u, 1u, 5u, 300u, 30000u})
        for (const double stays : {0.0, 0.5, 0.99, 1.0})
            for (const double comes : {0.0, 0.01, 0.3, 0.6}) {
                SCOPED_TRACE(testing::Message() << count << ", seed " << seed);
                check(places(count, stays, comes, seed++), count);
            }
}

TEST(Follow, RunsThatGoBothWaysDoNotLandOnOneAnother)
{
    // Many come where the list begins and many go in its middle; and the other way round.
    constexpr std::uint32_t kCount = 600;
    std::vector<std::uint32_t> up, down;
    for (std::uint32_t i = 0; i < 200; ++i) up.push_back(kNewItem);
    for (std::uint32_t i = 0; i < kCount; ++i) {
        if (i < 200 || i >= 450) up.push_back(i);
        if (i >= 150) down.push_back(i);
        if (i >= 500) down.push_back(kNewItem), down.push_back(kNewItem);
    }
    check(up, kCount);
    check(down, kCount);
}

}  // namespace
}  // namespace throng
