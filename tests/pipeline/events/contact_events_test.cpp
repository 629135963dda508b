// Contact events: what is told of touches is what their contacts say, and every begin has its end.
#include "throng/contact_events.hpp"

#include "tests/support/small_scenes.hpp"
#include "throng/catalog.hpp"
#include "throng/world.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <tuple>

namespace throng {
namespace {

using given::SceneOf;

constexpr double kG = 9.81;
constexpr double kNoHits = std::numeric_limits<double>::infinity();

using Parts = std::
    tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>;
Parts key_of(const TouchingParts& of)
{
    return {of.a.index, of.a.generation, of.b.index, of.b.generation, of.part_a, of.part_b};
}

// Who touches, by the contacts that a step left.
std::set<Parts> touching(const World& world)
{
    std::set<Parts> found;
    for (const ContactReport& contact : world.contacts()) {
        bool touches = !contact.force.isZero(0);
        for (const ContactPoint& point : contact.used())
            touches = touches || point.impulse > 0 || point.separation <= 0;
        if (touches) found.insert(key_of(contact));
    }
    return found;
}

// Follows a set through events: each begin is new, and each end was there.
void follow(const Events& events, std::set<Parts>& told)
{
    for (const TouchEvent& event : events.ended) EXPECT_EQ(told.erase(key_of(event)), 1u);
    for (const TouchEvent& event : events.begun) EXPECT_TRUE(told.insert(key_of(event)).second);
}

Scene dropped_box(double height)
{
    SceneOf made;
    made.floor();
    made.box(Vec3(0.5, 0.5, 0.5), Vec3(0, 0, 0.5 + height));
    return made.scene;
}

TEST(ContactEvents, ABoxThatLandsBeginsToTouchOnceAndEndsAsItIsRemoved)
{
    World world(dropped_box(0.1));
    world.listen({.touches = true});
    const BodyId floor = world.bodies()[0], box = world.bodies()[1];
    std::size_t begun = 0;
    for (int i = 0; i < 300; ++i) {
        world.step();
        begun += world.events().begun.size();
        EXPECT_TRUE(world.events().ended.empty());
        for (const TouchEvent& event : world.events().begun) {
            EXPECT_EQ(event.a, floor);
            EXPECT_EQ(event.b, box);
            EXPECT_EQ(event.step, world.report().step);
            // Falls 0.1 m in 0.143 s.
            EXPECT_NEAR(static_cast<double>(event.step) / 60, std::sqrt(0.2 / kG), 1.5 / 60);
        }
    }
    EXPECT_EQ(begun, 1u);
    EXPECT_FALSE(world.awake(box));  // and touches all the same
    world.remove({&box, 1});
    world.step();
    ASSERT_EQ(world.events().ended.size(), 1u);
    EXPECT_EQ(world.events().ended[0].a, floor);
    EXPECT_EQ(world.events().ended[0].b, box);
    world.step();
    EXPECT_TRUE(world.events().ended.empty());
}

TEST(ContactEvents, WhoTakesThePlaceOfWhoIsRemovedIsToldApart)
{
    World world(dropped_box(0));
    world.listen({.touches = true});
    world.step(5);
    const BodyId box = world.bodies()[1];
    world.remove({&box, 1});
    SceneOf other;
    other.box(Vec3(0.5, 0.5, 0.5), Vec3(0, 0, 0.5));
    const BodyId next = world.add(other.scene)[0];
    ASSERT_EQ(next.index, box.index);
    // Asked in between, nothing is lost.
    EXPECT_TRUE(world.contacts().empty());
    world.step();
    ASSERT_EQ(world.events().ended.size(), 1u);
    EXPECT_EQ(world.events().ended[0].b, box);
    ASSERT_EQ(world.events().begun.size(), 1u);
    EXPECT_EQ(world.events().begun[0].b, next);
}

TEST(ContactEvents, SleepersThatArePushedGoOnTouching)
{
    World world(dropped_box(0));
    world.listen({.touches = true});
    world.step(200);
    EXPECT_EQ(world.events().begun.size(), 1u);
    const BodyId box = world.bodies()[1];
    ASSERT_FALSE(world.awake(box));
    world.set_velocity(box, Vec3(0.3, 0, 0), Vec3(0, 0, 0));
    world.step(20);
    EXPECT_TRUE(world.events().begun.empty());
    EXPECT_TRUE(world.events().ended.empty());
    world.step(200);
    ASSERT_FALSE(world.awake(box));
    // Put elsewhere as it sleeps.
    Pose pose = world.pose(box);
    pose.position.z() += 5;
    world.set_pose(box, pose);
    world.step(3);
    EXPECT_EQ(world.events().ended.size(), 1u);
    EXPECT_TRUE(world.events().begun.empty());
}

class EventScenes : public testing::TestWithParam<const char*> { };

TEST_P(EventScenes, AreWhatTheContactsSay)
{
    const std::string name = GetParam();
    const auto colon = name.find(':');
    Scene scene = make_scene(name.substr(0, colon), std::stoi(name.substr(colon + 1)));
    World world(scene), threads(scene, 3), unheard(scene);
    for (World* each : {&world, &threads}) each->listen({.touches = true, .hit_speed = 0.5});
    std::set<Parts> told;
    for (int i = 0; i < 90; ++i) {
        world.step();
        threads.step();
        unheard.step();
        follow(world.events(), told);
        ASSERT_EQ(told, touching(world)) << "step " << i;
        const Events &one = world.events(), &other = threads.events();
        const auto same = [](const auto& a, const auto& b) {
            return key_of(a) == key_of(b) && a.step == b.step;
        };
        EXPECT_TRUE(std::ranges::equal(one.begun, other.begun, same));
        EXPECT_TRUE(std::ranges::equal(one.ended, other.ended, same));
        EXPECT_TRUE(std::ranges::equal(one.hits, other.hits, [&](const auto& a, const auto& b) {
            return same(a, b) && a.speed == b.speed && a.point == b.point && a.normal == b.normal;
        }));
        for (const HitEvent& hit : one.hits) {
            EXPECT_GE(hit.speed, 0.5);
            EXPECT_TRUE(told.contains(key_of(hit)));
        }
    }
    // Who listens changes nothing.
    EXPECT_EQ(world.state_hash(), unheard.state_hash());
    // All that go cease to touch.
    const std::vector<BodyId> all = world.bodies();
    world.remove(all);
    world.step();
    follow(world.events(), told);
    EXPECT_TRUE(told.empty());
}

TEST_P(EventScenes, ForcesOfContactsAddUpToThoseOnBodies)
{
    const std::string name = GetParam();
    const auto colon = name.find(':');
    World world(make_scene(name.substr(0, colon), std::stoi(name.substr(colon + 1))));
    world.step(60);
    std::vector<Vec3> sum(world.bodies().size(), Vec3::Zero());
    for (const ContactReport& contact : world.contacts()) {
        sum[contact.a.index] -= contact.force;
        sum[contact.b.index] += contact.force;
        EXPECT_NEAR(contact.normal.norm(), 1, 1e-6);
        EXPECT_GT(contact.count, 0);
    }
    for (const BodyId body : world.bodies()) {
        const Vec3 force = world.contact_force(body);
        EXPECT_LT((sum[body.index] - force).norm(), 1e-9 * (1 + force.norm()) + 1e-6) << body.index;
    }
}

INSTANTIATE_TEST_SUITE_P(Catalogue,
                         EventScenes,
                         testing::Values("pile:60",
                                         "spheres:60",
                                         "hulls:40",
                                         "stacks:40",
                                         "pyramid:55",
                                         "tumbler:40",
                                         "crowd:60",
                                         "sparse:40",
                                         "meshes:12",
                                         "bouncing:30",
                                         "rolling:40",
                                         "cradle:5",
                                         "dominoes:12",
                                         "card_house:3",
                                         "knots:3",
                                         "chain:6",
                                         "bullet_plate:3",
                                         "spring:3",
                                         "hills:30",
                                         "mixed:40"));

TEST(ContactEvents, ContactsTellWhereAndHowHardABoxRests)
{
    World world(dropped_box(0));
    world.step(60);
    const BodyId box = world.bodies()[1];
    const auto contacts = world.contacts();
    ASSERT_EQ(contacts.size(), 1u);
    EXPECT_EQ(contacts[0].b, box);
    EXPECT_NEAR(contacts[0].normal.z(), 1, 1e-6);
    EXPECT_NEAR(contacts[0].force.z(), kG * world.mass(box), 1e-3 * kG * world.mass(box));
    ASSERT_EQ(contacts[0].count, 4);
    for (const ContactPoint& point : contacts[0].used()) {
        EXPECT_NEAR(std::abs(point.position.x()), 0.5, 1e-3);
        EXPECT_NEAR(std::abs(point.position.y()), 0.5, 1e-3);
        EXPECT_NEAR(point.position.z(), 0, 1e-6);
        EXPECT_NEAR(point.separation, 0, 1e-3);
        EXPECT_GT(point.impulse, 0);
    }
}

TEST(ContactEvents, AHitIsToldAtItsSpeed)
{
    for (const double restitution : {0.0, 0.8}) {
        Scene scene = dropped_box(2);
        scene.materials.push_back({.name = "", .restitution = restitution});
        for (BodyDescription& body : scene.bodies) body.material = 0;
        World world(scene);
        world.listen({.hit_speed = 3});
        std::vector<HitEvent> hits;
        for (int i = 0; i < 60; ++i) {
            world.step();
            EXPECT_TRUE(world.events().begun.empty());
            hits.insert(hits.end(), world.events().hits.begin(), world.events().hits.end());
        }
        ASSERT_EQ(hits.size(), 1u);
        EXPECT_NEAR(hits[0].speed, std::sqrt(2 * kG * 2), kG / 60);
        EXPECT_NEAR(hits[0].normal.z(), 1, 1e-6);
        EXPECT_NEAR(hits[0].point.z(), 0, 1e-6);
    }
}

TEST(ContactEvents, StepsOfOneCallAreToldTogether)
{
    World at_once(dropped_box(0.05)), each(dropped_box(0.05));
    at_once.listen({.touches = true});
    each.listen({.touches = true});
    at_once.step(30);
    std::vector<TouchEvent> begun;
    for (int i = 0; i < 30; ++i) {
        each.step();
        begun.insert(begun.end(), each.events().begun.begin(), each.events().begun.end());
    }
    ASSERT_EQ(at_once.events().begun.size(), begun.size());
    for (std::size_t i = 0; i < begun.size(); ++i)
        EXPECT_EQ(at_once.events().begun[i].step, begun[i].step);
}

TEST(ContactEvents, NobodyWhoDoesNotListenHasThemInHisStep)
{
    World world(dropped_box(0));
    const auto has = [&] {
        for (const auto& stage : world.step_stages())
            if (stage.name == "find_touching_pairs") return true;
        return false;
    };
    EXPECT_FALSE(has());
    world.listen({.touches = true});
    EXPECT_TRUE(has());
    EXPECT_EQ(world.effects().cause_of(Effect::events), "program listens");
    world.step(3);
    world.listen({});
    EXPECT_FALSE(has());
    world.step(3);
    EXPECT_TRUE(world.events().begun.empty());
}

TEST(ContactEvents, ListeningAgainLosesNothingAndTellsOfNothingTwice)
{
    World world(dropped_box(0));
    const BodyId box = world.bodies()[1];
    world.listen({.touches = true});
    world.step(200);
    ASSERT_FALSE(world.awake(box));
    // Its pairs come back as this is done, before they are followed.
    world.set_velocity(box, Vec3(0.1, 0, 0), Vec3::Zero());
    EXPECT_EQ(world.contacts().size(), 1u);
    world.listen({.touches = true, .hit_speed = 3});
    world.step(3);
    EXPECT_TRUE(world.events().begun.empty());
    EXPECT_TRUE(world.events().ended.empty());
    // Who hears of hits alone is told of all that touch once he wants to.
    world.listen({.hit_speed = 3});
    world.step(3);
    EXPECT_TRUE(world.events().begun.empty());
    world.listen({.touches = true});
    world.step();
    EXPECT_EQ(world.events().begun.size(), 1u);
    world.remove({&box, 1});
    world.step();
    EXPECT_EQ(world.events().ended.size(), 1u);
}

TEST(ContactEvents, AreInTheOrderOfBodiesWhateverPlacesTheirShapesTake)
{
    SceneOf made;
    made.scene.gravity = Vec3::Zero();
    for (int i = 0; i < 3; ++i) made.ball(0.5, Vec3(0.9 * i, 0, 0));
    World world(made.scene);
    world.listen({.touches = true});
    // The first gives its place to a body of two shapes, which find room behind all others.
    const BodyId first = world.bodies()[0];
    world.remove({&first, 1});
    SceneOf next;
    const std::uint32_t ball = next.shape(SphereShape{0.5});
    next.body(
        next.shape(CompoundShape{{{ball, Pose{}}, {ball, {Vec3(0, 2, 0), Quat::Identity()}}}}),
        Vec3(0, 0, 0));
    ASSERT_EQ(world.add(next.scene)[0].index, 0u);
    world.step();
    const std::vector<TouchEvent>& begun = world.events().begun;
    ASSERT_EQ(begun.size(), 2u);
    EXPECT_EQ(begun[0].a.index, 1u);
    EXPECT_EQ(begun[0].b.index, 0u);
    EXPECT_EQ(begun[1].a.index, 1u);
    EXPECT_EQ(begun[1].b.index, 2u);
}

TEST(ContactEvents, WhereNoContactsAreKeptThatIsSaid)
{
    Scene scene = dropped_box(0);
    scene.settings.overlap = Overlap::back_up;
    World world(scene);
    EXPECT_TRUE(world.warnings().empty());
    world.listen({.touches = true});
    world.listen({.touches = true});
    ASSERT_EQ(world.warnings().size(), 1u);
    EXPECT_EQ(world.warnings()[0].rfind("listen: overlap=back_up keeps no list of contacts", 0),
              0u);
    world.step();
    EXPECT_TRUE(world.events().begun.empty());
}

TEST(ContactEvents, ASpeedThatIsNoneIsRefused)
{
    World world(dropped_box(0));
    for (const double speed : {0.0, -1.0, std::nan("")})
        EXPECT_THROW(world.listen({.hit_speed = speed}), std::invalid_argument);
    EXPECT_NO_THROW(world.listen({.hit_speed = kNoHits}));
}

}  // namespace
}  // namespace throng
