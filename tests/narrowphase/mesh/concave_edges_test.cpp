#include "narrowphase/mesh/concave_edges.hpp"

#include "cooking/repair/build_mesh.hpp"
#include "narrowphase/mesh/mesh_pairs.hpp"
#include "scene/catalog/closed_meshes.hpp"
#include "tests/support/dice.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace throng {
namespace {

constexpr ShapeRef kMesh{ShapeKind::mesh, 0}, kBall{ShapeKind::sphere, 0};

// Flat for x < 0, rising for x > 0 at an angle; squares of two triangles.
Mesh bent(double angle)
{
    std::vector<Vec3> vertices;
    for (const double y : {-2.0, 2.0})
        for (const double x : {-2.0, 0.0, 2.0})
            vertices.emplace_back(x > 0 ? x * std::cos(angle) : x, y,
                                  x > 0 ? x * std::sin(angle) : 0);
    return build_mesh(vertices, {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}}).mesh;
}

// What of the ball the triangles of the rising side are told of.
LocalManifold<double> ahead(const Mesh& mesh, const Vec3& center, double radius, double margin)
{
    LocalManifold<double> found;
    for (std::uint32_t t = 2; t < 4 && found.count == 0; ++t)
        add_points_ahead(MeshTriangle(mesh, t), {&center, 1}, radius, margin, found);
    return found;
}

TEST(ConcaveEdges, TellOfThePlaneAhead)
{
    const double angle = 0.3, radius = 0.2;
    const Mesh mesh = bent(angle);
    const Vec3 up(-std::sin(angle), 0, std::cos(angle));
    for (const double before : {0.07, 0.1, 0.2}) {
        const Vec3 center(-before, 0.3, radius);
        const auto found = ahead(mesh, center, radius, 0.25);
        ASSERT_EQ(found.count, 1) << before;
        EXPECT_LT((found.normal - up).norm(), 1e-12);
        EXPECT_NEAR(found.points[0].separation, up.dot(center) - radius, 1e-12);
        const Vec3 middle = center - up * (radius + found.points[0].separation / 2);
        EXPECT_LT((found.points[0].position - middle).norm(), 1e-12);
    }
}

TEST(ConcaveEdges, TellOfNothingThatCannotBeReached)
{
    const Vec3 center(-0.3, 0.3, 0.2);
    EXPECT_EQ(ahead(bent(0.3), center, 0.2, 0.2).count, 0);  // too far along the floor
    EXPECT_EQ(ahead(bent(0.3), center, 0.2, 0.5).count, 1);
    EXPECT_EQ(ahead(bent(0), center, 0.2, 0.5).count, 0);               // flat
    EXPECT_EQ(ahead(bent(-0.3), center, 0.2, 0.5).count, 0);            // falls away
    EXPECT_EQ(ahead(bent(0.3), Vec3(0.2, 0, 0.3), 0.2, 0.5).count, 0);  // over it already
}

// A valley, and a ridge before it: the plane of its far side cuts through the air beyond the ridge.
TEST(ConcaveEdges, DoNotReachOverARidge)
{
    std::vector<Vec3> vertices;
    for (const double y : {-2.0, 2.0}) {
        vertices.emplace_back(-2, y, -3);
        vertices.emplace_back(-0.1, y, 0);
        vertices.emplace_back(0, y, 0);
        vertices.emplace_back(2, y, 0.2);
    }
    const Mesh mesh =
        build_mesh(vertices, {{0, 1, 5}, {0, 5, 4}, {1, 2, 6}, {1, 6, 5}, {2, 3, 7}, {2, 7, 6}})
            .mesh;
    const auto told = [&](const Vec3& center) {
        LocalManifold<double> found;
        for (std::uint32_t t = 4; t < 6 && found.count == 0; ++t)
            add_points_ahead(MeshTriangle(mesh, t), {&center, 1}, 0.05, 0.2, found);
        return found.count;
    };
    EXPECT_EQ(told({-0.05, 0.1, 0.05}), 1);
    EXPECT_EQ(told({-0.2, 0.1, 0.05}), 0);
}

// Inside what bends inward alone, a ball meets the first of all planes in its way: those told of in
// one place have to be all that it needs until it is there.
TEST(ConcaveEdges, MeetEveryPlaneInTime)
{
    TriangleSoup half = ball_mesh(1, 40, 20);
    std::erase_if(half.triangles, [&](const auto& triangle) {
        return std::any_of(triangle.begin(), triangle.end(),
                           [&](std::uint32_t corner) { return half.vertices[corner].z() > 0.01; });
    });
    Shapes shapes;
    shapes.meshes = {build_mesh(half.vertices, half.triangles).mesh};
    shapes.spheres = {{0.1}};
    const Mesh& mesh = shapes.meshes[0];
    test::Dice dice(3);
    int touched = 0;
    for (int i = 0; i < 4000; ++i) {
        const double depth = dice.between(0.75, 0.88), margin = dice.between(0.01, 0.15);
        Vec3 down = dice.direction();
        down.z() = -std::abs(down.z()) - 0.5;
        const Vec3 center = depth * down.normalized(), way = margin * dice.direction();
        const auto reached = [&](const Vec3& normal, double separation) {
            const double nearing = -normal.dot(way);
            return nearing > 0 ? separation / nearing : std::numeric_limits<double>::infinity();
        };
        double exact = std::numeric_limits<double>::infinity(), told = exact;
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            const Vec3 inward = -mesh.normals[t];
            const Vec3& corner = mesh.vertices[mesh.triangles[t][0]];
            exact = std::min(exact, reached(inward, inward.dot(center - corner) - 0.1));
        }
        std::vector<PartManifold> found;
        collide_mesh({shapes, kMesh, kBall, {center, Quat::Identity()}, margin}, found);
        for (const auto& one : found)
            told = std::min(told, reached(one.manifold.normal, one.manifold.points[0].separation));
        if (exact > 1) {
            EXPECT_GT(told, 1 - 1e-9) << i;
            continue;
        }
        ++touched;
        EXPECT_NEAR(told, exact, 1e-9) << i;
    }
    EXPECT_GT(touched, 300);
}

}  // namespace
}  // namespace throng
