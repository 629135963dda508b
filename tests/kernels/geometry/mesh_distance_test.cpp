// Mesh distance: the tree against every triangle.
#include "kernels/geometry/mesh_distance.hpp"

#include "cooking/repair/build_mesh.hpp"
#include "scene/catalog/closed_meshes.hpp"

#include <gtest/gtest.h>

#include <random>

namespace throng {
namespace {

double plain_distance(const Mesh& mesh, const Vec3& point)
{
    double least = std::numeric_limits<double>::infinity();
    for (const auto& [a, b, c] : mesh.triangles) {
        const auto nearest = closest_on_triangle<double>(point, mesh.vertices[a], mesh.vertices[b],
                                                         mesh.vertices[c]);
        least = std::min(least, (nearest.point - point).norm());
    }
    return least;
}

class MeshDistance : public testing::Test {
protected:
    Vec3 point()
    {
        std::uniform_real_distribution<double> along(-1.2, 1.2);
        const double x = along(engine), y = along(engine);
        return {x, y, along(engine)};
    }

    std::mt19937_64 engine{31};
    TriangleSoup soup = torus_mesh(0.7, 0.25, 24, 12);
    Mesh mesh = build_mesh(soup.vertices, soup.triangles).mesh;
};

TEST_F(MeshDistance, IsThatOfTheNearestTriangleWhereverTheSearchBegins)
{
    for (int i = 0; i < 200; ++i) {
        const Vec3 at = point();
        const double truth = plain_distance(mesh, at);
        const auto some = static_cast<std::uint32_t>(engine() % mesh.triangles.size());
        ASSERT_EQ(nearest_on_mesh(mesh, at).distance, truth) << "seed 31, point " << i;
        ASSERT_EQ(nearest_on_mesh(mesh, at, truth * 1.001, some).distance, truth);
        // Nothing is that near; what is told then is further than asked for.
        ASSERT_GT(nearest_on_mesh(mesh, at, truth * 0.9, some).distance, truth * 0.9);
    }
}

TEST_F(MeshDistance, ComesWithinExactlyWhatIsNoFurther)
{
    for (int i = 0; i < 200; ++i) {
        const Vec3 at = point();
        const double truth = plain_distance(mesh, at);
        ASSERT_TRUE(comes_within(mesh, at, truth * (1 + 1e-12))) << "seed 31, point " << i;
        ASSERT_FALSE(comes_within(mesh, at, truth * (1 - 1e-12))) << "seed 31, point " << i;
    }
    EXPECT_FALSE(comes_within(Mesh{}, Vec3::Zero(), 1));
}

}  // namespace
}  // namespace throng
