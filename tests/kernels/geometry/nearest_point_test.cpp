// Nearest point: certificates that nothing is nearer, and a search over points of the surface.
#include "kernels/geometry/nearest_point.hpp"

#include "cooking/hulls/hull.hpp"
#include "cooking/repair/build_mesh.hpp"
#include "tests/support/dice.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace throng::test {
namespace {

// How far a solid reaches along a direction, and whether it holds a point give or take a margin.
struct Solid {
    const char* name;
    ShapeRef shape;
    std::function<double(const Vec3&)> extent;
    std::function<bool(const Vec3&, double)> holds;
};

std::vector<Solid> solids(Shapes& shapes, double size)
{
    const double r = 0.7 * size, h = 1.3 * size;
    const Vec3 half = Vec3(0.5, 1.1, 0.8) * size;
    shapes.spheres = {{r}};
    shapes.capsules = {{r, h}};
    shapes.cylinders = {{r, h}};
    shapes.boxes = {{half}};
    const std::vector<Vec3> tips = {{size, 0, 0},  {-size, 0, 0}, {0, size, 0},
                                    {0, -size, 0}, {0, 0, size},  {0, 0, -size}};
    shapes.hulls = {build_hull(tips).hull};
    const auto flat = [](const Vec3& v) { return std::hypot(v.x(), v.y()); };
    return {
        {"sphere",
         {ShapeKind::sphere, 0},
         [=](const Vec3& d) { return r * d.norm(); },
         [=](const Vec3& p, double by) { return p.norm() <= r + by; }},
        {"capsule",
         {ShapeKind::capsule, 0},
         [=](const Vec3& d) { return r * d.norm() + h * std::abs(d.z()); },
         [=](const Vec3& p, double by) {
             return std::hypot(flat(p), std::max(0.0, std::abs(p.z()) - h)) <= r + by;
         }},
        {"cylinder",
         {ShapeKind::cylinder, 0},
         [=](const Vec3& d) { return r * flat(d) + h * std::abs(d.z()); },
         [=](const Vec3& p, double by) { return flat(p) <= r + by && std::abs(p.z()) <= h + by; }},
        {"box",
         {ShapeKind::box, 0},
         [=](const Vec3& d) { return half.dot(d.cwiseAbs()); },
         [=](const Vec3& p, double by) { return (p.cwiseAbs() - half).maxCoeff() <= by; }},
        {"hull",
         {ShapeKind::hull, 0},
         [=](const Vec3& d) { return size * d.cwiseAbs().maxCoeff(); },
         [=](const Vec3& p, double by) { return p.lpNorm<1>() <= size + 2 * by; }},
    };
}

TEST(NearestPoint, LiesInTheSolidAndAPlaneThroughItPartsTheTwo)
{
    for (const double size : {1e-6, 1.0, 1e6}) {
        Shapes shapes;
        for (const Solid& solid : solids(shapes, size)) {
            Dice dice(21);
            for (int i = 0; i < 3000; ++i) {
                SCOPED_TRACE(std::string(solid.name) + ", point " + std::to_string(i));
                const double away = (i % 5 == 0 ? 1e3 : 2) * size;
                Vec3 point = dice.point(away);
                if (i % 3 == 0) point[i % 2] = 0;
                const NearestPoint nearest = nearest_point(shapes, solid.shape, point, 1e300);
                const double close = 1e-14 * away;
                ASSERT_TRUE(solid.holds(nearest.point, close));
                const Vec3 out = point - nearest.point;
                ASSERT_NEAR(nearest.distance, out.norm(), close);
                ASSERT_TRUE(!solid.holds(point, -close) || nearest.distance == 0);
                if (nearest.distance < 1e-6 * size) continue;
                // No point of the solid is further along `out`, so none is nearer.
                ASSERT_NEAR(solid.extent(out / out.norm()), nearest.point.dot(out) / out.norm(),
                            1e-8 * size);
            }
        }
    }
}

TEST(NearestPoint, OfAMeshIsNoFurtherThanAnyPointOfItsTriangles)
{
    std::vector<Vec3> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (std::uint32_t y = 0; y <= 6; ++y)
        for (std::uint32_t x = 0; x <= 6; ++x)
            vertices.emplace_back(x, y, std::sin(0.9 * x + 0.3 * y * y));
    for (std::uint32_t y = 0; y < 6; ++y)
        for (std::uint32_t x = 0; x < 6; ++x) {
            const std::uint32_t at = 7 * y + x;
            triangles.push_back({at, at + 1, at + 8});
            triangles.push_back({at, at + 8, at + 7});
        }
    Shapes shapes;
    shapes.meshes = {build_mesh(vertices, triangles).mesh};
    // Points of every triangle, at most 1/16 of an edge from one another.
    std::vector<Vec3> samples;
    for (const auto& [a, b, c] : triangles)
        for (int i = 0; i <= 16; ++i)
            for (int k = 0; i + k <= 16; ++k)
                samples.push_back(vertices[a] + (vertices[b] - vertices[a]) * i / 16.0
                                  + (vertices[c] - vertices[a]) * k / 16.0);
    Dice dice(22);
    for (int i = 0; i < 300; ++i) {
        const Vec3 point = Vec3(3, 3, 0) + dice.point(i % 3 == 0 ? 30 : 4);
        const NearestPoint nearest = nearest_point(shapes, {ShapeKind::mesh, 0}, point, 1e300);
        double least = 1e300, off = 1e300;
        for (const Vec3& sample : samples) {
            least = std::min(least, (sample - point).norm());
            off = std::min(off, (sample - nearest.point).norm());
        }
        ASSERT_LE(nearest.distance, least * (1 + 1e-14)) << "point " << i << " of seed 22";
        ASSERT_GE(nearest.distance, least - 0.12) << "point " << i << " of seed 22";
        ASSERT_LT(off, 0.12) << "point " << i << " of seed 22";
        ASSERT_NEAR((nearest.point - point).norm(), nearest.distance, 1e-13);
    }
}

TEST(NearestPoint, OfAPlaneIsStraightBelow)
{
    Shapes shapes;
    shapes.planes = {{Vec3(0.6, 0, 0.8), 2}};
    const NearestPoint above = nearest_point(shapes, {ShapeKind::plane, 0}, Vec3(3, 7, 4), 1e300);
    EXPECT_NEAR(above.distance, 3, 1e-14);
    EXPECT_LT((above.point - Vec3(1.2, 7, 1.6)).norm(), 1e-14);
    EXPECT_EQ(nearest_point(shapes, {ShapeKind::plane, 0}, Vec3(0, 7, 0), 1e300).distance, 0);
}

}  // namespace
}  // namespace throng::test
