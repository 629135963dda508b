// Odd meshes: those that real projects hold move, or are refused with what was found of them.
#include "pipeline/throng.hpp"
#include "scenes/catalog.hpp"
#include "scenes/mesh_file.hpp"
#include "tests/support/shared_data.hpp"

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

TEST(OddMeshes, AreRefusedWithWhatWasFound)
{
    // Its lower half.
    TriangleSoup bowl = ball_mesh(1, 24, 12);
    std::erase_if(bowl.triangles, [&](const auto& triangle) {
        return std::any_of(triangle.begin(), triangle.end(),
                           [&](std::uint32_t corner) { return bowl.vertices[corner].z() > 0.01; });
    });
    std::swap(bowl.triangles[5][0], bowl.triangles[5][1]);
    const std::string why = refusal_of(bowl);
    EXPECT_NE(why.find("shape solid: "), std::string::npos) << why;
    EXPECT_NE(why.find("Found: 1 triangle is wound against its neighbors"), std::string::npos)
        << why;
    EXPECT_NE(why.find("24 edges are open"), std::string::npos) << why;
}

TEST(OddMeshes, OfRealProjectsMoveOrAreRefused)
{
    struct Known {
        const char* file;
        const char* refusal;  // part of it; empty where it moves
    };
    // An open pot, rooms and a house without floors enclose nothing.
    for (const Known& known :
         {Known{"bunny.obj", ""}, Known{"bottle.obj", ""}, Known{"stairs.obj", ""},
          Known{"kettle.obj", "252 edges have more than two triangles"},
          Known{"level_01.obj", "148 edges are open"},
          Known{"building.obj", "112 edges are open"}}) {
        const auto path = shared_data(std::string("meshes/") + known.file);
        if (path.empty()) GTEST_SKIP() << known.file << " is not in the shared data";
        std::stringstream text;
        text << std::ifstream(path).rdbuf();
        const MeshFile file = read_mesh_text(text.str(), known.file);
        const std::string why = refusal_of({file.vertices, file.triangles});
        EXPECT_NE(why.find(known.refusal), std::string::npos) << known.file << ": " << why;
        EXPECT_EQ(why.empty(), std::string(known.refusal).empty()) << known.file << ": " << why;
    }
}

}  // namespace
}  // namespace throng
