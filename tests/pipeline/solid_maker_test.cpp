// Solid maker: what a moving mesh becomes does not hang on where its own origin is.
#include "pipeline/solid_maker.hpp"

#include "scenes/closed_meshes.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

MeshShape box_from(const Vec3& origin)
{
    MeshShape shape;
    const TriangleSoup soup = box_mesh({0.5, 0.25, 0.25});
    shape.vertices = soup.vertices;
    shape.triangles = soup.triangles;
    for (Vec3& vertex : shape.vertices) vertex -= origin;
    return shape;
}

TEST(MakeSolid, FarFromItsOriginAMeshIsMadeAboutItsMiddle)
{
    // Powers of two, so that moving the vertices rounds nothing.
    const Vec3 far(0x1p20, 0, -0x1p18);
    const MadeSolid near = make_solid(box_from(Vec3::Zero()), {}, {});
    const MadeSolid away = make_solid(box_from(far), {}, {});
    ASSERT_EQ(near.trouble + away.trouble, "");
    EXPECT_EQ(near.at, Vec3::Zero());
    EXPECT_EQ(away.at, -far);
    EXPECT_EQ(away.mass.center, near.mass.center - far);
    EXPECT_EQ(away.mass.volume, near.mass.volume);
    const Solid &a = std::get<Solid>(near.shape), &b = std::get<Solid>(away.shape);
    EXPECT_EQ(a.points.x, b.points.x);
    EXPECT_EQ(a.field.values, b.field.values);
}

}  // namespace
}  // namespace throng
