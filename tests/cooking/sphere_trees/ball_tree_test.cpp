#include "cooking/sphere_trees/ball_tree.hpp"

#include "tests/support/closed_meshes.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

// Some of one size and place, so that several are equally near.
std::vector<Ball> some_balls(RandomShapes& random, std::size_t count)
{
    std::vector<Ball> balls;
    for (std::size_t i = 0; i < count; ++i) {
        if (i % 7 == 6)
            balls.push_back(balls[i - 3]);
        else
            balls.push_back({random.vector(-1, 1), random.number(0.01, 0.2)});
    }
    return balls;
}

// In and about the balls, and every few in the middle of one.
Vec3 some_place(RandomShapes& random, const std::vector<Ball>& balls, std::size_t i)
{
    if (i % 5 == 4 && !balls.empty()) return balls[i % balls.size()].center;
    return random.vector(-2, 2);
}

constexpr std::array<std::size_t, 9> kCounts = {0, 1, 2, 7, 8, 9, 17, 100, 1000};

// Asks about fifty places of a tree of every count of balls.
template <class Ask>
void ask_at_places(std::uint64_t seed, const Ask& ask)
{
    RandomShapes random(seed);
    for (const std::size_t count : kCounts) {
        const std::vector<Ball> balls = some_balls(random, count);
        const BallTree tree(balls);
        for (std::size_t i = 0; i < 50; ++i)
            ask(random, balls, tree, some_place(random, balls, i), i);
    }
}

TEST(BallTree, FindsTheDistanceThatALookAtEveryBallFinds)
{
    ask_at_places(
        1,
        [](RandomShapes&, const auto& balls, const BallTree& tree, const Vec3& place, std::size_t) {
            double least = std::numeric_limits<double>::infinity();
            for (const Ball& ball : balls) least = std::min(least, distance_to(ball, place));
            EXPECT_EQ(tree.least_separation(place), least);
            EXPECT_EQ(tree.least_separation(place, 0.1) < 0.1, least < 0.1);
        });
}

TEST(BallTree, FindsTheTwoThatALookAtEveryBallFinds)
{
    ask_at_places(
        2,
        [](RandomShapes& random, const auto& balls, const BallTree& tree, const Vec3& place,
           std::size_t) {
            std::vector<std::uint8_t> gone(balls.size());
            for (std::uint8_t& one : gone) one = random.number(0, 1) < 0.3;
            NearestBalls wanted, wanted_left;
            for (std::uint32_t k = 0; k < balls.size(); ++k) {
                wanted.offer(k, distance_to(balls[k], place));
                if (gone[k] == 0) wanted_left.offer(k, distance_to(balls[k], place));
            }
            const NearestBalls all = tree.nearest(place), left = tree.nearest(place, gone);
            EXPECT_EQ(std::tuple(all.by, all.separation, all.next),
                      std::tuple(wanted.by, wanted.separation, wanted.next));
            EXPECT_EQ(std::tuple(left.by, left.separation, left.next),
                      std::tuple(wanted_left.by, wanted_left.separation, wanted_left.next));
        });
}

TEST(BallTree, FindsThoseWithinADistanceInOrder)
{
    ask_at_places(3,
                  [](RandomShapes& random, const auto& balls, const BallTree& tree,
                     const Vec3& place, std::size_t i) {
                      // As far as one of them, exactly.
                      const double extent = balls.empty()
                          ? random.number(0, 1)
                          : distance_to(balls[i % balls.size()], place);
                      std::vector<std::uint32_t> wanted, found;
                      for (std::uint32_t k = 0; k < balls.size(); ++k)
                          if (distance_to(balls[k], place) <= extent) wanted.push_back(k);
                      tree.find_within(place, extent, found);
                      EXPECT_EQ(found, wanted);
                  });
}

}  // namespace
}  // namespace throng
