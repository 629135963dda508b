// Escalation: what the solver would let fall is found, held, and let go again.
#include "kernels/math/rotation.hpp"
#include "tests/support/small_scenes.hpp"
#include "tests/support/watched.hpp"
#include "throng/energy_ledger.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace throng {
namespace {

// A box on a box, so many times as heavy.
Scene heavy_on_light(double ratio)
{
    given::SceneOf made;
    made.floor();
    for (const int i : {0, 1}) {
        BodyDescription& box = made.box(Vec3::Constant(0.5), Vec3(0, 0, 0.5 + i));
        box.mass = i == 0 ? 1 : ratio;
        box.name = i == 0 ? "light" : "heavy";
    }
    made.scene.settings.sleep = false;
    return made.scene;
}

double height_of_top(const World& world) { return world.pose(world.bodies().back()).position.z(); }

TEST(Escalation, HoldsAHeavyBoxOnALightOneThatFallsWithoutIt)
{
    Scene scene = heavy_on_light(1000);
    World held(scene);
    scene.settings.escalation = Escalation::off;
    World left(scene);
    held.step(600);
    left.step(600);
    EXPECT_NEAR(height_of_top(held), 1.5, 0.02);
    EXPECT_LT(height_of_top(left), 1);
    EXPECT_GT(held.report().islands_escalated, 100u);
    EXPECT_EQ(left.report().islands_escalated, 0u);
}

TEST(Escalation, CutsNoStepIntoMoreThanSixtyFourWhereAttractorsDraw)
{
    constexpr std::uint64_t kExact = 256;  // what an exact solve counts as
    std::set<std::uint64_t> cuts;          // substeps of islands that were cut finer
    for (const int substeps : {1, 4, 5, 16, 32, 64, 100})
        for (const double ratio : {100, 1000, 10'000, 100'000}) {
            Scene scene = heavy_on_light(ratio);
            scene.settings.substeps = substeps;
            scene.attractors.push_back({Vec3(0, 0, 1e3), 1e-3});
            World world(scene);
            std::uint64_t before = 0;
            for (int i = 0; i < 60; ++i) {
                world.step();
                const std::uint64_t work = world.report().escalation_work - before;
                before += work;
                if (work == 0 || world.report().manifolds == 0) continue;
                const std::uint64_t more = work / world.report().manifolds;
                if (more != kExact) cuts.insert(more + static_cast<std::uint64_t>(substeps));
            }
        }
    EXPECT_TRUE(cuts.contains(64));
    EXPECT_EQ(*cuts.rbegin(), 64u);
}

TEST(Escalation, IsCalledForByWhoIsStubbornAndByNobodyElse)
{
    World equal(heavy_on_light(1));
    equal.step(30);
    EXPECT_FALSE(equal.effects().on.has(Effect::escalation));
    World world(heavy_on_light(1000));
    EXPECT_FALSE(world.effects().on.has(Effect::escalation));
    world.step(30);
    EXPECT_TRUE(world.effects().on.has(Effect::escalation));
    EXPECT_EQ(world.effects().cause_of(Effect::escalation), "body 1 light");
    // Taken apart it is stubborn no more.
    world.set_pose(world.bodies().back(), {Vec3(5, 0, 0.5), Quat::Identity()});
    world.step(30);
    EXPECT_FALSE(world.effects().on.has(Effect::escalation));
}

TEST(Escalation, GivesTheSameBitsOnAnyNumberOfThreads)
{
    const auto hash_of = [](int threads) {
        World world(heavy_on_light(1000), threads);
        world.step(30);
        return world.state_hash();
    };
    EXPECT_EQ(hash_of(1), hash_of(2));
    EXPECT_EQ(hash_of(1), hash_of(3));
}

// A ball that weighs so many times as much falls on a small one, 0.3 m above it.
Scene heavy_falls_on_light(double ratio, double speed)
{
    given::SceneOf made;
    made.floor();
    made.ball(0.1, Vec3(0, 0, 0.1)).mass = 1;
    BodyDescription& heavy = made.ball(1, Vec3(0, 0, 1.5));
    heavy.mass = ratio;
    heavy.velocity = Vec3(0, 0, -speed);
    return made.scene;
}

TEST(Escalation, StopsWhatFallsOnSomethingLightWithoutThrowingItBack)
{
    for (const double ratio : {10.0, 30.0, 1000.0})
        for (const Solver solver : {Solver::soft_step, Solver::pgs}) {
            Scene scene = heavy_falls_on_light(ratio, 27);
            scene.settings.solver = solver;
            World world(scene);
            double fastest = 0;
            for (int i = 0; i < 60; ++i) {
                world.step();
                fastest = std::max(fastest, world.velocity(world.bodies().back()).z());
            }
            EXPECT_LT(fastest, 0.05 * 27) << ratio;
        }
}

// Each a little above the last, so that they come to meet one after another.
TEST(Escalation, DoesNotThrowAColumnThatIsDropped)
{
    std::uint64_t escalated = 0;
    for (const int count : {50, 60, 80}) {
        given::SceneOf made;
        made.floor();
        for (int i = 0; i < count; ++i)
            made.box(Vec3::Constant(0.05), Vec3(0, 0, 0.07 + 0.12 * i)).mass = 2;
        made.scene.settings.substeps = 16;
        World world(made.scene);
        EnergyLedger ledger;
        for (int i = 0; i < 80; ++i) {
            ledger.before_step(world);
            world.step();
            ledger.after_step(world);
            escalated += world.report().islands_escalated;
        }
        EXPECT_LT(ledger.gained(), 0.01 * ledger.greatest_kinetic()) << count;
    }
    EXPECT_GT(escalated, 0u);
}

TEST(Escalation, IsSharedByAllWhoNeedIt)
{
    // Coins: each pile alone would get sixteen times the substeps.
    given::SceneOf made;
    made.floor();
    constexpr int kPiles = 9, kHigh = 30;
    constexpr double kThick = 0.002;  // m
    const std::uint32_t coin = made.shape(CylinderShape{0.012, kThick / 2});
    for (int pile = 0; pile < kPiles; ++pile)
        for (int k = 0; k < kHigh; ++k) made.body(coin, Vec3(0.1 * pile, 0, kThick * (k + 0.5)));
    made.scene.settings.sleep = false;
    World world(made.scene);
    world.step(60);
    EXPECT_GT(world.report().islands_escalated, 0u);
    EXPECT_EQ(world.report().islands_escalated % kPiles, 0u);
    const std::vector<BodyId> bodies = world.bodies();
    for (int pile = 0; pile < kPiles; ++pile) {
        const BodyId top = bodies[static_cast<std::size_t>(1 + kHigh * pile + kHigh - 1)];
        EXPECT_NEAR(world.pose(top).position.z(), kThick * (kHigh - 0.5), kThick / 4) << pile;
    }
}

// A grid of cubes of 40 mm, of more contacts than a batch holds; a hair apart, or as far as they
// are dropped into a heap.
Scene many_cubes(double apart)
{
    given::SceneOf made;
    made.floor();
    for (int k = 0; k < 30; ++k)
        for (int i = 0; i < 15; ++i) {
            const double aside = apart > 0 ? 0.013 * ((7 * i + 11 * k) % 5) : 0;
            made.box(Vec3::Constant(0.02),
                     Vec3((0.041 + apart) * (i % 5) + aside, (0.041 + apart) * (i / 5) - aside,
                          (0.04 + apart) * (k + 0.5)));
        }
    return made.scene;
}

TEST(Escalation, HoldsGreatStructuresAndOnAnyNumberOfThreads)
{
    const Scene scene = many_cubes(0);
    World world(scene, 1), other(scene, 3);
    world.step(60);
    other.step(60);
    EXPECT_GT(world.report().islands_escalated, 20u);
    EXPECT_NEAR(height_of_top(world), 0.04 * 29.5, 0.004);
    EXPECT_EQ(world.state_hash(), other.state_hash());
    Scene left = scene;
    left.settings.escalation = Escalation::off;
    World falls(left);
    falls.step(240);
    EXPECT_LT(height_of_top(falls), 0.04 * 29);
}

TEST(Escalation, LeavesGreatHeapsAlone)
{
    World world(many_cubes(0.03));
    world.step(75);
    const std::size_t contacts = world.report().contacts;
    EXPECT_GT(contacts, 1500u);
    // A step of it with another substep would be as much as that.
    const std::uint64_t before = world.report().escalation_work;
    world.step(60);
    EXPECT_LT(world.report().escalation_work - before, contacts);
}

TEST(Escalation, IsTheSameWhoeverRollsElsewhere)
{
    // A heavy box that is set down askew turns as it settles, while a can rolls far away.
    const auto settled = [](bool rolls) {
        Scene scene = heavy_on_light(1000);
        scene.bodies.back().orientation = exponential(Vec3(0.02, 0.01, 0));
        scene.bodies.back().position.z() += 0.02;
        scene.shapes.push_back({"can", CylinderShape{0.5, 0.5}});
        BodyDescription can = scene.bodies.back();
        can.name = "can";
        can.shape = static_cast<std::uint32_t>(scene.shapes.size() - 1);
        can.mass = 1;
        can.position = Vec3(50, 0, rolls ? 0.8 : 0.5);
        can.orientation = exponential(Vec3(rolls ? 0.3 : 0, 0, 0));
        can.angular_velocity = Vec3::Zero();
        scene.bodies.push_back(can);
        World world(scene);
        world.step(60);
        const Pose heavy = world.pose(world.bodies()[2]);
        return std::pair(heavy.position, Vec3(heavy.orientation.vec()));
    };
    EXPECT_EQ(settled(false), settled(true));
}

TEST(Escalation, LetsNobodySinkWhoBearsTheHeavyWithOthers)
{
    // A ton on a plate on a hundred balls.
    given::SceneOf made;
    made.floor();
    for (int i = 0; i < 100; ++i)
        made.ball(0.05, Vec3(0.1 * (i % 10), 0.1 * (i / 10), 0.05)).mass = 0.5;
    made.box(Vec3(0.6, 0.6, 0.02), Vec3(0.45, 0.45, 0.12)).mass = 58;
    made.ball(0.4, Vec3(0.45, 0.45, 1.04)).mass = 1000;
    World world(made.scene);
    world.step(180);
    EXPECT_NEAR(height_of_top(world), 0.54, 1e-3);
}

// A column with a small one in it that stays where it is, but turns: lever arms press it in as its
// mass would be. Its upper half rocks on it, and is not thrown higher from time to time.
TEST(Escalation, HoldsTheHeavyOnWhoCanOnlyTurn)
{
    for (const double small : {0.04, 0.08})
        for (const bool round : {false, true}) {
            given::SceneOf made;
            made.floor();
            const auto add = [&](double half, double height) -> BodyDescription& {
                if (!round) return made.box(Vec3(half, half, half), Vec3(0, 0, height));
                return made.body(made.shape(CylinderShape{half, half}), Vec3(0, 0, height));
            };
            add(1, 1);
            add(small, 2 + small).lock_position = true;
            add(1, 3 + 2 * small);
            World world(made.scene);
            const auto ledger = given::watched<EnergyLedger>(world, 600);
            const double weight = world.mass(world.bodies()[3]) * 9.81;
            // By hairs of its place from nothing at all to 4e-3.
            EXPECT_LE(ledger.gained(), 5e-3 * weight) << small << ' ' << round;
        }
}

// Of a ball on a pivot and the floor neither gives way to the other; where the whole is turned
// their contact has lever arms of rounding alone, by which the exact solve once spun the ball.
TEST(Escalation, SpinsNobodyWhoCanOnlyTurn)
{
    for (const Precision precision : {Precision::float_, Precision::double_}) {
        const Quat turn = exponential(Vec3(0.29, 0.59, 0.88));
        given::SceneOf made;
        made.scene.settings.precision = precision;
        made.scene.gravity = turn * Vec3(0, 0, -9.81);
        made.floor().orientation = turn;
        const auto add = [&](auto shape, double mass, const Vec3& at) -> BodyDescription& {
            BodyDescription& body = made.body(made.shape(shape), turn * at);
            body.orientation = turn;
            body.mass = mass;
            return body;
        };
        for (int i = 0; i < 3; ++i)
            add(SphereShape{0.05}, 0.5,
                Vec3(0.4 * std::cos(2.1 * i), 0.4 * std::sin(2.1 * i), 0.05))
                .pivot = Vec3::Zero();
        for (int i = 0; i < 4; ++i)
            add(BoxShape{Vec3(0.5, 0.5, 0.1)}, 500, Vec3(0, 0, 0.2 + 0.2 * i));
        World world(made.scene);
        for (int step = 0; step < 60; ++step) {
            world.step();
            for (const BodyId body : world.bodies())
                ASSERT_LE(world.angular_velocity(body).norm(), 0.5) << step;
        }
    }
}

}  // namespace
}  // namespace throng
