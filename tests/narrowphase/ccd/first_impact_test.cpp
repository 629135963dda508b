#include "narrowphase/ccd/first_impact.hpp"

#include "tests/support/moving_pairs.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

MovingShape ball_at(double x, double way)
{
    MovingShape ball;
    ball.trajectory = {{{x, 0, 0}, Quat::Identity()}, {way, 0, 0}, Vec3::Zero()};
    return ball;
}

// Equal balls in a row: the first comes at the second, which stands beside the third.
TEST(FirstImpact, IsThatOfTheTwoThatMeetFirst)
{
    Shapes shapes;
    shapes.spheres = {{0.5}};
    const MovingShape group[] = {ball_at(0, 10), ball_at(2, 0), ball_at(4, 0)};
    const ImpactPair pairs[] = {{0, 2}, {1, 2}, {0, 1}};
    for (const ToiMethod method : test::kToiMethods) {
        const FirstImpact first = first_impact(shapes, group, pairs, 0, 1, method, 1e-4);
        EXPECT_EQ(first.pair, 2u);
        EXPECT_LE(first.impact.time, 0.1);
        EXPECT_NEAR(first.impact.time, 0.1, 1e-4 * 0.5 / 10);
    }
    // From then on, once the second goes on with what the first had.
    const MovingShape after[] = {ball_at(1, 0), ball_at(1, 10), ball_at(4, 0)};
    const FirstImpact second = first_impact(shapes, after, std::span(pairs).subspan(1, 1), 0.1, 1,
                                            ToiMethod::newton, 1e-4);
    EXPECT_EQ(second.pair, 0u);
    EXPECT_NEAR(second.impact.time, 0.2, 1e-4 * 0.5 / 10);
}

TEST(FirstImpact, LeavesOutWhatTouchesFromTheStart)
{
    Shapes shapes;
    shapes.spheres = {{0.5}};
    const MovingShape group[] = {ball_at(0, 0), ball_at(1, 0), ball_at(3, -4)};
    const ImpactPair pairs[] = {{0, 1}, {1, 2}};
    const FirstImpact first = first_impact(shapes, group, pairs, 0, 1, ToiMethod::newton, 1e-4);
    EXPECT_EQ(first.pair, 1u);
    EXPECT_EQ(first_impact(shapes, group, std::span(pairs).first(1), 0, 1, ToiMethod::newton, 1e-4)
                  .impact.state,
              ToiState::separated);
}

TEST(FirstImpact, IsTheLeastOfAllPairs)
{
    test::Dice dice(9);
    for (int i = 0; i < 60; ++i) {
        Shapes shapes;
        std::vector<MovingShape> group;
        std::vector<ImpactPair> pairs;
        for (std::uint32_t k = 0; k < 5; ++k) {
            group.push_back({test::random_shape(dice, test::kConvexKinds[k], shapes), {}, {}});
            group.back().trajectory = {{dice.point(3), dice.turn()}, dice.point(4), dice.point(2)};
            for (std::uint32_t other = 0; other < k; ++other) pairs.push_back({other, k});
        }
        double least = 1;
        for (const ImpactPair& pair : pairs) {
            const double size = impact_size(shapes, group[pair.a].shape, group[pair.b].shape);
            const Impact one = time_of_impact(shapes, group[pair.a], group[pair.b], 0, 1,
                                              impact_rule(ToiMethod::newton, 1e-4 * size));
            if (one.state == ToiState::hit) least = std::min(least, one.time);
        }
        const FirstImpact first = first_impact(shapes, group, pairs, 0, 1, ToiMethod::newton, 1e-4);
        // Where a search ends within its tolerance may depend on how far it was to look.
        EXPECT_NEAR(first.impact.time, least, 1e-3);
    }
}

}  // namespace
}  // namespace throng
