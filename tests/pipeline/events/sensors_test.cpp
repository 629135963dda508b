// Sensors: they touch nobody, and tell of everybody who overlaps them, however fast.
#include "pipeline/world/world_state.hpp"
#include "scene/catalog/random.hpp"
#include "tests/support/small_scenes.hpp"
#include "throng/catalog.hpp"
#include "throng/queries.hpp"
#include "throng/world.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>

namespace throng {
namespace {

using given::SceneOf;

BodyDescription& add_sensor(SceneOf& made, const Vec3& half, const Vec3& position)
{
    BodyDescription& sensor = made.box(half, position);
    sensor.motion = Motion::static_;
    sensor.sensor = true;
    return sensor;
}

TEST(Sensors, TellWhoComesAndWhoLeavesAndTouchNobody)
{
    SceneOf made;
    made.floor();
    add_sensor(made, Vec3(0.5, 0.5, 0.1), Vec3(0, 0, 2));
    made.ball(0.25, Vec3(0, 0, 4));
    World world(made.scene), without(made.scene);
    const BodyId sensor = world.bodies()[1], ball = world.bodies()[2];
    const BodyId other = without.bodies()[1];
    without.remove({&other, 1});
    world.listen({.sensors = true});
    std::uint64_t came = 0, left = 0;
    for (int i = 0; i < 120; ++i) {
        world.step();
        without.step();
        EXPECT_EQ(world.pose(ball).position, without.pose(ball).position);
        for (const TouchEvent& event : world.events().sensed) {
            EXPECT_EQ(event.a, sensor);
            EXPECT_EQ(event.b, ball);
            came = event.step;
            EXPECT_EQ(world.sensed(sensor), std::vector<BodyId>{ball});
        }
        for (const TouchEvent& event : world.events().left) {
            EXPECT_EQ(event.b, ball);
            left = event.step;
            EXPECT_TRUE(world.sensed(sensor).empty());
        }
        EXPECT_TRUE(world.events().begun.empty());
    }
    // From 4 m to 2.35 m and to 1.65 m by 9.81 m/s2.
    EXPECT_NEAR(static_cast<double>(came) / 60, std::sqrt(2 * 1.65 / 9.81), 1.1 / 60);
    EXPECT_NEAR(static_cast<double>(left) / 60, std::sqrt(2 * 2.35 / 9.81), 1.1 / 60);
}

TEST(Sensors, SenseABallThroughThreeAtAnySpeed)
{
    for (const double speed : {0.5, 5.0, 50.0, 500.0, 5000.0, 50000.0}) {
        for (const bool fast : {false, true}) {
            SceneOf made;
            made.scene.gravity = Vec3::Zero();
            for (int i = 0; i < 3; ++i)
                add_sensor(made, Vec3(0.01, 1, 1), Vec3(1.0 + 0.3 * i, 0, 0));
            BodyDescription& ball = made.ball(0.1, Vec3(0, 0.2, 0));
            ball.velocity = Vec3(speed, 0, 0);
            ball.fast = fast;
            World world(made.scene);
            world.listen({.sensors = true});
            std::vector<std::uint32_t> came, left;
            for (int i = 0; i < 60 + static_cast<int>(120 / speed); ++i) {
                world.step();
                for (const TouchEvent& event : world.events().sensed) came.push_back(event.a.index);
                for (const TouchEvent& event : world.events().left) left.push_back(event.a.index);
            }
            EXPECT_EQ(came, (std::vector<std::uint32_t>{0, 1, 2})) << speed;
            EXPECT_EQ(left, (std::vector<std::uint32_t>{0, 1, 2})) << speed;
        }
    }
}

TEST(Sensors, ThatMoveSenseWhatTheyComeTo)
{
    SceneOf made;
    made.floor();
    made.box(Vec3(0.5, 0.5, 0.5), Vec3(3, 0, 0.5)).motion = Motion::static_;
    BodyDescription& gate = add_sensor(made, Vec3(0.1, 1, 1), Vec3(0, 0, 1.5));
    gate.motion = Motion::kinematic;
    gate.velocity = Vec3(1, 0, 0);
    World world(made.scene);
    world.listen({.sensors = true});
    const BodyId wall = world.bodies()[1], sensor = world.bodies()[2];
    bool met = false;
    for (int i = 0; i < 360; ++i) {
        world.step();
        for (const TouchEvent& event : world.events().sensed) met = met || event.b == wall;
    }
    EXPECT_TRUE(met);
    EXPECT_TRUE(world.sensed(sensor).empty());  // it hangs above the floor, and has passed by
    // A dynamic one falls through the floor, and senses it.
    world.set_motion(sensor, Motion::dynamic);
    world.step(60);
    EXPECT_LT(world.pose(sensor).position.z(), 0);
    EXPECT_EQ(world.sensed(sensor), std::vector<BodyId>{world.bodies()[0]});
}

TEST(Sensors, EndWithWhoeverIsRemoved)
{
    SceneOf made;
    add_sensor(made, Vec3(1, 1, 1), Vec3(0, 0, 0));
    made.scene.gravity = Vec3::Zero();
    made.ball(0.25, Vec3(0, 0, 0));
    made.ball(0.25, Vec3(0.6, 0, 0));
    World world(made.scene);
    world.listen({.sensors = true});
    world.step();
    ASSERT_EQ(world.events().sensed.size(), 2u);
    const std::vector<BodyId> ids = world.bodies();
    world.remove({&ids[1], 1});
    SceneOf next;
    next.ball(0.25, Vec3(0, 0, 0));
    const BodyId same_place = world.add(next.scene)[0];
    ASSERT_EQ(same_place.index, ids[1].index);
    world.step();
    ASSERT_EQ(world.events().left.size(), 1u);
    EXPECT_EQ(world.events().left[0].b, ids[1]);
    ASSERT_EQ(world.events().sensed.size(), 1u);
    EXPECT_EQ(world.events().sensed[0].b, same_place);
    world.remove({&ids[0], 1});
    world.step();
    EXPECT_EQ(world.events().left.size(), 2u);
    EXPECT_FALSE(world.effects().on.has(Effect::sensors));
}

TEST(Sensors, FollowFiltersAndAreSwitched)
{
    SceneOf made;
    made.scene.gravity = Vec3::Zero();
    made.box(Vec3(1, 1, 1), Vec3(0, 0, 0)).motion = Motion::static_;
    made.ball(0.25, Vec3(3, 0, 0)).velocity = Vec3(-2, 0, 0);
    made.scene.bodies[1].group = 2;
    World world(made.scene);
    world.listen({.touches = true, .sensors = true});
    const BodyId box = world.bodies()[0], ball = world.bodies()[1];
    world.set_sensor(box, true);
    EXPECT_TRUE(world.sensor(box));
    world.set_filter(box, 1, 1);
    EXPECT_EQ(world.mask(box), 1u);
    world.step(75);
    EXPECT_TRUE(world.sensed(box).empty());
    world.set_filter(box, 1, 3);
    world.step(1);
    EXPECT_EQ(world.sensed(box), std::vector<BodyId>{ball});
    EXPECT_FALSE(Queries(world).blocked({Vec3(0, 0, 9), Vec3(0, 0, -1), 8.5}));
    world.set_sensor(box, false);
    EXPECT_EQ(world.group(box), 1u);
    world.step();
    EXPECT_EQ(world.events().left.size(), 1u);
    EXPECT_EQ(world.events().begun.size(), 1u);
    EXPECT_THROW(world.sensed(box), std::invalid_argument);
}

TEST(Sensors, AreRefusedOfWhatCannotBeOne)
{
    SceneOf made;
    made.floor().sensor = true;
    EXPECT_NE(check_scene(made.scene).find("bodies[0].sensor: wanted a convex shape"),
              std::string::npos);
    made.scene.bodies[0].sensor = false;
    World world(made.scene);
    EXPECT_THROW(world.set_sensor(world.bodies()[0], true), std::invalid_argument);
}

// Who overlaps whom, found by asking about each two.
std::set<std::pair<std::uint32_t, std::uint32_t>>
brute_force(const World& world, std::uint32_t sensors, const std::vector<ShapeQuery>& boxes)
{
    std::set<std::pair<std::uint32_t, std::uint32_t>> found;
    Queries queries(world);
    for (std::uint32_t i = 0; i < sensors; ++i)
        for (const BodyId body : queries.find_overlaps(boxes[i]))
            if (world.motion(body) != Motion::static_) found.insert({i, body.index});
    return found;
}

class SensorScenes : public testing::TestWithParam<const char*> { };

TEST_P(SensorScenes, AreWhatAskingAboutEachTells)
{
    const std::string name = GetParam();
    const auto colon = name.find(':');
    const Scene scene = make_scene(name.substr(0, colon), std::stoi(name.substr(colon + 1)));
    World world(scene), threads(scene, 3), alone(scene);
    // Boxes all over the place.
    Box3 space;
    for (const BodyId body : alone.bodies()) {
        if (alone.motion(body) == Motion::static_) continue;
        space = joined(space, {alone.pose(body).position, alone.pose(body).position});
    }
    Random random(5);
    SceneOf boxes;
    std::vector<ShapeQuery> queries;
    constexpr std::uint32_t kSensors = 12;
    for (std::uint32_t i = 0; i < kSensors; ++i) {
        Vec3 at;
        for (int k = 0; k < 3; ++k) at[k] = random.uniform(space.lower[k], space.upper[k]);
        at.z() *= 0.6;
        const Vec3 half(random.uniform(0.2, 1.5), random.uniform(0.2, 1.5), random.uniform(0.2, 1));
        add_sensor(boxes, half, at);
        queries.push_back({BoxShape{half}, {at, Quat::Identity()}});
    }
    std::vector<BodyId> ids;
    for (World* each : {&world, &threads}) {
        ids = each->add(boxes.scene);
        each->listen({.sensors = true});
    }
    std::map<std::uint32_t, std::uint32_t> sensor_of;
    for (std::uint32_t i = 0; i < kSensors; ++i) sensor_of[ids[i].index] = i;
    std::set<std::pair<std::uint32_t, std::uint32_t>> told;
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> parts;  // of a body that are inside
    std::size_t events = 0;
    for (int i = 0; i < 90; ++i) {
        world.step();
        threads.step();
        alone.step();
        for (const TouchEvent& event : world.events().sensed)
            if (++parts[{sensor_of[event.a.index], event.b.index}] == 1)
                told.insert({sensor_of[event.a.index], event.b.index});
        for (const TouchEvent& event : world.events().left)
            if (--parts[{sensor_of[event.a.index], event.b.index}] == 0)
                told.erase({sensor_of[event.a.index], event.b.index});
        events += world.events().sensed.size();
        ASSERT_EQ(told, brute_force(alone, kSensors, queries)) << "step " << i;
        const auto same = [](const auto& a, const auto& b) {
            return static_cast<const TouchingParts&>(a) == static_cast<const TouchingParts&>(b);
        };
        ASSERT_TRUE(std::ranges::equal(world.events().sensed, threads.events().sensed, same));
        ASSERT_TRUE(std::ranges::equal(world.events().left, threads.events().left, same));
    }
    // Nobody felt them.
    for (const BodyId body : alone.bodies())
        ASSERT_EQ(alone.pose(body).position, world.pose(body).position);
    EXPECT_GT(events, 0u);
}

INSTANTIATE_TEST_SUITE_P(Catalogue,
                         SensorScenes,
                         testing::Values("pile:80",
                                         "spheres:80",
                                         "hulls:60",
                                         "stacks:60",
                                         "tumbler:40",
                                         "crowd:60",
                                         "meshes:30",
                                         "bouncing:30"));

}  // namespace
}  // namespace throng
