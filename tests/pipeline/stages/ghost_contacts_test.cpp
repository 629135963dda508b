// Ghost contacts: what lies flush is no bump, and what stands out is one.
#include "kernels/math/rotation.hpp"
#include "tests/support/small_scenes.hpp"

#include <gtest/gtest.h>

#include <random>

namespace throng {
namespace {

using given::SceneOf;

constexpr double kSpeed = 8;
const Vec3 kTile(0.5, 0.5, 0.25);  // half extents

MeshShape sheet()
{
    MeshShape mesh;
    mesh.vertices = {{-0.5, -0.5, 0.25}, {0.5, -0.5, 0.25}, {0.5, 0.5, 0.25}, {-0.5, 0.5, 0.25}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

using AnyShape = decltype(ShapeDescription::shape);

struct Slider {
    const char* name;
    AnyShape shape;
    double height;
    Quat turn = Quat::Identity();
};

std::vector<Slider> sliders()
{
    const Quat lying = exponential(Vec3(0, 1.5707963267948966, 0));
    const Quat askew = exponential(Vec3(0, 0, 0.7853981633974483));
    return {{"ball", SphereShape{0.5}, 0.5},
            {"box", BoxShape{Vec3::Constant(0.25)}, 0.25},
            {"box askew", BoxShape{Vec3::Constant(0.25)}, 0.25, askew},
            {"capsule lying", CapsuleShape{0.2, 0.4}, 0.2, lying},
            {"cylinder standing", CylinderShape{0.3, 0.3}, 0.3},
            {"stone",
             HullShape{{{0.25, 0.25, -0.2},
                        {-0.25, 0.25, -0.2},
                        {0.25, -0.25, -0.2},
                        {-0.25, -0.25, -0.2},
                        {0, 0, 0.4}}},
             0.2}};
}

// Smooth tiles along x, those from the fourth on raised by a step; the slider is made last.
Scene tiled(const AnyShape& tile, const Slider& slider, double step = 0)
{
    SceneOf made;
    made.scene.materials[0].friction = 0;
    made.scene.settings.sleep = false;
    const std::uint32_t shape = made.shape(tile);
    for (int i = -1; i < 10; ++i)
        for (int j = -1; j <= 1; ++j)
            made.body(shape, Vec3(i, j, (i < 4 ? 0 : step) - 0.25)).motion = Motion::static_;
    BodyDescription& body = made.body(made.shape(slider.shape), Vec3(0, 0.13, slider.height));
    body.orientation = slider.turn;
    body.velocity = Vec3(kSpeed, 0, 0);
    return made.scene;
}

double speed_after(const Scene& scene, int steps)
{
    World world(scene, 1);
    world.step(steps);
    return world.velocity(world.bodies().back()).x();
}

TEST(GhostContacts, TilesOfBoxesTakeNoSpeed)
{
    for (const Slider& slider : sliders())
        EXPECT_NEAR(speed_after(tiled(BoxShape{kTile}, slider), 60), kSpeed, 1e-3 * kSpeed)
            << slider.name;
}

TEST(GhostContacts, TilesOfTrianglesTakeNoSpeed)
{
    for (const Slider& slider : sliders())
        EXPECT_NEAR(speed_after(tiled(sheet(), slider), 60), kSpeed, 1e-3 * kSpeed) << slider.name;
}

TEST(GhostContacts, AStepIsMet)
{
    for (const Slider& slider : sliders()) {
        const double before = speed_after(tiled(BoxShape{kTile}, slider, 0.005), 20);
        const double after = speed_after(tiled(BoxShape{kTile}, slider, 0.005), 60);
        EXPECT_NEAR(before, kSpeed, 1e-3 * kSpeed) << slider.name;
        EXPECT_LT(after, 0.97 * kSpeed) << slider.name;
    }
}

// Its foot is in the floor's plane, where a tile's rim would be.
TEST(GhostContacts, AThinWallThatStandsOnTheFloorIsMet)
{
    for (const Slider& slider : sliders()) {
        Scene scene = tiled(BoxShape{kTile}, slider);
        SceneOf more;
        more.scene = scene;
        const BodyDescription last = more.scene.bodies.back();
        more.scene.bodies.pop_back();
        more.box(Vec3(0.002, 2, 0.5), Vec3(3, 0, 0.5)).motion = Motion::static_;
        more.scene.bodies.push_back(last);
        World world(more.scene, 1);
        world.step(60);
        EXPECT_LT(world.pose(world.bodies().back()).position.x(), 3) << slider.name;
    }
}

// A slider on a long cart of two boxes that meet under it: they are one body.
TEST(GhostContacts, SeamsOfABodyThatMovesTakeNoSpeed)
{
    SceneOf made;
    made.scene.materials[0].friction = 0;
    made.scene.settings.sleep = false;
    made.floor();
    const std::uint32_t half = made.shape(BoxShape{Vec3(1, 0.5, 0.25)});
    CompoundShape cart;
    for (const double x : {-1.0, 1.0})
        cart.parts.push_back({half, {Vec3(x, 0, 0), Quat::Identity()}});
    made.body(made.shape(cart), Vec3(0, 0, 0.25));
    made.box(Vec3::Constant(0.1), Vec3(-0.8, 0.03, 0.6)).velocity = Vec3(4, 0, 0);
    EXPECT_NEAR(speed_after(made.scene, 20), 4, 4e-3);
}

// A board that leans as it lands lies on all the tiles below it, not by turns on those at its ends.
TEST(GhostContacts, BoardsThatLandOnSmallTilesComeToRest)
{
    SceneOf made;
    made.scene.settings.solver = Solver::direct;
    made.scene.materials[0].restitution = 0.1;
    const std::uint32_t tile = made.shape(BoxShape{Vec3(0.05, 0.05, 0.025)});
    for (int i = -20; i <= 20; ++i)
        for (int j = -20; j <= 20; ++j)
            made.body(tile, Vec3(0.1 * i, 0.1 * j, -0.025)).motion = Motion::static_;
    std::mt19937 random(3);
    const auto within = [&](double from, double to) {
        return std::uniform_real_distribution<double>(from, to)(random);
    };
    for (int i = 0; i < 36; ++i) {
        const Vec3 half(within(0.06, 0.2), within(0.02, 0.1), within(0.003, 0.02));
        const Vec3 place(0.6 * (i % 6) - 1.5, 0.6 * (i / 6) - 1.5, 0.25);
        BodyDescription& board = made.box(half, place);
        board.orientation = exponential(Vec3(within(-2, 2), within(-2, 2), within(-2, 2)));
        board.angular_velocity = Vec3(within(-4, 4), within(-4, 4), 0);
    }
    World world(made.scene, 2);
    world.step(300);
    EXPECT_LT(world.measure().greatest_overlap, 1e-3);
    for (const BodyId body : world.bodies())
        EXPECT_LT(world.velocity(body).norm() + world.angular_velocity(body).norm(), 1e-2);
}

TEST(GhostContacts, AreCalledForByWhatMayLieFlush)
{
    SceneOf one;
    one.floor();
    one.box(Vec3::Constant(0.5), Vec3(0, 0, 0.5));
    EXPECT_FALSE(World(one.scene, 1).effects().on.has(Effect::seams));
    one.box(Vec3::Constant(0.5), Vec3(3, 0, 0.5)).motion = Motion::static_;
    EXPECT_TRUE(World(one.scene, 1).effects().on.has(Effect::seams));
}

}  // namespace
}  // namespace throng
