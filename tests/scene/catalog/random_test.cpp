// Random: the very numbers of Python's generator.
#include "scene/catalog/random.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>

namespace throng {
namespace {

// Computed with Python's random module: for Random(seed), the first and the thousandth random();
// and, each from a fresh generator, randrange(10) eight times, getrandbits(32) twice after those,
// then uniform(-3, 5). A thousand draws renew the state three times.
struct Known {
    std::uint64_t seed;
    double first, thousandth;
    std::array<std::uint32_t, 8> digits;
    std::array<std::uint32_t, 2> words;
    double uniform;
};

// clang-format off
const Known kKnown[] = {
    {0x0,                0x1.b0580f98a7dbep-1, 0x1.ebf1437477ccep-2, {6, 6, 0, 4, 8, 7, 6, 4}, {4156669319, 2046968324}, -0x1.15b813553bce0p-3},
    {0x1,                0x1.132d8f91b7584p-3, 0x1.699b1d0fc4300p-1, {2, 9, 1, 4, 1, 7, 7, 7}, {2798570523, 1630434966}, 0x1.a7a7181adfcc8p+1},
    {0xffffffff,         0x1.454d9227a7013p-1, 0x1.492df3ceb45eep-2, {9, 3, 3, 9, 8, 4, 9, 5}, {4130059007, 1636881668}, 0x1.307e34582322ep+1},
    {0x100000000,        0x1.ced31cb3df170p-4, 0x1.5487e3d9d2810p-5, {1, 5, 6, 0, 0, 9, 5, 8}, {4272311653, 1940533316}, -0x1.71aa6d6e533d2p+1},
    {0xffffffffffffffff, 0x1.659799fd7f980p-6, 0x1.cd4f273d5bd94p-1, {0, 3, 5, 9, 3, 7, 9, 1}, {3949527284, 3868957638}, -0x1.033f076c9a800p-5},
};
// clang-format on

TEST(Random, GivesPythonsFractions)
{
    for (const Known& known : kKnown) {
        SCOPED_TRACE(known.seed);
        Random random(known.seed);
        EXPECT_EQ(random.unit(), known.first);
        for (int i = 0; i < 998; ++i) random.unit();
        EXPECT_EQ(random.unit(), known.thousandth);
    }
}

TEST(Random, GivesPythonsWholeNumbersBitsAndRanges)
{
    for (const Known& known : kKnown) {
        SCOPED_TRACE(known.seed);
        Random random(known.seed);
        for (const std::uint32_t digit : known.digits) EXPECT_EQ(random.below(10), digit);
        for (const std::uint32_t word : known.words) EXPECT_EQ(random.bits(32), word);
        EXPECT_EQ(random.uniform(-3, 5), known.uniform);
    }
}

TEST(Random, StaysInRange)
{
    Random random(7);
    std::array<int, 3> seen = {};
    for (int i = 0; i < 3000; ++i) {
        ++seen.at(random.below(3));
        const double x = random.uniform(-2, -1);
        EXPECT_TRUE(-2 <= x && x <= -1) << x;
        EXPECT_LT(random.bits(1), 2U);
        EXPECT_EQ(random.below(1), 0U);
    }
    for (const int count : seen) EXPECT_NEAR(count, 1000, 100);
}

}  // namespace
}  // namespace throng
