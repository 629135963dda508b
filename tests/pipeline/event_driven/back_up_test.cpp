// What overlap=back_up keeps to, through the public door.
#include "tests/pipeline/event_driven/carried_scenes.hpp"
#include "throng/dials.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

using given::box_on_a_lift;
using given::carried;
using given::energy_of;
using given::hash_after;
using given::heap_of_balls;
using given::least_separation;
using given::place_of;
using given::row_of_balls;
using given::SceneOf;
using given::stack_of_boxes;
using given::tumbling_boxes;
using given::velocity_of;

constexpr double kGravity = 9.81;

SceneOf backed_up(double friction, double restitution)
{
    return carried(Overlap::back_up, friction, restitution);
}

TEST(BackUp, FindsContactsThatExistBecauseOfAnEarlierOneInTheStep)
{
    World world(row_of_balls(Overlap::back_up));
    world.step();
    // Each impact is told up to a tolerance early.
    const double early = 2 * 1e-4 * 0.5;
    for (std::size_t i = 0; i < 3; ++i) {
        const double wanted = i == 0 ? 1 : i == 1 ? 3 : 12;
        EXPECT_NEAR(place_of(world, i).x(), wanted, early);
        EXPECT_NEAR(velocity_of(world, i).x(), i == 2 ? 100 : 0, 1e-9);
    }
    EXPECT_GT(place_of(world, 1).x() - place_of(world, 0).x(), 1);
    EXPECT_EQ(world.report().fallbacks, 0u);
}

TEST(BackUp, ElasticBallKeepsItsEnergyWhereItsFlightDoes)
{
    for (const Integrator integrator :
         {Integrator::midpoint, Integrator::splitting, Integrator::rk4}) {
        SceneOf made = backed_up(0, 1);
        made.scene.settings.integrator = integrator;
        made.scene.settings.dt = 0.01;
        made.floor();
        made.ball(0.1, Vec3(0, 0, 1));
        World world(made.scene);
        const double before = energy_of(world);
        double least = 1;
        for (int step = 0; step < 1000; ++step) {
            world.step();
            least = std::min(least, least_separation(world, 1, 0.1));
            ASSERT_NEAR(energy_of(world), before, 1e-9 * before);
        }
        EXPECT_GT(least, 0);
        EXPECT_LT(least, 0.05);  // it does come down
        EXPECT_EQ(world.report().fallbacks, 0u);
    }
}

// Eight balls at 100 m/s between two walls strike some ten thousand times in a second.
TEST(BackUp, StepEndsWhereItsWorkDoesAndSaysSo)
{
    SceneOf made = backed_up(0, 1);
    made.scene.gravity = Vec3::Zero();
    made.scene.settings.dt = 10;
    for (const double x : {-1.0, 1.78})
        made.box(Vec3(0.9, 1, 1), Vec3(x, 0, 0)).motion = Motion::static_;
    for (int i = 0; i < 8; ++i)
        made.ball(0.05, Vec3(0.11 * i - 0.04, 0, 0)).velocity.x() = i % 2 == 0 ? 100 : -70;
    World world(made.scene);
    const double before = energy_of(world);
    world.step();
    EXPECT_EQ(world.report().fallbacks, 1u);
    EXPECT_LE(energy_of(world), before * (1 + 1e-9));
    EXPECT_EQ(world.measure().overlapping_pairs, 0u);
}

// Two towers of five.
TEST(BackUp, RestingBodiesStayAsTheyLie)
{
    SceneOf made = backed_up(0.5, 0);
    made.scene.settings.substeps = 4;
    made.floor();
    for (int i = 0; i < 10; ++i)
        made.box(Vec3(0.5, 0.5, 0.5), Vec3(1.5 * (i % 2), 0, 0.5001 + 1.0002 * (i / 2)));
    World world(made.scene);
    world.step(60);
    std::vector<Vec3> before;
    for (std::size_t i = 1; i <= 10; ++i) before.push_back(place_of(world, i));
    world.step(60);
    for (std::size_t i = 1; i <= 10; ++i)
        EXPECT_LT((place_of(world, i) - before[i - 1]).norm(), 1e-8) << i;
    EXPECT_EQ(world.measure().overlapping_pairs, 0u);
    EXPECT_EQ(world.report().fallbacks, 0u);
}

TEST(BackUp, BouncingBallComesToRestInTheTimeItShould)
{
    SceneOf made = backed_up(0, 0.5);
    made.scene.settings.integrator = Integrator::midpoint;
    made.scene.settings.dt = 0.01;
    made.floor();
    made.ball(0.1, Vec3(0, 0, 1.1));
    World world(made.scene);
    int last = 0;
    for (int step = 1; step <= 200; ++step) {
        world.step();
        ASSERT_GT(least_separation(world, 1, 0.1), 0);
        if (velocity_of(world, 1).norm() > 1e-3) last = step;
    }
    // Of the endless row of bounces those within the tolerance are left out.
    const double left_out = 4 * std::sqrt(2 * 1e-5 / kGravity) / (1 - 0.5);
    EXPECT_NEAR(last * 0.01, 1.354571, 0.01 + left_out);
    EXPECT_NEAR(place_of(world, 1).z(), 0.1 + 0.5e-5, 1e-7);  // half the tolerance above the floor
    EXPECT_EQ(world.report().fallbacks, 0u);
}

TEST(BackUp, StackStandsApartAndStill)
{
    World world(stack_of_boxes(Overlap::back_up, 4));
    for (int step = 0; step < 120; ++step) {
        world.step();
        ASSERT_EQ(world.measure().overlapping_pairs, 0u) << "step " << step;
    }
    EXPECT_LT(given::greatest_speed(world), 1e-6);
    for (std::size_t i = 1; i <= 4; ++i)  // each half of 1e-4 times 0.5 m over the one below
        EXPECT_NEAR(place_of(world, i).z(), static_cast<double>(i) * (1 + 2.5e-5) - 0.5, 1e-5);
    EXPECT_EQ(world.report().fallbacks, 0u);
}

TEST(BackUp, BallsNeverOverlapAndGainNoEnergy)
{
    for (const double restitution : {0.0, 0.5}) {
        World world(heap_of_balls(Overlap::back_up, restitution));
        double energy = energy_of(world);
        for (int step = 0; step < 60; ++step) {
            world.step();
            ASSERT_GT(least_separation(world, 1, 0.1), 0) << "step " << step;
            ASSERT_LT(energy_of(world), energy * (1 + 1e-6));
        }
        EXPECT_LT(energy_of(world), 0.9 * energy);
        EXPECT_EQ(world.report().fallbacks, 0u);
    }
}

TEST(BackUp, BoxesThatTumbleNeverOverlap)
{
    World world(tumbling_boxes(Overlap::back_up));
    for (int step = 0; step < 150; ++step) {
        world.step();
        ASSERT_EQ(world.measure().overlapping_pairs, 0u) << "step " << step;
    }
    EXPECT_LT(place_of(world, 1).z(), 0.5);  // it has come down
}

TEST(BackUp, SameBitsForAnyNumberOfThreads)
{
    const Scene scene = heap_of_balls(Overlap::back_up, 0.5);
    const std::string wanted = hash_after(scene, 1, 30);
    EXPECT_EQ(hash_after(scene, 2, 30), wanted);
    EXPECT_EQ(hash_after(scene, 3, 30), wanted);
}

TEST(BackUp, PlatformCarriesWhatRestsOnIt)
{
    World world(box_on_a_lift(Overlap::back_up));
    for (int step = 0; step < 100; ++step) {
        world.step();
        ASSERT_EQ(world.measure().overlapping_pairs, 0u) << "step " << step;
    }
    EXPECT_LT((velocity_of(world, 1) - Vec3(0.2, 0, 1)).norm(), 1e-6);
}

// A floor of two triangles, and a wall of two more at x = 1.
MeshShape corner()
{
    MeshShape mesh;
    mesh.vertices = {{-3, -3, 0}, {1, -3, 0}, {1, 3, 0}, {-3, 3, 0}, {1, -3, 2}, {1, 3, 2}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}};
    return mesh;
}

TEST(BackUp, HoldsBodiesApartFromStaticMeshes)
{
    for (const Overlap overlap : {Overlap::back_up, Overlap::subdivide}) {
        SceneOf made = carried(overlap, 0, 0);
        made.scene.settings.dt = 0.01;
        made.body(made.shape(corner()), Vec3::Zero()).motion = Motion::static_;
        made.ball(0.1, Vec3(0, 0.3, 0.4)).velocity = Vec3(3, 0, 0);
        made.box(Vec3(0.2, 0.2, 0.1), Vec3(-1, -1, 0.3)).velocity = Vec3(1, 0, 0);
        World world(made.scene);
        const double bound = overlap == Overlap::back_up ? 0 : 2e-5;
        for (int step = 0; step < 100; ++step) {
            world.step();
            ASSERT_GE(place_of(world, 1).z() - 0.1, -bound);
            ASSERT_LE(place_of(world, 1).x() + 0.1, 1 + bound);
            ASSERT_GE(place_of(world, 2).z() - 0.1, -bound);
        }
        EXPECT_NEAR(place_of(world, 1).x(), 0.9, 1e-4);  // at the wall
        EXPECT_NEAR(place_of(world, 1).z(), 0.1, 1e-4);  // and on the floor
        EXPECT_NEAR(place_of(world, 2).z(), 0.1, 1e-4);
        EXPECT_EQ(world.report().fallbacks, 0u);
    }
}

TEST(BackUp, PendulumStrikesAPostAndKeepsItsPivot)
{
    for (const Overlap overlap : {Overlap::back_up, Overlap::subdivide}) {
        SceneOf made = carried(overlap, 0, 1);
        made.scene.settings.integrator = Integrator::midpoint;
        made.scene.settings.dt = 0.01;
        BodyDescription& rod = made.box(Vec3(0.05, 0.05, 0.5), Vec3(0, 0, 0));
        rod.pivot = Vec3(0, 0, 0.5);
        rod.angular_velocity = Vec3(0, -2, 0);
        made.ball(0.1, Vec3(0.3, 0, -0.45)).motion = Motion::static_;
        World world(made.scene);
        const double before = energy_of(world);
        double furthest = 0;
        for (int step = 0; step < 200; ++step) {
            world.step();
            const Pose pose = world.pose(world.bodies()[0]);
            ASSERT_LT((pose * Vec3(0, 0, 0.5) - Vec3(0, 0, 0.5)).norm(), 1e-9) << step;
            ASSERT_LE(world.measure().greatest_overlap,
                      overlap == Overlap::back_up ? 0 : 2 * 1e-4 * 0.05);
            furthest = std::max(furthest, (pose * Vec3(0.05, 0, -0.45)).x());
        }
        EXPECT_NEAR(furthest, 0.2, 0.01);  // it comes up to the post
        EXPECT_NEAR(energy_of(world), before, 1e-3 * std::abs(before));
    }
}

TEST(BackUp, TellsTheForceOfContacts)
{
    for (const Overlap overlap : {Overlap::back_up, Overlap::subdivide}) {
        World world(stack_of_boxes(overlap, 3));
        world.step(60);
        const double weight = 1000 * kGravity;
        for (std::size_t i = 0; i < 4; ++i) {
            const Vec3 force = world.contact_force(world.bodies()[i]);
            EXPECT_NEAR(force.z(), i == 0 ? -3 * weight : weight, 1e-6 * weight) << i;
        }
        EXPECT_EQ(world.report().manifolds, 3u);
        EXPECT_EQ(world.report().contacts, 12u);
        EXPECT_EQ(world.report().islands, 1u);
    }
}

TEST(BackUp, IsLeftWhereTheResponseNeedsOverlapAndItIsSaid)
{
    SceneOf made = backed_up(0.5, 0);
    made.scene.settings.response = Response::penalty;
    made.floor();
    made.ball(0.1, Vec3(0, 0, 1));
    World world(made.scene);
    EXPECT_TRUE(world.effects().on.has(Effect::contact));
    EXPECT_FALSE(world.effects().on.has(Effect::no_overlap));
    made.scene.dials_set = {"overlap"};
    ASSERT_EQ(unused_dials(made.scene).size(), 1u);
    EXPECT_EQ(unused_dials(made.scene)[0], "overlap: unused, response penalty needs overlap");
    made.scene.settings.response = Response::impulse;
    EXPECT_TRUE(World(made.scene).effects().on.has(Effect::no_overlap));
    EXPECT_TRUE(unused_dials(made.scene).empty());
}

// Bodies and their shapes are counted apart.
TEST(BackUp, ABallBouncesOnTheFloorWhoeverHasSeveralShapes)
{
    for (const Overlap overlap : {Overlap::back_up, Overlap::subdivide}) {
        given::SceneOf made;
        made.scene.materials[0].restitution = 0.5;
        made.scene.settings.overlap = overlap;
        const std::uint32_t part = made.shape(BoxShape{Vec3(0.5, 0.1, 0.1)});
        CompoundShape cross;
        cross.parts = {{part, Pose{}},
                       {part, {Vec3::Zero(), Quat(std::sqrt(0.5), 0, 0, std::sqrt(0.5))}}};
        made.body(made.shape(cross), Vec3(5, 0, 0.3));
        const std::uint32_t ball = made.shape(SphereShape{0.1});
        made.body(ball, Vec3(0, 0, 0.5)).velocity = Vec3(1, 0, 0);
        made.box(Vec3(20, 20, 0.5), Vec3(0, 0, -0.5)).motion = Motion::static_;
        World world(made.scene);
        const BodyId falling = world.bodies()[1];
        double highest = 0;
        for (int i = 0; i < 120; ++i) {
            world.step();
            ASSERT_GT(world.pose(falling).position.z(), 0.1 - 1e-4);
            if (i > 20) highest = std::max(highest, world.pose(falling).position.z());
        }
        // It has bounced once, to a quarter of the height, and stopped sliding by friction.
        EXPECT_NEAR(highest, 0.1 + 0.25 * 0.4, 0.01);
    }
}

}  // namespace
}  // namespace throng
