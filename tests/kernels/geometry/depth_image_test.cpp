// Depth image: what rays meet, layer by layer.
#include "kernels/geometry/depth_image.hpp"

#include "cooking/repair/build_mesh.hpp"
#include "kernels/geometry/mesh.hpp"
#include "kernels/geometry/mesh_distance.hpp"
#include "kernels/geometry/support.hpp"
#include "scene/catalog/closed_meshes.hpp"
#include "tests/support/polyhedra.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

Mesh mesh_of(const TriangleSoup& soup) { return build_mesh(soup.vertices, soup.triangles).mesh; }

// Whole numbers of pixels, so that rays run through corners and along edges.
RayGrid grid_of(double pixel, std::int32_t rays, double shift = 0)
{
    return {pixel, {-rays / 2, -rays / 2}, {shift, shift}, {rays + 1, rays + 1}};
}

double length_of(std::span<const RayInterval> intervals)
{
    double length = 0;
    for (const RayInterval& part : intervals) length += part.leave - part.enter;
    return length;
}

TEST(DepthImage, ARayThroughEdgesAndCornersMeetsEachSurfaceOnce)
{
    // Edges and corners of all triangles lie on rays.
    Shapes shapes;
    shapes.meshes = {mesh_of(box_mesh({1, 1, 1})),
                     mesh_of({{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
                              {{0, 2, 4},
                               {2, 1, 4},
                               {1, 3, 4},
                               {3, 0, 4},
                               {2, 0, 5},
                               {1, 2, 5},
                               {3, 1, 5},
                               {0, 3, 5}}})};
    const RayGrid grid = grid_of(0.125, 20);
    for (std::uint32_t i = 0; i < 2; ++i) {
        DepthImage image;
        image.draw(shapes, {ShapeKind::mesh, i}, {}, grid, Layers::all);
        int within = 0;
        for (std::int32_t y = 0; y < grid.count[1]; ++y)
            for (std::int32_t x = 0; x < grid.count[0]; ++x) {
                const double ax = std::abs(grid.at(0, x)), ay = std::abs(grid.at(1, y));
                const double half = i == 0 ? (std::max(ax, ay) <= 1 ? 1.0 : -1.0) : 1 - ax - ay;
                const auto parts = image.on(static_cast<std::size_t>(y * grid.count[0] + x));
                const bool on_rim = i == 0 ? std::max(ax, ay) == 1 : half == 0;
                if (on_rim) continue;  // one way or the other
                ASSERT_EQ(parts.size(), half > 0 ? 1u : 0u) << ax << " " << ay;
                if (half <= 0) continue;
                ++within;
                EXPECT_NEAR(parts[0].enter, -half, 1e-15);
                EXPECT_NEAR(parts[0].leave, half, 1e-15);
                EXPECT_LT(image.normal(parts[0].enter_face).z(), 0);
                EXPECT_GT(image.normal(parts[0].leave_face).z(), 0);
            }
        EXPECT_EQ(within, i == 0 ? 15 * 15 : 113);
    }
}

TEST(DepthImage, RaysThroughVerticesOfATurnedMeshAreInsideWhereThePointsAre)
{
    Shapes shapes;
    shapes.meshes = {mesh_of(torus_mesh(0.7, 0.3, 20, 12))};
    find_vertex_normals(shapes.meshes[0]);
    RandomShapes random(3);
    for (int i = 0; i < 40; ++i) {
        const Pose pose = random.pose(0.5);
        // A ray through a vertex to the last bit: nine rays about it, its own in the middle.
        const auto vertex = static_cast<std::size_t>(random.number(0, 240));
        const Vec3 at =
            pose.orientation.toRotationMatrix() * shapes.meshes[0].vertices[vertex] + pose.position;
        const RayGrid grid{1, {0, 0}, {at.x(), at.y()}, {1, 1}};
        DepthImage image;
        image.draw(shapes, {ShapeKind::mesh, 0}, pose, grid, Layers::all);
        for (const RayInterval& part : image.on(0)) {
            const Vec3 middle(at.x(), at.y(), 0.5 * (part.enter + part.leave));
            EXPECT_LE(signed_distance(shapes.meshes[0], pose.to_local(middle)), 1e-12);
        }
        for (std::size_t k = 1; k < image.on(0).size(); ++k) {
            const double z = 0.5 * (image.on(0)[k - 1].leave + image.on(0)[k].enter);
            const Vec3 between(at.x(), at.y(), z);
            EXPECT_GE(signed_distance(shapes.meshes[0], pose.to_local(between)), -1e-12);
        }
    }
}

TEST(DepthImage, OfAMeshIsThatOfItsConvexShape)
{
    Shapes shapes;
    const Vec3 half(0.6, 0.4, 0.3);
    shapes.boxes = {{half}};
    shapes.meshes = {mesh_of(box_mesh(half))};
    RandomShapes random(11);
    for (int i = 0; i < 20; ++i) {
        const Pose pose = random.pose(0.3);
        const RayGrid grid = grid_of(0.05, 40, 0.37);
        DepthImage solid, surface;
        solid.draw(shapes, {ShapeKind::box, 0}, pose, grid, Layers::all);
        surface.draw(shapes, {ShapeKind::mesh, 0}, pose, grid, Layers::all);
        for (std::size_t ray = 0; ray < grid.rays(); ++ray) {
            const auto one = solid.on(ray), two = surface.on(ray);
            ASSERT_EQ(one.size(), two.size());
            if (one.empty()) continue;
            // Nearly along a face rounding grows by what the ray leans.
            EXPECT_NEAR(one[0].enter, two[0].enter, 1e-12);
            EXPECT_NEAR(one[0].leave, two[0].leave, 1e-12);
            EXPECT_NEAR(
                (solid.normal(one[0].enter_face) - surface.normal(two[0].enter_face)).norm(), 0,
                1e-12);
        }
    }
}

TEST(DepthImage, LayersOfAHoleAreSeenAndASingleOneFillsIt)
{
    Shapes shapes;
    shapes.meshes = {mesh_of(torus_mesh(1, 0.25, 48, 24))};
    const Pose lying{Vec3::Zero(), Quat(Eigen::AngleAxisd(0.5, Vec3::UnitX()))};
    const Pose across{Vec3::Zero(), Quat(0.5, 0.5, 0.5, 0.5)};  // its axis along x
    const RayGrid middle{0.01, {0, 0}, {0.5, 0.5}, {1, 1}};
    DepthImage image;
    image.draw(shapes, {ShapeKind::mesh, 0}, lying, middle, Layers::all);
    EXPECT_EQ(image.on(0).size(), 0u);
    image.draw(shapes, {ShapeKind::mesh, 0}, across, middle, Layers::all);
    ASSERT_EQ(image.on(0).size(), 2u);
    EXPECT_NEAR(length_of(image.on(0)), 1, 0.02);
    image.draw(shapes, {ShapeKind::mesh, 0}, across, middle, Layers::single);
    ASSERT_EQ(image.on(0).size(), 1u);
    EXPECT_NEAR(length_of(image.on(0)), 2.5, 0.02);
}

TEST(DepthImage, BodiesThatCutThemselvesAreWhole)
{
    // Two boxes in one mesh, from -1 to 0.25 and from -0.25 to 1, then one within the other.
    for (const double inner : {1.25, 0.5}) {
        TriangleSoup soup = box_mesh({0.5, 0.5, 0.625});
        const TriangleSoup more = box_mesh({0.5, 0.5, inner / 2});
        const bool within = inner < 1;
        for (Vec3& vertex : soup.vertices) vertex.z() -= within ? 0 : 0.375;
        for (const Vec3& vertex : more.vertices)
            soup.vertices.push_back(vertex + Vec3(0, 0, within ? 0 : 0.375));
        for (const auto& [i, j, k] : more.triangles)
            soup.triangles.push_back({i + 8, j + 8, k + 8});
        Shapes shapes;
        shapes.meshes = {mesh_of(soup)};
        DepthImage image;
        image.draw(shapes, {ShapeKind::mesh, 0}, {}, {0.1, {0, 0}, {0.5, 0.3}, {1, 1}},
                   Layers::all);
        ASSERT_EQ(image.on(0).size(), 1u);
        EXPECT_EQ(image.on(0)[0].enter, within ? -0.625 : -1);
        EXPECT_EQ(image.on(0)[0].leave, within ? 0.625 : 1);
    }
}

TEST(DepthImage, OddCountsLoseTheirLayerAlone)
{
    // Two plates above one another, of which either lacks one side.
    for (int missing = 0; missing < 4; ++missing) {
        TriangleSoup soup;
        const double heights[] = {0, 1, 2, 3};
        for (int side = 0; side < 4; ++side) {
            if (side == missing) continue;
            const auto at = static_cast<std::uint32_t>(soup.vertices.size());
            const double z = heights[side];
            soup.vertices.insert(soup.vertices.end(), {{-1, -1, z}, {2, -1, z}, {-1, 2, z}});
            if (side % 2 == 1) {
                soup.triangles.push_back({at, at + 1, at + 2});
            } else {
                soup.triangles.push_back({at, at + 2, at + 1});
            }
        }
        Shapes shapes;
        shapes.meshes = {mesh_of(soup)};
        DepthImage image;
        image.draw(shapes, {ShapeKind::mesh, 0}, {}, {1, {0, 0}, {0, 0}, {1, 1}}, Layers::all);
        ASSERT_EQ(image.on(0).size(), 1u) << missing;
        EXPECT_EQ(image.on(0)[0].enter, missing < 2 ? 2 : 0);
        EXPECT_EQ(image.on(0)[0].leave, missing < 2 ? 3 : 1);
    }
}

TEST(DepthImage, ASheetIsSolidBehindItsFrontAlone)
{
    Shapes shapes;
    shapes.meshes = {mesh_of({{{-1, -1, 0}, {2, -1, 0}, {-1, 2, 0}}, {{0, 1, 2}}})};
    const RayGrid grid{1, {0, 0}, {0, 0}, {1, 1}};
    DepthImage image;
    image.draw(shapes, {ShapeKind::mesh, 0}, {}, grid, Layers::sheet, 0.25);
    ASSERT_EQ(image.on(0).size(), 1u);
    EXPECT_EQ(image.on(0)[0].enter, -0.25);
    EXPECT_EQ(image.on(0)[0].enter_face, RayInterval::kNoFace);
    EXPECT_EQ(image.on(0)[0].leave, 0);
    EXPECT_EQ(image.on(0)[0].leave_face, 0u);
    const Pose upside_down{Vec3::Zero(), Quat(0, 1, 0, 0)};
    image.draw(shapes, {ShapeKind::mesh, 0}, upside_down, {1, {0, 0}, {0, 0}, {1, 1}},
               Layers::sheet, 0.25);
    ASSERT_EQ(image.on(0).size(), 1u);
    EXPECT_EQ(image.on(0)[0].enter, 0);
    EXPECT_EQ(image.on(0)[0].leave, 0.25);
}

TEST(DepthImage, RoundShapesAndPlanesHaveTheirEndsOnTheSurface)
{
    Shapes shapes;
    shapes.spheres = {{0.5}};
    shapes.capsules = {{0.3, 0.4}};
    shapes.cylinders = {{0.4, 0.3}};
    shapes.planes = {{Vec3(0.6, 0, 0.8), 0.1}};
    RandomShapes random(5);
    const RayGrid grid = grid_of(0.07, 16, 0.21);
    for (const ShapeKind kind : {ShapeKind::sphere, ShapeKind::capsule, ShapeKind::cylinder}) {
        const Pose pose = random.pose(0.2);
        const ConvexCore<double> core = convex_core_of<double>(shapes, {kind, 0});
        DepthImage image;
        image.draw(shapes, {kind, 0}, pose, grid, Layers::all);
        int met = 0;
        for (std::int32_t y = 0; y < grid.count[1]; ++y)
            for (std::int32_t x = 0; x < grid.count[0]; ++x)
                for (const RayInterval& part :
                     image.on(static_cast<std::size_t>(y * grid.count[0] + x))) {
                    ++met;
                    // Both ends lie in the plane that holds the shape along the normal there.
                    const auto beneath = [&](double z, std::uint32_t face) {
                        const Vec3 normal = pose.orientation.conjugate() * image.normal(face);
                        const Vec3 at = pose.to_local({grid.at(0, x), grid.at(1, y), z});
                        return normal.dot(support(core, normal).position) + core.convex_radius
                            - normal.dot(at);
                    };
                    EXPECT_NEAR(beneath(part.enter, part.enter_face), 0, 1e-12);
                    EXPECT_NEAR(beneath(part.leave, part.leave_face), 0, 1e-12);
                    EXPECT_LE(image.normal(part.enter_face).z(), 0);
                    EXPECT_GE(image.normal(part.leave_face).z(), 0);
                }
        EXPECT_GT(met, 50);
    }
    DepthImage image;
    image.draw(shapes, {ShapeKind::plane, 0}, {}, grid, Layers::all);
    ASSERT_EQ(image.on(0).size(), 1u);
    EXPECT_EQ(image.on(0)[0].enter_face, RayInterval::kNoFace);
    EXPECT_NEAR(image.on(0)[0].leave, (0.1 - 0.6 * grid.at(0, 0)) / 0.8, 1e-14);
}

}  // namespace
}  // namespace throng
