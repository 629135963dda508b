// What a step keeps to with response=penalty and response=kinematic, through the public door.
#include "tests/support/small_scenes.hpp"
#include "throng/catalog.hpp"
#include "throng/world.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

using given::SceneOf;

constexpr double kGravity = 9.81;

SceneOf on_a_floor(Response response)
{
    SceneOf made;
    made.scene.settings.response = response;
    made.scene.settings.precision = Precision::double_;
    made.scene.settings.sleep = false;
    made.floor();
    return made;
}

// One box of 1 kg and 1 m, its lower face at that height.
SceneOf lone_box(Response response, double height)
{
    SceneOf made = on_a_floor(response);
    made.box(Vec3::Constant(0.5), Vec3(0, 0, 0.5 + height)).mass = 1;
    return made;
}

BodyId last_of(const World& world) { return world.bodies().back(); }

TEST(Responses, ABoxComesToRestOnAPlane)
{
    for (const Response response : {Response::penalty, Response::kinematic})
        for (const Precision precision : {Precision::float_, Precision::double_}) {
            SceneOf made = lone_box(response, 0.1);
            made.scene.settings.precision = precision;
            World world(made.scene);
            world.step(300);
            EXPECT_LT(world.velocity(last_of(world)).norm(), 1e-6);
            EXPECT_LT(world.angular_velocity(last_of(world)).norm(), 1e-6);
            // Springs are as stiff as lets a corner, four times as easy to move as the middle,
            // swing by half a radian in a substep.
            const double swing = world.settings().dt / world.settings().substeps / 0.5;
            const double sunk = response == Response::penalty ? 4 * kGravity * swing * swing : 0;
            EXPECT_NEAR(world.pose(last_of(world)).position.z(), 0.5 - sunk, 1e-5);
            EXPECT_TRUE(world.warnings().empty());
        }
}

TEST(Responses, PenaltyOverlapIsLoadOverStiffness)
{
    for (const double stiffness : {2e4, 1e5}) {
        SceneOf made = lone_box(Response::penalty, 0);
        made.scene.settings.penalty_stiffness = stiffness;
        World world(made.scene);
        world.step(300);
        const double wanted = kGravity / (4 * stiffness);  // on four corners
        EXPECT_NEAR(world.measure().greatest_overlap, wanted, 1e-4 * wanted);
        EXPECT_NEAR(world.contact_force(last_of(world)).z(), kGravity, 1e-4 * kGravity);
    }
}

TEST(Responses, PenaltyStackBearsItself)
{
    SceneOf made = on_a_floor(Response::penalty);
    for (int k = 0; k < 4; ++k) made.box(Vec3::Constant(0.5), Vec3(0, 0, 0.5 + k)).mass = 1;
    World world(made.scene);
    world.step(1200);  // its slowest swing fades to a tenth every second
    for (const BodyId body : world.bodies()) EXPECT_LT(world.velocity(body).norm(), 1e-6);
    EXPECT_NEAR(world.contact_force(world.bodies().front()).z(), -4 * kGravity, 1e-3 * kGravity);
}

TEST(Responses, PenaltyFrictionSlidesByCoulombsLaw)
{
    SceneOf made = lone_box(Response::penalty, 0);
    made.scene.settings.dt = 1e-3;
    made.scene.settings.penalty_stiffness = 1e5;
    made.scene.bodies.back().position.z() -=
        kGravity / 4e5;  // already as deep as its weight has it
    made.scene.bodies.back().velocity = Vec3(4, 0, 0);
    World world(made.scene);
    world.step(500);
    // Braking loads the corners in front and unloads those behind: the sum stays its weight.
    EXPECT_NEAR(world.velocity(last_of(world)).x(), 4 - 0.5 * kGravity * 0.5, 1e-2);
}

// Friction is a spring with a damper: what sticks gives way as far as that bears it, and stays.
TEST(Responses, PenaltyFrictionHolds)
{
    const double slope = 0.3;  // tan, where friction would bear 0.5
    for (const double dt : {1.0 / 60, 1e-3}) {
        SceneOf made = lone_box(Response::penalty, 0);
        made.scene.settings.dt = dt;
        made.scene.gravity = kGravity * Vec3(slope, 0, -1).normalized();
        World world(made.scene);
        const int steps = static_cast<int>(2.5 / dt);
        world.step(steps);
        const Vec3 before = world.pose(last_of(world)).position;
        EXPECT_LT(std::abs(before.x()), 0.05);
        world.step(steps);
        EXPECT_LT((world.pose(last_of(world)).position - before).norm(), 1e-6);
        EXPECT_LT(world.velocity(last_of(world)).norm(), 1e-6);
    }
}

TEST(Responses, PenaltyRollingFrictionBringsABallToAStop)
{
    const double radius = 0.5, rolling = 0.02, speed = 0.5;
    SceneOf made = on_a_floor(Response::penalty);
    made.scene.materials[0].rolling_friction = rolling;
    BodyDescription& ball = made.ball(radius, Vec3(0, 0, radius));
    ball.mass = 1;
    ball.velocity = Vec3(speed, 0, 0);
    ball.angular_velocity = Vec3(0, speed / radius, 0);
    World world(made.scene);
    // A torque of rolling times the weight slows a solid ball that goes on rolling by this.
    const double slowing = rolling * kGravity / (1.4 * radius);
    world.step(60);
    EXPECT_NEAR(world.velocity(last_of(world)).x(), speed - slowing, 0.02 * slowing);
    world.step(120);
    EXPECT_LT(world.velocity(last_of(world)).norm(), 1e-6);
    EXPECT_LT(world.angular_velocity(last_of(world)).norm(), 1e-6);
}

// A heap falls onto springs a thousand times too stiff for its steps, and many of its boxes come to
// overlap beside what contacts had looked for: centimeters, which such springs hold a megajoule by.
TEST(Responses, PenaltyHeapOnStiffSpringsGainsNothing)
{
    for (const Integrator integrator : {Integrator::semi_implicit, Integrator::euler}) {
        Scene scene = make_scene("pile", 60);
        scene.settings.response = Response::penalty;
        scene.settings.penalty_stiffness = 1e9;
        scene.settings.substeps = 1;
        scene.settings.integrator = integrator;
        World world(scene);
        const Measures before = world.measure();
        double most = 0;
        for (int step = 0; step < 60; ++step) {
            world.step();
            most = std::max(most, world.measure().kinetic_energy);
        }
        EXPECT_LT(most, before.kinetic_energy + before.potential_energy);
        EXPECT_EQ(world.report().bodies_quarantined, 0u);
    }
}

// 5 m/s onto a spring that takes thirty substeps to turn it round.
TEST(Responses, PenaltyLosesLittleOfAnElasticBounce)
{
    SceneOf made = on_a_floor(Response::penalty);
    made.scene.gravity = Vec3::Zero();
    made.scene.materials[0].restitution = 1;
    made.scene.settings.dt = 1e-3;
    made.scene.settings.penalty_stiffness = 1e5;
    BodyDescription& ball = made.ball(0.5, Vec3(0, 0, 0.6));
    ball.mass = 1;
    ball.velocity = Vec3(0, 0, -5);
    World world(made.scene);
    world.step(60);
    EXPECT_NEAR(world.velocity(last_of(world)).z(), 5, 0.05);
}

// By stiffness and damping of auto, at any step.
TEST(Responses, PenaltyBouncesByTheCoefficient)
{
    for (const double restitution : {0.0, 0.5, 1.0})
        for (const double dt : {1.0 / 60, 1e-3}) {
            SceneOf made = on_a_floor(Response::penalty);
            made.scene.gravity = Vec3::Zero();
            made.scene.materials[0].restitution = restitution;
            made.scene.materials[0].friction = 0;
            made.scene.settings.dt = dt;
            made.ball(0.5, Vec3(0, 0, 1)).velocity = Vec3(0, 0, -5);
            made.ball(0.5, Vec3(5, 0, 3)).velocity = Vec3(2, 0, 0);
            made.ball(0.5, Vec3(7, 0, 3)).mass = 1;
            World world(made.scene);
            world.step(static_cast<int>(0.8 / dt));
            const std::vector<BodyId> ids = world.bodies();
            EXPECT_NEAR(world.velocity(ids[1]).z(), 5 * restitution, 1e-6) << restitution;
            EXPECT_NEAR((world.velocity(ids[3]) - world.velocity(ids[2])).x(), 2 * restitution,
                        1e-6);
        }
}

TEST(Responses, PenaltySlowsASlidingBounceByAllThatPressesIt)
{
    SceneOf made = on_a_floor(Response::penalty);
    made.scene.gravity = Vec3::Zero();
    made.scene.materials[0].restitution = 0.8;
    made.scene.materials[0].friction = 0.2;
    BodyDescription& ball = made.ball(0.5, Vec3(0, 0, 1));
    ball.velocity = Vec3(10, 0, -4);
    World world(made.scene);
    world.step(30);
    EXPECT_NEAR(world.velocity(last_of(world)).x(), 10 - 1.8 * 0.2 * 4, 1e-4);
}

TEST(Responses, KinematicTellsTheForceOfItsContacts)
{
    SceneOf made = on_a_floor(Response::kinematic);
    made.ball(0.5, Vec3(0, 0, 0.5)).mass = 3;
    World world(made.scene);
    world.step(30);
    EXPECT_NEAR(world.contact_force(last_of(world)).z(), 3 * kGravity, 0.01 * kGravity);
}

TEST(Responses, PenaltyBeyondTheLimitIsCutAndSaid)
{
    SceneOf made = lone_box(Response::penalty, 0);
    made.scene.settings.penalty_stiffness = 1e8;
    World world(made.scene);
    world.step(300);
    ASSERT_EQ(world.warnings().size(), 1u);
    const std::string said = world.warnings().front();
    EXPECT_NE(said.find("penalty_stiffness"), std::string::npos) << said;
    EXPECT_LT(world.velocity(last_of(world)).norm(), 1e-3);
    const auto at = said.find("take substeps=");
    ASSERT_NE(at, std::string::npos) << said;
    // What it says would do does.
    made.scene.settings.substeps = std::stoi(said.substr(at + 14));
    World finer(made.scene);
    finer.step(60);
    EXPECT_TRUE(finer.warnings().empty());
}

TEST(Responses, KinematicPartsBodiesNoFasterThanThePushLimit)
{
    SceneOf made = on_a_floor(Response::kinematic);
    made.scene.gravity = Vec3::Zero();
    made.scene.settings.push_limit = 0.6;
    for (int i = 0; i < 2; ++i) made.ball(0.5, Vec3(0.4 * i, 0, 5)).mass = 1 + i;
    World world(made.scene);
    const BodyId a = world.bodies()[1], b = world.bodies()[2];
    const auto apart = [&] { return (world.pose(b).position - world.pose(a).position).norm(); };
    world.step(30);
    EXPECT_NEAR(apart(), 0.4 + 0.6 * 0.5, 1e-9);
    world.step(60);
    EXPECT_NEAR(apart(), 1, 1e-6);
    EXPECT_EQ(world.velocity(a), Vec3(Vec3::Zero()));
    EXPECT_EQ(world.velocity(b), Vec3(Vec3::Zero()));
    // Half the way each, whatever they weigh.
    EXPECT_NEAR(world.pose(a).position.x(), -0.3, 1e-6);
}

TEST(Responses, KinematicTakesTheSpeedThatClosesAndKeepsTheSpeedAcross)
{
    SceneOf made = on_a_floor(Response::kinematic);
    made.scene.gravity = Vec3::Zero();
    made.scene.materials[0].friction = 0;
    made.ball(0.5, Vec3(0, 0, 0.499)).velocity = Vec3(2, 0, -3);
    World world(made.scene);
    world.step();
    EXPECT_NEAR(world.velocity(last_of(world)).x(), 2, 1e-12);
    EXPECT_NEAR(world.velocity(last_of(world)).z(), 0, 1e-12);
}

TEST(Responses, AreTheSameBitsOnAnyNumberOfThreads)
{
    for (const Response response : {Response::penalty, Response::kinematic}) {
        Scene scene = given::mixed_scene();
        scene.settings.response = response;
        std::string wanted;
        for (const int threads : {1, 2, 3}) {
            World world(scene, threads);
            world.step(120);
            if (threads == 1) wanted = world.state_hash();
            EXPECT_EQ(world.state_hash(), wanted) << threads;
            EXPECT_EQ(world.report().bodies_quarantined, 0u);
        }
    }
}

}  // namespace
}  // namespace throng
