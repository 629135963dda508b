// Mesh health: every kind of badness found, said and mended or left.
#include "cooking/repair/mesh_health.hpp"

#include "cooking/repair/build_mesh.hpp"
#include "kernels/geometry/mass.hpp"
#include "kernels/geometry/mesh.hpp"
#include "kernels/geometry/mesh_distance.hpp"
#include "scene/catalog/closed_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace throng {
namespace {

RepairedMesh repaired(const TriangleSoup& soup) { return repair(soup.vertices, soup.triangles); }

TriangleSoup joined_soups(TriangleSoup a, const TriangleSoup& b, const Vec3& by)
{
    const auto first = static_cast<std::uint32_t>(a.vertices.size());
    for (const Vec3& vertex : b.vertices) a.vertices.push_back(vertex + by);
    for (const auto& [i, j, k] : b.triangles)
        a.triangles.push_back({first + i, first + j, first + k});
    return a;
}

TriangleSoup inward(TriangleSoup soup)
{
    for (auto& triangle : soup.triangles) std::swap(triangle[1], triangle[2]);
    return soup;
}

bool says(const RepairedMesh& result, const std::string& what)
{
    return std::any_of(
        result.warnings.begin(), result.warnings.end(),
        [&](const std::string& warning) { return warning.find(what) != std::string::npos; });
}

TEST(MeshHealth, HasNothingToSayOfWhatIsSound)
{
    for (const TriangleSoup& soup :
         {box_mesh({1, 2, 3}), ball_mesh(1, 24, 12), torus_mesh(1, 0.3, 24, 12)}) {
        const RepairedMesh result = repaired(soup);
        EXPECT_EQ(result.trouble, "");
        EXPECT_TRUE(result.warnings.empty()) << result.warnings[0];
        EXPECT_TRUE(result.health.sound());
        EXPECT_EQ(result.health.pieces, 1u);
        EXPECT_EQ(result.mesh.triangles, build_mesh(soup.vertices, soup.triangles).mesh.triangles);
        EXPECT_EQ(result.mesh.vertex_normals.size(), result.mesh.vertices.size());
    }
}

TEST(MeshHealth, RefusesWhatIsEmptyOrBroken)
{
    EXPECT_NE(repair({}, {}).trouble.find("has no triangles"), std::string::npos);
    EXPECT_NE(
        repair({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}).trouble.find("no triangle with an"),
        std::string::npos);
    EXPECT_NE(repair({{0, 0, 0}, {1, 0, 0}}, {{0, 1, 2}}).trouble.find("names vertex 2"),
              std::string::npos);
}

TEST(MeshHealth, DropsTrianglesGivenTwiceEitherWayRound)
{
    TriangleSoup soup = ball_mesh(1, 12, 6);
    const std::size_t count = soup.triangles.size();
    const auto [a, b, c] = soup.triangles[7];
    soup.triangles.push_back({b, c, a});
    soup.triangles.push_back({c, b, a});
    const RepairedMesh result = repaired(soup);
    EXPECT_EQ(result.health.duplicates, 2u);
    EXPECT_EQ(result.mesh.triangles.size(), count);
    EXPECT_TRUE(says(result, "2 triangles are given more than once: dropped"));
    EXPECT_TRUE(result.health.sound());
    EXPECT_TRUE(is_closed(result.mesh));
}

TEST(MeshHealth, MakesWindingsAgree)
{
    TriangleSoup soup = ball_mesh(1, 24, 12);
    const double volume = mass_of(repaired(soup).mesh).volume;
    for (const std::size_t t : {0u, 5u, 6u, 100u})
        std::swap(soup.triangles[t][0], soup.triangles[t][1]);
    const RepairedMesh result = repaired(soup);
    EXPECT_EQ(result.health.turned, 4u);
    EXPECT_TRUE(says(result, "4 triangles are wound against their neighbors: turned over"));
    EXPECT_TRUE(is_closed(result.mesh));
    EXPECT_TRUE(result.health.sound());
    EXPECT_NEAR(mass_of(result.mesh).volume, volume, 1e-12);
}

TEST(MeshHealth, TurnsOverWhatIsInsideOut)
{
    // Far from the origin, where a volume about it would be mostly rounding.
    TriangleSoup soup = inward(torus_mesh(1, 0.3, 24, 12));
    for (Vec3& vertex : soup.vertices) vertex += Vec3(1e7, 2e7, -1e7);
    const RepairedMesh result = repaired(soup);
    EXPECT_EQ(result.health.inside_out, 1u);
    EXPECT_TRUE(says(result, "1 piece is inside out: turned over"));
    EXPECT_TRUE(result.health.sound());
    EXPECT_LT(signed_distance(result.mesh, Vec3(1e7 + 1, 2e7, -1e7)), -0.2);
}

TEST(MeshHealth, KeepsHollowsAndTurnsOutwardWhatStandsInThem)
{
    // A box, a hollow in it, and in the hollow a ball inside out.
    TriangleSoup soup =
        joined_soups(box_mesh({2, 2, 2}), inward(box_mesh({1.5, 1.5, 1.5})), {0, 0, 0});
    soup = joined_soups(soup, inward(ball_mesh(1, 12, 8)), {0, 0, 0});
    const RepairedMesh result = repaired(soup);
    EXPECT_EQ(result.health.pieces, 3u);
    EXPECT_EQ(result.health.hollows, 1u);
    EXPECT_EQ(result.health.inside_out, 1u);
    EXPECT_TRUE(result.health.sound());
    EXPECT_TRUE(says(result, "kept as a hollow"));
    EXPECT_TRUE(says(result, "3 pieces"));
    EXPECT_LT(signed_distance(result.mesh, Vec3(1.75, 0, 0)), 0);
    EXPECT_GT(signed_distance(result.mesh, Vec3(1.4, 0, 0)), 0);
    EXPECT_LT(signed_distance(result.mesh, Vec3(0.5, 0, 0)), 0);
}

TEST(MeshHealth, DoesNotTrustWhatIsBuriedOutward)
{
    const RepairedMesh result =
        repaired(joined_soups(box_mesh({2, 2, 2}), ball_mesh(1, 12, 8), {0.1, 0, 0}));
    EXPECT_EQ(result.health.buried, 1u);
    EXPECT_FALSE(result.health.sound());
    EXPECT_TRUE(says(result, "1 piece lies within another"));
}

TEST(MeshHealth, CountsOpenAndCrowdedEdges)
{
    TriangleSoup soup = box_mesh({1, 1, 1});
    soup.triangles.pop_back();
    RepairedMesh result = repaired(soup);
    EXPECT_EQ(result.health.open_edges, 3u);
    EXPECT_FALSE(result.health.sound());
    EXPECT_TRUE(says(result, "3 edges are open"));

    // A fin upon an edge of a box.
    soup = box_mesh({1, 1, 1});
    soup.vertices.emplace_back(3, 3, 0);
    soup.triangles.push_back({3, 7, 8});
    result = repaired(soup);
    EXPECT_EQ(result.health.crowded_edges, 1u);
    EXPECT_EQ(result.health.open_edges, 2u);
    EXPECT_TRUE(says(result, "more than two triangles"));
}

TEST(MeshHealth, LeavesAloneWhatHasOneSideOnly)
{
    // A strip with half a twist.
    TriangleSoup soup;
    constexpr std::uint32_t kSteps = 24;
    for (std::uint32_t i = 0; i < kSteps; ++i) {
        const double angle = 2 * 3.14159265358979 * i / kSteps;
        const Vec3 out(std::cos(angle), std::sin(angle), 0);
        const Vec3 across = 0.3 * (std::cos(angle / 2) * out + std::sin(angle / 2) * Vec3::UnitZ());
        soup.vertices.push_back(out - across);
        soup.vertices.push_back(out + across);
    }
    for (std::uint32_t i = 0; i < kSteps; ++i) {
        const std::uint32_t a = 2 * i, b = a + 1;
        const bool last = i + 1 == kSteps;
        const std::uint32_t c = last ? 1 : a + 2, d = last ? 0 : a + 3;
        soup.triangles.push_back({a, b, c});
        soup.triangles.push_back({b, d, c});
    }
    const RepairedMesh result = repaired(soup);
    EXPECT_EQ(result.health.one_sided, 1u);
    EXPECT_FALSE(result.health.sound());
    EXPECT_TRUE(says(result, "one side only"));
}

TEST(MeshHealth, CountsTrianglesThatCross)
{
    // A plate through a box: its upper and lower face each cross four walls.
    const RepairedMesh result =
        repaired(joined_soups(box_mesh({1, 1, 1}), box_mesh({1.5, 1.4, 0.1}), {0.03, 0.05, 0.07}));
    EXPECT_GE(result.health.cuts, 8u);
    EXPECT_FALSE(result.health.sound());
    EXPECT_TRUE(says(result, "pairs of triangles cross"));
    // Side by side they do not.
    EXPECT_EQ(
        repaired(joined_soups(box_mesh({1, 1, 1}), box_mesh({1, 1, 1}), {2.5, 0, 0})).health.cuts,
        0u);
    // Work has a bound, and the answer says where it was met.
    bool cut_short = false;
    EXPECT_LE(count_cuts(result.mesh, 5, cut_short), 5u);
    EXPECT_TRUE(cut_short);
}

}  // namespace
}  // namespace throng
