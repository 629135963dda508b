// Forces: what acts besides gravity and contacts, in flight and on what touches something.
#include "tests/pipeline/forces/force_scenes.hpp"
#include "tests/support/watched.hpp"
#include "throng/energy_ledger.hpp"
#include "throng/world.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace throng {
namespace {

using test::add_body;
using test::add_crate;
using test::add_floor;
using test::empty_scene;
using test::energy;
using test::spring_between;

TEST(Forces, AConstantOneGivesAParabolaAndATorqueASpin)
{
    Scene scene = empty_scene();
    BodyDescription& body = add_body(scene);
    body.force = Vec3(0, 3, 0);
    body.torque = Vec3(0, 0, 0.6);
    World world(scene);
    world.step(100);
    const BodyId id = world.bodies()[0];
    EXPECT_LT((world.pose(id).position - Vec3(0, 0.5 * 1.5, 0)).norm(), 1e-12);
    EXPECT_LT((world.angular_velocity(id) - Vec3(0, 0, 2)).norm(), 1e-12);
}

TEST(Forces, OnWhatTouchesSomethingActInEverySubstep)
{
    Scene scene = empty_scene(Integrator::semi_implicit);
    scene.gravity = Vec3(0, 0, -10);
    add_floor(scene, 0.3);
    add_crate(scene, Vec3(0, 0, 0.25)).force = Vec3(5, 0, -10);
    World world(scene);
    world.step(200);
    const BodyId crate = world.bodies()[1];
    // Pressed down by twice its weight: 20 N of load, 6 N of friction, so it stays.
    EXPECT_LT(world.velocity(crate).norm(), 1e-6);
    EXPECT_NEAR(world.contact_force(crate).z(), 20, 0.02);
    EXPECT_NEAR(world.contact_force(crate).x(), -5, 0.02);
}

TEST(Forces, DragEndsAtTheSpeedWhereItHoldsTheWeight)
{
    for (const Integrator integrator :
         {Integrator::semi_implicit, Integrator::splitting, Integrator::rk4}) {
        Scene scene = empty_scene(integrator);
        scene.gravity = Vec3(0, 0, -10);
        scene.wind = Vec3(4, 0, 0);
        add_body(scene).linear_drag = 8;
        World world(scene);
        world.step(2000);
        EXPECT_LT((world.velocity(world.bodies()[0]) - Vec3(4, 0, -2.5)).norm(), 1e-9);
    }
}

TEST(Forces, DragHoweverStrongOnlySlows)
{
    for (const Integrator integrator : {Integrator::semi_implicit, Integrator::splitting}) {
        Scene scene = empty_scene(integrator);
        BodyDescription& body = add_body(scene);
        body.linear_drag = body.angular_drag = 1e6;
        body.velocity = Vec3(7, 0, 0);
        body.angular_velocity = Vec3(0, 3, 0);
        World world(scene);
        double speed = 7, spin = 3;
        for (int step = 0; step < 20; ++step) {
            world.step();
            const BodyId id = world.bodies()[0];
            EXPECT_GE(world.velocity(id).x(), 0);
            EXPECT_LE(world.velocity(id).x(), speed);
            EXPECT_LE(world.angular_velocity(id).norm(), spin);
            speed = world.velocity(id).x();
            spin = world.angular_velocity(id).norm();
        }
        EXPECT_LT(speed, 1e-3);
    }
}

// With what changes on the way, and without.
void expect_drag_slows(double rate, bool attracted)
{
    Scene scene = empty_scene();
    scene.gravity = Vec3(0, 0, -10);
    scene.settings.dt = 1.0 / 60;
    if (attracted) scene.attractors.push_back({Vec3(0, 0, 100), 1e-6});
    add_floor(scene, 0);
    // A long crate: about its length its drag is stiffest.
    BodyDescription& crate = add_crate(scene, Vec3(0, 0, 0.25));
    crate.linear_drag = crate.angular_drag = rate;
    crate.velocity = Vec3(3, 0, 0);
    crate.angular_velocity = Vec3(0.5, 0, 2);
    World world(scene);
    double speed = 3;
    for (int step = 0; step < 120; ++step) {
        world.step();
        const BodyId id = world.bodies()[1];
        EXPECT_LE(world.velocity(id).norm(), speed + 1e-6) << rate;
        EXPECT_LE(world.angular_velocity(id).norm(), 2.1) << rate;
        speed = std::max(world.velocity(id).norm(), 0.3);
    }
    EXPECT_LT(speed, 0.31) << rate;
}

TEST(Forces, DragHoweverStrongOnlySlowsWhatTouches)
{
    for (const double rate : {30.0, 300.0, 1e6})
        for (const bool attracted : {false, true}) expect_drag_slows(rate, attracted);
}

TEST(Forces, AnAttractorHoldsABodyInItsOrbit)
{
    for (const Integrator integrator : {Integrator::splitting, Integrator::rk4}) {
        Scene scene = empty_scene(integrator);
        scene.attractors.push_back({Vec3(1, 0, 0), 4});
        add_body(scene, Vec3(3, 0, 0)).velocity = Vec3(0, std::sqrt(2.0), 0);
        World world(scene);
        const double before = energy(world);
        // Once around: radius 2 m at sqrt(2) m/s.
        const double around = 2 * std::numbers::pi * 2 / std::sqrt(2.0);
        world.step(static_cast<int>(std::lround(around / 1e-2)));
        EXPECT_LT((world.pose(world.bodies()[0]).position - Vec3(3, 0, 0)).norm(), 2e-2);
        EXPECT_NEAR(energy(world), before, 1e-6);
    }
}

// However close they come to it, and however few substeps see it: all that they have is turned
// round there, and once more each time that they are back.
TEST(Forces, AnAttractorGivesNothingToWhoFallThroughIt)
{
    for (const double sideways : {0.0, 1e-9, 1e-3, 3e-2, 0.3})
        for (const double strength : {4.0, 400.0})
            for (const int substeps : {1, 4}) {
                Scene scene = empty_scene(Integrator::auto_);
                scene.settings.substeps = substeps;
                scene.attractors.push_back({Vec3(1, 0, 0), strength});
                add_body(scene, Vec3(3, 0, 0)).velocity = Vec3(0, sideways, 0);
                const auto ledger = given::watched<EnergyLedger>(scene, 3000);
                EXPECT_LT(ledger.gained(), 0.015 * ledger.greatest_kinetic())
                    << sideways << " m/s, strength " << strength << ", substeps " << substeps;
            }
}

TEST(Forces, AttractorsAndWindGoWithTheLastBodyOfTheirScene)
{
    Scene lone = empty_scene();
    add_body(lone, Vec3(0, 0, 0)).linear_drag = 1;
    World world(lone);
    const BodyId first = world.bodies()[0];
    const auto pulled = [&] {
        world.set_velocity(first, Vec3::Zero(), Vec3::Zero());
        world.step();
        return world.velocity(first);
    };
    EXPECT_EQ(pulled(), Vec3(0, 0, 0));

    Scene planet = empty_scene();
    planet.attractors.push_back({Vec3(10, 0, 0), 100});
    add_body(planet, Vec3(10, 0, 0));
    add_body(planet, Vec3(10, 5, 0));
    Scene storm = empty_scene();
    storm.wind = Vec3(0, 0, 7);
    add_body(storm, Vec3(-50, 0, 0));
    const std::vector<BodyId> of_planet = world.add(planet), of_storm = world.add(storm);
    EXPECT_GT(pulled().x(), 0);
    EXPECT_GT(pulled().z(), 0);
    EXPECT_TRUE(world.effects().on.has(Effect::attractors));

    // One of two leaves it there; who takes that one's place has nothing to do with it.
    world.remove({&of_planet[0], 1});
    const std::vector<BodyId> other = world.add(lone);
    EXPECT_EQ(other[0].index, of_planet[0].index);
    world.remove(other);
    EXPECT_GT(pulled().x(), 0);
    world.remove({&of_planet[1], 1});
    EXPECT_EQ(pulled().x(), 0);
    EXPECT_FALSE(world.effects().on.has(Effect::attractors));
    EXPECT_GT(pulled().z(), 0);
    world.remove(of_storm);
    EXPECT_EQ(pulled(), Vec3(0, 0, 0));
    EXPECT_FALSE(world.effects().on.has(Effect::wind));
}

TEST(Forces, WhoSleepsInAFieldWakesWhenItGoes)
{
    Scene scene;
    scene.gravity.setZero();
    add_floor(scene, 0.5);
    add_crate(scene, Vec3(0, 0, 0.5));
    World world(scene);
    Scene magnet;
    magnet.attractors.push_back({Vec3(0, 0, -100), 1e5});
    magnet.bodies.emplace_back().motion = Motion::static_;
    const std::vector<BodyId> below = world.add(magnet);
    const BodyId crate = world.bodies()[1];
    world.step(240);
    ASSERT_FALSE(world.awake(crate));
    world.remove(below);
    EXPECT_TRUE(world.awake(crate));
}

TEST(Forces, ASpringBetweenTwoKeepsMomentumAndHasItsPeriod)
{
    Scene scene = empty_scene();
    add_body(scene, Vec3(-1, 0, 0));
    add_body(scene, Vec3(1.1, 0, 0)).velocity = Vec3(0, 0, 0.3);
    scene.springs.push_back(spring_between(0, 1, 100, 2));
    World world(scene);
    const double before = energy(world);
    double extent = 0;
    for (int step = 0; step < 300; ++step) {
        world.step();
        EXPECT_LT((world.measure().momentum - Vec3(0, 0, 0.6)).norm(), 1e-12);
        const auto ids = world.bodies();
        extent =
            std::max(extent, (world.pose(ids[1]).position - world.pose(ids[0]).position).norm());
    }
    EXPECT_NEAR(energy(world), before, 1e-6);
    EXPECT_NEAR(extent, 2.1, 0.02);
}

TEST(Forces, ASpringOffTheCenterTurnsItsBody)
{
    Scene scene = empty_scene();
    add_body(scene);
    Spring spring = spring_between(0, kNone, 50, 0);
    spring.at_a = Vec3(0.2, 0, 0);
    spring.at_b = Vec3(0.2, 0.1, 0);
    scene.springs.push_back(spring);
    World world(scene);
    world.step();
    const BodyId id = world.bodies()[0];
    // 5 N at 0.2 m: 2.5 m/s2 and 1 N m / 0.3 kg m2, for 0.01 s.
    EXPECT_NEAR(world.velocity(id).y(), 0.025, 1e-4);
    EXPECT_NEAR(world.angular_velocity(id).z(), 0.01 / 0.3, 1e-4);
}

// One end flies, the other lies on the floor: both are moved by the same force.
TEST(Forces, ASpringPassesMomentumToWhatTouchesSomething)
{
    Scene scene = empty_scene(Integrator::semi_implicit);
    scene.gravity = Vec3(0, 0, -10);
    add_floor(scene, 0);
    add_crate(scene, Vec3(0, 0, 0.25));
    add_crate(scene, Vec3(3, 0, 3));
    scene.springs.push_back(spring_between(1, 2, 2, 1));
    World world(scene);
    world.step(50);
    const Vec3 momentum = world.measure().momentum;
    EXPECT_LT(std::abs(momentum.x()), 1e-6);
    EXPECT_GT(world.velocity(world.bodies()[1]).x(), 0.1);
}

TEST(Forces, OfASpringGoWithEitherOfItsBodies)
{
    Scene scene = empty_scene();
    add_body(scene);
    add_body(scene, Vec3(1, 0, 0));
    scene.springs.push_back(spring_between(0, 1, 100, 3));
    World world(scene);
    const auto ids = world.bodies();
    world.remove(std::span(ids).subspan(1));
    world.step(10);
    EXPECT_EQ(world.velocity(ids[0]), Vec3(0, 0, 0));
    EXPECT_FALSE(world.effects().on.has(Effect::springs));
}

// A body that a spring holds by its middle, where it pulls at no arm: what it turns by is its own.
BodyDescription& add_held(Scene& scene, const Sym3& inertia, const Vec3& spin)
{
    BodyDescription& body = add_body(scene);
    body.inertia = inertia;
    body.angular_velocity = spin;
    Spring spring;
    spring.a = 0;
    spring.at_b = Vec3(0, 0, 1);
    spring.stiffness = 1;
    spring.length = 1;
    scene.springs.push_back(spring);
    return body;
}

TEST(Forces, NoSpinMakesEnergyOfItselfByAnyIntegratorThatIsAskedFor)
{
    const Sym3 needle{0.1, 0.099995, 1e-5}, crate{0.1, 0.2, 0.3}, slab{0.1, 0.11, 0.2};
    for (const Integrator integrator :
         {Integrator::midpoint, Integrator::splitting, Integrator::rk4, Integrator::auto_})
        for (const Sym3& inertia : {needle, crate, slab})
            for (const double rate : {30.0, 100.0, 300.0, 1000.0, 4000.0}) {
                Scene scene = empty_scene(integrator);
                add_held(scene, inertia, rate * Vec3(0.6, 0.48, 0.64));
                World world(scene);
                const double first = world.measure().kinetic_energy;
                for (int step = 0; step < 300; ++step) {
                    world.step();

                    ASSERT_LE(world.measure().kinetic_energy / first, 1.02)
                        << int(integrator) << ' ' << inertia.zz << ' ' << rate << " step " << step;
                    ASSERT_EQ(world.report().bodies_quarantined, 0u);
                }
            }
}

TEST(Forces, OfASpringGoOnWhereItsOtherBodyWasQuarantined)
{
    Scene scene = empty_scene();
    add_body(scene);
    add_body(scene, Vec3(2, 0, 0));
    scene.springs.push_back(spring_between(0, 1, 10, 1));
    World world(scene);
    const auto ids = world.bodies();
    world.set_force_field([](const FieldPlace& place) {
        const double force = place.body == 1 && place.time > 0.05 ? std::nan("") : 0.0;
        return Wrench{Vec3(force, 0, 0), Vec3::Zero()};
    });
    world.step(20);
    EXPECT_EQ(world.report().bodies_quarantined, 1u);
    EXPECT_TRUE(world.quarantined(ids[1]));
    EXPECT_TRUE(world.pose(ids[0]).position.allFinite());
    EXPECT_GT(world.velocity(ids[0]).x(), 0.3);
}

TEST(Forces, OfAProgramsOwnFieldAreAskedForAtEveryStage)
{
    Scene scene = empty_scene();
    add_body(scene);
    World world(scene);
    world.set_force_field([](const FieldPlace& place) {
        return Wrench{place.mass * Vec3(0, 0, std::cos(place.time)), Vec3::Zero()};
    });
    world.step(100);
    EXPECT_NEAR(world.velocity(world.bodies()[0]).z(), std::sin(1.0), 1e-9);
    world.set_force_field({});
    const Vec3 before = world.velocity(world.bodies()[0]);
    world.step(10);
    EXPECT_EQ(world.velocity(world.bodies()[0]), before);
}

class EveryMotion : public testing::TestWithParam<std::tuple<Integrator, Rotation>> { };

TEST(Forces, AnImpulseTurnsWhatHangsOnAPivotAboutIt)
{
    Scene scene = empty_scene();
    BodyDescription& body = add_body(scene);
    body.pivot = Vec3(0, 0, 1);
    // Stood on its head: the center of mass is above the pivot.
    body.orientation = Quat(0, 1, 0, 0);
    World world(scene);
    const BodyId id = world.bodies()[0];
    const double about_pivot = 0.2 + 2 * 1 * 1;  // kg m2, of y
    const Vec3 impulse(3, 0, 0);
    world.add_impulse(id, impulse);
    EXPECT_LT((world.angular_velocity(id) - Vec3(0, 3 / about_pivot, 0)).norm(), 1e-12);
    EXPECT_LT((world.velocity(id) - Vec3(3 / about_pivot, 0, 0)).norm(), 1e-12);
    // It got the work that an impulse does at the speed it gives.
    EXPECT_NEAR(energy(world), 0.5 * impulse.dot(world.velocity(id)), 1e-12);
    // Along the arm the pivot bears it.
    world.add_impulse(id, Vec3(0, 0, 5));
    EXPECT_LT((world.angular_velocity(id) - Vec3(0, 3 / about_pivot, 0)).norm(), 1e-12);
    const Vec3 pivot = world.pose(id) * Vec3(0, 0, 1);
    world.step(50);
    EXPECT_LT((world.pose(id) * Vec3(0, 0, 1) - pivot).norm(), 1e-9);
    EXPECT_NEAR(world.angular_velocity(id).y(), 3 / about_pivot, 1e-9);
}

// Bodies on springs, on pivots, in the wind, alone; some of them on the floor.
Scene busy_scene(Integrator integrator, Rotation rotation)
{
    Scene scene = empty_scene(integrator);
    scene.gravity = Vec3(0, 0, -10);
    scene.settings.precision = Precision::float_;
    scene.settings.rotation = rotation;
    scene.wind = Vec3(1, 0.5, 0);
    scene.attractors.push_back({Vec3(0, 0, 5), 3});
    add_floor(scene, 0.5);
    for (int i = 0; i < 200; ++i) {
        BodyDescription& crate =
            add_crate(scene, Vec3(1.5 * (i % 20), 1.5 * (i / 20), 0.3 + i % 3));
        crate.angular_velocity = Vec3(0.1 * i, 1, -0.05 * i);
        crate.linear_drag = 0.01 * (i % 5);
        if (i % 7 == 0) {
            crate.pivot = Vec3(0.3, 0.2, 0.1);
            crate.position.z() += 3;
        }
    }
    for (std::uint32_t i = 1; i < 150; i += 4)
        scene.springs.push_back(spring_between(i, i + 20, 30, 2));
    return scene;
}

TEST_P(EveryMotion, IsTheSameBitsOnAnyNumberOfThreads)
{
    const auto [integrator, rotation] = GetParam();
    const Scene scene = busy_scene(integrator, rotation);
    World one(scene, 1), three(scene, 3), in_order(scene, 2);
    in_order.run_in_order(true);
    for (int i = 0; i < 3; ++i) {
        one.step(10);
        three.step(10);
        in_order.step(10);
        EXPECT_EQ(one.state_hash(), three.state_hash());
        EXPECT_EQ(one.state_hash(), in_order.state_hash());
    }
    EXPECT_EQ(one.report().bodies_quarantined, 0u);
}

INSTANTIATE_TEST_SUITE_P(All,
                         EveryMotion,
                         testing::Combine(testing::Values(Integrator::semi_implicit,
                                                          Integrator::euler,
                                                          Integrator::midpoint,
                                                          Integrator::splitting,
                                                          Integrator::rk4),
                                          testing::Values(Rotation::quaternion,
                                                          Rotation::rotation_vector,
                                                          Rotation::matrix,
                                                          Rotation::quaternion_euler,
                                                          Rotation::matrix_euler,
                                                          Rotation::matrix_euler_repaired)));

}  // namespace
}  // namespace throng
