// Odd meshes: those that real projects hold move, or are refused with what was found of them.
#include "scene/catalog/closed_meshes.hpp"
#include "scene/files/mesh_file.hpp"
#include "tests/support/shared_data.hpp"
#include "throng/catalog.hpp"
#include "throng/throng.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

namespace throng {
namespace {

// Why a world would not take a body of this mesh; empty where it moves, and stays finite.
std::string refusal_of(const TriangleSoup& mesh)
{
    try {
        World world(find_scene("knots")->make_of(2, 1, mesh));
        world.step(5);
        EXPECT_EQ(world.report().bodies_quarantined, 0u);
    } catch (const std::invalid_argument& refusal) {
        return refusal.what();
    }
    return {};
}

TEST(OddMeshes, OpenOnesMoveAsSheetsAndSaySo)
{
    // Its lower half.
    TriangleSoup bowl = ball_mesh(1, 24, 12);
    std::erase_if(bowl.triangles, [&](const auto& triangle) {
        return std::any_of(triangle.begin(), triangle.end(),
                           [&](std::uint32_t corner) { return bowl.vertices[corner].z() > 0.01; });
    });
    std::swap(bowl.triangles[5][0], bowl.triangles[5][1]);
    EXPECT_EQ(refusal_of(bowl), "");
    const World world(find_scene("knots")->make_of(2, 1, bowl));
    std::string warnings;
    for (const std::string& warning : world.warnings()) warnings += warning + '\n';
    for (const char* part : {"1 triangle is wound against its neighbors", "24 edges are open",
                             "taken as a sheet 0.0", "as the surface of its level set"})
        EXPECT_NE(warnings.find(part), std::string::npos) << part << " is not in " << warnings;
}

TEST(OddMeshes, AreRefusedWithWhatWasFound)
{
    TriangleSoup tent;
    tent.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
    tent.triangles = {{0, 1, 2}, {1, 3, 2}};
    const std::string why = refusal_of(tent);
    EXPECT_NE(why.find("wanted a mesh"), std::string::npos) << why;
}

// An open pot, rooms and a house without floors enclose nothing: they move as sheets.
TEST(OddMeshes, OfRealProjectsMove)
{
    for (const char* const name :
         {"bunny.obj", "bottle.obj", "stairs.obj", "kettle.obj", "level_01.obj", "building.obj"}) {
        const auto path = shared_data(std::string("meshes/") + name);
        if (path.empty()) GTEST_SKIP() << name << " is not in the shared data";
        std::stringstream text;
        text << std::ifstream(path).rdbuf();
        const MeshFile file = read_mesh_text(text.str(), name);
        EXPECT_EQ(refusal_of({file.vertices, file.triangles}), "") << name;
    }
}

}  // namespace
}  // namespace throng
