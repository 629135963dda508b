// Parting: bodies made deep inside one another move apart, and get no speed by it.
#include "pipeline/energy_ledger.hpp"
#include "tests/pipeline/small_scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace throng {
namespace {

using given::greatest_speed;
using given::SceneOf;

// A heap of boxes of 1 m, each a quarter inside its neighbors.
SceneOf heap(int side, Precision precision = Precision::float_)
{
    SceneOf made;
    made.scene.settings.sleep = false;
    made.scene.settings.precision = precision;
    for (int x = 0; x < side; ++x)
        for (int y = 0; y < side; ++y)
            for (int z = 0; z < side; ++z)
                made.box(Vec3::Constant(0.5), 0.75 * Vec3(x, y, z) + Vec3(0, 0, 0.5)).mass = 1;
    return made;
}

TEST(Parting, BodiesAtRestStayAtRestAndComeApart)
{
    for (const Precision precision : {Precision::float_, Precision::double_}) {
        SceneOf made = heap(3, precision);
        made.scene.gravity = Vec3::Zero();
        World world(made.scene);
        const double limit = world.settings().push_limit;
        double fastest = 0, shrank = 0, overlap = world.measure().greatest_overlap;
        Vec3 middle = Vec3::Zero(), after = Vec3::Zero();
        for (const BodyId body : world.bodies()) middle += world.pose(body).position;
        for (int step = 0; step < 600; ++step) {
            world.step();
            fastest = std::max(fastest, greatest_speed(world));
            const double now = world.measure().greatest_overlap;
            shrank = std::max(shrank, (overlap - now) / world.settings().dt);
            overlap = now;
        }
        for (const BodyId body : world.bodies()) after += world.pose(body).position;
        EXPECT_LT(fastest, 1e-3);
        EXPECT_LE(shrank, limit * (1 + 1e-6));
        EXPECT_LT(overlap, 1e-3);
        EXPECT_LT((after - middle).norm(), 1e-3);
    }
}

TEST(Parting, OnAFloorAHeapSettlesWithoutFlyingUp)
{
    SceneOf made = heap(3);
    made.floor();
    World world(made.scene);
    EnergyLedger ledger;
    double highest = 0;
    for (int step = 0; step < 600; ++step) {
        ledger.before_step(world);
        world.step();
        ledger.after_step(world);
        for (const BodyId body : world.bodies())
            highest = std::max(highest, world.pose(body).position.z());
    }
    // Three boxes and what they were inside one another, and no more than a corner above that.
    EXPECT_LT(highest, 2.5 + 0.4);
    EXPECT_LT(world.measure().greatest_overlap, 5e-3);
    EXPECT_LT(greatest_speed(world), 1e-2);
}

TEST(Parting, BodiesThatMoveTogetherKeepTheirVelocity)
{
    SceneOf made = heap(2, Precision::double_);
    made.scene.gravity = Vec3::Zero();
    const Vec3 velocity(3, -2, 1);
    for (BodyDescription& body : made.scene.bodies) body.velocity = velocity;
    World world(made.scene);
    for (int step = 0; step < 300; ++step) {
        world.step();
        for (const BodyId body : world.bodies())
            ASSERT_LT((world.velocity(body) - velocity).norm(), 1e-3);
    }
    EXPECT_LT(world.measure().greatest_overlap, 1e-3);
}

TEST(Parting, HasTheSameBitsOnAnyNumberOfThreadsAndRunInOrder)
{
    for (const FrictionAt at : {FrictionAt::manifold, FrictionAt::points}) {
        SceneOf made = heap(4);
        made.scene.settings.friction_at = at;
        made.scene.materials[0].rolling_friction = 0.01;
        made.scene.materials[0].restitution = 0.3;
        made.floor();
        std::vector<std::string> hashes;
        for (const int threads : {1, 2, 3, 1}) {
            World world(made.scene, threads);
            world.run_in_order(hashes.size() == 3);
            world.step(60);
            hashes.push_back(world.state_hash());
        }
        for (const std::string& hash : hashes) EXPECT_EQ(hash, hashes[0]);
    }
}

}  // namespace
}  // namespace throng
