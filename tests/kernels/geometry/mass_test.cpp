#include "kernels/geometry/mass.hpp"

#include "cooking/hulls/hull.hpp"
#include "cooking/repair/build_mesh.hpp"
#include "kernels/geometry/mesh.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace throng {
namespace {

// The plain twin: cells of a grid counted where their middle is inside.
MassProperties
count_cells(const Vec3& half, int cells, const std::function<bool(const Vec3&)>& inside)
{
    const Vec3 cell = 2 * half / cells;
    const double each = cell.prod();
    double volume = 0;
    Vec3 first = Vec3::Zero();
    Mat3 second = Mat3::Zero();
    for (int i = 0; i < cells; ++i)
        for (int j = 0; j < cells; ++j)
            for (int k = 0; k < cells; ++k) {
                const Vec3 p = cell.cwiseProduct(Vec3(i + 0.5, j + 0.5, k + 0.5)) - half;
                if (!inside(p)) continue;
                volume += each;
                first += each * p;
                second += each * (p.squaredNorm() * Mat3::Identity() - p * p.transpose());
            }
    const Vec3 center = first / volume;
    second -= volume * (center.squaredNorm() * Mat3::Identity() - center * center.transpose());
    return {volume, center, Sym3::from(second)};
}

void expect_near(const MassProperties& a, const MassProperties& b, double tolerance)
{
    const double size = std::cbrt(b.volume);
    EXPECT_NEAR(a.volume, b.volume, tolerance * b.volume);
    EXPECT_LE((a.center - b.center).norm(), tolerance * size);
    const Mat3 wanted = b.inertia.matrix();
    EXPECT_LE((a.inertia.matrix() - wanted).norm(), tolerance * wanted.norm())
        << a.inertia.matrix() << "\nwanted\n"
        << wanted;
}

Hull hull_of(const std::vector<Vec3>& points)
{
    const HullResult result = build_hull(points);
    EXPECT_EQ(result.trouble, "");
    return result.hull;
}

std::vector<Vec3> box_corners(const Vec3& half)
{
    std::vector<Vec3> corners;
    for (int i = 0; i < 8; ++i)
        corners.push_back(half.cwiseProduct(Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
    return corners;
}

MassProperties mass_of_box(const Vec3& half)
{
    Shapes shapes;
    shapes.boxes.push_back({half});
    return mass_of(shapes, {ShapeKind::box, 0});
}

// The hull's faces as triangles.
Mesh mesh_of(const Hull& hull)
{
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (std::size_t f = 0; f + 1 < hull.face_begin.size(); ++f)
        for (std::uint32_t i = hull.face_begin[f] + 2; i < hull.face_begin[f + 1]; ++i)
            triangles.push_back({hull.face_vertices[hull.face_begin[f]], hull.face_vertices[i - 1],
                                 hull.face_vertices[i]});
    const MeshResult result = build_mesh(hull.vertices, triangles);
    EXPECT_EQ(result.trouble, "");
    return result.mesh;
}

class Random {
public:
    explicit Random(unsigned seed) : engine_(seed) { }
    double uniform() { return unit_(engine_); }
    Vec3 in_box() { return {uniform(), uniform(), uniform()}; }
    Pose pose()
    {
        return {in_box(), Quat(uniform(), uniform(), uniform(), uniform() + 1.5).normalized()};
    }

private:
    std::mt19937_64 engine_;
    std::uniform_real_distribution<double> unit_{-1, 1};
};

TEST(MassOf, RoundShapesMatchCountedCells)
{
    Shapes shapes;
    shapes.spheres.push_back({0.8});
    shapes.cylinders.push_back({0.7, 0.4});
    shapes.capsules.push_back({0.3, 0.6});
    const Vec3 half = Vec3::Ones();
    const auto across = [](const Vec3& p) { return std::hypot(p.x(), p.y()); };
    const auto in_sphere = [](const Vec3& p) { return p.norm() < 0.8; };
    const auto in_cylinder = [&](const Vec3& p) {
        return across(p) < 0.7 && std::abs(p.z()) < 0.4;
    };
    const auto in_capsule = [&](const Vec3& p) {
        return std::hypot(across(p), std::max(0.0, std::abs(p.z()) - 0.6)) < 0.3;
    };
    expect_near(mass_of(shapes, {ShapeKind::sphere, 0}), count_cells(half, 80, in_sphere), 1.5e-2);
    expect_near(mass_of(shapes, {ShapeKind::cylinder, 0}), count_cells(half, 80, in_cylinder),
                1.5e-2);
    expect_near(mass_of(shapes, {ShapeKind::capsule, 0}), count_cells(half, 80, in_capsule),
                1.5e-2);
}

TEST(MassOf, CapsuleMatchesDisksAlongItsAxis)
{
    const double radius = 0.3, half = 0.6;
    Shapes shapes;
    shapes.capsules.push_back({radius, half});
    MassProperties sum;
    const int disks = 200000;
    const double thick = 2 * (radius + half) / disks;
    for (int i = 0; i < disks; ++i) {
        const double z = (i + 0.5) * thick - radius - half;
        const double beyond = std::max(0.0, std::abs(z) - half);
        const double squared = radius * radius - beyond * beyond;
        const double mass = M_PI * squared * thick;
        sum.volume += mass;
        sum.inertia.zz += mass * squared / 2;
        sum.inertia.xx += mass * (squared / 4 + z * z);
    }
    sum.inertia.yy = sum.inertia.xx;
    expect_near(mass_of(shapes, {ShapeKind::capsule, 0}), sum, 1e-9);
}

TEST(MassOf, CapsuleOfNoLengthIsASphere)
{
    Shapes shapes;
    shapes.capsules.push_back({0.3, 0});
    shapes.spheres.push_back({0.3});
    expect_near(mass_of(shapes, {ShapeKind::capsule, 0}), mass_of(shapes, {ShapeKind::sphere, 0}),
                1e-15);
}

TEST(MassOf, HullOfABoxIsTheBox)
{
    for (const Vec3& half :
         {Vec3(1, 2, 3), Vec3(1000, 5e-4, 5e-4), Vec3(1e-6, 2e-6, 3e-6), Vec3(1e6, 1e6, 1)}) {
        const MassProperties box = mass_of_box(half), hull = mass_of(hull_of(box_corners(half)));
        expect_near(hull, box, 1e-14);
        // The least moment has to be right by its own measure too.
        EXPECT_NEAR(hull.inertia.xx, box.inertia.xx, 1e-13 * box.inertia.xx);
    }
}

TEST(MassOf, TetrahedronMatchesItsClosedForm)
{
    // Source: Tonon (2004); corners at the origin and at 1 along each axis.
    const MassProperties mass =
        mass_of(hull_of({Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()}));
    MassProperties wanted{1.0 / 6, Vec3::Constant(0.25), {}};
    wanted.inertia = {1.0 / 80, 1.0 / 80, 1.0 / 80, 1.0 / 480, 1.0 / 480, 1.0 / 480};
    expect_near(mass, wanted, 1e-14);
}

TEST(MassOf, RandomHullsMatchCountedCells)
{
    for (unsigned seed = 0; seed < 5; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random random(seed);
        std::vector<Vec3> points;
        for (int i = 0; i < 12; ++i) points.push_back(random.in_box());
        const Hull hull = hull_of(points);
        const auto inside = [&](const Vec3& p) {
            for (std::size_t f = 0; f < hull.normals.size(); ++f)
                if (hull.normals[f].dot(p) > hull.offsets[f]) return false;
            return true;
        };
        expect_near(mass_of(hull), count_cells(Vec3::Ones(), 60, inside), 1e-2);
        expect_near(mass_of(mesh_of(hull)), mass_of(hull), 1e-13);
    }
}

TEST(MassOf, MovedAndTurnedAndFarAwayIsTheSameMass)
{
    for (unsigned seed = 0; seed < 20; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random random(seed);
        std::vector<Vec3> points, moved;
        const Pose pose = random.pose();
        const Vec3 far = 1e6 * random.in_box();
        for (int i = 0; i < 12; ++i) points.push_back(random.in_box());
        for (const Vec3& point : points) moved.push_back(pose.orientation * point + far);
        const MassProperties mass = mass_of(hull_of(points));
        const PlacedMass placed[] = {{mass, {far, pose.orientation}}};
        expect_near(mass_of(hull_of(moved)), combine(placed), 1e-8);
    }
}

TEST(MassOf, WhatEnclosesNothingHasNoMass)
{
    Shapes shapes;
    shapes.planes.push_back({});
    shapes.meshes.push_back(
        build_mesh({Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY()}, {{0, 1, 2}}).mesh);
    EXPECT_EQ(mass_of(shapes, {ShapeKind::plane, 0}).volume, 0);
    EXPECT_EQ(mass_of(shapes, {ShapeKind::mesh, 0}).volume, 0);
    EXPECT_EQ(combine({}).volume, 0);
}

TEST(Combine, TwoHalvesOfABoxAreTheBox)
{
    const Vec3 half(0.5, 0.7, 0.9);
    const MassProperties part = mass_of_box({0.25, 0.7, 0.9});
    const PlacedMass parts[] = {{part, {{-0.25, 0, 0}, Quat::Identity()}},
                                {part, {{0.25, 0, 0}, Quat::Identity()}}};
    expect_near(combine(parts), mass_of_box(half), 1e-15);
}

TEST(Combine, TurnedPartsGiveAFullTensorThatMatchesCountedCells)
{
    Shapes shapes;
    shapes.boxes.push_back({{0.5, 0.2, 0.1}});
    shapes.spheres.push_back({0.25});
    const Pose first{{-0.4, -0.3, 0.2}, Quat(0.8, 0.3, -0.2, 0.5).normalized()};
    const Pose second{{0.5, 0.5, -0.4}, Quat::Identity()};
    const PlacedMass parts[] = {{mass_of(shapes, {ShapeKind::box, 0}), first},
                                {mass_of(shapes, {ShapeKind::sphere, 0}), second}};
    const auto inside = [&](const Vec3& p) {
        const Vec3 local = first.to_local(p).cwiseAbs();
        return (local.array() < shapes.boxes[0].half_extents.array()).all()
            || (p - second.position).norm() < 0.25;
    };
    const MassProperties whole = combine(parts);
    EXPECT_GT(std::abs(whole.inertia.xy), 1e-3);
    expect_near(whole, count_cells(Vec3::Ones(), 100, inside), 1e-2);
}

TEST(Combine, FarFromTheFrameKeepsItsDigits)
{
    Random random(7);
    const MassProperties part = mass_of_box({0.1, 0.2, 0.3});
    std::vector<PlacedMass> near, far;
    const Vec3 away(3e6, -2e6, 1e6);
    for (int i = 0; i < 10; ++i) {
        near.push_back({part, random.pose()});
        far.push_back(near.back());
        far.back().pose.position += away;
    }
    MassProperties moved = combine(near);
    moved.center += away;
    expect_near(combine(far), moved, 1e-8);
}

}  // namespace
}  // namespace throng
