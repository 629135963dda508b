// Mesh sides: an open mesh pushes from the side that a shape is on, and keeps it there.
#include "narrowphase/mesh/mesh_sides.hpp"

#include "cooking/hulls/hull.hpp"
#include "cooking/repair/build_mesh.hpp"
#include "cooking/repair/mesh_health.hpp"
#include "narrowphase/mesh/near_triangles.hpp"
#include "scene/catalog/sheets.hpp"
#include "tests/support/dice.hpp"
#include "throng/rotation.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace throng {
namespace {

using Soup = std::pair<std::vector<Vec3>, std::vector<std::array<std::uint32_t, 3>>>;

// A floor of 4 m by 4 m at 0, in squares of 1 m.
Soup floor_soup()
{
    const TriangleSoup soup = sheet_mesh(4, [](int i, int k) { return Vec3(i - 2, k - 2, 0); });
    return {soup.vertices, soup.triangles};
}

// A cube of 2 m about its origin; wound outward or inward.
Soup cube_soup(bool inward)
{
    Soup soup;
    for (const double z : {-1.0, 1.0})
        for (const double y : {-1.0, 1.0})
            for (const double x : {-1.0, 1.0}) soup.first.emplace_back(x, y, z);
    soup.second = {{4, 5, 7}, {4, 7, 6}, {0, 3, 1}, {0, 2, 3}, {0, 1, 5}, {0, 5, 4},
                   {2, 7, 3}, {2, 6, 7}, {0, 6, 2}, {0, 4, 6}, {1, 3, 7}, {1, 7, 5}};
    if (inward)
        for (auto& triangle : soup.second) std::swap(triangle[1], triangle[2]);
    return soup;
}

struct Guest {
    const char* name;
    ShapeRef shape;
    double height;  // m, of its center over its lowest point
};

struct Stage {
    Shapes shapes;
    std::vector<Guest> guests;

    explicit Stage(const Soup& soup)
    {
        shapes.meshes = {build_mesh(soup.first, soup.second).mesh};
        shapes.spheres = {{0.4}};
        shapes.capsules = {{0.3, 0.2}};
        shapes.cylinders = {{0.4, 0.5}};
        shapes.boxes = {{{0.5, 0.4, 0.3}}};
        std::vector<Vec3> points;
        for (const double x : {-0.5, 0.5})
            for (const double y : {-0.4, 0.4})
                for (const double z : {-0.4, 0.4}) points.emplace_back(x, y, z);
        shapes.hulls = {build_hull(points).hull};
        guests = {{"sphere", {ShapeKind::sphere, 0}, 0.4},
                  {"capsule", {ShapeKind::capsule, 0}, 0.5},
                  {"cylinder", {ShapeKind::cylinder, 0}, 0.5},
                  {"box", {ShapeKind::box, 0}, 0.3},
                  {"hull", {ShapeKind::hull, 0}, 0.4}};
    }

    using Found = std::vector<PartManifold>;
    Found collide(const Guest& guest,
                  const Vec3& at,
                  const Found& before = {},
                  const Quat& turn = Quat::Identity()) const
    {
        std::vector<std::uint32_t> held;
        for (const auto& one : before) held.push_back(one.part);
        Found found;
        const Pose pose{at, turn};
        const PairInput<double> in{shapes, {ShapeKind::mesh, 0}, guest.shape, pose, 0.01};
        NearTriangles near;
        near.add(in);
        near.find();
        collide_mesh(in, held, near.of(0), found);
        return found;
    }
};

double deepest(const Stage::Found& found)
{
    double least = 1;
    for (const auto& one : found)
        for (int k = 0; k < one.manifold.count; ++k)
            least = std::min(least, one.manifold.points[static_cast<std::size_t>(k)].separation);
    return least;
}

void expect_push(const Stage::Found& found, const Vec3& along, double depth)
{
    ASSERT_FALSE(found.empty());
    for (const auto& one : found) EXPECT_NEAR(one.manifold.normal.dot(along), 1, 1e-9);
    EXPECT_NEAR(deepest(found), -depth, 1e-9);
}

TEST(MeshSides, AnOpenMeshPushesFromBothSides)
{
    const Stage stage(floor_soup());
    for (const Guest& guest : stage.guests)
        for (const double side : {1.0, -1.0}) {
            SCOPED_TRACE(std::string(guest.name) + (side > 0 ? " in front" : " behind"));
            const auto found = stage.collide(guest, Vec3(0.3, 0.2, side * (guest.height - 0.05)));
            expect_push(found, side * Vec3::UnitZ(), 0.05);
            for (const auto& one : found) EXPECT_EQ((one.part & kBehind) != 0, side < 0);
        }
}

TEST(MeshSides, WhatTouchedOnOneSideIsPushedBackThereFromThrough)
{
    const Stage stage(floor_soup());
    for (const Guest& guest : stage.guests)
        for (const double side : {1.0, -1.0}) {
            SCOPED_TRACE(std::string(guest.name) + (side > 0 ? " in front" : " behind"));
            auto found = stage.collide(guest, Vec3(0.3, 0.2, side * guest.height));
            for (const double height : {0.1, -0.02, -0.1}) {
                found = stage.collide(guest, Vec3(0.32, 0.2, side * height), found);
                expect_push(found, side * Vec3::UnitZ(), guest.height - height);
            }
        }
}

TEST(MeshSides, WhatWasPressedAllTheWayThroughIsPushedBackToo)
{
    const Stage stage(floor_soup());
    for (const Guest& guest : stage.guests)
        for (const double side : {1.0, -1.0}) {
            SCOPED_TRACE(std::string(guest.name) + (side > 0 ? " in front" : " behind"));
            auto found = stage.collide(guest, Vec3(0.3, 0.2, side * 0.5 * guest.height));
            for (const double share : {-0.8, -1.2, -1.6}) {
                const double height = share * guest.height;
                found = stage.collide(guest, Vec3(0.32, 0.2, side * height), found);
                expect_push(found, side * Vec3::UnitZ(), guest.height - height);
            }
        }
}

// A plate that leans: its middle is over one triangle, and all that is lowest over the next.
TEST(MeshSides, WhatLeansIsPushedBackByTheTriangleThatItsMiddleIsOver)
{
    Stage stage(floor_soup());
    stage.shapes.boxes.push_back({{0.8, 0.1, 0.02}});
    const Guest plate{"plate", {ShapeKind::box, 1}, 0};
    for (const double lean : {0.1, 0.5}) {
        SCOPED_TRACE(lean);
        const Quat turn(Eigen::AngleAxisd(lean, Vec3::UnitY()));
        auto found = stage.collide(plate, Vec3(-0.1, 0.45, 0.001), {}, turn);
        ASSERT_FALSE(found.empty());
        for (const double height : {-0.01, -0.03, -0.1}) {
            found = stage.collide(plate, Vec3(-0.1, 0.45, height), found, turn);
            ASSERT_FALSE(found.empty()) << height;
            for (const auto& one : found) EXPECT_GT(one.manifold.normal.z(), 0) << height;
        }
    }
}

TEST(MeshSides, WhatGoesRoundARimIsLetGo)
{
    const Stage stage(floor_soup());
    const Guest& ball = stage.guests[0];
    const auto above = stage.collide(ball, Vec3(2.1, 0.3, 0.1));
    ASSERT_FALSE(above.empty());
    const auto below = stage.collide(ball, Vec3(2.1, 0.3, -0.1), above);
    ASSERT_FALSE(below.empty());
    for (const auto& one : below) EXPECT_LT(one.manifold.normal.z(), 0);
}

TEST(MeshSides, AClosedMeshHasAnInside)
{
    const Stage stage(cube_soup(false));
    for (const Guest& guest : stage.guests) {
        SCOPED_TRACE(guest.name);
        // By the nearest face, whose inside its center is in.
        expect_push(stage.collide(guest, Vec3(0.1, 0.2, 0.9)), Vec3::UnitZ(), guest.height + 0.1);
        expect_push(stage.collide(guest, Vec3(0.1, 0.2, 0.95 + guest.height)), Vec3::UnitZ(), 0.05);
    }
}

TEST(MeshSides, AStillMeshWoundInwardIsTurnedOverAndToldOf)
{
    const auto [vertices, triangles] = cube_soup(true);
    const RepairedMesh repaired = mend_still(vertices, triangles);
    EXPECT_EQ(repaired.health.inside_out, 1u);
    ASSERT_EQ(repaired.warnings.size(), 1u);
    EXPECT_NE(repaired.warnings[0].find("inside out"), std::string::npos);
    for (std::size_t t = 0; t < repaired.mesh.triangles.size(); ++t)
        EXPECT_GT(
            repaired.mesh.normals[t].dot(repaired.mesh.vertices[repaired.mesh.triangles[t][0]]), 0);
}

// A plate across ridges is behind the planes of their far flanks. Where it lies on a ridge it meets
// that flank's edge, seen from where it is; but not the flank from below.
TEST(MeshSides, AFarFlankOfARidgeIsNotMetFromBehind)
{
    const TriangleSoup soup = sheet_mesh(
        24, [](int i, int k) { return Vec3(0.15 * (i - 12), 0.4 * (k - 12), 0.1 * (i % 2)); });
    Stage stage(Soup{soup.vertices, soup.triangles});
    stage.shapes.boxes = {{{0.3, 0.21, 0.02}}};
    const Guest plate{"plate", {ShapeKind::box, 0}, 0.02};
    test::Dice dice(1);
    for (int i = 0; i < 3000; ++i) {
        const Quat yaw = exponential(Vec3(0, 0, dice.between(0, 3)));
        Quat turn = exponential(dice.point(0.1)) * yaw;
        Vec3 at(dice.between(-0.3, 0.3), dice.between(-0.4, 0.4), dice.between(0.115, 0.125));
        Stage::Found found;
        for (int step = 0; step < 4; ++step) {
            found = stage.collide(plate, at, found, turn);
            for (const auto& one : found) ASSERT_GT(one.manifold.normal.z(), 0) << i << ' ' << step;
            at += dice.point(0.005);
            turn = exponential(dice.point(0.05)) * turn;
        }
    }
}

TEST(MeshSides, AStillMeshWithNothingWrongStaysAsItIs)
{
    for (const Soup& soup : {floor_soup(), cube_soup(false)}) {
        const RepairedMesh repaired = mend_still(soup.first, soup.second);
        EXPECT_TRUE(repaired.warnings.empty());
        EXPECT_EQ(repaired.mesh.triangles, build_mesh(soup.first, soup.second).mesh.triangles);
    }
}

TEST(MeshSides, OneTriangleWoundAgainstTheOthersIsTurned)
{
    auto [vertices, triangles] = floor_soup();
    std::swap(triangles[7][0], triangles[7][1]);
    const RepairedMesh repaired = mend_still(vertices, triangles);
    EXPECT_EQ(repaired.health.turned, 1u);
    for (const Vec3& normal : repaired.mesh.normals) EXPECT_GT(normal.z(), 0.9);
}

}  // namespace
}  // namespace throng
