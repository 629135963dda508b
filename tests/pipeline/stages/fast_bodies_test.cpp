// Fast bodies: whoever goes far in a step is stopped where it meets something, and by nothing else.
#include "kernels/math/rotation.hpp"
#include "scene/catalog/closed_meshes.hpp"
#include "scene/catalog/parts.hpp"
#include "tests/support/dice.hpp"
#include "tests/support/small_scenes.hpp"
#include "tests/support/watched.hpp"
#include "throng/energy_ledger.hpp"
#include "throng/world.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace throng {
namespace {

using given::SceneOf;
using test::Dice;

constexpr ToiMethod kMethods[] = {ToiMethod::newton, ToiMethod::bisection, ToiMethod::conservative};

SceneOf weightless(double restitution = 0)
{
    SceneOf made;
    made.scene.gravity = Vec3::Zero();
    made.scene.materials[0].friction = 0;
    made.scene.materials[0].restitution = restitution;
    return made;
}

MeshShape sheet(double half)
{
    MeshShape mesh;
    mesh.vertices = {{0, -half, -half}, {0, half, -half}, {0, half, half}, {0, -half, half}};
    mesh.triangles = {{0, 2, 1}, {0, 3, 2}};  // faces -x
    return mesh;
}

void still(BodyDescription& body) { body.motion = Motion::static_; }

bool has_stage(World& world, std::string_view name)
{
    const auto stages = world.step_stages();
    return std::any_of(stages.begin(), stages.end(),
                       [&](const World::StageInfo& stage) { return stage.name == name; });
}

double x_of(const World& world, std::size_t place)
{
    return world.pose(world.bodies()[place]).position.x();
}

TEST(FastBodies, NeverComeThroughAThinPlateOrASheet)
{
    for (const ToiMethod method : kMethods)
        for (const double dt : {1.0 / 60, 1.0 / 240, 0.01})
            for (const bool marked : {false, true}) {
                SceneOf made = weightless();
                made.scene.settings.dt = dt;
                made.scene.settings.toi_method = method;
                still(made.box({0.0005, 1, 1}, Vec3::Zero()));
                still(made.body(made.shape(sheet(1)), {0, 10, 0}));
                for (const double y : {0.2, 10.2}) {
                    made.ball(0.005, {-10, y, 0.1}).velocity = Vec3(1000, 0, 0);
                    made.box({0.1, 0.02, 0.05}, {-10, y - 0.5, 0.1}).velocity = Vec3(500, 1, 2);
                    made.scene.bodies.back().angular_velocity = Vec3(10, 70, -40);
                }
                for (auto& body : made.scene.bodies) body.fast = marked;
                World world(made.scene);
                for (int step = 0; step < 30; ++step) {
                    world.step();
                    for (std::size_t i = 2; i < 6; ++i) EXPECT_LT(x_of(world, i), 0.001);
                }
            }
}

// The middle of a ring is outside of it, and what stands for it is off by more than the tolerance.
TEST(FastBodies, ThatAreRingsAreNotCaughtInABoardNorFallThroughASheet)
{
    MeshShape flat;
    flat.vertices = {{-50, -50, 0}, {50, -50, 0}, {50, 50, 0}, {-50, 50, 0}};
    flat.triangles = {{0, 1, 2}, {0, 2, 3}};
    const MeshShape ring = mesh_shape(torus_mesh(0.1, 0.01, 16, 8));
    for (const bool board : {true, false})
        for (const NonConvex way : {NonConvex::voxels, NonConvex::depth_image}) {
            SceneOf made;
            made.scene.materials[0].friction = 0.5;
            made.scene.settings.nonconvex = way;
            if (board)
                still(made.box({50, 50, 0.01}, {0, 0, -0.01}));
            else
                still(made.body(made.shape(flat), Vec3::Zero()));
            const auto shape = made.shape(ring);
            Dice dice(4);
            for (int i = 0; i < 8; ++i) {
                BodyDescription& body =
                    made.body(shape, {5.0 * (i % 4), 5.0 * (i / 4), dice.between(0.15, 0.4)});
                body.orientation = dice.turn();
                body.velocity = dice.point(7);
                body.velocity.z() = -7;
                body.angular_velocity = dice.point(10);
            }
            World world(made.scene);
            for (int step = 0; step < 180; ++step) world.step();
            for (std::size_t i = 1; i <= 8; ++i) {
                const Pose pose = world.pose(world.bodies()[i]);
                double lowest = 1;
                for (const Vec3& vertex : ring.vertices)
                    lowest = std::min(lowest, (pose * vertex).z());
                EXPECT_GT(lowest, -0.005) << board << ", body " << i;
            }
        }
}

TEST(FastBodies, MeetTheWallAtTheirTimeOfImpact)
{
    SceneOf made = weightless();
    still(made.box({0.5, 1, 1}, {0.5, 0, 0}));
    made.ball(0.1, {-3, 0, 0}).velocity = Vec3(300, 0, 0);
    World world(made.scene);
    world.step();
    // Held within the tolerance of the wall, and as fast as it was.
    EXPECT_LE(x_of(world, 1), -0.1);
    EXPECT_GE(x_of(world, 1), -0.1 - 1e-4 * 0.1);
    EXPECT_EQ(world.velocity(world.bodies()[1]), Vec3(300, 0, 0));
    world.step();
    EXPECT_NEAR(world.velocity(world.bodies()[1]).x(), 0, 0.1);
    EXPECT_LE(x_of(world, 1), -0.1 + 1e-3);
}

TEST(FastBodies, BounceOffWithWhatTheyHad)
{
    SceneOf made = weightless(1);
    still(made.box({0.01, 1, 1}, {0.01, 0, 0}));
    made.ball(0.1, {-3, 0, 0}).velocity = Vec3(300, 0, 0);
    World world(made.scene);
    world.step(4);
    EXPECT_NEAR(world.velocity(world.bodies()[1]).x(), -300, 0.3);
    EXPECT_LT(x_of(world, 1), -5);
}

// Who is held at a touch has not fallen the rest of the step's way, and has not its speed.
TEST(FastBodies, AreHeldWithTheEnergyTheyHad)
{
    for (const double dt : {1.0 / 30, 1.0 / 60, 1.0 / 240})
        for (const double height : {0.96, 1.1, 3.0}) {
            SceneOf made;
            made.scene.settings.dt = dt;
            made.scene.materials[0].friction = 0;
            made.floor();
            made.body(made.shape(CylinderShape{0.48, 0.48}), Vec3(0, 0, 0.48 + height)).fast = true;
            const auto ledger = given::watched<EnergyLedger>(made.scene, static_cast<int>(1 / dt));
            EXPECT_LE(ledger.gained(), 1e-4 * ledger.greatest_kinetic()) << dt << ' ' << height;
        }
}

// What a run makes, as a share of its greatest motion.
double share_made(const Scene& scene, int steps)
{
    const auto ledger = given::watched<EnergyLedger>(scene, steps);
    return ledger.gained() / ledger.greatest_kinetic();
}

// A corner that comes round strikes, and the same step takes the box up again from lower than it is
// held at: that much higher it is not as fast, nor, where it does not rise fast enough for that,
// does it spin as fast.
TEST(FastBodies, ThatAreThrownBackWithinTheStepAreHeldWithTheEnergyTheyHad)
{
    Dice dice(23);
    for (const int substeps : {4, 16})
        for (int i = 0; i < 40; ++i) {
            SceneOf made;
            made.scene.settings.substeps = substeps;
            made.scene.materials[0].friction = 0;
            made.scene.materials[0].restitution = 1;
            still(made.box({100, 100, 0.1}, {0, 0, -0.1}));
            BodyDescription& box = made.box({0.02, 0.012, 0.012}, {0, 0, 0.2});
            box.velocity = Vec3(1, 0, -2);
            box.angular_velocity = dice.point(80);
            EXPECT_LE(share_made(made.scene, 600), 5e-3) << substeps << ' ' << i;
        }
}

// A wind that blows at the floor, harder than gravity pulls.
TEST(FastBodies, AreHeldWithoutWhatTheWindGaveForTheRestOfTheirWay)
{
    for (const double height : {0.03, 0.07, 0.072, 0.1, 0.15})
        for (const double tilt : {0.2, 0.9, 1.4}) {
            SceneOf made;
            made.scene.materials[0].friction = 0;
            made.scene.materials[0].restitution = 1;
            made.scene.wind = Vec3(0, 0, -8);
            made.floor();
            BodyDescription& pill =
                made.body(made.shape(CapsuleShape{0.005, 0.004}), {0, 0, height});
            pill.orientation = turned(Quat::Identity(), Vec3(tilt, 0, 0), 1);
            pill.mass = 0.007;
            pill.linear_drag = 0.03;
            EXPECT_LE(share_made(made.scene, 300), 2e-3) << height << ' ' << tilt;
        }
}

// A block that swings down round its pivot, and is held as a corner of it meets the floor: within
// ten steps. Later one that stands on its head may be lifted as contacts push it out.
TEST(FastBodies, OnAPivotAreHeldWithTheEnergyTheyHad)
{
    for (const double spin : {12.0, 17.0, 22.0, 27.0})
        for (const double tilt : {0.0, 0.3, 0.6, 0.9}) {
            SceneOf made;
            made.scene.materials[0].friction = 0;
            made.floor();
            BodyDescription& block = made.box({0.02, 0.01, 0.015}, {0, 0, 0.035});
            block.pivot = Vec3(0.02, 0, -0.01);
            block.orientation = turned(Quat::Identity(), Vec3(0, tilt, 0), 1);
            block.angular_velocity = Vec3(0, -spin, 3);
            EXPECT_LE(share_made(made.scene, 10), 3e-3) << spin << ' ' << tilt;
        }
}

TEST(FastBodies, FlyPastACornerUndeflected)
{
    for (const bool marked : {false, true})
        for (const double separation : {1e-4, 0.02, 0.3}) {
            SceneOf made = weightless();
            still(made.box(Vec3::Constant(1), Vec3::Zero()));
            still(made.body(made.shape(sheet(1)), {0, -4, 0}));
            // Over the edges of the box and of the sheet, by less than their way in a step.
            const double radius = 0.2, speed = marked ? 8 : 40;
            made.ball(radius, {-3.05, 1 + radius + separation, 0}).velocity = Vec3(speed, 0, 0);
            made.scene.bodies.back().fast = marked;
            made.ball(radius, {-3.05, -3 + radius + separation, 0}).velocity = Vec3(speed, 0, 0);
            made.scene.bodies.back().fast = marked;
            World world(made.scene);
            for (int step = 0; step < 60; ++step) {
                world.step();
                for (std::size_t i = 2; i < 4; ++i)
                    ASSERT_EQ(world.velocity(world.bodies()[i]), Vec3(speed, 0, 0)) << separation;
            }
            EXPECT_GT(x_of(world, 2), 4);
            EXPECT_GT(x_of(world, 3), 4);
        }
}

TEST(FastBodies, MeetEachOther)
{
    for (const ToiMethod method : kMethods) {
        SceneOf made = weightless(1);
        made.scene.settings.toi_method = method;
        made.ball(0.01, {-5, 0, 0}).velocity = Vec3(1000, 0, 0);
        made.ball(0.01, {5, 0, 0}).velocity = Vec3(-1000, 0, 0);
        made.ball(0.01, {-5, 3, 0}).velocity = Vec3(1000, 0, 0);
        made.ball(0.01, {5, 3.0201, 0}).velocity = Vec3(-1000, 0, 0);
        World world(made.scene);
        world.step(4);
        EXPECT_NEAR(world.velocity(world.bodies()[0]).x(), -1000, 1);
        EXPECT_NEAR(world.velocity(world.bodies()[1]).x(), 1000, 1);
        EXPECT_LT(x_of(world, 0), x_of(world, 1));
        EXPECT_EQ(world.velocity(world.bodies()[2]), Vec3(1000, 0, 0));
        EXPECT_EQ(world.velocity(world.bodies()[3]), Vec3(-1000, 0, 0));
    }
}

TEST(FastBodies, TurnNoFurtherThanTheWall)
{
    // 150 degrees in the step: neither end of it touches.
    constexpr double kPi = 3.14159265358979323846;
    SceneOf made = weightless();
    made.ball(0.3, {5, 5, 5});  // somebody else
    still(made.box({0.05, 3, 3}, {0.65, 0, 0}));
    BodyDescription& rod = made.body(made.shape(CapsuleShape{0.02, 1}), Vec3::Zero());
    rod.orientation = exponential(Vec3(-kPi / 2, 0, 0));
    rod.angular_velocity = Vec3(0, 0, -50 * kPi);
    World world(made.scene);
    world.step();
    const Vec3 axis = world.pose(world.bodies()[2]).orientation * Vec3::UnitZ();
    EXPECT_LE(std::abs(axis.x()) + 0.02, 0.6 + 1e-9);
    EXPECT_GE(std::abs(axis.x()) + 0.02, 0.6 - 1e-4);
}

TEST(FastBodies, AreSweptAlongByWhatMovesByItself)
{
    for (const double speed : {5.0, 60.0, 300.0}) {
        SceneOf made = weightless();
        made.ball(0.1, {1, 0, 0});
        made.box({0.1, 0.2, 0.1}, {1.5, 3, 0});
        BodyDescription& plate = made.box({0.01, 5, 5}, {-1, 0, 0});
        plate.motion = Motion::kinematic;
        plate.velocity = Vec3(speed, 0, 0);
        World world(made.scene);
        for (int step = 0; step < 60; ++step) {
            world.step();
            for (std::size_t i = 0; i < 2; ++i) EXPECT_GT(x_of(world, i), x_of(world, 2)) << speed;
        }
    }
}

TEST(FastBodies, AreNoticedAsTheyFallFasterAndFaster)
{
    SceneOf made;
    still(made.box({1, 1, 0.001}, {0, 0, 0}));
    still(made.body(made.shape(sheet(1)), {5, 0, 0}));
    made.scene.bodies.back().orientation = exponential(Vec3(0, 1.5707963267948966, 0));
    made.ball(0.03, {0.1, 0, 30});
    made.ball(0.03, {5.1, 0.2, 30});
    World world(made.scene);
    EXPECT_FALSE(world.effects().on.has(Effect::fast_motion));
    EXPECT_FALSE(has_stage(world, "continuous_collision"));
    for (int step = 0; step < 240; ++step) {
        world.step();
        for (std::size_t i = 2; i < 4; ++i)
            EXPECT_GT(world.pose(world.bodies()[i]).position.z(), 0.01);
    }
    EXPECT_TRUE(world.effects().on.has(Effect::fast_motion));
    EXPECT_EQ(world.effects().cause_of(Effect::fast_motion), "body 2");
    EXPECT_TRUE(has_stage(world, "continuous_collision"));
}

TEST(FastBodies, AreStoppedWithinTheStepOfTheBlowThatMadeThemFast)
{
    // A cannon ball hits a pea that stands in front of a sheet.
    SceneOf made = weightless(1);
    still(made.body(made.shape(sheet(2)), {0.3, 0, 0}));
    made.ball(0.01, {0, 0, 0});
    made.ball(0.5, {-0.515, 0, 0}).velocity = Vec3(40, 0, 0);
    made.scene.bodies.back().mass = 1000;
    World world(made.scene);
    for (int step = 0; step < 2; ++step) {
        world.step();
        EXPECT_LT(x_of(world, 1), 0.3 + 0.005);
    }
}

TEST(FastBodies, SlideAlongAFloorOfTrianglesUnhindered)
{
    SceneOf made;
    made.scene.materials[0].friction = 0;
    MeshShape floor;
    for (int i = 0; i <= 40; ++i)
        for (const double y : {-2.0, 2.0}) floor.vertices.push_back({i * 1.0, y, 0});
    for (std::uint32_t i = 0; i < 80; i += 2) {
        floor.triangles.push_back({i, i + 2, i + 3});
        floor.triangles.push_back({i, i + 3, i + 1});
    }
    still(made.body(made.shape(floor), Vec3::Zero()));
    made.box({0.1, 0.1, 0.1}, {1, 0, 0.1}).velocity = Vec3(30, 0, 0);
    made.scene.bodies.back().fast = true;
    made.ball(0.1, {1, 1, 0.1}).velocity = Vec3(30, 0, 0);
    World world(made.scene);
    world.step(60);
    for (std::size_t i = 1; i < 3; ++i) {
        EXPECT_NEAR(x_of(world, i), 31, 0.3);
        EXPECT_NEAR(world.pose(world.bodies()[i]).position.z(), 0.1, 0.01);
    }
}

Scene swarm()
{
    Dice dice(21);
    SceneOf made = weightless(0.5);
    for (const double side : {-1.0, 1.0})
        for (int axis = 0; axis < 3; ++axis) {
            Vec3 half = Vec3::Constant(6), place = Vec3::Zero();
            half[axis] = 0.01;
            place[axis] = side * 5;
            still(made.box(half, place));
        }
    for (int i = 0; i < 150; ++i) {
        BodyDescription& body = i % 2 == 0 ? made.ball(0.05, dice.point(4.5))
                                           : made.box({0.02, 0.05, 0.1}, dice.point(4.5));
        body.velocity = dice.point(150);
        body.angular_velocity = dice.point(100);
    }
    return made.scene;
}

TEST(FastBodies, OfASwarmAllStayInTheirBox)
{
    World world(swarm());
    for (int step = 0; step < 60; ++step) {
        world.step();
        for (const BodyId body : world.bodies())
            EXPECT_LT(world.pose(body).position.cwiseAbs().maxCoeff(), 5.001);
    }
}

TEST(FastBodies, HaveTheSameBitsOnAnyNumberOfThreads)
{
    std::string hash;
    for (const int threads : {1, 2, 3}) {
        World world(swarm(), threads);
        world.step(20);
        if (hash.empty()) hash = world.state_hash();
        EXPECT_EQ(world.state_hash(), hash);
    }
    World world(swarm());
    world.run_in_order(true);
    world.step(20);
    EXPECT_EQ(world.state_hash(), hash);
}

// A thin rod tips over on a smooth floor, its end sliding: what it gains in energy, J, all in all.
double gained_by_tipping(double speed)
{
    SceneOf made;
    made.scene.materials[0].friction = 0;
    made.floor();
    BodyDescription& rod = made.body(made.shape(CapsuleShape{0.01, 0.5}), Vec3(0, 0, 0.4498));
    rod.orientation = turned(Quat::Identity(), Vec3(0, 0.5, 0), 1);
    rod.velocity = Vec3(speed, 0, 0);
    World world(made.scene);
    double energy = 1e30, gained = 0;
    for (int step = 0; step < 60; ++step) {
        world.step();
        EXPECT_TRUE(step == 0 || world.report().contacts > 0) << "step " << step;
        const Measures now = world.measure();
        gained += std::max(0.0, now.kinetic_energy + now.potential_energy - energy);
        energy = now.kinetic_energy + now.potential_energy;
    }
    return gained;
}

TEST(FastBodies, KeepTouchingWhatTheySlideOn)
{
    // Of the 1.4 J that it falls by; soft contacts give it some whatever its speed, and lost at
    // every other step they gave three quarters.
    for (const double speed : {3.0, 8.0}) EXPECT_LT(gained_by_tipping(speed), 0.07 * 1.4) << speed;
}

TEST(FastBodies, AreNoneInAHeapAtRest)
{
    World world(given::mixed_scene());
    world.step(30);
    EXPECT_FALSE(world.effects().on.has(Effect::fast_motion));
}

}  // namespace
}  // namespace throng
