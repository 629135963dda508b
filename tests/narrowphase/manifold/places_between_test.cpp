// Places between: what is taken covers what is not, stands apart, and is not shallow.
#include "narrowphase/manifold/places_between.hpp"

#include "tests/support/dice.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <span>

namespace throng::test {
namespace {

using Points = std::vector<LocalManifold<double>::Point>;

Points scattered(Dice& dice, std::uint32_t count, double depth)
{
    Points points;
    for (std::uint32_t i = 0; i < count; ++i)
        points.push_back({dice.point(1), dice.between(-depth, 0), i});
    return points;
}

double nearest(const Points& points, std::span<const std::size_t> taken, std::size_t to)
{
    double least = std::numeric_limits<double>::infinity();
    for (const std::size_t i : taken)
        least = std::min(least, (points[i].position - points[to].position).norm());
    return least;
}

TEST(PlacesBetween, NothingIsFurtherThanTheSpacingAndWhatIsTakenStandsThatFarApart)
{
    Dice dice(71);
    for (const double spacing : {0.2, 0.5, 1.0}) {
        const Points points = scattered(dice, 300, 0);
        std::vector<std::size_t> taken{7, 3};
        take_between(points, spacing, 0, points.size(), taken);
        ASSERT_EQ(taken[0], 7U);
        ASSERT_EQ(taken[1], 3U);
        for (std::size_t i = 0; i < points.size(); ++i)
            ASSERT_LE(nearest(points, taken, i), spacing) << "seed 71, point " << i;
        for (std::size_t k = 2; k < taken.size(); ++k)
            ASSERT_GT(nearest(points, std::span(taken).first(k), taken[k]), spacing);
    }
}

TEST(PlacesBetween, WhatLacksDepthCountsAsNearer)
{
    Dice dice(72);
    const Points points = scattered(dice, 300, 0.1);
    const double spacing = 0.3, shallow = 10;
    std::vector<std::size_t> taken;
    take_between(points, spacing, shallow, points.size(), taken);
    double deepest = 0;
    for (const auto& point : points) deepest = std::min(deepest, point.separation);
    EXPECT_EQ(points[taken.front()].separation, deepest);
    for (std::size_t i = 0; i < points.size(); ++i)
        ASSERT_LE(nearest(points, taken, i) - shallow * (points[i].separation - deepest), spacing);
    // A cube of side 2 reaches 3.5 across: what lacks more is never taken.
    for (const std::size_t i : taken)
        EXPECT_LE(shallow * (points[i].separation - deepest), 3.5 - spacing);
    EXPECT_LT(taken.size(), points.size());
}

TEST(PlacesBetween, NoMoreAreTakenThanAskedForAndNoneOfNothing)
{
    Dice dice(73);
    const Points points = scattered(dice, 50, 0);
    for (const std::size_t most : {0U, 1U, 5U}) {
        std::vector<std::size_t> taken;
        take_between(points, 0, 0, most, taken);
        EXPECT_EQ(taken.size(), most);
    }
    // Points on one place are all near once one of them is taken.
    const Points equal(20, points[0]);
    std::vector<std::size_t> taken;
    take_between(equal, 0, 0, 20, taken);
    EXPECT_EQ(taken.size(), 1U);
    taken.clear();
    take_between({}, 0, 0, 20, taken);
    EXPECT_TRUE(taken.empty());
}

}  // namespace
}  // namespace throng::test
