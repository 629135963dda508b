// Energy ledger: what grows without a source is told, and nothing else.
#include "throng/energy_ledger.hpp"

#include "tests/support/small_scenes.hpp"
#include "tests/support/watched.hpp"
#include "throng/catalog.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace throng {
namespace {

using given::SceneOf;
using given::watched;

// A ball on a spring to the world, drawn out by half a metre: 12.5 J, 1.6 swings a second.
Scene swing(Integrator integrator)
{
    SceneOf made;
    made.scene.gravity = Vec3::Zero();
    made.scene.settings.precision = Precision::double_;
    made.scene.settings.integrator = integrator;
    made.ball(0.1, Vec3(1.5, 0, 0)).mass = 1;
    Spring spring;
    spring.a = 0;
    spring.b = kNone;
    spring.stiffness = 100;
    spring.length = 1;
    made.scene.springs.push_back(spring);
    return made.scene;
}

TEST(EnergyLedger, TellsWhatAnUnstableIntegratorAdds)
{
    World world(swing(Integrator::euler));
    const auto energy = [&] {
        const Measures now = world.measure();
        return now.kinetic_energy + now.potential_energy;
    };
    const double before = energy();
    const EnergyLedger ledger = watched<EnergyLedger>(world, 120);
    EXPECT_GT(energy(), 2 * before);
    EXPECT_NEAR(ledger.gained(), energy() - before, 1e-9 * energy());
    EXPECT_EQ(ledger.from_step(), 0u);
    EXPECT_EQ(ledger.to_step(), 120u);
}

TEST(EnergyLedger, CountsASwingOnceHoweverOftenItComes)
{
    // A symplectic step's energy swings by the share of a radian that a substep is, to first order.
    const double share = 10.0 / 240;
    const EnergyLedger ledger = watched<EnergyLedger>(swing(Integrator::semi_implicit), 600);
    EXPECT_GT(ledger.gained(), 0);
    EXPECT_LT(ledger.gained(), 12.5 * share * (1 + share));
    EXPECT_LT(watched<EnergyLedger>(swing(Integrator::rk4), 600).gained(), 1e-6 * 12.5);
}

TEST(EnergyLedger, TellsWhatOverlapThrowsApart)
{
    SceneOf made;
    made.scene.gravity = Vec3::Zero();
    made.scene.settings.sleep = false;
    for (int i = 0; i < 2; ++i) made.ball(0.5, Vec3(0.5 * i, 0, 0)).mass = 1;
    double greatest = 0;
    World world(made.scene);
    EnergyLedger ledger;
    for (int i = 0; i < 30; ++i) {
        ledger.before_step(world);
        world.step();
        ledger.after_step(world);
        greatest = std::max(greatest, world.measure().kinetic_energy);
    }
    EXPECT_EQ(ledger.greatest_kinetic(), greatest);
    EXPECT_NEAR(ledger.gained(), greatest, 1e-3 * greatest);
}

// From above its pivot to below it in a step or two: across the wind at either end, along it
// between.
TEST(EnergyLedger, TellsNothingOfWindThatDrivesWhatGoesRoundAPivot)
{
    for (const Vec3& wind : {Vec3(5, 6, -10), Vec3(0, 12, 0), Vec3(0, 0, -12)})
        for (const double mass : {0.005, 0.017, 0.1}) {
            SceneOf made;
            made.scene.wind = wind;
            BodyDescription& ball = made.ball(0.01, Vec3(0, 0, 0.01));
            ball.orientation = Quat(1, -0.004, -0.009, 0).normalized();
            ball.pivot = Vec3(0, 0, -0.01);
            ball.mass = mass;
            ball.linear_drag = 0.4;
            World world(made.scene);
            const EnergyLedger ledger = watched<EnergyLedger>(world, 60);
            EXPECT_GT(ledger.greatest_kinetic(), 1e-3);
            EXPECT_LE(ledger.gained(), 1e-3 * ledger.greatest_kinetic()) << wind << ' ' << mass;
        }
}

// Cut at its touches, a step leaves velocities and heights of one time.
TEST(EnergyLedger, TellsNothingOfWhoTipsOverByCarriedGroups)
{
    for (const Overlap overlap : {Overlap::back_up, Overlap::subdivide})
        for (const double lean : {0.2, 1.0}) {
            SceneOf made;
            made.scene.settings.overlap = overlap;
            made.floor();
            const std::uint32_t rod = made.shape(CapsuleShape{0.006, 0.066});
            BodyDescription& tips = made.body(rod, Vec3(0, 0, 0.066 * std::cos(lean) + 0.0065));
            tips.orientation = Quat(Eigen::AngleAxisd(lean, Vec3::UnitX()));
            tips.angular_velocity = Vec3(3, 1, 0);
            const EnergyLedger ledger = watched<EnergyLedger>(made.scene, 60);
            EXPECT_LE(ledger.gained(), 3e-3 * ledger.greatest_kinetic())
                << int(overlap) << ' ' << lean;
        }
}

// A bar that tips over and is held on its way down, drawn by gravity, by a force, or from far away.
TEST(EnergyLedger, TellsNothingOfWhoIsHeldOnItsWayByWhateverItIsDrawn)
{
    for (int drawn = 0; drawn < 3; ++drawn)
        for (const double spin : {0.0, 10.0, 30.0})
            for (const double pull : {9.81, 100.0}) {
                SceneOf made;
                made.scene.gravity = drawn == 0 ? Vec3(0, 0, -pull) : Vec3(Vec3::Zero());
                made.floor();
                BodyDescription& bar = made.box(Vec3(0.005, 0.005, 0.5), Vec3(0, 0, 0.6));
                bar.orientation = Quat(Eigen::AngleAxisd(0.2, Vec3::UnitX()));
                bar.angular_velocity = Vec3(spin, 0.1 * spin, 0);
                bar.mass = 1;
                if (drawn == 1) bar.force = Vec3(0, 0, -pull);
                if (drawn == 2) made.scene.attractors.push_back({Vec3(0, 0, -1e4), 1e8 * pull});
                const EnergyLedger ledger = watched<EnergyLedger>(made.scene, 120);
                EXPECT_LE(ledger.gained(), 3e-3 * ledger.greatest_kinetic())
                    << drawn << ' ' << spin << ' ' << pull;
            }
}

// Rims that rock come to beside what contacts had looked for: nobody pressed these springs in.
TEST(EnergyLedger, TellsNothingOfPenaltySpringsInHoweverManySubsteps)
{
    for (const int substeps : {4, 16, 64, 128}) {
        SceneOf made;
        made.scene.settings.response = Response::penalty;
        made.scene.settings.dt = 1.0 / 240;
        made.scene.settings.substeps = substeps;
        made.floor();
        for (int i = 0; i < 6; ++i) {
            const std::uint32_t shape =
                made.shape(CylinderShape{0.1 + 0.02 * (i % 3), 0.3 - 0.1 * (i % 3)});
            BodyDescription& drum = made.body(shape, Vec3(0.05 * i, 0, 0.4 + 0.7 * i));
            drum.orientation = Quat(Eigen::AngleAxisd(0.4 * i, Vec3(1, 0.3 * i, 0).normalized()));
            drum.angular_velocity = Vec3(3, 2 - i, 1);
        }
        const EnergyLedger ledger = watched<EnergyLedger>(made.scene, 720);
        EXPECT_LE(ledger.gained(), 1e-2 * ledger.greatest_kinetic()) << substeps;
    }
}

TEST(EnergyLedger, TellsNothingOfForcesAndOfWhatMovesByItself)
{
    SceneOf made;
    made.scene.settings.precision = Precision::double_;
    made.scene.wind = Vec3(5, 1, 0);
    BodyDescription& pushed = made.box(Vec3(0.5, 0.3, 0.2), Vec3::Zero());
    pushed.force = Vec3(1e3, 0, 2e4);
    pushed.torque = Vec3(0, 0, 300);
    BodyDescription& blown = made.ball(0.5, Vec3(0, 10, 0));
    blown.mass = 0.1;
    blown.linear_drag = 0.5;
    made.scene.attractors.push_back({Vec3(0, 100, 0), 1e4});
    World world(made.scene);
    world.set_force_field([](const FieldPlace& place) {
        return Wrench{Vec3(0, place.mass, 0), Vec3(place.mass, 0, 0)};
    });
    const EnergyLedger ledger = watched<EnergyLedger>(world, 200);
    // The pull of the attractor is taken at the beginning of a substep, like gravity: what that
    // makes wrong goes with its change in a substep, here a millionth.
    EXPECT_LT(ledger.gained(), 1e-4 * ledger.greatest_kinetic());
    EXPECT_GT(ledger.greatest_kinetic(), 1e4);

    // A drum of what moves by itself, walkers and all.
    for (const char* name : {"tumbler", "crowd"}) {
        const EnergyLedger driven = watched<EnergyLedger>(make_scene(name, 40), 120);
        EXPECT_LT(driven.gained(), 0.01 * driven.greatest_kinetic()) << name;
    }
}

TEST(EnergyLedger, TellsNothingOfAHeapThatFallsAndRests)
{
    for (const double restitution : {0.0, 0.8}) {
        Scene scene = make_scene("pile", 60);
        for (Material& material : scene.materials) material.restitution = restitution;
        const EnergyLedger ledger = watched<EnergyLedger>(scene, 300);
        EXPECT_LT(ledger.gained(), 0.01 * ledger.greatest_kinetic());
    }
}

TEST(EnergyLedger, TellsNothingOfABallThatBouncesForEver)
{
    for (const int substeps : {1, 4}) {
        SceneOf made;
        made.floor();
        made.ball(0.5, Vec3(0, 0, 2));
        made.scene.materials.front().restitution = 1;
        made.scene.settings.substeps = substeps;
        const EnergyLedger ledger = watched<EnergyLedger>(made.scene, 300);
        EXPECT_LT(ledger.gained(), 1e-4 * ledger.greatest_kinetic()) << substeps;
        EXPECT_LT(std::abs(ledger.net()), 0.02 * ledger.greatest_kinetic()) << substeps;
    }
}

TEST(EnergyLedger, TellsNothingOfBuildingsThatSinkIntoTheirContactsAndComeBack)
{
    for (const char* name : {"stacks", "wall", "pyramid"}) {
        Scene scene = make_scene(name, 100);
        scene.settings.sleep = false;
        const EnergyLedger ledger = watched<EnergyLedger>(scene, 200);
        EXPECT_LT(ledger.gained(), 0.01 * ledger.greatest_kinetic()) << name;
    }
}

TEST(EnergyLedger, LeavesOutWhatIsDoneBetweenSteps)
{
    SceneOf made;
    made.scene.gravity = Vec3::Zero();
    made.ball(0.5, Vec3::Zero()).mass = 1;
    World world(made.scene);
    EnergyLedger ledger;
    for (int i = 0; i < 10; ++i) {
        world.add_impulse(world.bodies()[0], Vec3(1, 0, 0));
        ledger.before_step(world);
        world.step();
        ledger.after_step(world);
    }
    EXPECT_EQ(ledger.gained(), 0);
    EXPECT_NEAR(ledger.greatest_kinetic(), 50, 1e-9);
}

}  // namespace
}  // namespace throng
