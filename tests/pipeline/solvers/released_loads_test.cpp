// Released loads: what bore a load that is gone gives back what it gave too much, and no more.
#include "tests/support/small_scenes.hpp"
#include "tests/support/watched.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace throng {
namespace {

constexpr int kRows = 10;
constexpr double kBoxMass = 1000, kPull = 9.81;  // kg; m/s2

// A tower of boxes, the last of so many times the mass of the others; on a plane or, where that
// moves, on a plate.
Scene loaded_tower(double times, const Vec3& velocity = Vec3::Zero())
{
    given::SceneOf made;
    if (velocity.isZero(0)) {
        made.floor();
    } else {
        BodyDescription& plate = made.box(Vec3(50, 50, 1), Vec3(0, 0, -1));
        plate.motion = Motion::kinematic;
        plate.velocity = velocity;
    }
    for (int row = 0; row <= kRows; ++row) {
        BodyDescription& box = made.box(Vec3::Constant(0.5), Vec3(0.01 * (row % 2), 0, 0.5 + row));
        box.mass = row < kRows ? kBoxMass : times * kBoxMass;
        box.velocity = velocity;
    }
    made.scene.settings.sleep = false;
    return made.scene;
}

BodyId load_of(const World& world) { return world.bodies().back(); }

double fastest(World& world, int steps, const Vec3& velocity = Vec3::Zero())
{
    double fastest = 0;
    for (int step = 0; step < steps; ++step) {
        world.step();
        for (int row = 1; row <= kRows; ++row)
            fastest = std::max(
                fastest,
                (world.velocity(world.bodies()[static_cast<std::size_t>(row)]) - velocity).norm());
    }
    return fastest;
}

TEST(ReleasedLoads, ThrowNobodyWhateverWayTheyGo)
{
    for (const double times : {10, 100, 1000}) {
        for (int way = 0; way < 5; ++way) {
            World world(loaded_tower(times));
            world.step(300);
            const BodyId load = load_of(world);
            if (way == 0) world.remove(std::span(&load, 1));
            if (way == 1) world.set_mass(load, kBoxMass);
            if (way == 2)
                world.set_force(load, Vec3(0, 0, 2 * kPull * times * kBoxMass), {0, 0, 0});
            if (way == 3) world.set_pose(load, {Vec3(20, 0, 30), Quat::Identity()});
            if (way == 4) {
                world.set_motion(load, Motion::kinematic);
                world.set_velocity(load, Vec3(0, 0, 5), Vec3::Zero());
            }
            EXPECT_LT(fastest(world, 60), 0.4) << times << " times, way " << way;
        }
    }
}

TEST(ReleasedLoads, ThrowNobodyOffWhatMoves)
{
    for (const Vec3& velocity : {Vec3(5, 0, 0), Vec3(0, 0, 5), Vec3(0, 0, -5)}) {
        World world(loaded_tower(1000, velocity));
        EXPECT_LT(fastest(world, 300, velocity), 0.6) << velocity.transpose();
        const BodyId load = load_of(world);
        world.remove(std::span(&load, 1));
        EXPECT_LT(fastest(world, 60, velocity), 0.4) << velocity.transpose();
    }
}

// What a rigid tower bears, by counting who is above.
TEST(ReleasedLoads, LeaveEachContactTheWeightAboveIt)
{
    for (const double times : {10, 20}) {
        World world(loaded_tower(times));
        world.step(300);
        const BodyId load = load_of(world);
        world.remove(std::span(&load, 1));
        world.step();
        const std::vector<BodyId> bodies = world.bodies();
        ASSERT_EQ(world.contacts().size(), std::size_t{kRows});
        for (const ContactReport& contact : world.contacts()) {
            const auto upper = std::max(std::find(bodies.begin(), bodies.end(), contact.a),
                                        std::find(bodies.begin(), bodies.end(), contact.b));
            const double weight = kPull * kBoxMass * static_cast<double>(bodies.end() - upper);
            EXPECT_NEAR(std::abs(contact.force.z()), weight, 0.35 * weight) << times << " times";
        }
    }
}

TEST(ReleasedLoads, AreTheSameOnAnyNumberOfThreads)
{
    const auto run = [](int threads) {
        World world(loaded_tower(1000), threads);
        world.step(300);
        const BodyId load = load_of(world);
        world.remove(std::span(&load, 1));
        world.step(30);
        return world.state_hash();
    };
    EXPECT_EQ(run(1), run(2));
}

}  // namespace
}  // namespace throng
