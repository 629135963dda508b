// Mesh holes: small ones are closed the right way round, wide ones and odd rims are left.
#include "cooking/repair/mesh_holes.hpp"

#include "cooking/repair/build_mesh.hpp"
#include "cooking/repair/mesh_health.hpp"
#include "kernels/geometry/mass.hpp"
#include "kernels/geometry/mesh.hpp"
#include "scene/catalog/closed_meshes.hpp"
#include "scene/files/mesh_file.hpp"
#include "tests/support/shared_data.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

namespace throng {
namespace {

// Without the triangles of which a corner is one of `corners`.
TriangleSoup without(TriangleSoup soup, std::vector<std::uint32_t> corners)
{
    std::erase_if(soup.triangles, [&](const auto& triangle) {
        return std::any_of(corners.begin(), corners.end(), [&](std::uint32_t corner) {
            return std::find(triangle.begin(), triangle.end(), corner) != triangle.end();
        });
    });
    return soup;
}

bool says(const RepairedMesh& result, const std::string& what)
{
    return std::any_of(result.warnings.begin(), result.warnings.end(), [&](const auto& warning) {
        return warning.find(what) != std::string::npos;
    });
}

TEST(MeshHoles, ClosesTheCapOfABallOutward)
{
    // Its south pole, 12 triangles round one vertex, which the flat fan is just inside of.
    const TriangleSoup whole = ball_mesh(1, 12, 16);
    TriangleSoup soup = without(whole, {0});
    const std::size_t before = soup.triangles.size();
    const ClosedHoles closed = close_holes(soup.vertices, soup.triangles);
    EXPECT_EQ(closed.count, 1u);
    EXPECT_EQ(closed.longest, 12u);
    EXPECT_EQ(soup.triangles.size(), before + 12);
    const Mesh mesh = build_mesh(soup.vertices, soup.triangles).mesh;
    EXPECT_TRUE(is_closed(mesh));
    const double volume = mass_of(build_mesh(whole.vertices, whole.triangles).mesh).volume;
    EXPECT_LT(mass_of(mesh).volume, volume);
    EXPECT_GT(mass_of(mesh).volume, 0.999 * volume);
}

TEST(MeshHoles, ClosesATriangleByOneWithoutANewVertex)
{
    TriangleSoup soup = torus_mesh(1, 0.3, 24, 12);
    const std::size_t vertices = soup.vertices.size();
    const auto gone = soup.triangles[77];
    soup.triangles.erase(soup.triangles.begin() + 77);
    EXPECT_EQ(close_holes(soup.vertices, soup.triangles).count, 1u);
    EXPECT_EQ(soup.vertices.size(), vertices);
    auto put = soup.triangles.back();
    // The same, begun at whichever corner.
    while (put[0] != gone[0]) std::rotate(put.begin(), put.begin() + 1, put.end());
    EXPECT_EQ(put, gone);
}

TEST(MeshHoles, LeavesOpenWhatIsMeantToBe)
{
    // A bowl, a box without its lid, and a sheet.
    TriangleSoup bowl = ball_mesh(1, 24, 12);
    std::erase_if(bowl.triangles, [&](const auto& triangle) {
        return std::any_of(triangle.begin(), triangle.end(),
                           [&](std::uint32_t corner) { return bowl.vertices[corner].z() > 0.01; });
    });
    TriangleSoup box = box_mesh({1, 1, 1});
    box.triangles.erase(box.triangles.begin() + 2, box.triangles.begin() + 4);
    TriangleSoup sheet;
    sheet.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
    for (TriangleSoup* soup : {&bowl, &box, &sheet}) {
        const TriangleSoup before = *soup;
        EXPECT_EQ(close_holes(soup->vertices, soup->triangles).count, 0u);
        EXPECT_EQ(soup->vertices, before.vertices);
        EXPECT_EQ(soup->triangles, before.triangles);
    }
}

TEST(MeshHoles, JudgesAHoleByTheSurfaceThatItIsIn)
{
    // A sheet beside a ball far larger.
    TriangleSoup soup = ball_mesh(10, 24, 12);
    const auto first = static_cast<std::uint32_t>(soup.vertices.size());
    for (const Vec3& corner : {Vec3(20, 0, 0), Vec3(21, 0, 0), Vec3(21, 1, 0)})
        soup.vertices.push_back(corner);
    soup.triangles.push_back({first, first + 1, first + 2});
    EXPECT_EQ(close_holes(soup.vertices, soup.triangles).count, 0u);
}

TEST(MeshHoles, LeavesRimsThatMeetInAVertexAndCracksWithoutWidth)
{
    // Two triangles that share a corner alone.
    TriangleSoup soup = torus_mesh(1, 0.3, 24, 12);
    const auto first = soup.triangles[0];
    std::size_t second = 1;
    const auto shared = [&](const auto& triangle) {
        return std::count_if(triangle.begin(), triangle.end(), [&](std::uint32_t corner) {
            return std::find(first.begin(), first.end(), corner) != first.end();
        });
    };
    while (shared(soup.triangles[second]) != 1) ++second;
    soup.triangles.erase(soup.triangles.begin() + static_cast<std::ptrdiff_t>(second));
    soup.triangles.erase(soup.triangles.begin());
    EXPECT_EQ(close_holes(soup.vertices, soup.triangles).count, 0u);

    // An edge that is one on this side and two on the other.
    soup = box_mesh({1, 1, 1});
    const auto [a, b, c] = soup.triangles[0];
    soup.vertices.push_back(0.5 * (soup.vertices[a] + soup.vertices[b]));
    const auto middle = static_cast<std::uint32_t>(soup.vertices.size() - 1);
    soup.triangles[0] = {a, middle, c};
    soup.triangles.push_back({middle, b, c});
    EXPECT_EQ(close_holes(soup.vertices, soup.triangles).count, 0u);
}

TEST(MeshHoles, AreClosedInMending)
{
    TriangleSoup soup = without(ball_mesh(1, 12, 16), {0});
    soup.triangles.erase(soup.triangles.begin() + 100);
    // The winding of what is there may be at odds before.
    std::swap(soup.triangles[3][0], soup.triangles[3][1]);
    const RepairedMesh result = repair(soup.vertices, soup.triangles);
    EXPECT_EQ(result.health.holes, 2u);
    EXPECT_EQ(result.health.open_edges, 0u);
    EXPECT_TRUE(says(result, "closed 2 holes, the longest round 12 edges"));
    EXPECT_TRUE(result.health.sound());
    EXPECT_TRUE(is_closed(result.mesh));
    EXPECT_GT(mass_of(result.mesh).volume, 3.5);
}

TEST(MeshHoles, OfARealScanAreClosed)
{
    const auto path = shared_data("meshes/bunny.obj");
    if (path.empty()) GTEST_SKIP() << "meshes/bunny.obj is not in the shared data";
    std::stringstream text;
    text << std::ifstream(path).rdbuf();
    const MeshFile file = read_mesh_text(text.str(), "bunny.obj");
    const RepairedMesh result = repair(file.vertices, file.triangles);
    EXPECT_TRUE(says(result, "closed 4 holes, the longest round 12 edges"));
    EXPECT_TRUE(result.health.sound());
    EXPECT_TRUE(is_closed(result.mesh));
}

}  // namespace
}  // namespace throng
