// Pair filter: who may touch whom.
#include "broadphase/pair_filter.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

TEST(PairFilter, BothMustWantTheOther)
{
    PairFilter filter;
    filter.add(0, 0b01, 0b10);
    filter.add(1, 0b10, 0b01);
    filter.add(2, 0b10, 0b10);
    EXPECT_TRUE(filter.allows(0, 1));
    EXPECT_FALSE(filter.allows(0, 2));  // 0 wants 2, 2 does not want 0
    EXPECT_FALSE(filter.allows(1, 2));  // 2 wants 1, 1 does not want 2
    for (std::uint32_t a = 0; a < 3; ++a)
        for (std::uint32_t b = 0; b < 3; ++b) EXPECT_EQ(filter.allows(a, b), filter.allows(b, a));
}

TEST(PairFilter, AllTouchAllByDefault)
{
    PairFilter filter;
    filter.add(0);
    filter.add(1);
    EXPECT_TRUE(filter.allows(0, 1));
}

TEST(PairFilter, PartsOfOneBodyNeverTouch)
{
    PairFilter filter;
    filter.add(7);
    filter.add(7);
    EXPECT_FALSE(filter.allows(0, 1));
    EXPECT_FALSE(filter.allows(0, 0));
}

TEST(PairFilter, PlacesNobodyFilledInTouchNothing)
{
    PairFilter filter;
    filter.add(0);
    filter.resize(3);
    EXPECT_EQ(filter.size(), 3u);
    EXPECT_FALSE(filter.allows(0, 1));
    EXPECT_FALSE(filter.allows(1, 2));
}

}  // namespace
}  // namespace throng
