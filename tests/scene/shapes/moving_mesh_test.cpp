// Moving mesh: mended once on its way into a world, and let go of there.
#include "scene/shapes/moving_mesh.hpp"

#include "kernels/geometry/mesh.hpp"
#include "scene/rules/scene_check.hpp"
#include "tests/support/solid_scenes.hpp"
#include "throng/world.hpp"

#include <gtest/gtest.h>

namespace throng::given {
namespace {

// Of a size that no other test has.
MeshShape ring() { return mesh_of(torus_mesh(0.41, 0.13, 16, 8)); }

TEST(MovingMesh, IsMendedOnceWhoeverAsks)
{
    const MeshShape stated = ring();
    const auto first = moving_mesh(stated);
    EXPECT_EQ(first->repaired.mesh.triangles.size(), stated.triangles.size());
    EXPECT_EQ(moving_mesh(stated), first);
    EXPECT_EQ(moving_mesh(ring()), first);
    forget_moving_mesh(stated);
    const auto again = moving_mesh(stated);
    EXPECT_NE(again, first);
    EXPECT_EQ(again->repaired.mesh.vertices, first->repaired.mesh.vertices);
    EXPECT_EQ(again->repaired.mesh.triangles, first->repaired.mesh.triangles);
    forget_moving_mesh(stated);
}

TEST(MovingMesh, IsMendedAnewOnceAnythingOfItChanges)
{
    const MeshShape stated = ring();
    const auto first = moving_mesh(stated);
    MeshShape moved = stated, turned = stated;
    moved.vertices[5].z() += 0x1p-40;
    std::swap(turned.triangles[7][0], turned.triangles[7][1]);
    EXPECT_EQ(moving_mesh(moved)->repaired.mesh.vertices[5], moved.vertices[5]);
    EXPECT_EQ(moving_mesh(turned)->repaired.health.turned, 1u);
    EXPECT_EQ(moving_mesh(stated), first);
    for (const MeshShape& shape : {stated, moved, turned}) forget_moving_mesh(shape);
}

TEST(MovingMesh, FarFromItsOriginIsTakenAboutItsMiddle)
{
    MeshShape away = ring();
    const Vec3 far(0x1p10, 0, -0x1p8);
    for (Vec3& vertex : away.vertices) vertex += far;
    const auto found = moving_mesh(away);
    EXPECT_LT((found->at - far).norm(), 1e-9);
    EXPECT_LT(box_of(found->repaired.mesh).upper.maxCoeff(), 0.55);
    EXPECT_TRUE(moving_mesh(ring())->at.isZero(0));
    for (const MeshShape& shape : {away, ring()}) forget_moving_mesh(shape);
}

TEST(MovingMesh, IsKeptFromTheCheckUntilTheWorldHasIt)
{
    SceneOf made;
    made.scene.settings.nonconvex = NonConvex::hull;
    made.body(made.shape(ring()), Vec3::Zero());
    EXPECT_EQ(check_scene(made.scene), "");
    const std::weak_ptr<const MovingMesh> checked = moving_mesh(ring());
    EXPECT_FALSE(checked.expired());
    const World world(made.scene);
    EXPECT_EQ(world.body_count(), 1u);
    EXPECT_TRUE(checked.expired());
}

}  // namespace
}  // namespace throng::given
