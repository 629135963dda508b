// Springs: how far what they hold swings, in flight and on what touches something.
#include "tests/pipeline/forces/force_scenes.hpp"
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

// A crate on a smooth floor, 0.1 m along a spring; without a substep that it flies.
double widest_swing(Scene scene, double stiffness, int steps)
{
    scene.gravity = Vec3(0, 0, -10);
    add_floor(scene, 0);
    add_crate(scene, Vec3(0.1, 0, 0.25));
    Spring spring = spring_between(1, kNone, stiffness, 2);
    spring.at_b = Vec3(-2, 0, 0.25);
    scene.springs.push_back(spring);
    World world(scene);
    double widest = 0;
    for (int i = 0; i < steps; ++i) {
        world.step(1);
        widest = std::max(widest, std::abs(world.pose(world.bodies()[1]).position.x()));
    }
    EXPECT_GT(world.report().contacts, 0u);
    return widest;
}

TEST(Springs, OnWhatTouchesSomethingSwingNoWiderThanTheyBegan)
{
    for (const double stiffness : {1e2, 1e4, 1e6, 1e8})
        for (const Response response : {Response::impulse, Response::penalty, Response::kinematic})
            for (const Solver solver : {Solver::soft_step, Solver::pgs, Solver::direct}) {
                if (response != Response::impulse && solver != Solver::soft_step) continue;
                Scene scene = empty_scene(Integrator::semi_implicit);
                scene.settings.response = response;
                scene.settings.solver = solver;
                EXPECT_LT(widest_swing(scene, stiffness, 300), 0.116)
                    << stiffness << " N/m, response " << static_cast<int>(response) << ", solver "
                    << static_cast<int>(solver);
            }
}

// Held where they hit, by one another: what that draws their spring by is no brake in the air.
TEST(Springs, LetThoseFlyOnWhomTheyJoin)
{
    for (const Solver solver : {Solver::soft_step, Solver::pgs, Solver::direct}) {
        Scene scene = empty_scene(Integrator::auto_);
        scene.settings.solver = solver;
        scene.settings.dt = 1.0 / 240;
        scene.settings.substeps = 4;
        scene.materials.push_back({"smooth", 1000, 0, 0, 0});
        scene.shapes.push_back({"link", BoxShape{Vec3(0.02, 0.02, 0.045)}});
        const Vec3 speed(20, 0, 0);
        for (const double side : {-1.0, 1.0}) {
            BodyDescription link;
            link.shape = link.material = 0;
            link.mass = 0.1;
            link.position = Vec3(0, 0, 0.0455 * side);
            link.velocity = speed;
            link.angular_velocity = Vec3(20, 10 * side, -5);
            scene.bodies.push_back(link);
        }
        Spring spring = spring_between(0, 1, 2e4, 0);
        spring.at_a = Vec3(0, 0, 0.0455);
        spring.at_b = -spring.at_a;
        scene.springs.push_back(spring);
        World world(scene);
        const double before = energy(world);
        world.step(240);
        const Vec3 mean =
            (world.velocity(world.bodies()[0]) + world.velocity(world.bodies()[1])) / 2;
        EXPECT_LT((mean - speed).norm(), 1e-3) << static_cast<int>(solver);
        EXPECT_LT(energy(world), before * (1 + 1e-5)) << static_cast<int>(solver);
    }
}

TEST(Springs, KeepTheSwingOfWhatTouchesSomethingByEveryIntegrator)
{
    for (const Integrator integrator :
         {Integrator::semi_implicit, Integrator::splitting, Integrator::rk4}) {
        Scene scene = empty_scene(integrator);
        EXPECT_NEAR(widest_swing(scene, 100, 1000), 0.1, 1e-3);
    }
}

// What damps must not bear up what is at rest: the weight hangs as deep as the spring says.
TEST(Springs, DampedOnesBearAWeightByAWall)
{
    for (const double stiffness : {1e3, 1e5, 1e7}) {
        Scene scene = empty_scene(Integrator::semi_implicit);
        scene.gravity = Vec3(0, 0, -10);
        scene.materials.push_back({"m", 1000, 0, 0, 0});
        scene.shapes.push_back({"wall", PlaneShape{Vec3::UnitX(), 0}});
        scene.shapes.push_back({"crate", BoxShape{Vec3::Constant(0.1)}});
        BodyDescription wall;
        wall.shape = wall.material = 0;
        wall.motion = Motion::static_;
        scene.bodies.push_back(wall);
        BodyDescription& crate = add_crate(scene, Vec3(0.1, 0, 0));
        crate.force = Vec3(-5, 0, 0);
        Spring spring = spring_between(1, kNone, stiffness, 1);
        spring.at_b = Vec3(0.1, 0, 1);
        spring.damping = 2 * std::sqrt(stiffness);
        scene.springs.push_back(spring);
        World world(scene);
        world.step(300);
        const BodyId id = world.bodies()[1];
        EXPECT_NEAR(-world.pose(id).position.z() * stiffness / 10, 1, 1e-3) << stiffness;
        EXPECT_LT(world.velocity(id).norm(), 1e-6) << stiffness;
        EXPECT_NEAR(world.contact_force(id).x(), 5, 0.01) << stiffness;
    }
}

// The spring is now stiff for the step and now not, by how it stands to the rod, and the rod is
// carried by two laws in turn. Nothing turns it about its length.
TEST(Springs, OnARodOnAPivotLeaveItsOwnSpinAloneWhicheverLawCarriesIt)
{
    Scene scene;
    scene.shapes.push_back({"rod", CapsuleShape{0.021, 0.069}});
    BodyDescription& rod = scene.bodies.emplace_back();
    rod.shape = 0;
    rod.mass = 31;
    rod.pivot = Vec3(0, 0, 0.09);
    rod.orientation = Quat(0.799, 0.199, -0.552, -0.133).normalized();
    rod.angular_velocity = Vec3(-22, -25, -13);
    BodyDescription other;
    other.shape = 0;
    other.mass = 62;
    other.position = Vec3(0, 0, -2.1);
    other.velocity = Vec3(-0.4, 0.2, -2.2);
    other.angular_velocity = Vec3(-16, 4, -37);
    scene.bodies.push_back(other);
    scene.springs.push_back({});
    scene.springs[0].a = 0;
    scene.springs[0].b = 1;
    scene.springs[0].stiffness = 1100;
    scene.springs[0].length = 2;
    World world(scene);
    const BodyId id = world.bodies().front();
    const auto own_spin = [&] {
        return world.angular_velocity(id).dot(world.pose(id).orientation * Vec3::UnitZ());
    };
    // Exact where flight carries it; where the spring is stiff, the solver's arms are those of a
    // moment, and the rod turns on within it.
    const double begun = own_spin();
    for (int step = 0; step < 180; ++step) {
        world.step();
        ASSERT_NEAR(own_spin(), begun, 1e-5 * std::abs(begun)) << "step " << step;
    }
}

TEST(Springs, ByDefaultAreToldNothingOfAndHold)
{
    Scene scene = empty_scene(Integrator::semi_implicit);
    add_body(scene, Vec3(1.1, 0, 0));
    scene.springs.push_back(spring_between(0, kNone, 2e8, 1));
    World world(scene);
    EXPECT_TRUE(world.warnings().empty());
    const double first = energy(world);
    world.step(500);
    EXPECT_NEAR(energy(world) / first, 1, 1e-6);
}

// Nobody cuts a substep for a spring whose bodies touch nothing, whatever contacts would answer by:
// as it is, it would swing wider and wider, or be seen to.
TEST(Springs, InFlightMakeNoEnergyByAnyResponse)
{
    for (const Response response : {Response::impulse, Response::penalty, Response::kinematic})
        for (const double stiffness : {2e2, 2e4, 2e5, 2e6, 2e8})
            for (const bool by_an_arm : {false, true}) {
                Scene scene = empty_scene(Integrator::auto_);
                scene.settings.response = response;
                add_body(scene, Vec3(1.1, 0, 0));
                add_body(scene, Vec3(2.2, 0, 0));
                scene.springs.push_back(spring_between(0, kNone, stiffness, 1));
                scene.springs.push_back(spring_between(1, 0, stiffness, 1));
                if (by_an_arm) scene.springs.back().at_a = Vec3(0, 0.3, 0);
                World world(scene);
                EXPECT_TRUE(world.warnings().empty());
                const double first = energy(world);
                double greatest = first;
                for (int step = 0; step < 500; ++step) {
                    world.step();
                    greatest = std::max(greatest, energy(world));
                }
                EXPECT_LT(greatest / first, 1.01)
                    << stiffness << " N/m, response " << static_cast<int>(response)
                    << (by_an_arm ? ", by an arm" : "");
            }
}

TEST(Springs, ThatSwingWiderAreToldWithWhatWouldDo)
{
    Scene scene = empty_scene(Integrator::splitting);
    add_body(scene, Vec3(1, 0, 0));
    scene.springs.push_back(spring_between(0, kNone, 2e6, 1));  // limit 2 ms
    World world(scene);
    ASSERT_EQ(world.warnings().size(), 1u);
    EXPECT_NE(world.warnings()[0].find("substeps=5"), std::string::npos) << world.warnings()[0];
    scene.settings.substeps = 5;
    EXPECT_TRUE(World(scene).warnings().empty());
}

}  // namespace
}  // namespace throng
