// Surface points: all of the surface is near one, few are near one another, and the tree holds
// them.
#include "cooking/fields/surface_points.hpp"

#include "cooking/repair/build_mesh.hpp"
#include "kernels/geometry/mesh_distance.hpp"
#include "scene/catalog/closed_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

namespace throng::test {
namespace {

Mesh made(const TriangleSoup& soup)
{
    Mesh mesh = build_mesh(soup.vertices, soup.triangles).mesh;
    find_vertex_normals(mesh);
    return mesh;
}

double area_of(const Mesh& mesh, std::uint32_t triangle)
{
    const auto& [a, b, c] = mesh.triangles[triangle];
    return (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).norm()
        / 2;
}

double area_of(const Mesh& mesh)
{
    double area = 0;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) area += area_of(mesh, t);
    return area;
}

Vec3 point_at(const SurfacePoints& points, std::size_t i)
{
    return Vec3T<float>(points.x[i], points.y[i], points.z[i]).cast<double>();
}

// Random places of the surface, some of every triangle of a coarse mesh.
template <class Visitor>
void visit_surface(const Mesh& mesh, int count, std::uint64_t seed, const Visitor& visit)
{
    std::mt19937_64 engine(seed);
    const auto part = [&] { return static_cast<double>(engine() >> 11) * 0x1p-53; };
    for (int i = 0; i < count; ++i) {
        const auto t = static_cast<std::uint32_t>(engine() % mesh.triangles.size());
        const auto& [a, b, c] = mesh.triangles[t];
        double u = part(), v = part();
        if (u + v > 1) u = 1 - u, v = 1 - v;
        visit(t,
              Vec3(mesh.vertices[a] + u * (mesh.vertices[b] - mesh.vertices[a])
                   + v * (mesh.vertices[c] - mesh.vertices[a])));
    }
}

struct Sample {
    Mesh mesh;
    double spacing;
};

std::vector<Sample> samples()
{
    return {{made(box_mesh({0.5, 0.3, 0.2})), 0.05}, {made(box_mesh({0.5, 0.5, 0.004})), 0.06},
            {made(box_mesh({1, 1, 1})), 10},         {made(ball_mesh(0.5, 40, 20)), 0.06},
            {made(ball_mesh(0.5, 12, 6)), 0.05},     {made(torus_mesh(0.4, 0.1, 48, 24)), 0.03},
            {made(ball_mesh(1e-3, 60, 30)), 4e-4}};
}

TEST(SurfacePoints, NothingOfTheSurfaceIsFurtherThanTheSpacing)
{
    for (const auto& sample : samples()) {
        // Not bound to names of their own: Clang 14 lets no lambda see those.
        const auto& mesh = sample.mesh;
        const double spacing = sample.spacing;
        const SurfacePoints points = build_surface_points(mesh, spacing);
        ASSERT_EQ(points.spacing, spacing);
        visit_surface(mesh, 1000, 71, [&](std::uint32_t triangle, const Vec3& place) {
            double nearest = 1e300;
            for (std::size_t i = 0; i < points.size(); ++i) {
                // Of its own side.
                if (points.normals[i].cast<double>().dot(mesh.normals[triangle]) < 0) continue;
                nearest = std::min(nearest, (point_at(points, i) - place).norm());
            }
            ASSERT_LT(nearest, spacing * (1 + 1e-6));
        });
    }
}

TEST(SurfacePoints, LieOnTheSurfaceAndLookOutward)
{
    for (const auto& [mesh, spacing] : samples()) {
        const SurfacePoints points = build_surface_points(mesh, spacing);
        const double size = mesh.tree[0].upper.norm();
        for (std::size_t i = 0; i < points.size(); i += 7) {
            const MeshPoint nearest = nearest_on_mesh(mesh, point_at(points, i));
            ASSERT_LT(nearest.distance, 1e-6 * size);
            const Vec3 normal = points.normals[i].cast<double>();
            ASSERT_NEAR(normal.norm(), 1, 1e-6);
            // Of a corner of a box less than 55 degrees off each of its faces.
            ASSERT_GT(normal.dot(mesh.normals[nearest.triangle]), 0.57);
            // Its faces can be pushed straight on, and from a little aside as well.
            ASSERT_LT(points.cones[i], 0.9401F);
            ASSERT_LT(points.cones[i], normal.dot(mesh.normals[nearest.triangle]) - 0.05);
        }
    }
}

TEST(SurfacePoints, FewAreNeededHoweverFineTheMesh)
{
    const Mesh coarse = made(ball_mesh(0.5, 40, 20)), fine = made(ball_mesh(0.5, 264, 133));
    ASSERT_GT(fine.triangles.size(), 69000U);
    for (const double spacing : {0.05, 0.1}) {
        const double wanted = area_of(fine) / (spacing * spacing);
        const std::size_t of_fine = build_surface_points(fine, spacing).size();
        const std::size_t of_coarse = build_surface_points(coarse, spacing).size();
        // Disks of radius 0.2 spacing about vertices that do not meet: at most 7.2 for each square
        // of spacing; where there are few vertices, of 0.4 about the rest, 1.81.
        EXPECT_LT(static_cast<double>(of_fine), 7.3 * wanted);
        EXPECT_LT(static_cast<double>(of_coarse),
                  1.85 * wanted + static_cast<double>(coarse.vertices.size()));
        // Disks of radius `spacing` that cover: at least 0.38 of them.
        EXPECT_GT(static_cast<double>(of_fine), 0.38 * wanted);
    }
}

TEST(SurfacePoints, CornersAndEdgesOfABoxAreAmongThem)
{
    const Vec3 half(0.5, 0.25, 0.125);
    const SurfacePoints points = build_surface_points(made(box_mesh(half)), 0.1);
    int corners = 0;
    std::set<double> along_edge;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3 at = point_at(points, i);
        corners += at.cwiseAbs() == half;
        if (at.y() == half.y() && at.z() == half.z()) along_edge.insert(at.x());
    }
    EXPECT_EQ(corners, 8);
    ASSERT_GE(along_edge.size(), 8U);
    for (auto at = std::next(along_edge.begin()); at != along_edge.end(); ++at)
        EXPECT_LT(*at - *std::prev(at), 0.2);
}

TEST(SurfacePoints, TheTreeHoldsEachPointOnceInBallsOfSixteen)
{
    for (const auto& [mesh, spacing] : samples()) {
        const SurfacePoints points = build_surface_points(mesh, spacing);
        std::vector<int> seen(points.size(), 0);
        std::size_t leaves = 0;
        const auto visit = [&](const auto& self, std::uint32_t index,
                               std::vector<std::uint32_t> above) -> void {
            const SurfacePoints::Node& node = points.nodes[index];
            above.push_back(index);
            ASSERT_LT(above.size(), 40U);
            if (node.count == 0) {
                self(self, node.first, above);
                self(self, node.first + 1, above);
                return;
            }
            ++leaves;
            ASSERT_LE(node.count, 16U);
            for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
                ++seen[i];
                for (const std::uint32_t holder : above) {
                    const SurfacePoints::Node& ball = points.nodes[holder];
                    ASSERT_LE((point_at(points, i) - ball.center.cast<double>()).norm(),
                              ball.radius);
                }
            }
        };
        visit(visit, 0, {});
        EXPECT_EQ(std::count(seen.begin(), seen.end(), 1),
                  static_cast<std::ptrdiff_t>(points.size()));
        EXPECT_EQ(leaves, (points.size() + 15) / 16);
    }
}

}  // namespace
}  // namespace throng::test
