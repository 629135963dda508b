// Movers: the list is kept as if it were made afresh.
#include "kernels/data/bodies.hpp"

#include <gtest/gtest.h>

#include <random>

namespace throng {
namespace {

TEST(ActiveBodies, FollowWhoSleepsAndWakesAsIfListedAfresh)
{
    std::mt19937 random(1);
    BodyStates states;
    for (int i = 0; i < 200; ++i) {
        const auto kind = static_cast<BodyKind>(random() % 4);
        states.kind.push_back(kind);
        states.awake.push_back(kind == BodyKind::kinematic || kind == BodyKind::dynamic ? 1 : 0);
    }
    list_active_bodies(states);
    for (int step = 0; step < 100; ++step) {
        std::vector<std::uint32_t> woke;
        for (std::uint32_t i = 0; i < 200; ++i) {
            if (!states.dynamic(i) || random() % 3 != 0) continue;
            if (states.awake[i] == 0) woke.push_back(i);
            // Some awake and are put to rest again in the same step.
            states.awake[i] = states.awake[i] == 0 && random() % 4 != 0 ? 1 : 0;
        }
        update_active_bodies(woke, states);
        const ActiveBodies followed = states.active_bodies;
        list_active_bodies(states);
        ASSERT_EQ(followed.dynamic, states.active_bodies.dynamic);
        ASSERT_EQ(followed.kinematic, states.active_bodies.kinematic);
    }
}

TEST(ActiveBodies, LoseWhoIsQuarantined)
{
    BodyStates states;
    states.kind = {BodyKind::dynamic, BodyKind::kinematic, BodyKind::static_};
    states.awake = {1, 1, 0};
    list_active_bodies(states);
    EXPECT_EQ(states.active_bodies.dynamic, (std::vector<std::uint32_t>{0}));
    EXPECT_EQ(states.active_bodies.kinematic, (std::vector<std::uint32_t>{1}));
    states.kind = {BodyKind::static_, BodyKind::static_, BodyKind::static_};
    states.awake = {0, 0, 0};
    update_active_bodies({}, states);
    EXPECT_TRUE(states.active_bodies.none());
}

}  // namespace
}  // namespace throng
