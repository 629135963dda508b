// Mesh file: what an OBJ text says, and where it says it wrongly.
#include "scenes/mesh_file.hpp"

#include "scenes/scene_error.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace throng {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

constexpr const char* kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST(MeshFile, ReadsEveryFormOfCorner)
{
    for (const char* face : {"f 1 2 3", "f 1/1 2/1 3/1", "f 1//1 2//1 3//1", "f 1/1/1 2/2/2 3/3/3",
                             "f -4 -3 -2", "f\t1 2\t3  # three", "  f 1 2 3\r"}) {
        const MeshFile mesh = read_mesh_text(std::string(kSquare) + face, "m.obj");
        ASSERT_EQ(mesh.triangles.size(), 1u) << face;
        EXPECT_EQ(mesh.triangles[0], (Triangle{0, 1, 2})) << face;
    }
}

TEST(MeshFile, CutsPolygonsIntoFans)
{
    const MeshFile mesh = read_mesh_text(std::string(kSquare) + "f 2 3 4 1 2 3\n", "m.obj");
    const std::vector<Triangle> expected = {{1, 2, 3}, {1, 3, 0}, {1, 0, 1}, {1, 1, 2}};
    EXPECT_EQ(mesh.triangles, expected);
}

TEST(MeshFile, PassesOverTheRest)
{
    const MeshFile mesh =
        read_mesh_text("# cow\nmtllib a.mtl\n\ng x\nvn 0 0 1\nvt 0 0\nf 1 2 3\n"
                       "v +1 2e0 -3.5 1.0\nv 0 0 0 0.5 0.5 0.5\nv 1 1 1 #end\ns off",
                       "m.obj");
    ASSERT_EQ(mesh.vertices.size(), 3u);
    EXPECT_EQ(mesh.vertices[0], Vec3(1, 2, -3.5));
    EXPECT_EQ(mesh.triangles.size(), 1u);
    EXPECT_TRUE(read_mesh_text("", "m.obj").triangles.empty());
}

TEST(MeshFile, RefusesBadLinesAtTheirPlace)
{
    struct Bad {
        const char* text;
        const char* expected;
    };
    const Bad all[] = {
        {"v 1 2\n", "m.obj:1:6: error: v: wanted three finite numbers, not \"\""},
        {"\nv 1 x 2\n", "m.obj:2:5: error: v: wanted three finite numbers, not \"x\""},
        {"v 1 nan 2\n", "m.obj:1:5: error: v: wanted three finite numbers, not \"nan\""},
        {"v 1 1e999 2\n", "m.obj:1:5: error: v: wanted three finite numbers, not \"1e999\""},
        {"v 1 inf 2\n", "m.obj:1:5: error: v: wanted three finite numbers, not \"inf\""},
        {"v 0 0 0\nf 1 1\n", "m.obj:2:6: error: f: wanted at least three corners"},
        {"v 0 0 0\nf 0 1 1\n", "m.obj:2:3: error: f: wanted the number of a vertex"},
        {"v 0 0 0\nf 1 -2 1\n", "m.obj:2:5: error: f: wanted the number of a vertex"},
        {"v 0 0 0\nf 1 1 2\n", "m.obj:2:7: error: f: wanted one of the 1 vertices"},
        {"v 0 0 0\nf 1 1 a\n", "m.obj:2:7: error: f: wanted the number of a vertex"},
        {"v 0 0 0\nf 1 1 1.5\n", "m.obj:2:7: error: f: wanted the number of a vertex"},
        {"v 0 0 0\nf 1 1 99999999999999999999\n",
         "m.obj:2:7: error: f: wanted the number of a vertex"},
        {"v 0 0 0\nf 1 1 -9223372036854775808\n",
         "m.obj:2:7: error: f: wanted the number of a vertex"},
    };
    for (const Bad& bad : all) {
        try {
            read_mesh_text(bad.text, "m.obj");
            ADD_FAILURE() << "taken: " << bad.text;
        } catch (const SceneError& error) {
            const std::string expected = bad.expected;
            EXPECT_EQ(std::string(error.what()).substr(0, expected.size()), expected);
        }
    }
}

TEST(MeshFile, ReadsBackWhatItWrote)
{
    MeshFile mesh;
    mesh.vertices = {Vec3(0.1, 1.0 / 3, -1e-300), Vec3(5e-324, 1e300, -0.0), Vec3(1, 2, 3)};
    mesh.triangles = {{0, 1, 2}, {2, 1, 0}};
    const MeshFile again = read_mesh_text(mesh_text(mesh), "m.obj");
    EXPECT_EQ(again.vertices, mesh.vertices);
    EXPECT_EQ(again.triangles, mesh.triangles);
}

}  // namespace
}  // namespace throng
