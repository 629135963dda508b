// Movers: the list is kept as if it were made afresh.
#include "kernels/data/bodies.hpp"

#include <gtest/gtest.h>

#include <random>

namespace throng {
namespace {

TEST(Movers, FollowWhoSleepsAndWakesAsIfListedAfresh)
{
    std::mt19937 random(1);
    BodyStates states;
    for (int i = 0; i < 200; ++i) {
        const auto kind = static_cast<BodyKind>(random() % 4);
        states.kind.push_back(kind);
        states.awake.push_back(kind == BodyKind::kinematic || kind == BodyKind::dynamic ? 1 : 0);
    }
    list_movers(states);
    for (int step = 0; step < 100; ++step) {
        std::vector<std::uint32_t> awoken;
        for (std::uint32_t i = 0; i < 200; ++i) {
            if (!states.dynamic(i) || random() % 3 != 0) continue;
            if (states.awake[i] == 0) awoken.push_back(i);
            // Some awake and are put to rest again in the same step.
            states.awake[i] = states.awake[i] == 0 && random() % 4 != 0 ? 1 : 0;
        }
        follow_movers(awoken, states);
        const Movers followed = states.movers;
        list_movers(states);
        ASSERT_EQ(followed.dynamic, states.movers.dynamic);
        ASSERT_EQ(followed.kinematic, states.movers.kinematic);
    }
}

TEST(Movers, LoseWhoIsQuarantined)
{
    BodyStates states;
    states.kind = {BodyKind::dynamic, BodyKind::kinematic, BodyKind::still};
    states.awake = {1, 1, 0};
    list_movers(states);
    EXPECT_EQ(states.movers.dynamic, (std::vector<std::uint32_t>{0}));
    EXPECT_EQ(states.movers.kinematic, (std::vector<std::uint32_t>{1}));
    states.kind = {BodyKind::still, BodyKind::still, BodyKind::still};
    states.awake = {0, 0, 0};
    follow_movers({}, states);
    EXPECT_TRUE(states.movers.none());
}

}  // namespace
}  // namespace throng
