// What the dial effects=auto leaves out: no more than it promises, and not for longer.
#include "pipeline/step/neglect.hpp"
#include "tests/kernels/solver/random_contacts.hpp"
#include "tests/support/small_scenes.hpp"
#include "throng/catalog.hpp"
#include "throng/effect_ledger.hpp"
#include "throng/world.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

using given::SceneOf;

constexpr int kSteps = 6;  // of 1/60 s: the time that the promise is for

World world_of(Scene scene, EffectChoice effects, int threads = 1)
{
    scene.settings.effects = effects;
    return World(scene, threads);
}

EffectEntry entry_of(World& world, Effect effect)
{
    return effect_ledger(world, {})[static_cast<std::size_t>(effect)];
}

// Put where a body is by another world, so that both have the same bits.
void put_alike(BodyId body,
               const World& from,
               const Vec3& spin,
               std::initializer_list<World*> worlds)
{
    const Pose pose = from.pose(body);
    const Vec3 velocity = from.velocity(body);
    for (World* world : worlds) {
        world->set_pose(body, pose);
        world->set_velocity(body, velocity, spin);
    }
}

// Boxes of all proportions in flight, slow and fast, far apart.
Scene tops(double fastest)
{
    SceneOf made;
    made.scene.gravity = Vec3::Zero();
    std::mt19937 random(7);
    for (int i = 0; i < 300; ++i) {
        const Vec3 half(given::random_number(random, 0.1, 1), given::random_number(random, 0.1, 1),
                        given::random_number(random, 0.1, 1));
        BodyDescription& body = made.box(half, Vec3(10.0 * i, 0, 0));
        body.angular_velocity = given::random_vector(random, fastest);
        body.orientation = exponential(given::random_vector(random, 2));
    }
    return made.scene;
}

TEST(NeglectEffects, NoTopIsOffByMoreThanIsPromised)
{
    const Scene scene = tops(2);
    World full = world_of(scene, EffectChoice::called), less = world_of(scene, EffectChoice::auto_);
    const double promised = kOfError * scene.settings.effects_error;
    double worst = 0;
    std::size_t neglected = 0, alike = 0;
    for (int step = 0; step < kSteps; ++step) {
        full.step();
        less.step();
        const EffectEntry entry = entry_of(less, Effect::gyroscopic);
        EXPECT_LE(entry.bound, promised);
        EXPECT_EQ(entry_of(full, Effect::gyroscopic).neglected, 0u);
        neglected = entry.neglected;
    }
    for (const BodyId body : full.bodies()) {
        const Quat is = less.pose(body).orientation, should_be = full.pose(body).orientation;
        worst = std::max(worst, is.angularDistance(should_be));
        alike += is.coeffs() == should_be.coeffs() ? 1 : 0;
    }
    EXPECT_LE(worst, 1.01 * promised);
    EXPECT_GT(worst, 0.2 * promised);  // there was something to leave out
    EXPECT_GT(neglected, 100u);
    EXPECT_GT(alike, 50u);  // fast ones go on by the same bits
    EXPECT_LE(neglected + alike, 310u);
}

TEST(NeglectEffects, WhoSpinsUpHasHisTorqueBack)
{
    World full = world_of(tops(0.5), EffectChoice::called),
          less = world_of(tops(0.5), EffectChoice::auto_);
    const std::vector<BodyId> bodies = full.bodies();
    less.step(20);
    EXPECT_GT(entry_of(less, Effect::gyroscopic).neglected, 290u);
    std::mt19937 random(3);
    for (const BodyId body : bodies)
        put_alike(body, less, given::random_vector(random, 1).normalized() * 60, {&full, &less});
    full.step(kSteps);
    less.step(kSteps);
    EXPECT_LT(entry_of(less, Effect::gyroscopic).neglected, 20u);
    std::size_t alike = 0;
    for (const BodyId body : bodies)
        alike += less.pose(body).orientation.coeffs() == full.pose(body).orientation.coeffs();
    EXPECT_GT(alike, 280u);
}

TEST(NeglectEffects, AsCalledOnceTheDialSaysSo)
{
    World world = world_of(tops(2), EffectChoice::auto_);
    world.step(5);
    EXPECT_GT(entry_of(world, Effect::gyroscopic).neglected, 100u);
    Settings settings = world.settings();
    settings.effects = EffectChoice::called;
    world.set_settings(settings);
    World full = world_of(tops(2), EffectChoice::called);
    for (const BodyId body : world.bodies())
        put_alike(body, world, world.angular_velocity(body), {&full, &world});
    world.step(kSteps);
    full.step(kSteps);
    EXPECT_EQ(entry_of(world, Effect::gyroscopic).neglected, 0u);
    for (const BodyId body : world.bodies())
        EXPECT_EQ(world.pose(body).orientation.coeffs(), full.pose(body).orientation.coeffs());
}

// Balls that roll out, on a floor that leans.
Scene rolling(double lean)
{
    SceneOf made;
    made.scene.materials[0].friction = 0.6;
    made.scene.materials[0].rolling_friction = 0.05;
    const Quat turned(Eigen::AngleAxisd(lean, Vec3::UnitY()));
    BodyDescription& floor = made.box(Vec3(50, 50, 1), turned * Vec3(0, 0, -1));
    floor.orientation = turned;
    floor.motion = Motion::static_;
    for (int i = 0; i < 10; ++i) {
        BodyDescription& ball = made.ball(0.5, turned * Vec3(3 * i - 20, 0, 0.5));
        ball.velocity = turned * Vec3(0.1 * i, 0, 0);
        ball.angular_velocity = turned * Vec3(0, 0.2 * i, 0);
    }
    return made.scene;
}

TEST(NeglectEffects, RollingFrictionIsLeftOutOfWhatItDoesNotHold)
{
    for (const double lean : {0.0, 0.02}) {
        World full = world_of(rolling(lean), EffectChoice::called),
              less = world_of(rolling(lean), EffectChoice::auto_);
        std::size_t neglected = 0;
        for (int step = 0; step < 600; ++step) {
            full.step();
            less.step();
            const EffectEntry entry = entry_of(less, Effect::rolling_friction);
            EXPECT_LE(entry.bound, kOfError * full.settings().effects_error);
            neglected += entry.neglected;
        }
        // On a slope it is what holds a ball.
        EXPECT_EQ(neglected > 0, lean == 0) << lean;
        EXPECT_EQ(less.report().bodies_awake, 0u);
        for (const BodyId body : full.bodies()) {
            const double off = (less.center_of_mass(body) - full.center_of_mass(body)).norm();
            EXPECT_LE(off, neglected > 0 ? full.settings().effects_error * 0.5 : 0) << lean;
        }
    }
}

TEST(NeglectEffects, TheSameBitsOnAnyNumberOfThreads)
{
    World one = world_of(make_scene("tumbler", 300), EffectChoice::auto_, 1),
          three = world_of(make_scene("tumbler", 300), EffectChoice::auto_, 3);
    for (int step = 0; step < 60; ++step) {
        one.step();
        three.step();
        ASSERT_EQ(one.state_hash(), three.state_hash()) << step;
    }
    const EffectEntry a = entry_of(one, Effect::gyroscopic),
                      b = entry_of(three, Effect::gyroscopic);
    EXPECT_GT(a.neglected, 200u);
    EXPECT_EQ(a.neglected, b.neglected);
    EXPECT_EQ(a.bound, b.bound);
}

}  // namespace
}  // namespace throng
