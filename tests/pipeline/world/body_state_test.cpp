// Body state: what is read and written of many bodies is what each of them says and is told.
#include "throng/body_state.hpp"

#include "tests/support/small_scenes.hpp"
#include "throng/catalog.hpp"
#include "throng/world.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace throng {
namespace {

using given::mixed_scene;

// All of one body, as a program may keep it.
struct Record {
    float tag = 0;
    double position[3] = {}, orientation[4] = {}, velocity[3] = {}, spin[3] = {};
};

template <class Number, class Records>
StateColumns<Number> columns_of(Records& records)
{
    return {{records[0].position, sizeof(Record)},
            {records[0].orientation, sizeof(Record)},
            {records[0].velocity, sizeof(Record)},
            {records[0].spin, sizeof(Record)}};
}

TEST(BodyState, IsWhatEachBodySays)
{
    for (const int threads : {1, 3}) {
        World world(make_scene("pile", 3000), threads);
        world.step(20);
        std::vector<BodyId> ids = world.bodies();
        std::reverse(ids.begin(), ids.end());
        std::vector<Record> records(ids.size());
        world.read_state(ids, columns_of<double>(records));
        const StateSpans kept = world.stored_state();
        for (std::size_t i = 0; i < ids.size(); ++i) {
            const Pose pose = world.pose(ids[i]);
            const Record& record = records[i];
            for (int k = 0; k < 3; ++k) {
                ASSERT_EQ(record.position[k], pose.position[k]);
                ASSERT_EQ(record.orientation[k + 1], pose.orientation.vec()[k]);
                ASSERT_EQ(record.velocity[k], world.velocity(ids[i])[k]);
                ASSERT_EQ(record.spin[k], world.angular_velocity(ids[i])[k]);
            }
            ASSERT_EQ(record.orientation[0], pose.orientation.w());
            ASSERT_EQ(record.tag, 0);
            const std::uint32_t at = ids[i].index;
            ASSERT_EQ(kept.center[at], world.center_of_mass(ids[i]));
            ASSERT_EQ(kept.generation[at], ids[i].generation);
            ASSERT_EQ(kept.awake[at] != 0, world.awake(ids[i]));
        }
        ASSERT_EQ(kept.active_dynamic.size(), world.report().bodies_awake);
    }
}

TEST(BodyState, WrittenIsAsIfEachHadBeenSet)
{
    World at_once(mixed_scene()), each(mixed_scene());
    const std::vector<BodyId> ids = each.bodies();
    std::vector<Record> records(ids.size());
    each.read_state(ids, columns_of<double>(records));
    for (std::size_t i = 0; i < ids.size(); ++i) {
        records[i].position[2] += 0.1;
        records[i].velocity[0] += 1;
        Pose pose = each.pose(ids[i]);
        pose.position.z() += 0.1;
        each.set_pose(ids[i], pose);
        each.set_velocity(ids[i], Vec3(each.velocity(ids[i]) + Vec3(1, 0, 0)),
                          each.angular_velocity(ids[i]));
    }
    at_once.write_state(ids, columns_of<const double>(records));
    at_once.step(60);
    each.step(60);
    EXPECT_EQ(at_once.state_hash(), each.state_hash());
}

TEST(BodyState, WhatIsLeftOutStaysAndWhatIsRefusedChangesNothing)
{
    World world(mixed_scene());
    world.step(5);
    const std::vector<BodyId> ids = world.bodies();
    std::vector<Record> records(ids.size());
    world.read_state(ids, columns_of<double>(records));
    StateColumns<const double> velocities;
    velocities.velocity = {records[0].velocity, sizeof(Record)};
    world.write_state(ids, velocities);
    std::vector<Record> after(ids.size());
    world.read_state(ids, columns_of<double>(after));
    for (std::size_t i = 0; i < ids.size(); ++i) {
        EXPECT_TRUE(std::ranges::equal(after[i].position, records[i].position));
        EXPECT_TRUE(std::ranges::equal(after[i].spin, records[i].spin));
    }
    const std::string before = world.state_hash();

    const auto refused = [&](const auto& spoil) {
        std::vector<Record> spoilt = records;
        for (Record& record : spoilt) record.position[0] += 1;
        spoil(spoilt.back());
        EXPECT_THROW(world.write_state(ids, columns_of<const double>(spoilt)),
                     std::invalid_argument);
        EXPECT_EQ(world.state_hash(), before);
    };
    refused([](Record& record) { record.position[1] = std::nan(""); });
    refused([](Record& record) { record.orientation[0] += 0.1; });
    refused([](Record& record) { record.velocity[2] = INFINITY; });
    refused([](Record& record) { record.spin[2] = std::nan(""); });
    std::vector<BodyId> stale = ids;
    stale.back().generation += 1;
    EXPECT_THROW(world.read_state(stale, columns_of<double>(records)), std::invalid_argument);
    EXPECT_THROW(world.write_state(stale, columns_of<const double>(records)),
                 std::invalid_argument);
    world.read_state({}, {});
}

}  // namespace
}  // namespace throng
