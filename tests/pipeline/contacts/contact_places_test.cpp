// Contact places: a contact stays where it is while its pair touches; no place is lost or had
// twice.
#include "pipeline/contacts/recycled_manifolds.hpp"
#include "pipeline/step/stages.hpp"
#include "pipeline/world/world_state.hpp"
#include "tests/support/small_scenes.hpp"
#include "throng/catalog.hpp"

#include <gtest/gtest.h>

#include <map>

namespace throng {
namespace {

template <class Real>
ConvexContacts<Real>& contacts_of(World& world)
{
    return std::get<ConvexContacts<Real>>(std::get<Step<Real>>(state_of(world).step).data);
}

// Contacts of those who sleep.
template <class Real>
std::size_t asleep(World& world)
{
    const auto& sleeping =
        std::get<SleepingContacts<Real>>(std::get<Step<Real>>(state_of(world).step).data);
    return sleeping.contacts.size() - sleeping.free_contacts.size();
}

// Looks at a world step after step.
template <class Real>
class Places {
public:
    explicit Places(World& world) : world_(world) { }

    /// After a step.
    void check()
    {
        const auto& contacts = contacts_of<Real>(world_);
        const auto& keys = state_of(world_).get<Pairs>().keys;
        ASSERT_EQ(contacts.of_pair.size(), keys.size());
        std::vector<int> holders(contacts.contacts.size(), 0);
        std::map<PairKey, std::uint32_t> now;
        std::size_t came = 0;
        for (std::size_t i = 0; i < keys.size(); ++i)
            came += contacts.at(i) != nullptr && !last_.contains(keys[i]) ? 1 : 0;
        // All are put in order once many came; until then whoever touches on keeps its place.
        const bool ordered = contacts.strayed == 0 && strayed_ + came > 0;
        strayed_ = contacts.strayed;
        orders += ordered ? 1 : 0;
        for (std::size_t i = 0; i < keys.size(); ++i) {
            const std::uint32_t place = contacts.of_pair[i].contact;
            ASSERT_EQ(contacts.at(i) == nullptr, place == PairState::kApart);
            if (place == PairState::kApart) continue;
            ASSERT_LT(place, contacts.contacts.size());
            ++holders[place];
            ASSERT_GE(contacts.contacts[place].count, 1);
            ASSERT_LE(contacts.contacts[place].count, 4);
            now[keys[i]] = place;
            if (ordered) {
                ASSERT_EQ(place, now.size() - 1);
            }
            const auto before = last_.find(keys[i]);
            if (before != last_.end()) {
                if (!ordered) {
                    ASSERT_EQ(place, before->second);
                }
                ++kept;
            } else {
                ++begun;
            }
        }
        std::size_t ended_now = 0;
        for (const auto& [key, place] : last_) ended_now += now.contains(key) ? 0 : 1;
        ended += ended_now;
        ASSERT_EQ(contacts.contacts.size() - contacts.free.size(), now.size());
        for (const std::uint32_t place : contacts.free) ++holders.at(place);
        for (const int times : holders) ASSERT_EQ(times, 1);
        // A place is made only where none is free; what wakes comes before all that ends has, and
        // may end at once.
        const std::size_t asleep_now = asleep<Real>(world_),
                          woke = asleep_ - std::min(asleep_, asleep_now);
        asleep_ = asleep_now;
        most_ = ordered ? now.size() : std::max(most_, now.size() + ended_now + woke);
        ASSERT_LE(contacts.contacts.size(), most_);
        last_ = std::move(now);
    }

    std::size_t kept = 0, orders = 0, begun = 0, ended = 0;

private:
    World& world_;
    std::map<PairKey, std::uint32_t> last_;
    std::size_t most_ = 0, strayed_ = 0, asleep_ = 0;
};

TEST(ContactPlaces, NoneLeaksWhileATumblerTurns)
{
    for (const int threads : {1, 2}) {
        World world(make_scene("tumbler", 100), threads);
        Places<float> places(world);
        for (int step = 0; step < 250; ++step) {
            world.step();
            ASSERT_NO_FATAL_FAILURE(places.check()) << "step " << step;
        }
        // Enough came and went for this to say something.
        EXPECT_GT(places.begun, 300u);
        EXPECT_GT(places.ended, 100u);
        EXPECT_GT(places.kept, 10000u);
        EXPECT_GT(places.orders, 5u);
    }
}

TEST(ContactPlaces, NoneLeaksWhenBodiesAreTakenAwayOrFallAsleep)
{
    Scene scene = make_scene("pile", 100);
    scene.settings.precision = Precision::double_;
    World world(scene);
    Places<double> places(world);
    std::size_t next = 0;
    for (int step = 0; step < 300; ++step) {
        if (step % 10 == 9) {
            const std::vector<BodyId> bodies = world.bodies();
            next = (next + 7) % bodies.size();
            if (world.motion(bodies[next]) == Motion::dynamic)
                world.remove(std::span(bodies).subspan(next, 1));
        }
        world.step();
        ASSERT_NO_FATAL_FAILURE(places.check()) << "step " << step;
    }
    EXPECT_LT(world.body_count(), 90u);
    EXPECT_GT(places.ended, 50u);
}

// How many contacts of hulls say what was found of their own pair.
template <class Real>
std::size_t count_found(World& world)
{
    const auto& contacts = contacts_of<Real>(world);
    const auto& keys = state_of(world).get<Pairs>().keys;
    const Shapes& shapes = state_of(world).get<Shapes>();
    const Colliders& colliders = state_of(world).get<Colliders>();
    const Bounds& bounds = state_of(world).get<Bounds>();
    std::size_t count = 0;
    EXPECT_EQ(contacts.found.size(), contacts.contacts.size());
    EXPECT_EQ(contacts.apart_until.size(), keys.size());
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const PairPlace pair = place_of(keys[i], colliders, bounds);
        const Contact<Real>* const contact = contacts.at(i);
        if (!contact || !is_recycled(colliders.shape[pair.a].kind, colliders.shape[pair.b].kind))
            continue;
        PairCache cache;
        CachedManifold<Real> told;
        const CachedManifold<Real>& kept = contacts.found[contacts.of_pair[i].contact];
        EXPECT_FALSE(find_or_recycle(shapes, colliders, bounds, pair, &kept, cache, told));
        EXPECT_EQ(told.manifold.count, contact->count);
        for (std::size_t k = 0; k < static_cast<std::size_t>(contact->count); ++k)
            EXPECT_EQ(told.manifold.points[k].feature, contact->points[k].feature);
        ++count;
    }
    return count;
}

template <class Real>
void check_what_was_found(int threads)
{
    Scene scene = make_scene("hulls", 150);
    scene.settings.sleep = false;
    scene.settings.precision =
        std::is_same_v<Real, double> ? Precision::double_ : Precision::float_;
    World world(scene, threads);
    Places<Real> places(world);
    std::size_t count = 0;
    for (int step = 0; step < 150; ++step) {
        if (step % 30 == 29) {
            const std::vector<BodyId> bodies = world.bodies();
            world.remove(std::span(bodies).subspan(bodies.size() / 2, 1));
        }
        world.step();
        ASSERT_NO_FATAL_FAILURE(places.check()) << "step " << step;
        count += count_found<Real>(world);
        ASSERT_FALSE(::testing::Test::HasFailure()) << "step " << step;
    }
    EXPECT_GT(places.orders, 5u);
    EXPECT_GT(count, 5000u);
}

TEST(ContactPlaces, WhatWasFoundFollowsItsContactInFloat) { check_what_was_found<float>(2); }
TEST(ContactPlaces, WhatWasFoundFollowsItsContactInDouble) { check_what_was_found<double>(1); }

TEST(ContactPlaces, ScenesWithoutHullsKeepNothingOfWhatWasFound)
{
    World world(make_scene("pile", 100));
    for (int step = 0; step < 30; ++step) world.step();
    const auto& contacts = contacts_of<float>(world);
    EXPECT_GT(contacts.contacts.size(), 0u);
    EXPECT_EQ(contacts.found.capacity() + contacts.scratch.found_gathered.capacity(), 0u);
    EXPECT_EQ(contacts.apart_until.capacity() + contacts.travels.approach.capacity(), 0u);
}

// Balls of radius a half in a row.
struct Row {
    World world;
    std::vector<BodyId> balls;

    Row(std::initializer_list<double> places) : world(Settings{})
    {
        given::SceneOf made;
        for (const double x : places) made.ball(0.5, Vec3(x, 0, 0));
        balls = world.add(made.scene);
    }
    ConvexContacts<float>& contacts() { return contacts_of<float>(world); }
    void put(std::size_t ball, double x)
    {
        world.set_pose(balls[ball], {Vec3(x, 0, 0), Quat::Identity()});
        world.set_velocity(balls[ball], Vec3::Zero(), Vec3::Zero());
    }
    float impulse(std::size_t place) { return contacts().contacts[place].points[0].impulse; }
};

TEST(ContactPlaces, AFreePlaceIsTakenAgainWithoutWhatWasInIt)
{
    Row row({0, 0.98, 10, 10.98, 20});
    row.world.step();
    ASSERT_EQ(row.contacts().contacts.size(), 2u);
    // The first pair parts, and others meet: just, so that nothing pushes.
    row.put(1, 5);
    row.put(4, -0.9999999);
    row.contacts().contacts[0].points[0].impulse = 1e6f;
    row.world.step();
    EXPECT_EQ(row.contacts().contacts.size(), 2u);
    EXPECT_EQ(row.contacts().free.size(), 0u);
    EXPECT_LT(row.impulse(0), 1);
    EXPECT_LT(given::greatest_speed(row.world), 3.1);
}

TEST(ContactPlaces, APairThatComesBackBeginsAnew)
{
    Row row({0, 0.98});
    row.world.step();
    row.contacts().contacts[0].points[0].impulse = 1e6f;
    // Apart, but near enough to stay a pair.
    row.put(1, 1.04);
    row.put(0, 0);
    row.world.step();
    ASSERT_EQ(state_of(row.world).get<Pairs>().keys.size(), 1u);
    ASSERT_EQ(row.contacts().free.size(), 1u);
    row.put(1, 0.98);
    row.put(0, 0);
    row.world.step();
    EXPECT_EQ(row.contacts().free.size(), 0u);
    EXPECT_LT(given::greatest_speed(row.world), 3.1);
}

}  // namespace
}  // namespace throng
