// Contact check: residuals of contacts whose misses are known by hand, and of those that keep the
// law.
#include "throng/contact_check.hpp"

#include "tests/support/small_scenes.hpp"
#include "tests/support/watched.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace throng {
namespace {

using given::SceneOf;
using given::watched;

constexpr double kGravity = 9.81, kFrame = 1.0 / 60, kFriction = 0.5;

// A box that may not turn, so that a push gives it its impulse over its mass wherever it is.
SceneOf sled()
{
    SceneOf made;
    made.scene.settings.sleep = false;
    made.scene.settings.precision = Precision::double_;
    made.floor();
    made.box(Vec3(0.5, 0.5, 0.25), Vec3(0, 0, 0.25)).lock_rotation = true;
    return made;
}
BodyId last_of(const World& world) { return world.bodies().back(); }

// What a world shows that is not as its step left it.
ContactResiduals once_moved_at(World& world, const Vec3& velocity)
{
    ContactResiduals residuals;
    residuals.before_step(world);
    world.step();
    world.set_velocity(last_of(world), velocity, Vec3::Zero());
    residuals.after_step(world);
    return residuals;
}

TEST(ContactResiduals, OfWhatRestsAreNone)
{
    SceneOf made = sled();
    made.scene.bodies[1].lock_rotation = false;
    const ContactResiduals residuals = watched<ContactResiduals>(made.scene, 60);
    EXPECT_TRUE(residuals.known());
    EXPECT_LT(residuals.complementarity(), 1e-6);
    EXPECT_LT(residuals.friction_cone(), 1e-6);
}

TEST(ContactResiduals, OfWhatGoesInIsTheSpeedThatNothingStops)
{
    SceneOf made = sled();
    made.scene.settings.substeps = 1;
    made.scene.bodies[1].position.z() = 0.05;  // 12 m/s would be the way out in a step
    World world(made.scene);
    EXPECT_NEAR(once_moved_at(world, Vec3(0, 0, -2)).complementarity(), 2, 1e-9);
}

TEST(ContactResiduals, OfWhatIsStillAboveTheFloorAreNone)
{
    SceneOf made = sled();
    made.scene.bodies[1].position.z() = 0.26;  // found ahead of the touch
    World world(made.scene);
    EXPECT_EQ(once_moved_at(world, Vec3(3, 0, -2)).complementarity(), 0);
    EXPECT_EQ(once_moved_at(world, Vec3(3, 0, -2)).friction_cone(), 0);
}

// A contact that bears the weight and parts at once: faster than its force gives in 1/60 s, and
// slower.
TEST(ContactResiduals, OfWhatPartsAreTheLesserOfItsSpeedAndWhatIsGiven)
{
    World world(sled().scene);
    world.step(60);
    // Four points bear a quarter each.
    const double given = kGravity * kFrame / 4;
    EXPECT_NEAR(once_moved_at(world, Vec3(0, 0, 1)).complementarity(), given, 0.01 * given);
    World again(sled().scene);
    again.step(60);
    EXPECT_NEAR(once_moved_at(again, Vec3(0, 0, 0.01)).complementarity(), 0.01, 1e-9);
}

// What forces throw out of the floor is pushed as it parts: by a quarter at each of four points of
// what made it faster.
TEST(ContactResiduals, OfPenaltyForcesAreWhatTheyThrowBy)
{
    SceneOf made = sled();
    made.scene.settings.response = Response::penalty;
    made.scene.settings.substeps = 1;
    made.scene.bodies[1].position.z() = 0.2;
    World world(made.scene);
    int thrown = 0;
    for (int step = 0; step < 8; ++step) {
        const double before = world.velocity(last_of(world)).z();
        const double told = watched<ContactResiduals>(world, 1).complementarity();
        const double speed = world.velocity(last_of(world)).z();
        const double given = (speed - before + kGravity * kFrame) / 4;
        if (!(speed > 0)) continue;
        EXPECT_NEAR(told, std::min(given, speed), 1e-9) << step;
        thrown += told > 0.05 ? 1 : 0;
    }
    EXPECT_GE(thrown, 2);
}

TEST(ContactResiduals, OfSlidingAreNoneWhereFrictionOpposesIt)
{
    SceneOf made = sled();
    made.scene.bodies[1].velocity = Vec3(3, 2, 0);
    EXPECT_LT(watched<ContactResiduals>(made.scene, 20).friction_cone(), 1e-6);
}

TEST(ContactResiduals, OfSlidingAreWhatFrictionCouldDoAndDoesNot)
{
    const double most = kFriction * kGravity * kFrame;  // m/s
    const auto told = [](const Vec3& before, const Vec3& after) {
        SceneOf made = sled();
        made.scene.bodies[1].velocity = before;
        World world(made.scene);
        world.step(20);
        return once_moved_at(world, after).friction_cone();
    };
    // At rest friction is none: what creeps is not held, what slides is not slowed.
    EXPECT_NEAR(told(Vec3::Zero(), Vec3(0.01, 0, 0)), 0.01, 1e-6);
    EXPECT_NEAR(told(Vec3::Zero(), Vec3(0, 1, 0)), most, 0.01 * most);
    // It has been sliding: at once the other way, and across.
    EXPECT_NEAR(told(Vec3(5, 0, 0), Vec3(-1, 0, 0)), 2 * most, 0.01 * most);
    EXPECT_NEAR(told(Vec3(5, 0, 0), Vec3(0, 30, 0)), std::sqrt(2) * most, 0.01 * most);
}

// A pyramid has its sides along x and y here: aslant it bears sqrt(2) times too much.
TEST(ContactResiduals, OfAPyramidAreWhatItHasBeyondTheCone)
{
    SceneOf made = sled();
    made.scene.settings.friction_cone = FrictionCone::pyramid;
    made.scene.bodies[1].velocity = Vec3(3, 3, 0);
    const double beyond = (std::sqrt(2) - 1) * kFriction * kGravity * kFrame;
    EXPECT_NEAR(watched<ContactResiduals>(made.scene, 20).friction_cone(), beyond, 0.01 * beyond);
    made.scene.bodies[1].velocity = Vec3(3, 0, 0);
    EXPECT_LT(watched<ContactResiduals>(made.scene, 20).friction_cone(), 1e-5);
}

// What spins as it slides is held by less at points, which slide in unlike directions.
TEST(ContactResiduals, OfWhatSpinsAreSmallByEitherKindOfFriction)
{
    const double most = kFriction * kGravity * kFrame;  // m/s
    for (const FrictionAt at : {FrictionAt::manifold, FrictionAt::points}) {
        SceneOf made = sled();
        made.scene.settings.friction_at = at;
        made.scene.settings.iterations = 16;
        BodyDescription& box = made.scene.bodies[1];
        box.lock_rotation = false;
        box.velocity = Vec3(2, 0, 0);
        box.angular_velocity = Vec3(0, 0, 5);
        EXPECT_LT(watched<ContactResiduals>(made.scene, 10).friction_cone(), 0.1 * most);
    }
}

TEST(ContactResiduals, OfABallThatBouncesOrRollsAreNone)
{
    SceneOf made = sled();
    made.scene.materials[0].restitution = 1;
    made.scene.bodies.pop_back();
    made.ball(0.5, Vec3(0, 0, 1));
    World bounces(made.scene);
    for (int step = 0; step < 120; ++step)
        EXPECT_LT(watched<ContactResiduals>(bounces, 1).complementarity(), 1e-6) << step;
    EXPECT_GT(bounces.center_of_mass(last_of(bounces)).z(), 0.5);

    made.scene.materials[0].restitution = 0;
    made.scene.bodies.back().position.z() = 0.5;
    made.scene.bodies.back().velocity = Vec3(2, 0, 0);
    made.scene.bodies.back().angular_velocity = Vec3(0, 4, 0);
    EXPECT_LT(watched<ContactResiduals>(made.scene, 60).friction_cone(), 1e-6);
}

TEST(ContactResiduals, AreNotKnownWhereNoContactsAreKept)
{
    SceneOf made = sled();
    made.scene.settings.overlap = Overlap::back_up;
    const ContactResiduals residuals = watched<ContactResiduals>(made.scene, 3);
    EXPECT_FALSE(residuals.known());
    EXPECT_TRUE(std::isinf(residuals.complementarity()));
    EXPECT_TRUE(std::isinf(residuals.friction_cone()));
}

TEST(ContactResiduals, AreTheSameBitsOnAnyNumberOfThreads)
{
    const Scene scene = given::mixed_scene();
    World one(scene, 1), three(scene, 3);
    for (int step = 0; step < 60; ++step) {
        const auto a = watched<ContactResiduals>(one, 1), b = watched<ContactResiduals>(three, 1);
        EXPECT_EQ(a.complementarity(), b.complementarity()) << step;
        EXPECT_EQ(a.friction_cone(), b.friction_cone()) << step;
    }
}

TEST(ContactPairs, AreWhatTheStepFoundAndNotWhatOverlapsSince)
{
    SceneOf made = sled();
    made.box(Vec3(0.5, 0.5, 0.25), Vec3(5, 0, 0.25));
    World world(made.scene);
    EXPECT_TRUE(contact_pairs(world).empty());
    world.step(30);
    const std::vector<BodyPair> on_floor = {{0, 1}, {0, 2}}, with_both = {{0, 1}, {0, 2}, {1, 2}};
    EXPECT_EQ(contact_pairs(world), on_floor);
    EXPECT_EQ(overlapping_pairs(world, 0), on_floor);
    world.set_pose(world.bodies()[2], {Vec3(0.75, 0, 0.24), Quat::Identity()});
    EXPECT_EQ(overlapping_pairs(world, 0), with_both);
    const std::vector<BodyPair> deep = {{1, 2}};
    EXPECT_EQ(overlapping_pairs(world, 0.1), deep);
    world.step();
    EXPECT_EQ(contact_pairs(world), with_both);
}

TEST(UnbalancedForces, OfWhatRestsAreNoneAndOfWhatFallsItsWeight)
{
    SceneOf made = sled();
    made.box(Vec3(0.5, 0.5, 0.25), Vec3(0, 0, 0.75)).force = Vec3(0, 0, -100);
    made.ball(0.1, Vec3(9, 0, 50)).mass = 2;
    made.ball(0.1, Vec3(9, 9, 50)).linear_drag = 0.1;
    World world(made.scene);
    world.step(60);
    const std::vector<Vec3> left = unbalanced_forces(world);
    const std::vector<BodyId> ids = world.bodies();
    for (const int box : {1, 2}) {
        const auto at = static_cast<std::size_t>(box);
        EXPECT_LT(left[at].norm(), 1e-3 * kGravity * world.mass(ids[at])) << box;
        EXPECT_LT(Vec3(world.contact_force(ids[at]) + world.mass(ids[at]) * world.gravity()
                       + made.scene.bodies[at].force - left[at])
                      .norm(),
                  1e-9);
    }
    EXPECT_NEAR(left[3].z(), -2 * kGravity, 1e-12);
    EXPECT_TRUE(std::isnan(left[4].z())) << "is dragged";
    EXPECT_TRUE(std::isnan(left[0].z())) << "stands still";
}

TEST(ContactPairs, OfWhoIsRemovedAreGoneBeforeTheNextStep)
{
    SceneOf made = sled();
    made.box(Vec3(0.2, 0.2, 0.2), Vec3(0, 0, 0.7));
    World world(made.scene);
    world.step(5);
    EXPECT_EQ(contact_pairs(world).size(), 2u);
    const BodyId top = last_of(world);
    world.remove({&top, 1});
    const std::vector<BodyPair> left = contact_pairs(world);
    ASSERT_EQ(left.size(), 1u);
    EXPECT_EQ(left[0], (BodyPair{0, 1}));
    EXPECT_EQ(unbalanced_forces(world).size(), 3u);
}

}  // namespace
}  // namespace throng
