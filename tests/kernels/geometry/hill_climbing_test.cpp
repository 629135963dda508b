#include "kernels/geometry/hill_climbing.hpp"

#include "tests/support/polyhedra.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace throng {
namespace {

// Corners round a circle, one ring at each height.
std::vector<Vec3> rings(int corners, double radius, const std::vector<double>& heights)
{
    std::vector<Vec3> points;
    for (const double height : heights) {
        for (int i = 0; i < corners; ++i) {
            const double angle = 2 * std::numbers::pi * i / corners;
            points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), height);
        }
    }
    return points;
}

// A cube whose faces bulge by so much, with points strewn over them.
std::vector<Vec3> bulging_cube(RandomShapes& random, int points, double bulge)
{
    std::vector<Vec3> cloud = corners_of(Vec3::Ones());
    for (int i = 0; i < points; ++i) {
        Vec3 point = random.vector(-1, 1);
        const int axis = i % 3;
        const double u = point[(axis + 1) % 3], v = point[(axis + 2) % 3];
        point[axis] = (i % 2 == 0 ? 1 : -1) * (1 + bulge * (1 - u * u) * (1 - v * v));
        cloud.push_back(point);
    }
    return cloud;
}

std::uint16_t first_furthest(const Hull& hull, const Vec3& direction)
{
    std::size_t best = 0;
    for (std::size_t i = 1; i < hull.vertices.size(); ++i)
        if (direction.dot(hull.vertices[i]) > direction.dot(hull.vertices[best])) best = i;
    return static_cast<std::uint16_t>(best);
}

// Directions that lead into trouble: along face normals, edges and axes, a hair beside them, and
// anywhere.
std::vector<Vec3> directions_for(const Hull& hull, RandomShapes& random)
{
    std::vector<Vec3> directions;
    const auto with_neighbors = [&](const Vec3& direction) {
        directions.push_back(direction);
        for (const double tilt : {1e-16, 1e-13, 1e-10, 1e-6, 1e-4})
            directions.emplace_back(direction + direction.norm() * random.vector(-tilt, tilt));
    };
    const std::size_t faces = std::max<std::size_t>(1, hull.normals.size() / 30);
    for (std::size_t i = 0; i < hull.normals.size(); i += faces) with_neighbors(hull.normals[i]);
    const std::size_t edges = std::max<std::size_t>(1, hull.edges.size() / 20);
    for (std::size_t i = 0; i < hull.edges.size(); i += edges)
        with_neighbors(hull.vertices[hull.edges[i].to] - hull.vertices[hull.edges[i].from]);
    for (int i = 0; i < 3; ++i) {
        with_neighbors(Vec3::Unit(i));
        with_neighbors(-Vec3::Unit(i));
    }
    for (int i = 0; i < 100; ++i) directions.push_back(random.vector(-1, 1));
    return directions;
}

void expect_same_as_looking(const Hull& hull, RandomShapes& random)
{
    const HillClimbingShape shape(hull);
    HillClimbingCount count;
    for (const Vec3& direction : directions_for(hull, random)) {
        const std::uint16_t truth = first_furthest(hull, direction);
        const auto anywhere = static_cast<std::uint16_t>(
            random.number(0, static_cast<double>(hull.vertices.size()) - 0.5));
        ASSERT_EQ(furthest_vertex(shape, direction, count), truth) << direction.transpose();
        ASSERT_EQ(furthest_vertex(shape, direction, anywhere, count), truth);
        ASSERT_EQ(furthest_vertex_near(shape, direction, anywhere, count), truth);
    }
}

TEST(HillClimbing, FindsTheVertexThatLookingAtAllFinds)
{
    RandomShapes random(71);
    for (const int points : {10, 13, 32, 60, 128, 1000, 10000}) {
        SCOPED_TRACE("seed 71, points " + std::to_string(points));
        const int hulls = points < 200 ? 10 : 1;
        for (int i = 0; i < hulls; ++i) expect_same_as_looking(random.hull(points, 0.5), random);
    }
}

TEST(HillClimbing, FansAndDrumsTrapNobody)
{
    RandomShapes random(72);
    std::vector<Vec3> cone = rings(500, 1, {0});
    cone.emplace_back(0, 0, 0.7);
    std::vector<Vec3> spindle = rings(300, 0.5, {0});
    spindle.emplace_back(0, 0, 3);
    spindle.emplace_back(0, 0, -3);
    const Quat aslant = random.turn();
    for (std::vector<Vec3> points :
         {rings(500, 1, {-0.5, 0.5}), rings(64, 1, {-1e-3, 1e-3}), cone, spindle}) {
        for (const bool turned : {false, true}) {
            if (turned)
                for (Vec3& point : points) point = aslant * point;
            SCOPED_TRACE("seed 72, points " + std::to_string(points.size()));
            const HullResult built = build_hull(points);
            ASSERT_EQ(built.trouble, "");
            ASSERT_GT(built.hull.vertices.size(), points.size() / 2);
            expect_same_as_looking(built.hull, random);
        }
    }
}

// Faces that are put together though their corners leave the plane by a little: over their rims
// alone there are true dead ends.
TEST(HillClimbing, NearlyFlatFacesTrapNobody)
{
    RandomShapes random(73);
    for (const double bulge : {1e-3, 1e-4, 3e-5, 1e-5, 3e-6, 1e-7, 1e-9, 1e-12, 1e-15, 0.0}) {
        for (const bool turned : {false, true}) {
            SCOPED_TRACE("seed 73, bulge " + std::to_string(bulge));
            std::vector<Vec3> points = bulging_cube(random, 1200, bulge);
            const Quat aslant = turned ? random.turn() : Quat(1, 0, 0, 0);
            for (Vec3& point : points) point = aslant * point;
            expect_same_as_looking(build_hull(points).hull, random);
        }
    }
}

TEST(HillClimbing, SameAtEveryScaleAndFarFromTheOrigin)
{
    RandomShapes random(74);
    for (const double scale : {1e-6, 1.0, 1e6}) {
        for (const double shift : {0.0, 1.0, 1000.0}) {
            SCOPED_TRACE("seed 74, scale " + std::to_string(scale));
            std::vector<Vec3> points;
            for (int i = 0; i < 300; ++i)
                points.emplace_back(scale * (random.vector(-1, 1) + Vec3::Constant(shift)));
            expect_same_as_looking(build_hull(points).hull, random);
        }
    }
}

TEST(HillClimbing, DirectionsThatAreNoneEndSomewhere)
{
    RandomShapes random(75);
    const Hull hull = random.hull(200, 0.5);
    const HillClimbingShape shape(hull);
    HillClimbingCount count;
    const double none = std::numeric_limits<double>::quiet_NaN();
    const double much = std::numeric_limits<double>::infinity();
    EXPECT_EQ(furthest_vertex(shape, Vec3::Zero(), count), 0);
    for (const Vec3& direction : {Vec3(none, none, none), Vec3(much, 0, 0), Vec3(much, -much, none),
                                  Vec3(1e300, 1e300, 0), Vec3(0, 1e-320, 0)})
        EXPECT_LT(furthest_vertex(shape, direction, count), hull.vertices.size());
    EXPECT_LE(count.looked, 20 * static_cast<std::int64_t>(hull.vertices.size()));
}

TEST(HillClimbing, HullsPutTogetherByHandAreLookedAtWhole)
{
    RandomShapes random(76);
    Hull hull;
    hull.vertices = random.hull(100, 0.5).vertices;
    expect_same_as_looking(hull, random);
}

// What a turning hull takes, a hundredth of a radian at a time.
double looked_at_a_step(RandomShapes& random, int points, bool remembers)
{
    const Hull hull = random.hull(points, 0.5);
    const HillClimbingShape shape(hull);
    HillClimbingCount count;
    std::uint16_t last = furthest_vertex(shape, Vec3::UnitX(), count);
    count = {};
    for (int i = 0; i < 2000; ++i) {
        const double angle = 0.01 * i;
        const Vec3 direction(std::cos(angle), std::sin(angle), 0.5 * std::sin(0.37 * angle));
        last = remembers ? furthest_vertex(shape, direction, last, count)
                         : furthest_vertex(shape, direction, count);
    }
    EXPECT_EQ(count.supports, 2000);
    EXPECT_GE(count.steps, count.supports);
    return static_cast<double>(count.looked) / static_cast<double>(count.supports);
}

TEST(HillClimbing, CostHardlyGrowsWithTheHull)
{
    RandomShapes random(77);
    for (const bool remembers : {true, false}) {
        const double few = looked_at_a_step(random, 32, remembers);
        for (const int points : {128, 1000, 10000}) {
            const double many = looked_at_a_step(random, points, remembers);
            EXPECT_LT(many, 2 * few) << "seed 77, points " << points << ", remembers " << remembers;
            EXPECT_LT(many, 32);
        }
    }
}

// The far side of a drum's cap is no walk round its rim.
TEST(HillClimbing, ADrumIsCrossedByItsLinks)
{
    RandomShapes random(78);
    const Hull drum = build_hull(rings(1000, 1, {-0.2, 0.2})).hull;
    const HillClimbingShape shape(drum);
    HillClimbingCount count;
    for (int i = 0; i < 500; ++i) {
        const Vec3 direction = random.vector(-1, 1) + Vec3(0, 0, 50);
        const auto start = static_cast<std::uint16_t>(random.number(0, 1999));
        ASSERT_EQ(furthest_vertex(shape, direction, start, count), first_furthest(drum, direction));
    }
    EXPECT_LT(count.steps, 500 * 20);
}

}  // namespace
}  // namespace throng
