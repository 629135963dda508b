#include "cooking/sphere_trees/sphere_tree.hpp"

#include "cooking/sphere_trees/sphere_error.hpp"
#include "tests/support/closed_meshes.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

struct Case {
    const char* name;
    Mesh mesh;
    SphereTree tree;
};

// Three levels: enough for every promise, and quickly built.
const std::vector<Case>& cases()
{
    static const std::vector<Case> all = [] {
        std::vector<Case> made;
        made.push_back({"ball", closed(ball_mesh(0.5, 16, 8)), {}});
        made.push_back({"box", closed(box_mesh({0.5, 0.4, 0.3})), {}});
        made.push_back({"torus", closed(torus_mesh(0.35, 0.15, 24, 12)), {}});
        made.push_back({"noisy ball", closed(noisy_ball(7, 0.5, 0.1)), {}});
        for (Case& one : made) one.tree = build_sphere_tree(one.mesh, {3, 64, 0, 50000});
        return made;
    }();
    return all;
}

std::vector<Ball> balls_of(const SphereTree::Level& level)
{
    std::vector<Ball> balls;
    for (const SphereTree::Node& node : level.nodes)
        balls.push_back({node.center.cast<double>(), double{node.radius}});
    return balls;
}

// How far a place is from the balls' surface: outside at once; inside along many ways, of which
// the shortest is further than the truth.
double from_surface_of(const std::vector<Ball>& balls, const Vec3& at, RandomShapes& random)
{
    const double outside = distance_to_balls(balls, at);
    if (outside >= 0) return outside;
    double least = std::numeric_limits<double>::infinity();
    for (int way = 0; way < 200; ++way) {
        const Vec3 along = random.vector(-1, 1).normalized();
        double gone = 0;
        // Each stride is known to stay inside.
        for (int stride = 0; stride < 100 && gone < least; ++stride) {
            const double here = distance_to_balls(balls, at + along * gone);
            if (here > -1e-4) break;
            gone -= here;
        }
        least = std::min(least, gone);
    }
    return least;
}

TEST(SphereTree, ErrorFallsWithEachLevel)
{
    for (const Case& one : cases()) {
        ASSERT_FALSE(one.tree.levels.empty()) << one.name;
        EXPECT_EQ(one.tree.levels[0].nodes.size(), 1U) << one.name;
        for (std::size_t level = 1; level < one.tree.levels.size(); ++level)
            EXPECT_LT(one.tree.levels[level].error, 0.9 * one.tree.levels[level - 1].error)
                << one.name << " level " << level;
    }
    // A ring is nothing like one sphere, and much like sixty-four.
    const SphereTree& ring = cases()[2].tree;
    ASSERT_EQ(ring.levels.size(), 3U);
    EXPECT_LT(ring.levels[2].error, 0.1 * ring.levels[0].error);
}

TEST(SphereTree, NoPlaceOfTheMeshIsFurtherFromTheSpheresThanTheError)
{
    RandomShapes random(11);
    for (const Case& one : cases())
        for (const SphereTree::Level& level : one.tree.levels) {
            const std::vector<Ball> balls = balls_of(level);
            for (int i = 0; i < 400; ++i) {
                const double far = from_surface_of(balls, place_on(one.mesh, random), random);
                // Random ways out are longer than the shortest by a part of it; strides end 1e-4
                // short of the surface.
                EXPECT_LE(far, 1.1 * level.error + 1e-3 * size_of(one.mesh)) << one.name;
            }
        }
}

TEST(SphereTree, NoPlaceOfTheSpheresIsFurtherFromTheMeshThanTheError)
{
    RandomShapes random(12);
    for (const Case& one : cases())
        for (const SphereTree::Level& level : one.tree.levels) {
            const std::vector<Ball> balls = balls_of(level);
            double furthest = 0;
            for (const Ball& ball : balls)
                for (int i = 0; i < 200; ++i) {
                    const Vec3 at = ball.center + ball.radius * random.vector(-1, 1).normalized();
                    if (distance_to_balls(balls, at) < -1e-9) continue;
                    furthest = std::max(furthest, std::abs(signed_distance(one.mesh, at)));
                }
            EXPECT_LE(furthest, level.error) << one.name;
            // And it says little more than there is to say, where the looks go far enough.
            if (level.error > 0.05 * size_of(one.mesh)) {
                EXPECT_GE(furthest, level.error / 2) << one.name;
            }
        }
}

TEST(SphereTree, NoPlaceInsideIsFurtherFromTheSpheresThanTheError)
{
    RandomShapes random(13);
    for (const Case& one : cases())
        for (const SphereTree::Level& level : one.tree.levels) {
            const std::vector<Ball> balls = balls_of(level);
            for (int i = 0; i < 2000; ++i) {
                const Vec3 at = random.vector(-0.5, 0.5);
                const double depth = -signed_distance(one.mesh, at);
                const double outside = distance_to_balls(balls, at);
                if (depth <= 0 || outside <= 0) continue;
                EXPECT_LE(std::max(depth, outside), level.error) << one.name;
            }
        }
}

TEST(SphereTree, BoundsHoldAllBelowAndEverySphereHasAParent)
{
    for (const Case& one : cases())
        for (std::size_t level = 0; level + 1 < one.tree.levels.size(); ++level) {
            const auto& below = one.tree.levels[level + 1].nodes;
            std::uint32_t next = 0;
            for (const SphereTree::Node& node : one.tree.levels[level].nodes) {
                EXPECT_EQ(node.first, next) << one.name;
                next = node.first + node.count;
                EXPECT_GE(node.bound, node.radius);
                for (std::uint32_t i = node.first; i < next; ++i) {
                    const double apart = double{(below[i].center - node.center).norm()};
                    // One unit of float in what the sum comes to.
                    EXPECT_LE(apart + double{below[i].bound}, double{node.bound} * (1 + 1e-6));
                }
            }
            EXPECT_EQ(next, below.size()) << one.name;
        }
}

TEST(SphereTree, ComesOutTheSameEachTime)
{
    const Case& one = cases()[3];
    const SphereTree again = build_sphere_tree(one.mesh, {3, 64, 0, 50000});
    ASSERT_EQ(again.levels.size(), one.tree.levels.size());
    for (std::size_t level = 0; level < again.levels.size(); ++level) {
        EXPECT_EQ(again.levels[level].error, one.tree.levels[level].error);
        ASSERT_EQ(again.levels[level].nodes.size(), one.tree.levels[level].nodes.size());
        for (std::size_t i = 0; i < again.levels[level].nodes.size(); ++i) {
            EXPECT_EQ(again.levels[level].nodes[i].center, one.tree.levels[level].nodes[i].center);
            EXPECT_EQ(again.levels[level].nodes[i].radius, one.tree.levels[level].nodes[i].radius);
        }
    }
}

TEST(SphereTree, EndsWhereTheErrorIsMetAndIsEmptyOfNothing)
{
    const Case& one = cases()[1];
    const double wanted = one.tree.levels[1].error;
    EXPECT_EQ(build_sphere_tree(one.mesh, {3, 64, wanted, 50000}).levels.size(), 2U);
    EXPECT_TRUE(build_sphere_tree(Mesh{}).levels.empty());
}

TEST(SphereError, IsThatOfAKnownPair)
{
    // One ball in a cube: corners stick out of it by sqrt(3) - 1, and it touches the faces.
    const Mesh cube = closed(box_mesh({1, 1, 1}));
    const std::vector<Ball> balls = {{Vec3::Zero(), 1}};
    const double far = std::sqrt(3.0) - 1;
    EXPECT_GE(sphere_error(cube, balls), far);
    EXPECT_LE(sphere_error(cube, balls), 1.1 * far);
    // Grown to the corners it sticks out of the faces as far.
    const std::vector<Ball> grown = {{Vec3::Zero(), std::sqrt(3.0)}};
    EXPECT_GE(sphere_error(cube, grown), far);
    EXPECT_LE(sphere_error(cube, grown), 1.1 * far);
}

TEST(SphereError, FindsAHollowThatTheSurfaceDoesNotTellOf)
{
    // Eight small balls in the corners of a cube and twelve hundred over its faces: all of the
    // surface is near to them, the middle is not.
    const Mesh cube = closed(box_mesh({1, 1, 1}));
    std::vector<Ball> balls;
    for (int x = 0; x <= 10; ++x)
        for (int y = 0; y <= 10; ++y)
            for (int z = 0; z <= 10; ++z) {
                const bool rim = x % 10 == 0 || y % 10 == 0 || z % 10 == 0;
                if (rim) balls.push_back({Vec3(x - 5, y - 5, z - 5) * 0.18, 0.18});
            }
    EXPECT_GE(sphere_error(cube, balls), 1.0);
}

}  // namespace
}  // namespace throng
