// Body changes: what is changed of a body between steps is as if it had been stated so.
#include "pipeline/world/world_state.hpp"
#include "scene/catalog/random.hpp"
#include "tests/support/small_scenes.hpp"
#include "throng/scene_file.hpp"
#include "throng/world.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

namespace throng {
namespace {

using given::mixed_scene;
using given::SceneOf;

constexpr double kG = 9.81, kDt = 1.0 / 60;

// A floor, and a box beside a tower that it does not touch.
Scene box_in_air(Motion motion, double height = 3)
{
    SceneOf made;
    made.floor();
    made.box(Vec3(0.5, 0.3, 0.2), Vec3(0, 0, height)).motion = motion;
    for (int i = 0; i < 3; ++i) made.box(Vec3(0.5, 0.5, 0.5), Vec3(3, 0, 0.5 + i));
    return made.scene;
}

BodyId second(const World& world) { return world.bodies()[1]; }

TEST(BodyChanges, WhoBecomesDynamicFallsAsIfItHadBeen)
{
    for (const Motion motion : {Motion::static_, Motion::kinematic}) {
        World changed(box_in_air(motion)), stated(box_in_air(Motion::dynamic));
        changed.set_motion(second(changed), Motion::dynamic);
        EXPECT_EQ(changed.motion(second(changed)), Motion::dynamic);
        EXPECT_EQ(changed.mass(second(changed)), stated.mass(second(stated)));
        for (int i = 0; i < 120; ++i) {
            changed.step();
            stated.step();
            ASSERT_EQ(changed.pose(second(changed)).position, stated.pose(second(stated)).position);
            ASSERT_EQ(changed.velocity(second(changed)), stated.velocity(second(stated)));
        }
        EXPECT_EQ(changed.state_hash(), stated.state_hash());
    }
}

TEST(BodyChanges, WhoBecomesStaticStaysWhereItIsAndBearsOthers)
{
    SceneOf made;
    made.floor();
    made.box(Vec3(0.5, 0.5, 0.5), Vec3(0, 0, 2));
    made.box(Vec3(0.4, 0.4, 0.4), Vec3(0, 0, 3.2));
    World world(made.scene);
    world.step(10);
    const BodyId low = world.bodies()[1], high = world.bodies()[2];
    world.set_motion(low, Motion::static_);
    const Pose there = world.pose(low);
    EXPECT_EQ(world.mass(low), 0);
    world.step(120);
    EXPECT_EQ(world.pose(low).position, there.position);
    EXPECT_NEAR(world.pose(high).position.z(), there.position.z() + 0.9, 2e-3);
    // And is somebody with the same mass again.
    world.set_motion(low, Motion::dynamic);
    EXPECT_EQ(world.mass(low), 1000);
    world.step(120);
    EXPECT_NEAR(world.pose(low).position.z(), 0.5, 2e-3);
    EXPECT_NEAR(world.pose(high).position.z(), 1.4, 4e-3);
}

TEST(BodyChanges, WhatIsTakenFromUnderASleeperWakesIt)
{
    SceneOf made;
    made.floor();
    made.box(Vec3(0.5, 0.5, 0.5), Vec3(0, 0, 0.5)).motion = Motion::static_;
    made.box(Vec3(0.4, 0.4, 0.4), Vec3(0, 0, 1.4));
    World world(made.scene);
    world.step(200);
    const BodyId low = world.bodies()[1], high = world.bodies()[2];
    ASSERT_FALSE(world.awake(high));
    world.set_filter(low, 1, 0);
    world.step(120);
    EXPECT_NEAR(world.pose(high).position.z(), 0.4, 2e-3);
    EXPECT_EQ(world.mask(low), 0u);
}

TEST(BodyChanges, ACenterOffTheFrameGoesWithTheMotion)
{
    SceneOf made;
    HullShape wedge{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}};
    made.body(made.shape(wedge), Vec3(0, 0, 5)).motion = Motion::kinematic;
    made.scene.gravity = Vec3::Zero();
    World world(made.scene);
    const BodyId body = world.bodies()[0];
    EXPECT_EQ(world.center_of_mass(body), Vec3(0, 0, 5));
    world.set_motion(body, Motion::dynamic);
    EXPECT_LT((world.center_of_mass(body) - Vec3(0.25, 0.25, 5.25)).norm(), 1e-12);
    EXPECT_EQ(world.pose(body).position, Vec3(0, 0, 5));
    world.set_velocity(body, Vec3::Zero(), Vec3(0, 0, 2));
    world.set_motion(body, Motion::kinematic);
    // The frame's own velocity: of a point off the center that turns.
    EXPECT_LT((world.velocity(body) - Vec3(0.5, -0.5, 0)).norm(), 1e-12);
    EXPECT_EQ(world.angular_velocity(body), Vec3(0, 0, 2));
}

TEST(BodyChanges, MassAndInertiaAreThoseGiven)
{
    World world(box_in_air(Motion::dynamic));
    const BodyId box = second(world);
    const Sym3 before = world.inertia(box);
    world.set_mass(box, 2 * world.mass(box));
    EXPECT_EQ(world.mass(box), 2 * 1000 * 8 * 0.5 * 0.3 * 0.2);
    EXPECT_NEAR(world.inertia(box).xx, 2 * before.xx, 1e-9 * before.xx);
    world.set_mass(box, 3, Sym3{1, 2, 2.5, 0, 0, 0});
    EXPECT_EQ(world.inertia(box).yy, 2);
    world.add_angular_impulse(box, Vec3(1, 2, 2.5));
    EXPECT_LT((world.angular_velocity(box) - Vec3(1, 1, 1)).norm(), 1e-12);
    EXPECT_THROW(world.set_mass(box, 0), std::invalid_argument);
    EXPECT_THROW(world.set_mass(box, 1, Sym3{1, 1, 3, 0, 0, 0}), std::invalid_argument);
    EXPECT_EQ(world.mass(box), 3);
}

TEST(BodyChanges, LocksHoldAndLetGo)
{
    World world(box_in_air(Motion::dynamic));
    const BodyId box = second(world);
    world.set_velocity(box, Vec3(1, 0, 0), Vec3(1, 2, 3));
    world.set_locks(box, true, true);
    world.step(30);
    EXPECT_EQ(world.pose(box).position, Vec3(0, 0, 3));
    EXPECT_EQ(world.angular_velocity(box), Vec3(0, 0, 0));
    world.set_locks(box, false, true);
    world.add_impulse(box, Vec3(0, 0, 100), Vec3(0.5, 0, 3));
    world.step(200);
    EXPECT_NEAR(world.pose(box).position.z(), 0.2, 2e-3);
    EXPECT_EQ(world.pose(box).orientation.coeffs(), Quat::Identity().coeffs());
}

TEST(BodyChanges, ConveyorsAndWalkersAreSwitched)
{
    SceneOf made;
    made.floor();
    made.box(Vec3(0.5, 0.5, 0.5), Vec3(0, 0, 0.5));
    World world(made.scene);
    world.step(120);
    const BodyId floor = world.bodies()[0], box = world.bodies()[1];
    ASSERT_FALSE(world.awake(box));
    world.set_drive_velocity(floor, {1.0, std::nullopt, std::nullopt});
    world.step(60);
    EXPECT_NEAR(world.velocity(box).x(), 1, 1e-3);
    world.set_drive_velocity(floor, {});
    world.step(60);
    EXPECT_NEAR(world.velocity(box).x(), 0, 1e-6);
    world.set_drive_velocity(box, {std::nullopt, 2.0, std::nullopt});
    world.step(30);
    EXPECT_NEAR(world.velocity(box).y(), 2, 1e-6);
    world.set_drive_velocity(box, {});
    world.step(120);
    EXPECT_EQ(world.effects().on.has(Effect::drive), false);
    EXPECT_NEAR(world.velocity(box).y(), 0, 1e-6);
}

TEST(BodyChanges, GravityIsScaledAndIsAForceOnlyThen)
{
    Scene scene = box_in_air(Motion::dynamic);
    World world(scene);
    const BodyId box = second(world);
    world.set_gravity_scale(box, 0);
    EXPECT_EQ(world.gravity_scale(box), 0);
    world.step(30);
    EXPECT_LT((world.pose(box).position - Vec3(0, 0, 3)).norm(), 1e-9);
    world.set_gravity_scale(box, -0.5);
    world.set_gravity(Vec3(0, 0, -2));
    world.step(60);
    EXPECT_NEAR(world.velocity(box).z(), 1, 1e-6);
    world.set_mass(box, 5);
    world.step(60);
    EXPECT_NEAR(world.velocity(box).z(), 2, 1e-6);
    world.set_gravity_scale(box, 1);
    EXPECT_FALSE(world.effects().on.has(Effect::forces));

    // As a scene states it.
    scene.bodies[1].gravity_scale = 0.25;
    World stated(scene);
    stated.step(30);
    EXPECT_NEAR(stated.velocity(second(stated)).z(), -0.25 * kG * 0.5, 1e-4);
}

TEST(BodyChanges, UserDataStaysWithTheBodyAndNoOther)
{
    Scene scene = box_in_air(Motion::dynamic);
    scene.bodies[1].user_data = 7;
    World world(scene);
    const BodyId box = second(world);
    EXPECT_EQ(world.user_data(box), 7u);
    world.set_user_data(box, ~std::uint64_t{0});
    EXPECT_EQ(world.user_data(box), ~std::uint64_t{0});
    EXPECT_EQ(world.user_data(world.bodies()[0]), 0u);
    world.remove({&box, 1});
    SceneOf other;
    other.ball(0.2, Vec3(0, 0, 1));
    const BodyId next = world.add(other.scene)[0];
    ASSERT_EQ(next.index, box.index);
    EXPECT_EQ(world.user_data(next), 0u);
    EXPECT_EQ(world.gravity_scale(next), 1);
}

TEST(BodyChanges, ImpulsesAndForcesAtAPointDoWhatTheyShould)
{
    Scene scene = box_in_air(Motion::dynamic);
    scene.gravity = Vec3::Zero();
    World world(scene);
    const BodyId box = second(world);
    const double mass = world.mass(box);
    const Sym3 inertia = world.inertia(box);
    world.add_impulse(box, Vec3(0, 0, 6), Vec3(0.5, 0.3, 3));
    EXPECT_NEAR(world.velocity(box).z(), 6 / mass, 1e-12);
    EXPECT_NEAR(world.angular_velocity(box).x(), 0.3 * 6 / inertia.xx, 1e-9);
    EXPECT_NEAR(world.angular_velocity(box).y(), -0.5 * 6 / inertia.yy, 1e-9);

    world.set_velocity(box, Vec3::Zero(), Vec3::Zero());
    world.add_force(box, Vec3(10 * mass, 0, 0));
    world.add_force(box, Vec3(0, 10 * mass, 0));
    world.add_torque(box, Vec3(0, 0, 3 * inertia.zz));
    EXPECT_TRUE(world.effects().on.has(Effect::forces));
    world.step();
    const Vec3 velocity = world.velocity(box);
    EXPECT_LT((velocity - Vec3(10 * kDt, 10 * kDt, 0)).norm(), 1e-6);
    EXPECT_NEAR(world.angular_velocity(box).z(), 3 * kDt, 1e-6);
    // For that step alone.
    world.step();
    EXPECT_EQ(world.velocity(box), velocity);
    EXPECT_FALSE(world.effects().on.has(Effect::forces));

    // Beside a constant one, which comes back to its very bits.
    world.set_force(box, Vec3(0.1, 0, 0), Vec3::Zero());
    world.add_force(box, Vec3(1.0 / 3, 0, 0), Vec3(0, 0, 3));
    world.step();
    EXPECT_EQ(state_of(world).get<Forces>().force[box.index], Vec3(0.1, 0, 0));
    world.set_force(box, Vec3::Zero(), Vec3::Zero());
    EXPECT_FALSE(world.effects().on.has(Effect::forces));
}

TEST(BodyChanges, APushLastsThroughOtherChangesAndLeavesNothing)
{
    Scene scene = box_in_air(Motion::dynamic);
    World world(scene);
    const BodyId box = second(world);
    const double mass = world.mass(box);
    world.add_force(box, Vec3(60 * mass, 0, 0));
    world.set_gravity(Vec3(0, 0, -3));
    world.set_gravity_scale(box, 0.5);
    world.set_mass(box, 2 * mass);
    world.set_force(box, Vec3(0, 2 * mass, 0), Vec3::Zero());
    world.add_force(box, Vec3(60 * mass, 0, 0));
    world.step();
    EXPECT_NEAR(world.velocity(box).x(), 60 * kDt, 1e-6);
    EXPECT_NEAR(world.velocity(box).y(), kDt, 1e-6);
    EXPECT_NEAR(world.velocity(box).z(), -1.5 * kDt, 1e-6);
    world.step(59);
    EXPECT_NEAR(world.velocity(box).x(), 60 * kDt, 1e-6);
    EXPECT_NEAR(world.velocity(box).y(), 1, 1e-5);
    EXPECT_NEAR(world.velocity(box).z(), -1.5, 1e-5);
    // Pushed as it ceases to be dynamic, too.
    world.add_force(box, Vec3(1e6, 0, 0));
    world.set_motion(box, Motion::static_);
    world.step();
    world.set_gravity_scale(box, 1);
    world.set_motion(box, Motion::dynamic);
    world.step();
    EXPECT_EQ(world.velocity(box).x(), 0);
    EXPECT_NEAR(world.velocity(box).z(), -3 * kDt, 1e-6);
}

TEST(BodyChanges, WhoIsDrivenAndBecomesStaticIsAConveyor)
{
    SceneOf made;
    made.floor();
    made.box(Vec3(3, 1, 0.2), Vec3(0, 0, 0.2)).drive_velocity = {0.5, std::nullopt, std::nullopt};
    made.box(Vec3(0.3, 0.3, 0.3), Vec3(0, 0, 0.7));
    World world(made.scene);
    const BodyId belt = world.bodies()[1], crate = world.bodies()[2];
    world.set_motion(belt, Motion::static_);
    world.step(60);
    EXPECT_EQ(world.pose(belt).position, Vec3(0, 0, 0.2));
    EXPECT_NEAR(world.velocity(crate).x(), 0.5, 1e-3);
}

TEST(BodyChanges, AKinematicBodyGetsToWhereItIsSent)
{
    World world(box_in_air(Motion::kinematic));
    const BodyId box = second(world);
    Random random(3);
    for (int i = 0; i < 50; ++i) {
        Pose to;
        for (int k = 0; k < 3; ++k) to.position[k] = random.uniform(-3, 3);
        to.orientation = Quat(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1),
                              random.uniform(-1, 1))
                             .normalized();
        world.move_to(box, to, kDt);
        world.step();
        const Pose now = world.pose(box);
        EXPECT_LT((now.position - to.position).norm(), 1e-12);
        EXPECT_GT(std::abs(now.orientation.dot(to.orientation)), 1 - 1e-12);
    }
}

TEST(BodyChanges, WhoIsPutToSleepSleepsWithWhatItTouches)
{
    World world(box_in_air(Motion::dynamic));
    const BodyId box = second(world), low = world.bodies()[2], top = world.bodies()[4];
    world.step(5);
    const Pose there = world.pose(box);
    world.sleep(box);
    world.sleep(low);
    EXPECT_FALSE(world.awake(box));
    EXPECT_FALSE(world.awake(top));
    world.step(60);
    EXPECT_EQ(world.pose(box).position, there.position);
    EXPECT_EQ(world.report().bodies_awake, 0u);
    world.wake(top);
    EXPECT_TRUE(world.awake(low));
    world.wake(box);
    world.step(120);
    EXPECT_LT(world.pose(box).position.z(), 0.6);
}

TEST(BodyChanges, WhatCannotBeIsRefusedAndChangesNothing)
{
    SceneOf made;
    made.floor();
    made.box(Vec3(0.5, 0.5, 0.5), Vec3(0, 0, 0.5));
    MeshShape mesh;
    mesh.vertices = {Vec3(-3, -3, 0), Vec3(3, -3, 0), Vec3(3, 3, 0)};
    mesh.triangles = {{0, 1, 2}};
    made.body(made.shape(mesh), Vec3(9, 9, 0)).motion = Motion::static_;
    BodyDescription ghost;
    ghost.motion = Motion::kinematic;
    made.scene.bodies.push_back(ghost);
    made.box(Vec3(0.5, 0.5, 0.5), Vec3(5, 0, 4)).pivot = Vec3(0, 0, 1);
    World world(made.scene);
    world.step();
    const std::vector<BodyId> ids = world.bodies();
    const BodyId floor = ids[0], box = ids[1], sheet = ids[2], nothing = ids[3], hung = ids[4];
    BodyId gone = box;
    gone.generation += 1;
    const std::string before = world.state_hash();
    const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
    const auto refused = [&](const std::function<void()>& call, const char* who) {
        try {
            call();
            ADD_FAILURE() << who << " is not refused";
        } catch (const std::invalid_argument& error) {
            EXPECT_EQ(std::string(error.what()).rfind(who, 0), 0u) << error.what();
        }
    };
    refused([&] { world.set_motion(floor, Motion::dynamic); }, "set_motion");
    refused([&] { world.set_motion(sheet, Motion::dynamic); }, "set_motion");
    refused([&] { world.set_motion(nothing, Motion::dynamic); }, "set_motion");
    refused([&] { world.set_motion(hung, Motion::static_); }, "set_motion");
    refused([&] { world.set_motion(box, static_cast<Motion>(9)); }, "set_motion");
    refused([&] { world.set_motion(gone, Motion::static_); }, "set_motion");
    refused([&] { world.set_mass(box, -1); }, "set_mass");
    refused([&] { world.set_mass(box, nan); }, "set_mass");
    refused([&] { world.set_mass(floor, 1); }, "set_mass");
    refused([&] { world.set_locks(floor, true, true); }, "set_locks");
    refused([&] { world.set_locks(hung, true, false); }, "set_locks");
    refused(
        [&] {
            world.set_drive_velocity(box, {nan, std::nullopt, std::nullopt});
        },
        "set_drive_velocity");
    refused([&] { world.set_force(box, Vec3(nan, 0, 0), Vec3::Zero()); }, "set_force");
    refused([&] { world.set_force(floor, Vec3(1, 0, 0), Vec3::Zero()); }, "set_force");
    refused([&] { world.set_gravity_scale(box, inf); }, "set_gravity_scale");
    refused([&] { world.add_impulse(floor, Vec3(1, 0, 0)); }, "add_impulse");
    refused([&] { world.add_impulse(box, Vec3(1, 0, 0), Vec3(nan, 0, 0)); }, "add_impulse");
    refused([&] { world.add_angular_impulse(box, Vec3(inf, 0, 0)); }, "add_angular_impulse");
    refused([&] { world.add_force(nothing, Vec3(1, 0, 0)); }, "add_force");
    refused([&] { world.add_torque(box, Vec3(nan, 0, 0)); }, "add_torque");
    refused([&] { world.move_to(box, Pose{}, kDt); }, "move_to");
    refused([&] { world.move_to(nothing, Pose{}, 0); }, "move_to");
    refused([&] { world.move_to(nothing, {Vec3(0, 0, 0), Quat(2, 0, 0, 0)}, 1); }, "move_to");
    refused([&] { world.sleep(floor); }, "sleep");
    refused([&] { world.wake(gone); }, "wake");
    refused([&] { world.user_data(gone); }, "user_data");
    refused([&] { world.step(-1); }, "step");
    refused([&] { world.set_gravity(Vec3(0, 0, -1e300)); }, "set_gravity");
    refused([&] { world.pose(BodyId{}); }, "pose: this id names no body");
    Settings odd;
    odd.solver = static_cast<Solver>(99);
    refused([&] { World world_of_none(odd); }, "world: settings.solver: wanted");
    odd = {};
    odd.precision = static_cast<Precision>(9);
    refused([&] { World world_of_none(odd); }, "world: settings.precision: wanted");
    Scene moved = made.scene;
    moved.bodies[1].motion = static_cast<Motion>(9);
    refused([&] { World world_of_none(moved); }, "scene: bodies[1].motion: wanted");
    refused([&] { World(Settings{}, -1); }, "world: threads");
    refused([&] { World(Settings{}, 1000000); }, "world: threads");
    EXPECT_EQ(world.state_hash(), before);
}

// Calls at random, whatever they are, on worlds of one and of three threads.
void change_at_random(World& world, Random& random)
{
    const std::vector<BodyId> ids = world.bodies();
    for (int i = 0; i < 4; ++i) {
        const BodyId id = ids[random.below(static_cast<std::uint32_t>(ids.size()))];
        const double x = random.uniform(-1, 1), y = random.uniform(-1, 1);
        try {
            switch (random.below(17)) {
            case 0:
                return world.set_motion(id, static_cast<Motion>(random.below(3)));
            case 1:
                return world.set_mass(id, std::exp(3 * x) * 500);
            case 2:
                return world.set_filter(id, 1 + random.below(2), random.below(4) == 0 ? 2 : ~0u);
            case 3:
                return world.set_locks(id, random.below(4) == 0, random.below(3) == 0);
            case 4:
                return world.set_drive_velocity(
                    id,
                    {x > 0 ? std::optional<double>(y) : std::nullopt, std::nullopt, std::nullopt});
            case 5:
                return world.set_force(id, Vec3(x, y, 0) * 100, Vec3(0, 0, x));
            case 6:
                return world.set_gravity_scale(id, random.below(2) == 0 ? 1 : x);
            case 7:
                return world.add_force(id, Vec3(x, y, 1) * 1000, Vec3(x, y, 1));
            case 8:
                return world.add_impulse(id, Vec3(x, y, 1) * 100, Vec3(x, y, 1));
            case 9:
                return world.move_to(id, {Vec3(x, y, 2), Quat::Identity()}, 0.1);
            case 10:
                return world.sleep(id);
            case 11:
                return world.wake(id);
            case 12:
                return world.set_fast(id, x > 0);
            case 13:
                return world.set_gravity(Vec3(x, y, -9));
            case 14:
                return world.set_sensor(id, x > 0);
            case 15:
                return world.listen({.touches = true, .hit_speed = 1.1 + y, .sensors = x > 0});
            default:
                return world.set_velocity(id, Vec3(x, y, 1), Vec3(y, x, 0));
            }
        } catch (const std::invalid_argument&) { }
    }
}

TEST(BodyChanges, AtRandomAreTheSameOnAnyThreadsAndWhatTheBodiesCallFor)
{
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        Scene scene = mixed_scene();
        scene.settings.partial_rest = seed % 3 == 0;
        World one(scene, 1), three(scene, 3);
        for (World* world : {&one, &three})
            world->listen({.touches = true, .hit_speed = 1, .sensors = true});
        Random of_one(seed), of_three(seed);
        std::size_t open = 0;
        for (int i = 0; i < 80; ++i) {
            change_at_random(one, of_one);
            change_at_random(three, of_three);
            one.step();
            three.step();
            open += one.events().begun.size();
            ASSERT_LE(one.events().ended.size(), open);
            open -= one.events().ended.size();
            ASSERT_EQ(one.state_hash(), three.state_hash()) << "seed " << seed << " step " << i;
            ASSERT_EQ(one.events().begun.size(), three.events().begun.size());
            ASSERT_EQ(one.events().sensed.size(), three.events().sensed.size());
            // Counted one by one, as if all were counted.
            WorldState& state = state_of(one);
            state.refresh();
            EffectCensus afresh;
            afresh.count_all(state.effect_facts().bodies);
            const EffectCensus& kept = state.get<EffectCensus>();
            for (std::size_t k = 0; k < kCalls; ++k) {
                const auto call = static_cast<Call>(k);
                // As fast and as spinning as they were when they were changed last.
                if (call == Call::fast || call == Call::turns || call == Call::uneven_turns)
                    continue;
                ASSERT_EQ(kept.count(call), afresh.count(call))
                    << "seed " << seed << " step " << i << " call " << k;
            }
            ASSERT_EQ(kept.kinds().size(), afresh.kinds().size());
            ASSERT_EQ(kept.materials().size(), afresh.materials().size());
            for (const BodyId id : one.bodies()) ASSERT_FALSE(one.quarantined(id));
        }
        const std::vector<BodyId> all = one.bodies();
        one.remove(all);
        one.step();
        EXPECT_EQ(one.events().ended.size(), open);
    }
}

TEST(BodyChanges, AFileKeepsScaleAndUserData)
{
    Scene scene = box_in_air(Motion::dynamic);
    scene.bodies[1].gravity_scale = 0.5;
    scene.bodies[1].user_data = std::uint64_t{1} << 53;
    const std::string path = testing::TempDir() + "body_changes.json";
    write_scene(scene, path);
    const Scene read = read_scene(path);
    EXPECT_EQ(read.bodies[1].gravity_scale, 0.5);
    EXPECT_EQ(read.bodies[1].user_data, std::uint64_t{1} << 53);
}

}  // namespace
}  // namespace throng
