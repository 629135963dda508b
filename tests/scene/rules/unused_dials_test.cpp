// Unused dials: each is named with its reason, and none that something in the scene reads.
#include "scene/catalog/closed_meshes.hpp"
#include "scene/rules/scene_check.hpp"
#include "throng/dials.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

using Sentences = std::vector<std::string>;

MeshShape box_shape()
{
    MeshShape shape;
    const TriangleSoup soup = box_mesh({1, 1, 1});
    shape.vertices = soup.vertices;
    shape.triangles = soup.triangles;
    return shape;
}

// A body of each shape.
Scene scene_of(const std::vector<MeshShape>& shapes, Motion motion)
{
    Scene scene;
    for (const MeshShape& shape : shapes) {
        BodyDescription body;
        body.shape = static_cast<std::uint32_t>(scene.shapes.size());
        body.motion = motion;
        scene.shapes.push_back({"", shape});
        scene.bodies.push_back(body);
    }
    scene.dials_set = {"nonconvex", "voxel_size", "image_resolution", "sphere_levels", "max_parts"};
    return scene;
}

TEST(UnusedDials, AreThoseThatAnotherMakesMeaningless)
{
    Scene scene;
    scene.dials_set = {"contact_rate", "push_limit", "iterations", "dt"};
    EXPECT_TRUE(unused_dials(scene).empty());
    scene.settings.solver = Solver::pgs;
    const Sentences expected = {"contact_rate: unused, solver pgs has no soft contacts"};
    EXPECT_EQ(unused_dials(scene), expected);
    scene.dials_set = {"penalty_damping", "direct_limit", "sleep", "method_start"};
    EXPECT_EQ(unused_dials(scene).size(), 3u);
    scene.settings.narrowphase = NarrowPhase::gjk;
    EXPECT_EQ(unused_dials(scene).size(), 2u);
    scene.dials_set = {"effects_error"};
    EXPECT_EQ(unused_dials(scene).size(), 1u);
    scene.settings.effects = EffectChoice::auto_;
    EXPECT_TRUE(unused_dials(scene).empty());
    scene.dials_set = {"rest_force"};
    EXPECT_EQ(unused_dials(scene),
              Sentences{"rest_force: unused, partial_rest off lets nobody rest by itself"});
    scene.settings.partial_rest = true;
    EXPECT_TRUE(unused_dials(scene).empty());
}

TEST(UnusedDials, AreAllOfMovingMeshesWhereNoneMoves)
{
    const Scene still = scene_of({box_shape()}, Motion::static_);
    const Sentences unused = unused_dials(still);
    ASSERT_EQ(unused.size(), still.dials_set.size());
    for (std::size_t i = 0; i < unused.size(); ++i)
        EXPECT_EQ(unused[i], still.dials_set[i] + ": unused, no mesh moves");
}

TEST(UnusedDials, HaveTheTreeOfAMeshWhereNoneStandsStill)
{
    Scene still = scene_of({box_shape()}, Motion::static_);
    Scene moving = scene_of({box_shape()}, Motion::dynamic);
    still.dials_set = moving.dials_set = {"mesh_tree"};
    EXPECT_TRUE(unused_dials(still).empty());
    EXPECT_EQ(unused_dials(moving), Sentences{"mesh_tree: unused, no mesh stands still"});
}

TEST(UnusedDials, AreThoseThatNoWayOfAMovingMeshAsksFor)
{
    const Scene scene = scene_of({box_shape()}, Motion::dynamic);
    const Sentences expected = {"image_resolution: unused, no moving mesh goes by depth_image",
                                "sphere_levels: unused, no moving mesh goes by spheres",
                                "max_parts: unused, no moving mesh goes by parts"};
    EXPECT_EQ(unused_dials(scene), expected);
}

TEST(UnusedDials, AreNotThoseThatAShapesOwnWayAsksFor)
{
    MeshShape spheres = box_shape(), parts = box_shape();
    spheres.nonconvex = "spheres";
    parts.nonconvex = "parts";
    parts.max_parts = 3;
    const Sentences expected = {"nonconvex: unused, each mesh that asks for it states its own",
                                "voxel_size: unused, no moving mesh goes by voxels",
                                "image_resolution: unused, no moving mesh goes by depth_image",
                                "max_parts: unused, each mesh that asks for it states its own"};
    EXPECT_EQ(unused_dials(scene_of({spheres, parts}, Motion::dynamic)), expected);
}

TEST(UnusedDials, AreNotTheVoxelsThatMendAnOpenMesh)
{
    MeshShape open = box_shape();
    open.nonconvex = "hull";
    open.triangles.pop_back();
    Scene scene = scene_of({open}, Motion::dynamic);
    scene.dials_set = {"voxel_size"};
    EXPECT_TRUE(unused_dials(scene).empty());
}

TEST(CheckScene, HoldsADialThatAMeshStatesToWhatTheDialTakes)
{
    const auto refused = [](auto spoil) {
        MeshShape shape = box_shape();
        spoil(shape);
        const Scene scene = scene_of({shape}, Motion::dynamic);
        return !check_scene(scene).empty();
    };
    EXPECT_FALSE(refused([](MeshShape&) {}));
    EXPECT_TRUE(refused([](MeshShape& shape) { shape.nonconvex = "voxel"; }));
    EXPECT_TRUE(refused([](MeshShape& shape) { shape.voxel_size = -1; }));
    EXPECT_TRUE(refused([](MeshShape& shape) { shape.image_resolution = 513; }));
    EXPECT_TRUE(refused([](MeshShape& shape) { shape.sphere_levels = -2; }));
    EXPECT_TRUE(refused([](MeshShape& shape) { shape.max_parts = 1000; }));
}

}  // namespace
}  // namespace throng
