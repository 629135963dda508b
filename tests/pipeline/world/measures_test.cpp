// Measures: what a state is worth, against what it was made to be.
#include "tests/support/small_scenes.hpp"
#include "throng/catalog.hpp"
#include "throng/world.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

using given::SceneOf;

TEST(Measures, OverlapsAreTheLeastTranslationOfEachPair)
{
    SceneOf made;
    made.floor();
    made.box(Vec3(0.5, 0.5, 0.5), Vec3(0, 0, 0.45));    // 0.05 into the floor
    made.box(Vec3(0.5, 0.5, 0.5), Vec3(0.5, 0, 1.25));  // 0.2 into the box below
    made.ball(0.5, Vec3(10, 0, 0.4));                   // 0.1 into the floor
    made.ball(0.5, Vec3(10, 0.7, 0.9));                 // beside it, 0.1398 into it
    made.ball(0.5, Vec3(20, 0, 0.6));                   // nowhere
    World world(made.scene);
    const Measures measures = world.measure();
    EXPECT_EQ(measures.overlapping_pairs, 4u);
    const double beside = 1 - std::hypot(0.7, 0.5);
    EXPECT_NEAR(measures.greatest_overlap, 0.2, 1e-9);
    EXPECT_NEAR(measures.mean_overlap, (0.05 + 0.2 + 0.1 + beside) / 4, 1e-9);
}

TEST(Measures, EnergyAndMomentumAreTheTextbooks)
{
    SceneOf made;
    made.scene.gravity = Vec3(0, 0, -10);
    BodyDescription& box = made.box(Vec3(0.5, 1, 1.5), Vec3(1, 2, 3));
    box.mass = 12.0;
    box.velocity = Vec3(1, 0, 2);
    box.angular_velocity = Vec3(0, 0, 3);
    made.ball(0.5, Vec3(50, 0, 0)).motion = Motion::kinematic;
    made.scene.bodies[1].velocity = Vec3(9, 9, 9);
    World world(made.scene);
    const Measures measures = world.measure();
    // Moment about z: m (1 + 4) / 12 with sides 1 and 2.
    EXPECT_NEAR(measures.kinetic_energy, 0.5 * 12 * 5 + 0.5 * 5 * 9, 1e-9);
    EXPECT_NEAR(measures.potential_energy, 12 * 10 * 3, 1e-9);
    EXPECT_LE((measures.momentum - Vec3(12, 0, 24)).norm(), 1e-12);
    const Vec3 angular = 12 * Vec3(1, 2, 3).cross(Vec3(1, 0, 2)) + Vec3(0, 0, 15);
    EXPECT_LE((measures.angular_momentum - angular).norm(), 1e-9);
}

TEST(Measures, TurnWithTheWorld)
{
    // The same body seen from a world that is turned: numbers that are no directions stay.
    const auto measured = [](const Quat& turn) {
        SceneOf made;
        made.scene.gravity.setZero();
        BodyDescription& box = made.box(Vec3(0.5, 1, 1.5), turn * Vec3(1, 2, 3));
        box.orientation = turn;
        box.angular_velocity = turn * Vec3(1, 2, 3);
        return World(made.scene).measure();
    };
    const Quat turn(0.5, 0.5, -0.5, 0.5);
    const Measures a = measured(Quat::Identity()), b = measured(turn);
    EXPECT_NEAR(a.kinetic_energy, b.kinetic_energy, 1e-8);
    EXPECT_LE((turn * a.angular_momentum - b.angular_momentum).norm(), 1e-8);
}

TEST(Measures, ChangeNothing)
{
    World world(given::mixed_scene(), 2);
    world.step(20);
    const std::string before = world.state_hash();
    static_cast<void>(world.measure());
    EXPECT_EQ(world.state_hash(), before);
}

TEST(Measures, LeaveOutWhatWasRemoved)
{
    SceneOf made;
    made.box(Vec3(0.5, 0.5, 0.5), Vec3(0, 0, 0)).velocity = Vec3(1, 0, 0);
    made.box(Vec3(0.5, 0.5, 0.5), Vec3(0.2, 0, 0)).velocity = Vec3(1, 0, 0);
    World world(made.scene);
    EXPECT_EQ(world.measure().overlapping_pairs, 1u);
    world.remove(std::vector{world.bodies()[0]});
    EXPECT_EQ(world.measure().overlapping_pairs, 0u);
    EXPECT_NEAR(world.measure().kinetic_energy, 500, 1e-9);
    world.remove(world.bodies());
    EXPECT_EQ(world.measure().kinetic_energy, 0);
    EXPECT_EQ(world.measure().greatest_overlap, 0);
}

TEST(Measures, MemoryGrowsWithTheBodies)
{
    World small(given::mixed_scene());
    World large(given::mixed_scene());
    for (int i = 0; i < 5; ++i) large.add(given::mixed_scene());
    EXPECT_GT(small.memory_bytes(), 0u);
    EXPECT_GT(large.memory_bytes(), small.memory_bytes());
}

TEST(Measures, RoomThatIsIdleForLongIsGivenBack)
{
    World world(find_scene("stacks")->make(500, kDefaultSeed), 1);
    for (int i = 0; i < 10; ++i) world.step();
    const std::size_t standing = world.memory_bytes();
    world.set_gravity(Vec3::Zero());
    for (const BodyId body : world.bodies())
        world.set_velocity(body, Vec3(0, 0, world.pose(body).position.z()), Vec3::Zero());
    for (int i = 0; i < 90; ++i) world.step();
    ASSERT_EQ(world.report().contacts, 0u);
    EXPECT_LT(world.memory_bytes() + 500 * 200, standing);  // B
}

}  // namespace
}  // namespace throng
