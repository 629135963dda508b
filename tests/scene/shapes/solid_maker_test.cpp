// Solid maker: what a moving mesh becomes does not hang on where its own origin is, and what it
// loses is told.
#include "scene/shapes/solid_maker.hpp"

#include "scene/catalog/closed_meshes.hpp"

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
    const auto &a = std::get<Solid>(near.shape), &b = std::get<Solid>(away.shape);
    EXPECT_EQ(a.points.x, b.points.x);
    EXPECT_EQ(a.field.values, b.field.values);
}

MeshShape taken_by(const char* way, const TriangleSoup& soup)
{
    MeshShape shape;
    shape.nonconvex = way;
    shape.vertices = soup.vertices;
    shape.triangles = soup.triangles;
    return shape;
}

std::string warnings_of(const MeshShape& shape)
{
    std::string warnings;
    for (const std::string& warning : make_solid(shape, {}, {}).warnings)
        warnings += warning + '\n';
    return warnings;
}

TEST(MakeSolid, WarnsOfWhatAMeshLoses)
{
    const TriangleSoup ring = torus_mesh(2, 0.5, 24, 12);
    EXPECT_NE(warnings_of(taken_by("hull", ring)).find("hollows are filled, "), std::string::npos);
    MeshShape coarse = taken_by("parts", ring);
    coarse.max_parts = 1;
    EXPECT_NE(warnings_of(coarse).find(" of its longest side; more max_parts"), std::string::npos);
    coarse = taken_by("spheres", ring);
    coarse.sphere_levels = 1;
    EXPECT_NE(warnings_of(coarse).find(" of its longest side; more sphere_l"), std::string::npos);
    coarse = taken_by("depth_image", ring);
    coarse.image_resolution = 4;
    EXPECT_NE(warnings_of(coarse).find(" of its longest side; a greater im"), std::string::npos);
    coarse = taken_by("voxels", ring);
    coarse.voxel_size = 0.6;
    EXPECT_NE(warnings_of(coarse).find(" of its longest side; a smaller vo"), std::string::npos);
}

TEST(MakeSolid, WarnsOfNothingWhereNothingIsLost)
{
    for (const char* way : {"voxels", "parts", "spheres", "depth_image", "hull"})
        EXPECT_EQ(warnings_of(taken_by(way, ball_mesh(1, 12, 6))), "") << way;
    for (const char* way : {"voxels", "depth_image"})
        EXPECT_EQ(warnings_of(taken_by(way, torus_mesh(2, 0.7, 24, 12))), "") << way;
}

// Two walls, a floor and nothing else: what is within reach from afar is no inside.
TEST(MakeSolid, TellsHowFarTheMassIsFromThatOfAnOpenMeshClosed)
{
    TriangleSoup open = box_mesh({1, 1, 1});
    open.triangles.resize(open.triangles.size() - 4);
    const std::string warnings = warnings_of(taken_by("voxels", open));
    EXPECT_NE(warnings.find("% less than that of its triangles"), std::string::npos) << warnings;
}

}  // namespace
}  // namespace throng
