#include "kernels/geometry/mesh.hpp"

#include "cooking/repair/build_mesh.hpp"
#include "kernels/geometry/k_dop.hpp"
#include "kernels/geometry/mass.hpp"
#include "scene/catalog/closed_meshes.hpp"
#include "tests/support/dice.hpp"
#include "tests/support/shared_data.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <random>
#include <sstream>

namespace throng {
namespace {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

struct Soup {
    std::vector<Vec3> vertices;
    Triangles triangles;

    void add_quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
    {
        const auto first = static_cast<std::uint32_t>(vertices.size());
        vertices.insert(vertices.end(), {a, b, c, d});
        triangles.push_back({first, first + 1, first + 2});
        triangles.push_back({first, first + 2, first + 3});
    }
};

// A prism along y over a polygon in the xz plane (counter-clockwise with x to the right, z up),
// its sides alone; every quad has vertices of its own.
Soup prism_sides(const std::vector<std::array<double, 2>>& outline)
{
    Soup soup;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const auto [x, z] = outline[i];
        const auto [next_x, next_z] = outline[(i + 1) % outline.size()];
        soup.add_quad({x, 0, z}, {x, 1, z}, {next_x, 1, next_z}, {next_x, 0, next_z});
    }
    return soup;
}

Soup cube()
{
    Soup soup = prism_sides({{0, 0}, {1, 0}, {1, 1}, {0, 1}});
    soup.add_quad({0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1});
    soup.add_quad({0, 1, 0}, {0, 1, 1}, {1, 1, 1}, {1, 1, 0});
    return soup;
}

Mesh built(const Soup& soup)
{
    const MeshResult result = build_mesh(soup.vertices, soup.triangles);
    EXPECT_EQ(result.trouble, "");
    return result.mesh;
}

// The tree holds every triangle once, boxes hold what is below them, and leaves are small.
void expect_tree_holds_all(const Mesh& mesh)
{
    std::vector<std::uint32_t> order = mesh.order;
    std::sort(order.begin(), order.end());
    for (std::uint32_t i = 0; i < order.size(); ++i) ASSERT_EQ(order[i], i);
    std::size_t in_leaves = 0;
    for (const Mesh::Node& node : mesh.tree) {
        const Box3 box{node.lower, node.upper};
        in_leaves += node.count;
        EXPECT_LE(node.count, 4U);
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
            EXPECT_TRUE(box.contains(triangle_box(mesh, mesh.order[i])));
        for (std::uint32_t child = 0; node.count == 0 && child < 2; ++child) {
            const Mesh::Node& below = mesh.tree[node.first + child];
            EXPECT_TRUE(box.contains({below.lower, below.upper}));
        }
    }
    EXPECT_EQ(in_leaves, mesh.triangles.size());
}

void expect_neighbors_agree(const Mesh& mesh)
{
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        for (std::size_t e = 0; e < 3; ++e) {
            const std::int32_t beyond = mesh.adjacent[t][e];
            if (beyond < 0) {
                EXPECT_TRUE(mesh.convex_edges[t] >> e & 1);
                continue;
            }
            const auto other = static_cast<std::size_t>(beyond);
            const std::uint32_t from = mesh.triangles[t][e], to = mesh.triangles[t][(e + 1) % 3];
            bool found = false;
            for (std::size_t k = 0; k < 3; ++k)
                found = found
                    || (mesh.triangles[other][k] == to && mesh.triangles[other][(k + 1) % 3] == from
                        && mesh.adjacent[other][k] == static_cast<std::int32_t>(t));
            EXPECT_TRUE(found) << "triangle " << t << " edge " << e;
        }
}

void expect_same_as_all(const Mesh& mesh, const Box3& box)
{
    std::vector<std::uint32_t> wanted, found{7};
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
        if (box.overlaps(triangle_box(mesh, t))) wanted.push_back(t);
    find_triangles(mesh, box, found);
    EXPECT_EQ(found.front(), 7U);
    found.erase(found.begin());
    EXPECT_EQ(found, wanted);
}

TEST(BuildMesh, CubeOfSeparateQuadsIsWeldedAndClosed)
{
    const Mesh mesh = built(cube());
    EXPECT_EQ(mesh.vertices.size(), 8U);
    EXPECT_EQ(mesh.triangles.size(), 12U);
    EXPECT_TRUE(is_closed(mesh));
    EXPECT_NEAR(mass_of(mesh).volume, 1, 1e-15);
    expect_neighbors_agree(mesh);
    expect_tree_holds_all(mesh);
    // Each triangle has two edges of the cube and one across its square.
    for (std::size_t t = 0; t < 12; ++t) {
        int convex = 0;
        for (std::size_t e = 0; e < 3; ++e) {
            const auto beyond = static_cast<std::size_t>(mesh.adjacent[t][e]);
            const bool folded = mesh.normals[t].dot(mesh.normals[beyond]) < 0.5;
            EXPECT_EQ(mesh.convex_edges[t] >> e & 1, folded);
            convex += folded;
        }
        EXPECT_EQ(convex, 2);
    }
}

TEST(BuildMesh, StairHasOneConcaveEdgeAndRims)
{
    const Mesh mesh = built(prism_sides({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}));
    EXPECT_EQ(mesh.vertices.size(), 12U);
    EXPECT_FALSE(is_closed(mesh));
    expect_neighbors_agree(mesh);
    int rims = 0, concave = 0, convex = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        for (std::size_t e = 0; e < 3; ++e) {
            const std::int32_t beyond = mesh.adjacent[t][e];
            if (beyond < 0) {
                ++rims;
                continue;
            }
            const auto other = static_cast<std::size_t>(beyond);
            if (mesh.normals[t].dot(mesh.normals[other]) > 0.5) continue;
            const Vec3& corner = mesh.vertices[mesh.triangles[t][e]];
            const bool inner = corner.x() == 1 && corner.z() == 1;
            EXPECT_EQ(mesh.convex_edges[t] >> e & 1, !inner);
            ++(inner ? concave : convex);
        }
    EXPECT_EQ(rims, 12);
    EXPECT_EQ(concave, 2);
    EXPECT_EQ(convex, 10);
}

TEST(BuildMesh, FlatGroundHasNoConvexEdgeInside)
{
    // Heights rounded to single precision, far from the origin.
    Soup soup;
    const auto at = [](int i, int j) {
        const float slope = 0.1F * static_cast<float>(i) + 0.05F * static_cast<float>(j);
        return Vec3(i + 1000, j - 500, double{slope});
    };
    for (int i = 0; i < 20; ++i)
        for (int j = 0; j < 20; ++j)
            soup.add_quad(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
    const Mesh mesh = built(soup);
    EXPECT_EQ(mesh.vertices.size(), 441U);
    expect_neighbors_agree(mesh);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        for (std::size_t e = 0; e < 3; ++e)
            EXPECT_EQ(mesh.convex_edges[t] >> e & 1, mesh.adjacent[t][e] < 0);
}

TEST(BuildMesh, TrianglesOfNoAreaAndUnusedVerticesAreLeftOut)
{
    Soup soup = cube();
    soup.vertices.insert(soup.vertices.begin(), Vec3(50, 50, 50));
    for (auto& triangle : soup.triangles)
        for (std::uint32_t& vertex : triangle) ++vertex;
    const Mesh clean = built(soup);
    soup.vertices.emplace_back(0, 0.5, 0);
    soup.triangles.insert(soup.triangles.begin() + 3, {1, 2, 2});
    soup.triangles.push_back({1, 2, static_cast<std::uint32_t>(soup.vertices.size() - 1)});
    const Mesh mesh = built(soup);
    EXPECT_EQ(mesh.triangles, clean.triangles);
    EXPECT_EQ(mesh.vertices, clean.vertices);
    EXPECT_EQ(mesh.vertices.size(), 8U);
}

TEST(BuildMesh, EdgesOfThreeTrianglesOrOfClashingDirectionsAreRims)
{
    Soup fan;
    fan.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}};
    fan.triangles = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}};
    for (const auto& beyond : built(fan).adjacent) EXPECT_EQ(beyond, (std::array{-1, -1, -1}));
    fan.triangles = {{0, 1, 2}, {0, 1, 3}};
    for (const auto& beyond : built(fan).adjacent) EXPECT_EQ(beyond, (std::array{-1, -1, -1}));
    fan.triangles = {{0, 1, 2}, {1, 0, 3}};
    EXPECT_EQ(built(fan).adjacent[0], (std::array{1, -1, -1}));
}

TEST(BuildMesh, RefusesWhatIsNoMesh)
{
    const std::vector<Vec3> line{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
    EXPECT_EQ(build_mesh(line, {}).trouble, "has no triangles; give at least one");
    EXPECT_EQ(build_mesh(line, {{0, 1, 2}}).trouble,
              "has no triangle with an area; give at least one");
    EXPECT_EQ(build_mesh(line, {{0, 1, 3}}).trouble, "triangle 0 names vertex 3; there are 3");
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(build_mesh({{0, 0, 0}, {1, nan, 0}, {2, 0, 1}}, {{0, 1, 2}}).trouble,
              "vertex 1 is not finite; give finite coordinates");
}

TEST(BuildMesh, WorksAtEverySize)
{
    for (double size = 1e-6; size < 2e6; size *= 10) {
        Soup soup = cube();
        for (Vec3& vertex : soup.vertices) vertex = size * (vertex + Vec3(10, 20, 30));
        const Mesh mesh = built(soup);
        EXPECT_EQ(mesh.triangles.size(), 12U);
        EXPECT_TRUE(is_closed(mesh));
        EXPECT_EQ(mesh.convex_edges, built(cube()).convex_edges);
    }
}

TEST(FindTriangles, MatchesLookingAtEveryTriangle)
{
    std::mt19937_64 engine(3);
    std::uniform_real_distribution<double> unit(-1, 1);
    const auto in_box = [&] { return Vec3(unit(engine), unit(engine), unit(engine)); };
    Soup soup;
    for (int i = 0; i < 500; ++i) {
        const Vec3 middle = 5 * in_box();
        const double size = i % 50 == 0 ? 5 : 0.2;
        soup.vertices.insert(soup.vertices.end(),
                             {middle, middle + size * in_box(), middle + size * in_box()});
        const auto first = static_cast<std::uint32_t>(3 * i);
        soup.triangles.push_back({first, first + 1, first + 2});
    }
    // Many alike, which no cut of the tree can part.
    for (int i = 0; i < 100; ++i) soup.triangles.push_back({0, 1, 2});
    const Mesh mesh = built(soup);
    expect_tree_holds_all(mesh);
    for (int i = 0; i < 200; ++i) {
        const Vec3 middle = 6 * in_box(), half = in_box().cwiseAbs();
        expect_same_as_all(mesh, {middle - half, middle + half});
    }
    expect_same_as_all(mesh, {});
    expect_same_as_all(mesh, {Vec3::Constant(-1e9), Vec3::Constant(1e9)});
    std::vector<std::uint32_t> found;
    find_triangles({}, {Vec3::Zero(), Vec3::Ones()}, found);
    EXPECT_TRUE(found.empty());

    // Many at once, of two meshes and of none.
    const Mesh other = built(cube()), nothing;
    std::vector<TriangleSearch> searches(50);
    for (std::size_t i = 0; i < searches.size(); ++i) {
        const Vec3 middle = 3 * in_box(), half = 2 * in_box().cwiseAbs();
        searches[i].mesh = i % 7 == 0 ? &nothing : i % 3 == 0 ? &other : &mesh;
        searches[i].box = {middle - half, middle + half};
        searches[i].found = {7};
    }
    find_triangles(searches);
    for (const TriangleSearch& search : searches) {
        std::vector<std::uint32_t> wanted;
        find_triangles(*search.mesh, search.box, wanted);
        EXPECT_EQ(search.found, wanted);
    }
}

// Small boxes hold what they stand for, where that is a number that single precision has not.
TEST(FindTriangles, SmallBoxesAreRoundedOutward)
{
    Soup soup = cube();
    for (Vec3& vertex : soup.vertices) vertex = 0.1 * vertex + Vec3(1e5 / 3, -1e-9 / 3, 1e3 / 7);
    const Mesh mesh = built(soup);
    ASSERT_EQ(mesh.small_tree.size(), mesh.tree.size());
    ASSERT_EQ(mesh.small_boxes.size(), mesh.triangles.size());
    for (const Mesh::SmallBox& small : mesh.small_boxes) {
        const Box3 box = triangle_box(mesh, small.first);
        for (int k = 0; k < 3; ++k) {
            const auto at = static_cast<std::size_t>(k);
            EXPECT_LE(double{small.lower[at]}, box.lower[k]);
            EXPECT_GE(double{small.upper[at]}, box.upper[k]);
            EXPECT_GT(double{std::nextafter(small.lower[at], 1e9F)}, box.lower[k]);
            EXPECT_LT(double{std::nextafter(small.upper[at], -1e9F)}, box.upper[k]);
        }
    }
}

// Vertices and faces of an OBJ file; polygons become fans, texture and normal indices are skipped.
Soup read_obj(const std::filesystem::path& path)
{
    Soup soup;
    std::ifstream file(path);
    for (std::string line, word; std::getline(file, line);) {
        std::istringstream words(line);
        words >> word;
        if (word == "v") {
            Vec3 vertex;
            words >> vertex.x() >> vertex.y() >> vertex.z();
            soup.vertices.push_back(vertex);
        } else if (word == "f") {
            std::vector<std::uint32_t> corners;
            while (words >> word)
                corners.push_back(static_cast<std::uint32_t>(std::stoul(word)) - 1);
            for (std::size_t i = 2; i < corners.size(); ++i)
                soup.triangles.push_back({corners[0], corners[i - 1], corners[i]});
        }
        word.clear();
    }
    return soup;
}

TEST(BuildMesh, RealMeshesAreJoinedAndSearchable)
{
    if (shared_data("meshes").empty()) GTEST_SKIP() << "meshes is not there; set THRONG_DATA";
    for (const char* name : {"bunny", "torus", "cube_cup", "spot", "snowflake", "kettle", "bottle",
                             "level_01", "stairs", "building"}) {
        SCOPED_TRACE(name);
        const Soup soup = read_obj(shared_data("meshes/" + std::string(name) + ".obj"));
        const auto begin = std::chrono::steady_clock::now();
        const Mesh mesh = built(soup);
        const std::chrono::duration<double, std::milli> taken =
            std::chrono::steady_clock::now() - begin;
        expect_neighbors_agree(mesh);
        expect_tree_holds_all(mesh);
        const Box3 all{mesh.tree[0].lower, mesh.tree[0].upper};
        std::mt19937_64 engine(1);
        std::uniform_real_distribution<double> unit(0, 1);
        for (int i = 0; i < 20; ++i) {
            const Vec3 at(unit(engine), unit(engine), unit(engine));
            const Vec3 lower = all.lower + at.cwiseProduct(all.upper - all.lower);
            expect_same_as_all(mesh, {lower, lower + 0.1 * (all.upper - all.lower)});
        }
        int convex = 0;
        for (const std::uint8_t bits : mesh.convex_edges)
            convex += (bits & 1) + (bits >> 1 & 1) + (bits >> 2 & 1);
        std::printf("%s: %zu of %zu triangles, %zu of %zu vertices, %.0f%% convex, closed %d, "
                    "volume %g, %.1f ms\n",
                    name, mesh.triangles.size(), soup.triangles.size(), mesh.vertices.size(),
                    soup.vertices.size(),
                    100.0 * convex / static_cast<double>(3 * mesh.triangles.size()),
                    is_closed(mesh), mass_of(mesh).volume, taken.count());
        const bool solid =
            std::string("torus cube_cup spot snowflake stairs").find(name) != std::string::npos;
        if (solid) {
            EXPECT_TRUE(is_closed(mesh));
            EXPECT_GT(mass_of(mesh).volume, 0);
        }
    }
}

// Those whose own k-DOPs are near, one by one.
TEST(FindTriangles, ByKDopsFindsAllThatAreNearInEverySlab)
{
    const TriangleSoup ball = ball_mesh(1, 60, 30);
    Mesh mesh = build_mesh(ball.vertices, ball.triangles).mesh;
    Shapes shapes;
    shapes.capsules = {{0.05, 0.8}};
    const auto rod = convex_core_of<double>(shapes, {ShapeKind::capsule, 0});
    test::Dice dice(5);
    std::size_t by_boxes = 0, by_slabs = 0;
    for (const int k : {14, 18, 26}) {
        bound_by_k_dops(mesh, k);
        const Slabs slabs = slabs_of(k);
        for (int i = 0; i < 50; ++i) {
            const Vec3 at = dice.point(1);
            const Mat3 turn = dice.turn().toRotationMatrix();
            const double margin = dice.between(0, 0.1);
            const KDop around = k_dop_of(rod, turn, at, k);
            const Vec3 half = (turn.col(2) * 0.8).cwiseAbs() + Vec3::Constant(0.05 + margin);
            const Box3 box{at - half, at + half};
            std::vector<std::uint32_t> boxes, wanted, found;
            find_triangles(mesh, box, boxes);
            for (const std::uint32_t t : boxes) {
                KDop own = empty_k_dop(slabs);
                for (const std::uint32_t corner : mesh.triangles[t])
                    add(mesh.vertices[corner], slabs, own);
                if (parting_slab(around, own, slabs, margin) == slabs.end) wanted.push_back(t);
            }
            find_triangles(mesh, box, around, margin, found);
            EXPECT_EQ(found, wanted) << k << ' ' << i;
            by_boxes += boxes.size();
            by_slabs += found.size();
        }
    }
    EXPECT_GT(by_slabs, 500u);
    EXPECT_LT(by_slabs, by_boxes / 2);
}

}  // namespace
}  // namespace throng
