// Voxel terrain: what comes to rest on a level set lies on the surface it was made of.
#include "kernels/geometry/mesh_distance.hpp"
#include "tests/support/solid_scenes.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

constexpr double kVoxel = 0.1;  // m
// What is told of a solid's depths, world.solids() says so, and what bodies at rest sink in for the
// contact to bear them.
constexpr double kStated = 0.5 * kVoxel, kBearing = 0.005;

// Hills and hollows of 0.2 m, 2 m from one to the next; hollows are at (1, -1), (-1, 1), (3, 1) ...
constexpr double kPi = 3.14159265358979323846;
double height(double x, double y) { return 0.2 * std::sin(kPi / 2 * x) * std::sin(kPi / 2 * y); }

// How far a place is above the hills: the least distance to any place of them within 0.6 m along
// x and y, looked for on ever finer grids.
double above_hills(const Vec3& place)
{
    double x = place.x(), y = place.y(), half = 0.6;
    double least = std::numeric_limits<double>::infinity();
    for (int round = 0; round < 4; ++round, half *= 0.15) {
        const double middle_x = x, middle_y = y;
        for (int i = -10; i <= 10; ++i)
            for (int k = -10; k <= 10; ++k) {
                const double u = middle_x + half * i / 10, v = middle_y + half * k / 10;
                const double far = (place - Vec3(u, v, height(u, v))).norm();
                if (far >= least) continue;
                least = far;
                x = u;
                y = v;
            }
    }
    return place.z() < height(place.x(), place.y()) ? -least : least;
}

/// A body as balls: what of it is lowest, seen from the hills.
double clearance(const World& world, BodyId body, const std::vector<Vec3>& middles, double radius)
{
    double least = std::numeric_limits<double>::infinity();
    const Pose pose = world.pose(body);
    for (const Vec3& middle : middles) least = std::min(least, above_hills(pose * middle) - radius);
    return least;
}

TEST(VoxelTerrain, BodiesOfEveryKindComeToRestOnTheSurface)
{
    given::SceneOf made;
    made.scene.materials[0].rolling_friction = 0.02;
    static const VoxelsShape hills =
        given::voxels_of(given::block_under(height, 90, 0.1), kVoxel, 0.5);
    made.body(made.shape(hills), Vec3::Zero()).motion = Motion::static_;
    made.ball(0.25, Vec3(1.1, -1, 0.5));
    const Vec3 half(0.3, 0.2, 0.15);
    made.box(half, Vec3(-1, 1.05, 0.5));
    made.body(made.shape(CapsuleShape{0.15, 0.25}), Vec3(3, 1, 0.5)).orientation =
        Quat(std::sqrt(0.5), 0, std::sqrt(0.5), 0);
    made.body(made.shape(given::mesh_of(torus_mesh(0.3, 0.12, 48, 24))), Vec3(-3, -1, 0.5));
    World world(made.scene);
    ASSERT_EQ(world.solids().size(), 2u);
    EXPECT_NE(world.solids()[0].find("depths within 0.05 m"), std::string::npos)
        << world.solids()[0];
    world.step(300);
    EXPECT_LT(given::greatest_speed(world), 0.02);

    std::vector<Vec3> box, axis, ring;
    for (int i = -10; i <= 10; ++i)
        for (int k = -10; k <= 10; ++k)
            for (const double side : {-1.0, 1.0}) {
                box.push_back(half.cwiseProduct(Vec3(0.1 * i, 0.1 * k, side)));
                box.push_back(half.cwiseProduct(Vec3(0.1 * i, side, 0.1 * k)));
            }
    for (int i = -10; i <= 10; ++i) axis.emplace_back(0, 0, 0.025 * i);
    for (int i = 0; i < 96; ++i)
        ring.emplace_back(0.3 * std::cos(kPi / 48 * i), 0.3 * std::sin(kPi / 48 * i), 0);
    const std::vector<BodyId> ids = world.bodies();
    const double found[] = {clearance(world, ids[1], {Vec3::Zero()}, 0.25),
                            clearance(world, ids[2], box, 0), clearance(world, ids[3], axis, 0.15),
                            clearance(world, ids[4], ring, 0.12)};
    for (const double separation : found) {
        EXPECT_GT(separation, -kStated - kBearing);
        EXPECT_LT(separation, kStated);
    }
    // The ball is looked up in the field itself, which is off by the curvature of the hills alone:
    // h^2 / 8 times the sum of two curvatures of 0.5 / m.
    EXPECT_NEAR(found[0], 0, kVoxel * kVoxel / 8 + kBearing);
    EXPECT_LT(world.measure().greatest_overlap, kStated);
}

TEST(VoxelTerrain, CallsForVoxelContactAndNoOtherWay)
{
    World world(given::solids_on_voxels(NonConvex::hull));
    const Effects& effects = world.effects();
    EXPECT_TRUE(effects.on.has(Effect::voxel_contact));
    EXPECT_FALSE(effects.on.has(Effect::mesh_contact));
    EXPECT_FALSE(effects.on.has(Effect::sphere_contact));
    const auto collides_solids = [](World& of) {
        const std::vector<World::StageInfo> stages = of.step_stages();
        return std::any_of(stages.begin(), stages.end(),
                           [](const auto& stage) { return stage.name == "collide_solids"; });
    };
    EXPECT_TRUE(collides_solids(world));
    World without(given::mixed_scene());
    EXPECT_FALSE(collides_solids(without));
}

}  // namespace
}  // namespace throng
