#include "cooking/hulls/hull_guide.hpp"

#include "cooking/hulls/hull.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace throng {
namespace {

Hull drum(int corners)
{
    std::vector<Vec3> points;
    for (int i = 0; i < corners; ++i) {
        const double angle = 2 * std::numbers::pi * i / corners;
        for (const double height : {-0.5, 0.5})
            points.emplace_back(std::cos(angle), std::sin(angle), height);
    }
    return build_hull(points).hull;
}

bool links(const HullGuide& guide, std::size_t from, std::size_t to)
{
    return std::any_of(guide.links.begin() + guide.begin[from],
                       guide.links.begin() + guide.begin[from + 1],
                       [&](std::uint16_t link) { return link == to; });
}

TEST(HullGuide, EveryCellNamesAVertexThatIsNearlyFurthest)
{
    const Hull hull = drum(60);
    ASSERT_EQ(hull.guide.toward.size(), 6u * hull.guide.side * hull.guide.side);
    for (int i = 0; i < 2000; ++i) {
        const double turn = 2.39996 * i, height = (i + 0.5) / 1000 - 1;  // a spiral over the sphere
        const double across = std::sqrt(1 - height * height);
        const Vec3 direction(across * std::cos(turn), across * std::sin(turn), height);
        const std::size_t cell = hull.guide.cell(direction);
        ASSERT_LT(cell, hull.guide.toward.size());
        double most = -10;
        for (const Vec3& vertex : hull.vertices) most = std::max(most, direction.dot(vertex));
        // No cell is wider than 0.6 radian.
        ASSERT_GT(direction.dot(hull.vertices[hull.guide.toward[cell]]), most - 0.7);
        ASSERT_EQ(hull.guide.cell(1e-3 * direction), cell);
    }
}

TEST(HullGuide, FacesOfManyCornersAreLinkedBothWays)
{
    const Hull hull = drum(200);
    const HullGuide& guide = hull.guide;
    ASSERT_EQ(guide.begin.size(), hull.vertices.size() + 1);
    EXPECT_GT(guide.links.size(), hull.neighbors.size());
    EXPECT_LT(guide.links.size(), 5 * hull.neighbors.size());
    for (std::size_t from = 0; from < hull.vertices.size(); ++from) {
        for (std::size_t i = hull.neighbor_begin[from]; i < hull.neighbor_begin[from + 1]; ++i)
            ASSERT_TRUE(links(guide, from, hull.neighbors[i]));
        for (std::size_t i = guide.begin[from]; i < guide.begin[from + 1]; ++i)
            ASSERT_TRUE(links(guide, guide.links[i], from));
    }
    EXPECT_TRUE(drum(6).guide.links.empty());
}

TEST(HullGuide, SlackCoversCornersOffTheirPlane)
{
    std::vector<Vec3> points;
    for (int i = 0; i < 8; ++i) points.emplace_back(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    EXPECT_LT(build_hull(points).hull.guide.slack, 1e-10);
    points[7].z() -= 1e-5;
    const Hull uneven = build_hull(points).hull;
    ASSERT_EQ(uneven.normals.size(), 6u);
    EXPECT_GT(uneven.guide.slack, 1e-5);
    EXPECT_LT(uneven.guide.slack, 1e-4);
}

TEST(HullGuide, DirectionsThatAreNoneHaveACell)
{
    const HullGuide guide = drum(20).guide;
    const double none = std::numeric_limits<double>::quiet_NaN();
    const double much = std::numeric_limits<double>::infinity();
    for (const Vec3& direction : {Vec3(0, 0, 0), Vec3(none, 0, 1), Vec3(none, none, none),
                                  Vec3(much, 0, 0), Vec3(much, -much, much), Vec3(0, 5e-324, 0)})
        EXPECT_LT(guide.cell(direction), guide.toward.size());
}

}  // namespace
}  // namespace throng
