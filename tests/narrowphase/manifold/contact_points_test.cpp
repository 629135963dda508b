#include "narrowphase/manifold/contact_points.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace throng {
namespace {

using Point = LocalManifold<double>::Point;

double area(const std::vector<Vec3>& p)
{
    // Of the best order of four corners.
    const auto quad = [&](std::size_t a, std::size_t b, std::size_t c, std::size_t d) {
        return std::abs((p[c] - p[a]).cross(p[d] - p[b]).z()) / 2;
    };
    return std::max({quad(0, 1, 2, 3), quad(0, 2, 1, 3), quad(0, 1, 3, 2)});
}

}  // namespace

TEST(ContactPoints, FourOrFewerAreAllKept)
{
    const std::vector<Point> points = {
        {{0, 0, 0}, 0, 7}, {{1, 0, 0}, 0, 8}, {{1, 1, 0}, 0, 9}, {{0, 1, 0}, 0, 3}};
    for (std::size_t count = 0; count <= 4; ++count) {
        LocalManifold<double> out;
        reduce_to_four<double>({points.data(), count}, out);
        ASSERT_EQ(out.count, static_cast<int>(count));
        for (std::size_t i = 0; i < count; ++i) {
            EXPECT_EQ(out.points[i].feature, points[i].feature);
        }
    }
}

TEST(ContactPoints, TheDeepestIsToldAndTheRestSpreadOut)
{
    std::mt19937_64 engine(51);
    std::uniform_real_distribution<double> number(-1, 1);
    for (int i = 0; i < 500; ++i) {
        std::vector<Point> points;
        for (std::uint32_t k = 0; k < 5 + static_cast<std::uint32_t>(i % 20); ++k) {
            // Corners of a convex polygon, as clipping gives them.
            const Vec3 corner = Vec3(number(engine), number(engine), 0).normalized();
            points.push_back({corner, number(engine), k});
        }
        LocalManifold<double> out;
        reduce_to_four<double>(points, out);
        ASSERT_EQ(out.count, 4);
        double least = 1, kept = 1, most = 0;
        std::vector<Vec3> chosen;
        for (const Point& point : points) least = std::min(least, point.separation);
        for (const Point& point : out.points) {
            kept = std::min(kept, point.separation);
            chosen.push_back(point.position);
        }
        ASSERT_GE(kept, least - 1e-12) << "seed 51, set " << i;
        ASSERT_LE(kept, least + kDrawn<double> * 2) << "seed 51, set " << i;
        for (std::size_t a = 0; a < points.size(); ++a) {
            for (std::size_t b = 0; b < a; ++b) {
                for (std::size_t c = 0; c < b; ++c) {
                    for (std::size_t d = 0; d < c; ++d) {
                        most = std::max(most,
                                        area({points[a].position, points[b].position,
                                              points[c].position, points[d].position}));
                    }
                }
            }
        }
        // One of the four may be there for its depth alone.
        ASSERT_GT(area(chosen), 0.25 * most) << "seed 51, set " << i;
    }
}

TEST(ContactPoints, SmallChangesOfDepthKeepTheSameFour)
{
    std::mt19937_64 engine(52);
    std::uniform_real_distribution<double> noise(-1e-6, 1e-6);
    std::vector<Point> points;
    for (std::uint32_t k = 0; k < 8; ++k) {
        const double x = k & 1 ? 1 : 0.4, y = k & 1 ? 0.4 : 1;
        points.push_back({{k & 2 ? x : -x, k & 4 ? y : -y, 0}, 0, k});
    }
    LocalManifold<double> first;
    reduce_to_four<double>(points, first);
    for (int i = 0; i < 200; ++i) {
        for (Point& point : points) point.separation = noise(engine);
        LocalManifold<double> out;
        reduce_to_four<double>(points, out);
        for (std::size_t k = 0; k < 4; ++k) {
            ASSERT_EQ(out.points[k].feature, first.points[k].feature) << "seed 52, try " << i;
        }
    }
}

TEST(ContactPoints, ManyInOnePlaceAreFinite)
{
    std::vector<Point> points;
    for (std::uint32_t k = 0; k < 6; ++k) points.push_back({{1, 2, 3}, -0.1 * k, k});
    LocalManifold<double> out;
    reduce_to_four<double>(points, out);
    ASSERT_GT(out.count, 0);
    double told = 0;
    for (int k = 0; k < out.count; ++k) {
        EXPECT_EQ(out.points[std::size_t(k)].position, Vec3(1, 2, 3));
        told = std::min(told, out.points[std::size_t(k)].separation);
    }
    EXPECT_EQ(told, -0.5);
}

// Who leans on what is left out goes there without a jump: a thousandth of the way in depth moves
// no point by more than its share of the way.
TEST(ContactPoints, LeaningMovesPointsAndNeverSwapsThem)
{
    std::vector<Point> points;
    for (std::uint32_t k = 0; k < 8; ++k) {
        const double angle = 0.7853981633974483 * k + 0.1;
        points.push_back({{std::cos(angle), std::sin(angle), 0}, 0, k});
    }
    LocalManifold<double> before;
    reduce_to_four<double>(points, before);
    // About all axes across the normal, from flat to far more than counts.
    for (int axis = 0; axis < 40; ++axis) {
        const Vec3 lean(std::cos(0.157 * axis), std::sin(0.157 * axis), 0);
        LocalManifold<double> last = before;
        for (int step = 0; step <= 4000; ++step) {
            auto leaning = points;
            for (Point& point : leaning)
                point.separation = -1e-3 * step * kDrawn<double> * 2 * lean.dot(point.position);
            LocalManifold<double> out;
            reduce_to_four<double>(leaning, out);
            for (std::size_t k = 0; k < 4; ++k) {
                ASSERT_EQ(out.points[k].feature, before.points[k].feature);
                ASSERT_LT((out.points[k].position - last.points[k].position).norm(), 5e-3)
                    << "axis " << axis << ", step " << step << ", point " << k;
                // Where it goes it lies on what leans.
                ASSERT_NEAR(out.points[k].separation,
                            -1e-3 * step * kDrawn<double> * 2 * lean.dot(out.points[k].position),
                            1e-12);
            }
            last = out;
        }
        double told = 1, least = 1;
        for (const Point& point : last.points) told = std::min(told, point.separation);
        for (const Point& point : points)
            least = std::min(least, -4 * kDrawn<double> * 2 * lean.dot(point.position));
        ASSERT_NEAR(told, least, kDrawn<double> * 2);
    }
}

}  // namespace throng
