// Ray cast: closed forms against a march through distances written down afresh, and the corners.
#include "kernels/geometry/ray_cast.hpp"

#include "cooking/hulls/hull.hpp"
#include "cooking/repair/build_mesh.hpp"
#include "tests/support/dice.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace throng::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Never more than the distance to the shape; below 0 inside, 0 on the surface.
using Distance = std::function<double(const Vec3&)>;

struct Solid {
    const char* name;
    ShapeRef shape;
    Distance distance;
};

std::vector<Vec3> octahedron(double size)
{
    return {{size, 0, 0}, {-size, 0, 0}, {0, size, 0}, {0, -size, 0}, {0, 0, size}, {0, 0, -size}};
}

struct Solids {
    Shapes shapes;
    std::vector<Solid> all;

    explicit Solids(double size = 1)
    {
        const double r = 0.7 * size, h = 1.3 * size;
        const Vec3 half = Vec3(0.5, 1.1, 0.8) * size;
        shapes.spheres = {{r}};
        shapes.capsules = {{r, h}};
        shapes.cylinders = {{r, h}};
        shapes.boxes = {{half}};
        shapes.hulls = {build_hull(octahedron(size)).hull};
        shapes.planes = {{Vec3(0.6, 0, 0.8), 0.3 * size}};
        all.push_back(
            {"sphere", {ShapeKind::sphere, 0}, [=](const Vec3& p) { return p.norm() - r; }});
        all.push_back({"capsule", {ShapeKind::capsule, 0}, [=](const Vec3& p) {
                           const double over = std::max(0.0, std::abs(p.z()) - h);
                           return std::hypot(p.x(), p.y(), over) - r;
                       }});
        all.push_back({"cylinder", {ShapeKind::cylinder, 0}, [=](const Vec3& p) {
                           return std::max(std::hypot(p.x(), p.y()) - r, std::abs(p.z()) - h);
                       }});
        all.push_back({"box", {ShapeKind::box, 0}, [=](const Vec3& p) {
                           return (p.cwiseAbs() - half).maxCoeff();
                       }});
        all.push_back({"hull", {ShapeKind::hull, 0}, [=](const Vec3& p) {
                           return (p.lpNorm<1>() - size) / std::sqrt(3.0);
                       }});
        all.push_back({"plane", {ShapeKind::plane, 0}, [=](const Vec3& p) {
                           return 0.6 * p.x() + 0.8 * p.z() - 0.3 * size;
                       }});
    }
};

struct March {
    double distance = kInfinity;
    double closest = kInfinity;  // to the surface, on the way
};

// Steps that the distance allows, until it is gone.
March march(const Distance& distance, const LocalRay& ray, double size)
{
    March result;
    double at = 0;
    for (int step = 0; step < 4000 && at <= ray.longest; ++step) {
        const double left = distance(ray.from + ray.along * at);
        result.closest = std::min(result.closest, left);
        if (left < 1e-12 * size) {
            result.distance = at;
            break;
        }
        at += left;
    }
    return result;
}

void expect_as_marched(const Solids& solids, const Solid& solid, const LocalRay& ray, double size)
{
    const LocalRayHit met = cast_ray(solids.shapes, solid.shape, ray);
    const March marched = march(solid.distance, ray, size);
    if (met.found() != (marched.distance < kInfinity)) {
        // The two may part over a ray that grazes, or ends at the surface.
        const double end = met.found() ? solid.distance(ray.from + ray.along * met.distance) : 0;
        EXPECT_LT(marched.closest, 1e-6 * size);
        EXPECT_LT(std::abs(end), 1e-9 * size);
        return;
    }
    if (!met.found()) return;
    EXPECT_LE(met.distance, ray.longest);
    EXPECT_NEAR(met.normal.norm(), 1, 1e-12);
    EXPECT_LE(met.normal.dot(ray.along), 1e-12);
    if (met.distance == 0) {
        EXPECT_LE(solid.distance(ray.from), 1e-12 * size);
        return;
    }
    // Slow to end where the ray comes in flat.
    const double flat = std::max(1e-3, -met.normal.dot(ray.along));
    EXPECT_NEAR(met.distance, marched.distance, 1e-9 * size / flat);
    const Vec3 point = ray.from + ray.along * met.distance;
    EXPECT_NEAR(solid.distance(point), 0, 1e-12 * size);
    // The distance grows along the normal; at an edge along either face's.
    const double h = 1e-6 * size;
    EXPECT_NEAR(solid.distance(point + met.normal * h), h, 1e-3 * h);
}

TEST(RayCast, AgreesWithAMarchThroughDistances)
{
    for (const double size : {1e-6, 1.0, 1e6}) {
        const Solids solids(size);
        for (const Solid& solid : solids.all) {
            Dice dice(7);
            for (int i = 0; i < 4000; ++i) {
                LocalRay ray;
                ray.from = dice.point((i % 2 == 0 ? 1.5 : 6.0) * size);
                ray.along = dice.direction();
                if (i % 3 != 0) ray.along = (dice.point(size) - ray.from).normalized();
                if (i % 5 == 0) ray.along = Vec3::Unit(i % 3) * (i % 2 == 0 ? 1 : -1);
                ray.longest = (i % 4 == 0 ? dice.between(0, 5) : 50) * size;
                expect_as_marched(solids, solid, ray, size);
                ASSERT_FALSE(::testing::Test::HasFailure())
                    << solid.name << " of size " << size << ", ray " << i << " of seed 7";
            }
        }
    }
}

TEST(RayCast, BeginningInsideMeetsAtNoDistanceAgainstTheRay)
{
    const Solids solids;
    const Vec3 along = Vec3(1, -2, 3).normalized();
    for (const Solid& solid : solids.all) {
        const LocalRayHit met = cast_ray(solids.shapes, solid.shape, {Vec3(0.1, 0.1, -0.1), along});
        EXPECT_EQ(met.distance, 0) << solid.name;
        EXPECT_EQ(met.normal, -along) << solid.name;
    }
}

TEST(RayCast, LeavingFromOutsideMeetsNothing)
{
    const Solids solids;
    for (const Solid& solid : solids.all) {
        const Vec3 from(3, 3, 3);
        EXPECT_FALSE(cast_ray(solids.shapes, solid.shape, {from, from.normalized()}).found())
            << solid.name;
    }
}

TEST(RayCast, EndsAtItsGreatestDistance)
{
    const Solids solids;
    const LocalRay at_sphere{Vec3(2.7, 0, 0), -Vec3::UnitX(), 2};
    EXPECT_EQ(cast_ray(solids.shapes, {ShapeKind::sphere, 0}, at_sphere).distance, 2);
    for (const Solid& solid : solids.all) {
        const LocalRay whole{Vec3(4, 3, 5), -Vec3(4, 3, 5).normalized()};
        const double distance = cast_ray(solids.shapes, solid.shape, whole).distance;
        const LocalRay to{whole.from, whole.along, distance};
        const LocalRay less{whole.from, whole.along, distance * (1 - 1e-12)};
        EXPECT_EQ(cast_ray(solids.shapes, solid.shape, to).distance, distance) << solid.name;
        EXPECT_FALSE(cast_ray(solids.shapes, solid.shape, less).found()) << solid.name;
    }
}

TEST(RayCast, RaysInAFaceMeetItsRimAndRaysBesideItNothing)
{
    const Solids solids;
    const ShapeRef box{ShapeKind::box, 0}, can{ShapeKind::cylinder, 0}, plane{ShapeKind::plane, 0};
    const LocalRayHit in = cast_ray(solids.shapes, box, {Vec3(-2, 0.3, 0.8), Vec3::UnitX()});
    EXPECT_EQ(in.distance, 1.5);
    EXPECT_EQ(in.normal, -Vec3::UnitX());
    const double out = std::nextafter(0.8, 1.0);
    EXPECT_FALSE(cast_ray(solids.shapes, box, {Vec3(-2, 0.3, out), Vec3::UnitX()}).found());
    EXPECT_DOUBLE_EQ(cast_ray(solids.shapes, can, {Vec3(-2, 0, 1.3), Vec3::UnitX()}).distance, 1.3);
    EXPECT_DOUBLE_EQ(cast_ray(solids.shapes, can, {Vec3(0.7, 0, 3), -Vec3::UnitZ()}).distance, 1.7);
    EXPECT_FALSE(cast_ray(solids.shapes, can, {Vec3(0.7001, 0, 3), -Vec3::UnitZ()}).found());
    EXPECT_FALSE(cast_ray(solids.shapes, plane, {Vec3(0, 0, 1), Vec3::UnitY()}).found());
}

TEST(RayCast, RaysThroughEdgesAndCornersMeet)
{
    const Solids solids;
    const ShapeRef box{ShapeKind::box, 0}, hull{ShapeKind::hull, 0};
    const Vec3 half(0.5, 1.1, 0.8);
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3 sign(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
        const Vec3 at = half.cwiseProduct(sign);
        const LocalRay ray{at + 2 * sign, -sign.normalized()};
        EXPECT_NEAR(cast_ray(solids.shapes, box, ray).distance, 2 * std::sqrt(3.0), 1e-14);
    }
    for (const Vec3& at : octahedron(1)) {
        const LocalRayHit met = cast_ray(solids.shapes, hull, {3 * at, -at});
        EXPECT_NEAR(met.distance, 2, 1e-14);
        EXPECT_LT(met.normal.dot(-at), -0.5);
    }
}

TEST(RayCast, FromFarAwayKeepsItsDigits)
{
    const Solids solids;
    Dice dice(11);
    for (const Solid& solid : solids.all)
        for (int i = 0; i < 200; ++i) {
            // Towards the middle, from the plane's open side, and not along it.
            const Vec3 away = dice.direction();
            if (0.6 * away.x() + 0.8 * away.z() < 0.1) continue;
            const LocalRayHit near = cast_ray(solids.shapes, solid.shape, {10 * away, -away});
            const LocalRayHit far = cast_ray(solids.shapes, solid.shape, {1e7 * away, -away});
            ASSERT_TRUE(near.found() && far.found()) << solid.name << ", ray " << i;
            EXPECT_NEAR(far.distance - 1e7, near.distance - 10, 1e-7) << solid.name;
            EXPECT_LT((far.normal - near.normal).norm(), 1e-6) << solid.name;
        }
}

// A wavy field, and its triangles.
Mesh field(int side, double size, double wave)
{
    std::vector<Vec3> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    const auto at = [&](int x, int y) { return static_cast<std::uint32_t>(y * (side + 1) + x); };
    for (int y = 0; y <= side; ++y)
        for (int x = 0; x <= side; ++x)
            vertices.push_back(Vec3(x, y, wave * std::sin(0.9 * x + 0.31 * y * y)) * size);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            triangles.push_back({at(x, y), at(x + 1, y), at(x + 1, y + 1)});
            triangles.push_back({at(x, y), at(x + 1, y + 1), at(x, y + 1)});
        }
    return build_mesh(vertices, triangles).mesh;
}

// Weights of the corners and the way along the ray, by solving for all of them at once.
double solved(const Mesh& mesh, std::size_t triangle, const LocalRay& ray)
{
    const auto& [a, b, c] = mesh.triangles[triangle];
    Mat3 m;
    m << mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a], -ray.along;
    const Vec3 x = m.inverse() * (ray.from - mesh.vertices[a]);
    const bool hit = x[0] >= 0 && x[1] >= 0 && x[0] + x[1] <= 1 && x[2] >= 0 && x[2] <= ray.longest;
    return hit ? x[2] : kInfinity;
}

TEST(RayCast, MeshAgreesWithEveryTriangleAskedInTurn)
{
    for (const double size : {1e-6, 1.0, 1e6}) {
        Shapes shapes;
        shapes.meshes.push_back(field(9, size, 0.8));
        const Mesh& mesh = shapes.meshes[0];
        Dice dice(3);
        int hits = 0;
        for (int i = 0; i < 2000; ++i) {
            LocalRay ray{Vec3(4.5, 4.5, 0) * size + dice.point(8 * size), dice.direction()};
            if (i % 3 != 0)
                ray.along =
                    (Vec3(4.5, 4.5, 0) * size + dice.point(4 * size) - ray.from).normalized();
            if (i % 4 == 0) ray.longest = dice.between(0, 10 * size);
            double wanted = kInfinity;
            for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
                wanted = std::min(wanted, solved(mesh, t, ray));
            const LocalRayHit met = cast_ray(shapes, {ShapeKind::mesh, 0}, ray);
            ASSERT_EQ(met.found(), wanted < kInfinity) << "size " << size << ", ray " << i;
            if (!met.found()) continue;
            ++hits;
            ASSERT_NEAR(met.distance, wanted, 1e-9 * size) << "size " << size << ", ray " << i;
            ASSERT_LT(met.normal.dot(ray.along), 0);
        }
        EXPECT_GT(hits, 300);
    }
}

TEST(RayCast, NoRaySlipsThroughTheSeamsOfAMesh)
{
    for (const double wave : {0.0, 0.8}) {
        Shapes shapes;
        shapes.meshes.push_back(field(6, 1, wave));
        const Mesh& mesh = shapes.meshes[0];
        for (const double away : {3.0, 1e7})
            for (const auto& corners : mesh.triangles)
                for (std::size_t k = 0; k < 3; ++k)
                    for (const double part : {0.0, 0.25, 0.5, 1.0}) {
                        const Vec3 &a = mesh.vertices[corners[k]],
                                   &b = mesh.vertices[corners[(k + 1) % 3]];
                        const Vec3 at = a + part * (b - a);
                        const bool inner = at.x() > 0 && at.x() < 6 && at.y() > 0 && at.y() < 6;
                        if (!inner) continue;
                        for (const double side : {1.0, -1.0}) {
                            const LocalRay ray{at + Vec3(0, 0, side * away), {0, 0, -side}};
                            const LocalRayHit met = cast_ray(shapes, {ShapeKind::mesh, 0}, ray);
                            ASSERT_NEAR(met.distance, away, away * 1e-14);
                            ASSERT_GT(met.normal.z() * side, 0);
                        }
                    }
    }
}

TEST(RayCast, AMeshIsMetWhereTheRayBeginsAndMissedInItsPlane)
{
    Shapes shapes;
    shapes.meshes.push_back(field(4, 1, 0));
    const ShapeRef mesh{ShapeKind::mesh, 0};
    EXPECT_EQ(cast_ray(shapes, mesh, {Vec3(1.2, 1.7, 0), -Vec3::UnitZ()}).distance, 0);
    EXPECT_FALSE(cast_ray(shapes, mesh, {Vec3(-1, 1.7, 0), Vec3::UnitX()}).found());
    EXPECT_FALSE(cast_ray(shapes, mesh, {Vec3(1.2, 1.7, 1), Vec3::UnitX()}).found());
    EXPECT_FALSE(cast_ray(shapes, mesh, {Vec3(1.2, 1.7, 1), -Vec3::UnitZ(), 0.99}).found());
}

TEST(RayCast, AbsurdNumbersGiveNoNonsense)
{
    const Solids solids;
    for (const Solid& solid : solids.all)
        for (const double far : {1e150, 1e300})
            for (const Vec3& along : {Vec3(Vec3::UnitX()), Vec3(-1, 0, 1e-320)}) {
                const LocalRayHit met =
                    cast_ray(solids.shapes, solid.shape, {Vec3(far, -far, far), along});
                EXPECT_FALSE(std::isnan(met.distance)) << solid.name;
                EXPECT_TRUE(met.normal.allFinite()) << solid.name;
            }
}

}  // namespace
}  // namespace throng::test
