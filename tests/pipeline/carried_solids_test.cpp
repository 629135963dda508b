// What overlap=back_up and subdivide keep to for bodies that need not be convex.
#include "pipeline/unused_dials.hpp"
#include "scenes/noisy_balls.hpp"
#include "tests/pipeline/carried_scenes.hpp"
#include "tests/pipeline/solid_scenes.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

using namespace given;

constexpr double kDt = 0.01;

SceneOf solids(Overlap overlap)
{
    SceneOf made = carried(overlap, 0.5, 0);
    made.scene.settings.dt = kDt;
    made.scene.settings.nonconvex = NonConvex::spheres;
    made.scene.settings.sphere_levels = 3;
    return made;
}

// Rings that fall on one another, with a lump, a box and a ball.
void add_rings(SceneOf& made)
{
    const std::uint32_t ring = made.shape(mesh_of(torus_mesh(0.3, 0.12, 16, 8)));
    for (int i = 0; i < 3; ++i) {
        const double lean = 0.1 + 0.2 * i;
        made.body(ring, Vec3(0.05 * i, -0.03 * i, 0.3 + 0.45 * i)).orientation =
            Quat(std::cos(lean), 0.8 * std::sin(lean), 0.6 * std::sin(lean), 0);
    }
    made.body(made.shape(mesh_of(noisy_ball(0.2, 0.3, 180, 5))), Vec3(0.2, 0, 1.8));
    made.box(Vec3(0.2, 0.15, 0.1), Vec3(-0.2, 0.1, 1.7));
    made.ball(0.1, Vec3(0.05, 0, 2.2));
}

Scene falling_rings(Overlap overlap)
{
    SceneOf made = solids(overlap);
    made.floor();
    add_rings(made);
    return made.scene;
}

TEST(CarriedSolids, NeverOverlapByBackUp)
{
    World world(falling_rings(Overlap::back_up));
    ASSERT_TRUE(world.effects().on.has(Effect::no_overlap));
    double energy = energy_of(world);
    for (int step = 0; step < 100; ++step) {
        world.step();
        ASSERT_EQ(world.measure().overlapping_pairs, 0u) << "step " << step;
        ASSERT_LT(energy_of(world), energy * (1 + 1e-6)) << "step " << step;
        energy = energy_of(world);
    }
    EXPECT_LT(place_of(world, 6).z(), 1.0);  // they have come down
    EXPECT_EQ(world.report().fallbacks, 0u);
}

TEST(CarriedSolids, OverlapNoMoreThanTheToleranceBySubdivide)
{
    const Scene scene = falling_rings(Overlap::subdivide);
    World world(scene);
    ASSERT_TRUE(world.effects().on.has(Effect::little_overlap));
    // The tolerance of the largest that may meet, and what any two close in the shortest piece.
    const double most = 1e-4 * 0.2 + 2 * std::sqrt(2 * 9.81 * 2.2) * kDt / 4096;
    for (int step = 0; step < 100; ++step) {
        world.step();
        ASSERT_LE(world.measure().greatest_overlap, most) << "step " << step;
    }
    EXPECT_LE(world.report().deepest, most);
    EXPECT_LT(place_of(world, 6).z(), 1.0);
    EXPECT_EQ(world.report().fallbacks, 0u);
}

// What is rough does not roll on for ever.
TEST(CarriedSolids, ComeToRest)
{
    SceneOf made = solids(Overlap::back_up);
    made.floor();
    const std::uint32_t box = made.shape(mesh_of(box_mesh(Vec3(0.3, 0.2, 0.1))));
    for (int i = 0; i < 2; ++i) made.body(box, Vec3(0.03 * i, 0.02 * i, 0.2 + 0.25 * i));
    World world(made.scene);
    for (int step = 0; step < 150; ++step) {
        world.step();
        ASSERT_EQ(world.measure().overlapping_pairs, 0u) << "step " << step;
    }
    EXPECT_LT(given::greatest_speed(world), 1e-6);
    EXPECT_EQ(world.report().fallbacks, 0u);
}

TEST(CarriedSolids, AreHeldApartFromStaticMeshesAndWhatMovesByItself)
{
    for (const Overlap overlap : {Overlap::back_up, Overlap::subdivide}) {
        SceneOf made = solids(overlap);
        MeshShape valley;
        valley.vertices = {{-3, -3, 1}, {0, -3, 0}, {3, -3, 1}, {-3, 3, 1}, {0, 3, 0}, {3, 3, 1}};
        valley.triangles = {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}};
        made.body(made.shape(valley), Vec3(0, 0, -0.5)).motion = Motion::static_;
        BodyDescription& paddle = made.box(Vec3(0.1, 0.5, 0.3), Vec3(-1, 0, 0.5));
        paddle.motion = Motion::kinematic;
        paddle.velocity = Vec3(0.5, 0, 0);
        paddle.angular_velocity = Vec3(0, 0, 1);
        add_rings(made);
        World world(made.scene);
        const double most = overlap == Overlap::back_up ? 0 : 5e-5;
        for (int step = 0; step < 60; ++step) {
            world.step();
            ASSERT_LE(world.measure().greatest_overlap, most) << "step " << step;
        }
        for (std::size_t i = 2; i < 8; ++i) EXPECT_GT(place_of(world, i).z(), -0.5);
        EXPECT_EQ(world.report().fallbacks, 0u);
    }
}

TEST(CarriedSolids, SameBitsForAnyNumberOfThreads)
{
    for (const Overlap overlap : {Overlap::back_up, Overlap::subdivide}) {
        const Scene scene = falling_rings(overlap);
        EXPECT_EQ(hash_after(scene, 4, 40), hash_after(scene, 1, 40));
    }
}

// A thin ring on its way through another at many times its thickness a step.
TEST(CarriedSolids, FastOnesDoNotPassThroughOneAnother)
{
    for (const Overlap overlap : {Overlap::back_up, Overlap::subdivide}) {
        SceneOf made = solids(overlap);
        made.scene.gravity = Vec3::Zero();
        made.scene.settings.sphere_levels = 4;
        const std::uint32_t ring = made.shape(mesh_of(torus_mesh(0.3, 0.03, 32, 8)));
        made.body(ring, Vec3::Zero());
        made.body(ring, Vec3(-3, 0.3, 0)).velocity = Vec3(100, 0, 0);
        World world(made.scene);
        world.step(10);
        EXPECT_GT(velocity_of(world, 0).x(), 10);  // it was struck
        EXPECT_EQ(world.measure().overlapping_pairs, 0u);
    }
}

TEST(CarriedSolids, NothingIsSaidOfSpheresAndAllOfTheOthers)
{
    Scene scene = falling_rings(Overlap::back_up);
    scene.dials_set = {"overlap"};
    EXPECT_TRUE(unused_dials(scene).empty());
    for (const NonConvex way : {NonConvex::voxels, NonConvex::depth_image}) {
        scene.settings.nonconvex = way;
        EXPECT_FALSE(World(scene).effects().on.has(Effect::no_overlap));
        ASSERT_EQ(unused_dials(scene).size(), 1u);
        EXPECT_EQ(
            unused_dials(scene)[0],
            "overlap: unused, what goes by voxels or depth images is not held apart; contacts "
            "go by allow");
    }
}

}  // namespace
}  // namespace throng
