#include "cooking/decomposition/convex_parts.hpp"

#include "cooking/decomposition/hull_mesh.hpp"
#include "kernels/geometry/mass.hpp"
#include "kernels/geometry/mesh.hpp"
#include "kernels/math/hash.hpp"
#include "scene/files/mesh_file.hpp"
#include "tests/support/closed.hpp"
#include "tests/support/shared_data.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <sstream>

namespace throng {
namespace {

// A solid of unit cubes: the faces that no other cube covers. Needs no two cubes that share an edge
// or a corner alone.
Mesh of_cubes(const std::vector<std::array<int, 3>>& cubes)
{
    std::vector<Vec3> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (const auto& cube : cubes)
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (const int side : {-1, 1}) {
                auto beside = cube;
                beside[axis] += side;
                if (std::find(cubes.begin(), cubes.end(), beside) != cubes.end()) continue;
                const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
                const auto first = static_cast<std::uint32_t>(vertices.size());
                for (int corner = 0; corner < 4; ++corner) {
                    Vec3 at(cube[0], cube[1], cube[2]);
                    at[static_cast<int>(axis)] += side > 0 ? 1 : 0;
                    at[static_cast<int>(u)] += corner == 1 || corner == 2 ? 1 : 0;
                    at[static_cast<int>(v)] += corner >= 2 ? 1 : 0;
                    vertices.push_back(at);
                }
                if (side > 0) {
                    triangles.push_back({first, first + 1, first + 2});
                    triangles.push_back({first, first + 2, first + 3});
                } else {
                    triangles.push_back({first, first + 2, first + 1});
                    triangles.push_back({first, first + 3, first + 2});
                }
            }
    return closed({std::move(vertices), std::move(triangles)});
}

Mesh shared_mesh(const std::filesystem::path& path)
{
    std::ifstream in(path);
    std::stringstream text;
    text << in.rdbuf();
    const MeshFile file = read_mesh_text(text.str(), path.filename().string());
    return closed({file.vertices, file.triangles});
}

// The least height above any hull: below 0 inside of one.
double height_above_all(const ConvexParts& parts, const Vec3& point)
{
    double least = std::numeric_limits<double>::infinity();
    for (const Hull& hull : parts.hulls) {
        double height = -std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < hull.normals.size(); ++i)
            height = std::max(height, hull.normals[i].dot(point) - hull.offsets[i]);
        least = std::min(least, height);
    }
    return least;
}

std::uint64_t fingerprint(const ConvexParts& parts)
{
    Hash hash;
    for (const Hull& hull : parts.hulls)
        for (const Vec3& vertex : hull.vertices)
            for (const double x : vertex) hash.add(x);
    hash.add(parts.error);
    hash.add(parts.volume_error);
    return hash.value();
}

void expect_sound(const Mesh& mesh, const ConvexParts& parts, int most)
{
    ASSERT_TRUE(parts.trouble.empty()) << parts.trouble;
    ASSERT_FALSE(parts.hulls.empty());
    EXPECT_LE(parts.hulls.size(), static_cast<std::size_t>(most));
    EXPECT_LE(parts.outside, parts.error);
    EXPECT_LE(parts.uncovered, parts.error);
    // Rounding of coordinates as large as the mesh.
    const double slack = 1e-12 * longest_side(mesh);
    double volume = 0;
    for (const Hull& hull : parts.hulls) {
        EXPECT_LE(hull.vertices.size(), kMostPartVertices);
        volume += mass_of(hull).volume;
    }
    EXPECT_NEAR(volume / mass_of(mesh).volume - 1, parts.volume_error, 1e-9);
    for (const Vec3& vertex : mesh.vertices)
        EXPECT_LE(height_above_all(parts, vertex), parts.uncovered + slack);
}

TEST(ConvexParts, ConvexMeshIsItsOnlyPart)
{
    const Mesh box = closed(box_mesh({1, 2, 3}));
    const ConvexParts parts = split_into_parts(box, {});
    expect_sound(box, parts, 1);
    EXPECT_EQ(parts.hulls[0].vertices.size(), 8u);
    EXPECT_NEAR(parts.volume_error, 0, 1e-12);
    EXPECT_NEAR(parts.outside, 0, 1e-12);

    const Mesh ball = closed(ball_mesh(1, 8, 8));
    const ConvexParts round = split_into_parts(ball, {});
    expect_sound(ball, round, 1);
    EXPECT_EQ(round.hulls[0].vertices.size(), ball.vertices.size());
    EXPECT_NEAR(round.volume_error, 0, 1e-9);
}

struct Letter {
    const char* name;
    std::vector<std::array<int, 3>> cubes;
    std::size_t parts;
    double shared;  // volume that two parts have in common, against the whole
};

TEST(ConvexParts, ShapesOfBoxesComeApartIntoThem)
{
    const std::vector<Letter> letters = {
        {"L", {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {0, 2, 0}}, 2, 0},
        {"U", {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {2, 1, 0}, {0, 2, 0}, {2, 2, 0}}, 3, 0},
        {"cross", {{1, 1, 0}, {0, 1, 0}, {2, 1, 0}, {1, 0, 0}, {1, 2, 0}}, 2, 0.2},
        {"corner", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, 3, 0},
    };
    for (const Letter& letter : letters) {
        SCOPED_TRACE(letter.name);
        const Mesh mesh = of_cubes(letter.cubes);
        ASSERT_TRUE(is_closed(mesh));
        const ConvexParts parts = split_into_parts(mesh, {});
        expect_sound(mesh, parts, 16);
        EXPECT_EQ(parts.hulls.size(), letter.parts);
        // The planes of faces are rounded: a little of each cut.
        EXPECT_NEAR(parts.volume_error, letter.shared, 1e-9);
        EXPECT_NEAR(parts.outside, 0, 1e-9);
    }
}

TEST(ConvexParts, TorusKeepsItsHole)
{
    const Mesh torus = closed(torus_mesh(3, 1, 16, 8));
    double last = std::numeric_limits<double>::infinity();
    for (const int most : {1, 6, 12}) {
        // An error that no number of these parts reaches.
        const ConvexParts parts = split_into_parts(torus, {most, 0.1});
        expect_sound(torus, parts, most);
        EXPECT_LT(parts.error, 0.7 * last) << most;
        last = parts.error;
        if (most == 1) continue;
        // The inner rim is 2 away; half of that is more than any straight side bulges.
        for (int i = -4; i <= 4; ++i)
            EXPECT_GT(height_above_all(parts, Vec3(0, 0, 0.25 * i)), 1) << most;
    }
    // No worse than sixths of the ring: their hulls bulge by 1 - cos(pi / 6) of the inner
    // radius, 2.
    EXPECT_LT(last, 0.27);
}

TEST(ConvexParts, ErrorIsThatOfManyPoints)
{
    const Mesh torus = closed(torus_mesh(3, 1, 24, 12));
    const ConvexParts parts = split_into_parts(torus, {6, 0});
    expect_sound(torus, parts, 6);
    // Points all over the faces of the hulls, by no way that the search goes.
    double furthest = 0;
    for (const Hull& hull : parts.hulls) {
        const HullMesh faces = hull_mesh(hull.vertices);
        for (const auto& [a, b, c] : faces.triangles)
            for (int i = 0; i <= 20; ++i)
                for (int k = 0; i + k <= 20; ++k) {
                    const Vec3 at = (i * faces.vertices[a] + k * faces.vertices[b]
                                     + (20 - i - k) * faces.vertices[c])
                        / 20;
                    furthest = std::max(furthest, signed_distance(torus, at));
                }
    }
    EXPECT_LE(furthest, parts.error);
    EXPECT_GE(furthest, 0.8 * parts.error);
}

TEST(ConvexParts, SameBitsOnEveryRun)
{
    const Mesh torus = closed(torus_mesh(3, 1, 16, 8));
    const ConvexParts once = split_into_parts(torus, {6, 0});
    const ConvexParts again = split_into_parts(torus, {6, 0});
    EXPECT_EQ(fingerprint(once), fingerprint(again));
}

TEST(ConvexParts, SizeChangesNothing)
{
    TriangleSoup soup = torus_mesh(3, 1, 16, 8);
    const ConvexParts large = split_into_parts(closed(soup), {6, 0});
    // By a power of two, so that not a bit of any number is another.
    for (Vec3& vertex : soup.vertices) vertex /= 1024;
    const ConvexParts small = split_into_parts(closed(soup), {6, 0});
    EXPECT_EQ(small.hulls.size(), large.hulls.size());
    EXPECT_DOUBLE_EQ(1024 * small.error, large.error);
    EXPECT_DOUBLE_EQ(small.volume_error, large.volume_error);
}

TEST(ConvexParts, WhatIsNotClosedIsRefused)
{
    TriangleSoup soup = box_mesh({1, 1, 1});
    soup.triangles.pop_back();
    EXPECT_EQ(split_into_parts(closed(soup), {}).trouble,
              "has 3 edges that are not shared by two triangles; give a closed mesh");
    EXPECT_FALSE(put_into_hull(closed(soup)).trouble.empty());
    EXPECT_EQ(split_into_parts(Mesh(), {}).trouble, "has no triangles; give a closed mesh");

    soup = box_mesh({1, 1, 1});
    for (auto& triangle : soup.triangles) std::swap(triangle[0], triangle[1]);
    EXPECT_EQ(split_into_parts(closed(soup), {}).trouble,
              "is inside out; give triangles that turn outward");
}

TEST(ConvexParts, HullTellsHowMuchItFills)
{
    // Three cubes of an L and a half square between them.
    const Mesh mesh = of_cubes({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    const ConvexParts hull = put_into_hull(mesh);
    ASSERT_EQ(hull.hulls.size(), 1u);
    EXPECT_NEAR(hull.volume_error, 0.5 / 3, 1e-9);
    // The middle of the slope, half of a cube off either face of the corner.
    EXPECT_NEAR(hull.outside, 0.5, 0.01);
    ASSERT_EQ(hull.warnings.size(), 1u);
    EXPECT_EQ(hull.warnings[0], "holes and hollows are filled, 17 % more than the mesh");
}

// Bounds are of the longest side and of the mesh's volume: what was measured, with a tenth of room.
void expect_measured(const char* name, int most, double error, double volume_error)
{
    const auto path = shared_data("meshes/" + std::string(name) + ".obj");
    if (path.empty()) GTEST_SKIP() << "needs the shared meshes";
    const Mesh mesh = shared_mesh(path);
    ASSERT_TRUE(is_closed(mesh));
    const ConvexParts parts = split_into_parts(mesh, {most, 0});
    expect_sound(mesh, parts, most);
    EXPECT_LT(parts.error, error * longest_side(mesh));
    EXPECT_LT(parts.volume_error, volume_error);
    EXPECT_LT(parts.error, 0.5 * put_into_hull(mesh).error);
}

TEST(ConvexParts, RealTorusKeepsItsMeasuredError) { expect_measured("torus", 12, 0.024, 0.057); }

TEST(ConvexParts, SnowflakeKeepsItsMeasuredError) { expect_measured("snowflake", 16, 0.044, 0.62); }

TEST(ConvexParts, CubeCupKeepsItsMeasuredError) { expect_measured("cube_cup", 8, 0.02, 0.013); }

TEST(ConvexParts, OpenRealMeshesAreRefused)
{
    // 42 edges round the holes in the base.
    const auto path = shared_data("meshes/bunny.obj");
    if (path.empty()) GTEST_SKIP() << "needs the shared meshes";
    EXPECT_EQ(split_into_parts(shared_mesh(path), {}).trouble,
              "has 42 edges that are not shared by two triangles; give a closed mesh");
}

}  // namespace
}  // namespace throng
