// Level set: read, made and written; what may move and what is refused.
#include "scene/shapes/level_set.hpp"

#include "kernels/geometry/mass.hpp"
#include "kernels/geometry/mesh.hpp"
#include "scene/catalog/closed_meshes.hpp"
#include "scene/rules/scene_check.hpp"
#include "tests/support/vdb_files.hpp"
#include "throng/world.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace throng {
namespace {

Scene scene_of(std::shared_ptr<const LevelSet> level_set, Motion motion)
{
    Scene scene;
    scene.shapes = {{"ground", VoxelsShape{"", std::move(level_set)}}};
    scene.bodies.push_back({});
    scene.bodies[0].shape = 0;
    scene.bodies[0].motion = motion;
    return scene;
}

TEST(LevelSet, OfABallIsClosedAndWeighsWhatTheBallDoes)
{
    const LevelSetResult read = read_level_set(ball_vdb(0.5));
    ASSERT_EQ(read.trouble, "");
    EXPECT_TRUE(read.level_set->whole);
    EXPECT_TRUE(is_closed(read.level_set->surface));
    const double volume = 4.0 / 3 * std::numbers::pi * 0.125;
    // Cells of a tenth of the radius, and flat faces across them, lie h^2 / 8 times two curvatures
    // too deep each: 1/200 of the radius, thrice that of the volume.
    EXPECT_NEAR(mass_of(read.level_set->surface).volume, volume, 0.015 * volume);

    World world(scene_of(read.level_set, Motion::dynamic));
    EXPECT_NEAR(world.mass(world.bodies()[0]), 1000 * volume, 15 * volume);
    ASSERT_EQ(world.solids().size(), 1u);
    EXPECT_EQ(world.solids()[0].find("ground: voxels of 0.05 m, "), 0u) << world.solids()[0];
}

TEST(LevelSet, CutOffAtItsEndStandsStillAndMayNotMoveFreely)
{
    const LevelSetResult read = read_level_set(open_ground_vdb());
    ASSERT_EQ(read.trouble, "");
    EXPECT_FALSE(read.level_set->whole);
    for (const Motion motion : {Motion::static_, Motion::kinematic})
        EXPECT_EQ(check_scene(scene_of(read.level_set, motion)), "");
    EXPECT_EQ(check_scene(scene_of(read.level_set, Motion::dynamic)),
              "shapes.ground.voxels.file: wanted a level set whose surface is closed, for a body "
              "that moves; this one is cut off where its values end");
}

TEST(LevelSet, OfNothingIsRefused)
{
    const std::string trouble = check_scene(scene_of(nullptr, Motion::static_));
    EXPECT_EQ(trouble.find("shapes.ground.voxels.file: wanted a level set with a surface"), 0u)
        << trouble;
    EXPECT_NE(check_scene(scene_of(std::make_shared<LevelSet>(), Motion::static_)), "");
    Scene scene = scene_of(read_level_set(ball_vdb(0.5)).level_set, Motion::static_);
    scene.shapes.push_back({"both", CompoundShape{{{0, {}}}}});
    EXPECT_EQ(check_scene(scene),
              "shapes.both.compound[0].shape: wanted a sphere, capsule, cylinder, box or hull as "
              "part of a compound");
}

TEST(LevelSet, MadeOfAMeshReadsBackToTheSameBits)
{
    const auto path = std::filesystem::path(testing::TempDir()) / "level_set_test.vdb";
    const TriangleSoup torus = torus_mesh(0.4, 0.15, 32, 16);
    const LevelSetResult made = make_level_set(torus.vertices, torus.triangles, 0.04, 0.2);
    ASSERT_EQ(made.trouble, "");
    EXPECT_TRUE(made.level_set->whole);
    EXPECT_EQ(made.level_set->field.voxel, 0.04);
    EXPECT_DOUBLE_EQ(made.level_set->field.band, 0.2);
    EXPECT_GT(made.level_set->error, 0);
    EXPECT_LT(made.level_set->error, kWorstVoxels * 0.04);

    ASSERT_EQ(write_level_set(*made.level_set, path.string()), "");
    const LevelSetResult again = read_level_set(bytes_of_file(path));
    ASSERT_EQ(again.trouble, "");
    EXPECT_TRUE(same_level_set(*made.level_set, *again.level_set));
    EXPECT_EQ(again.level_set->error, made.level_set->error);
    EXPECT_EQ(again.level_set->surface.vertices, made.level_set->surface.vertices);
    EXPECT_EQ(again.level_set->surface.triangles, made.level_set->surface.triangles);

    // A bit that has fallen over anywhere is seen before anything is made of the file.
    const std::string whole = bytes_of_file(path);
    for (std::size_t part = 0; part < 40; ++part) {
        std::string damaged = whole;
        damaged[(whole.size() - 17) * part / 39] ^= 4;
        EXPECT_EQ(read_level_set(damaged).trouble,
                  "is damaged, by its checksum; wanted it as it was written");
    }
    std::filesystem::remove(path);

    const LevelSetResult other = make_level_set(torus.vertices, torus.triangles, 0.05, 0.2);
    EXPECT_FALSE(same_level_set(*made.level_set, *other.level_set));
}

TEST(LevelSet, SaysWhatIsWrongWithBytesAndMeshes)
{
    for (const std::string& bytes :
         {std::string(), std::string("v 0 0 0\n"), std::string(200, ' ')}) {
        const LevelSetResult read = read_level_set(bytes);
        EXPECT_EQ(read.level_set, nullptr);
        EXPECT_EQ(read.trouble.find("is no .vdb file that can be read ("), 0u) << read.trouble;
    }
    const std::string whole = ball_vdb(0.5);
    for (int part = 0; part < 20; ++part) {
        const std::string torn =
            whole.substr(0, whole.size() * static_cast<std::size_t>(part) / 20);
        EXPECT_NE(read_level_set(torn).trouble, "") << part;
    }
    EXPECT_NE(make_level_set({}, {}).trouble, "");
    const TriangleSoup box = box_mesh({1, 1, 1});
    EXPECT_NE(make_level_set(box.vertices, box.triangles, 1e-7).trouble.find("more than the limit"),
              std::string::npos);
}

}  // namespace
}  // namespace throng
