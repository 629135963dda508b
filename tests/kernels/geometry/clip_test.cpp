#include "kernels/geometry/clip.hpp"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace throng {
namespace {

Polygon<double> square()
{
    Polygon<double> polygon;
    polygon.add({1, 1, 0}, 0);
    polygon.add({-1, 1, 0}, 1);
    polygon.add({-1, -1, 0}, 2);
    polygon.add({1, -1, 0}, 3);
    return polygon;
}

double area(const Polygon<double>& polygon)
{
    Vec3 sum = Vec3::Zero();
    for (int i = 1; i + 1 < polygon.count; ++i) {
        const auto at = static_cast<std::size_t>(i);
        sum += (polygon.corners[at] - polygon.corners[0])
                   .cross(polygon.corners[at + 1] - polygon.corners[0]);
    }
    return sum.norm() / 2;
}

}  // namespace

TEST(Clip, KeepsThePartInside)
{
    Polygon<double> polygon = square();
    cut<double>(polygon, Vec3::UnitX(), 0.25, 0, 100);
    EXPECT_EQ(polygon.count, 4);
    EXPECT_NEAR(area(polygon), 2.5, 1e-15);
    cut<double>(polygon, Vec3::UnitY(), 0.5, 0, 101);
    EXPECT_NEAR(area(polygon), 1.25 * 1.5, 1e-15);
    cut<double>(polygon, Vec3::UnitX(), -2, 0, 102);
    EXPECT_EQ(polygon.count, 0);
    cut<double>(polygon, Vec3::UnitX(), 2, 0, 103);
    EXPECT_EQ(polygon.count, 0);
}

TEST(Clip, AreasOnBothSidesOfACutAddUp)
{
    std::mt19937_64 engine(41);
    std::uniform_real_distribution<double> number(-1, 1);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 normal(number(engine), number(engine), number(engine));
        const double offset = number(engine);
        Polygon<double> one = square(), two = square();
        cut<double>(one, normal, offset, 0, 100);
        cut<double>(two, Vec3(-normal), -offset, 0, 100);
        ASSERT_NEAR(area(one) + area(two), 4, 1e-12) << "seed 41, cut " << i;
    }
}

TEST(Clip, CornersKeepTheirNamesWhileTheSameLinesMeet)
{
    Polygon<double> one = square(), two = square();
    cut<double>(one, Vec3(1, 0.1, 0), 0.5, 0, 100);
    cut<double>(two, Vec3(1, 0.2, 0), 0.4, 0, 100);
    ASSERT_EQ(one.count, two.count);
    std::set<std::uint32_t> names;
    for (int i = 0; i < one.count; ++i) {
        EXPECT_EQ(one.corner_id(i), two.corner_id(i));
        names.insert(one.corner_id(i));
    }
    EXPECT_EQ(names.size(), static_cast<std::size_t>(one.count));
}

TEST(Clip, CornersWithinTheSlackStay)
{
    Polygon<double> polygon = square();
    cut<double>(polygon, Vec3::UnitX(), 1 - 1e-6, 1e-4, 100);
    EXPECT_EQ(polygon.count, 4);
    EXPECT_EQ(polygon.corner_id(0), square().corner_id(0));
    EXPECT_EQ(area(polygon), 4);
}

TEST(Clip, AFullPolygonGivesUpLittle)
{
    // Hundreds of cuts round a circle: more corners than there is room for.
    Polygon<double> polygon = square();
    Eigen::Vector2d at(1, 0);
    const double s = 0.02, c = std::sqrt(1 - s * s);
    for (int i = 0; i < 314; ++i) {
        cut<double>(polygon, Vec3(at.x(), at.y(), 0), 0.9, 0, static_cast<std::uint16_t>(100 + i));
        at = {c * at.x() - s * at.y(), s * at.x() + c * at.y()};
    }
    EXPECT_LE(polygon.count, kMaxCorners);
    EXPECT_NEAR(area(polygon), 3.14159 * 0.81, 0.01);
}

}  // namespace throng
