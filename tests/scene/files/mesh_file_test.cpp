// Mesh file: what an OBJ text says, and where it says it wrongly.
#include "scene/files/mesh_file.hpp"

#include "scene/files/scene_error.hpp"

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

TEST(MeshFile, ReadsLinesThatGoOnAndATextThatSaysItIsUtf8)
{
    const MeshFile mesh = read_mesh_text("\xef\xbb\xbfv 0 0 0\nv 1 \\\n0 0\nv 0 1\\\r\n 0\n"
                                         "# a comment may go on \\\nf 9 9 9\nf 1 \\\n\\\n 2 3",
                                         "m.obj");
    EXPECT_EQ(mesh.vertices, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}}));
}

// Triangles turn as the polygon does and have its area: they do not overlap.
TEST(MeshFile, CutsPolygonsThatAreNotConvex)
{
    // An arrow whose fan would fold over, and a comb of five teeth, both askew in space.
    std::vector<std::vector<Vec3>> polygons = {{{2, 0, 0}, {0, 2, 0}, {0.5, 0, 0}, {0, -2, 0}}};
    std::vector<Vec3>& comb = polygons.emplace_back();
    for (int tooth = 0; tooth < 5; ++tooth) {
        comb.emplace_back(2 * tooth, tooth == 0 ? -1 : 0, 0);
        comb.emplace_back(2 * tooth + 0.5, 3, 0);
    }
    comb.emplace_back(10, -1, 0);
    const std::vector<double> areas = {3, 24};
    const Quat askew(Eigen::AngleAxisd(1, Vec3(1, 2, 3).normalized()));
    for (std::size_t p = 0; p < polygons.size(); ++p)
        for (std::size_t start = 0; start < polygons[p].size(); ++start) {
            // The face comes first: its vertices are known only at the end.
            std::string face = "f", vertices;
            for (std::size_t i = 0; i < polygons[p].size(); ++i) {
                const Vec3 at = askew * polygons[p][i];
                vertices += "v " + std::to_string(at.x()) + ' ' + std::to_string(at.y()) + ' '
                    + std::to_string(at.z()) + '\n';
                face += ' ' + std::to_string((start + i) % polygons[p].size() + 1);
            }
            const MeshFile mesh = read_mesh_text(face + '\n' + vertices, "m.obj");
            ASSERT_EQ(mesh.triangles.size(), polygons[p].size() - 2);
            const Vec3 up = askew * Vec3::UnitZ() * (p == 0 ? 1 : -1);
            double area = 0;
            for (const auto& [a, b, c] : mesh.triangles) {
                const Vec3& corner = mesh.vertices[a];
                const double twice =
                    (mesh.vertices[b] - corner).cross(mesh.vertices[c] - corner).dot(up);
                EXPECT_GT(twice, 0) << p << ' ' << start;
                area += twice / 2;
            }
            EXPECT_NEAR(area, areas[p], 1e-4) << p << ' ' << start;  // the text has six digits
        }
}

TEST(MeshFile, CutsPolygonsWithoutEarsAsWell)
{
    // One that cuts itself, one without any area, and one of too many corners to be cut with care.
    std::string text = "v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 4\nf 1 2 1 2 1\nf";
    for (int i = 0; i < 1000; ++i) text += i % 2 == 0 ? " 1" : " 3";
    const MeshFile mesh = read_mesh_text(text, "m.obj");
    EXPECT_EQ(mesh.triangles.size(), 2u + 3 + 998);
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
