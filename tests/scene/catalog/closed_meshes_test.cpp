// Closed meshes: each encloses what its formula says, faces outward and does not cut itself.
#include "scene/catalog/closed_meshes.hpp"

#include "cooking/repair/build_mesh.hpp"
#include "kernels/geometry/mass.hpp"
#include "kernels/geometry/mesh_distance.hpp"
#include "scene/catalog/noisy_balls.hpp"
#include "scene/catalog/swept_meshes.hpp"
#include "scene/catalog/threads.hpp"
#include "tests/scene/catalog/mesh_crossings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

namespace throng {
namespace {

constexpr double kPi = std::numbers::pi;

Mesh built(const TriangleSoup& soup)
{
    MeshResult result = build_mesh(soup.vertices, soup.triangles);
    EXPECT_EQ(result.trouble, "");
    return std::move(result.mesh);
}

double volume_of(const TriangleSoup& soup) { return mass_of(built(soup)).volume; }

/// A regular polygon's part of the disc round it.
double polygon_part(double corners) { return std::sin(2 * kPi / corners) * corners / (2 * kPi); }

double length_of(std::span<const CurvePoint> curve)
{
    double sum = 0;
    for (std::size_t i = 0; i < curve.size(); ++i)
        sum += (curve[(i + 1) % curve.size()].place - curve[i].place).norm();
    return sum;
}

constexpr TorusKnot kTrefoil{2, 3, 1.0, 0.5}, kCinquefoil{2, 5, 1.0, 0.5}, kWound{3, 2, 1.0, 0.5},
    kRing{1, 0, 1.0, 0};
constexpr Thread kThread{0.01, 0.005, 0.00025};

TEST(ClosedMeshes, AreClosedFaceOutwardAndDoNotCutThemselves)
{
    const std::pair<const char*, TriangleSoup> all[] = {
        {"box", box_mesh({1, 2, 3})},
        {"ball", ball_mesh(1, 24, 12)},
        {"torus", torus_mesh(1, 0.25, 24, 12)},
        {"trefoil", tube_mesh(torus_knot(kTrefoil, 96), 0.2, 10)},
        {"cinquefoil", tube_mesh(torus_knot(kCinquefoil, 160), 0.15, 10)},
        {"wound", tube_mesh(torus_knot(kWound, 160), 0.15, 10)},
        {"link", tube_mesh(link_curve(0.5, 0.5, 12), 0.2, 10)},
        {"icosahedron", geodesic_ball(1, 1)},
        {"lump", noisy_ball(1, 0.4, 2000, 3)},
        {"bolt", bolt_mesh(kThread, 0.05, 24)},
        {"nut", nut_mesh(kThread, 0.016, 24)},
    };
    for (const auto& [name, soup] : all) {
        SCOPED_TRACE(name);
        const Mesh mesh = built(soup);
        // Nothing was welded or left out: the shapes are made of what they need.
        EXPECT_EQ(mesh.triangles.size(), soup.triangles.size());
        EXPECT_EQ(mesh.vertices.size(), soup.vertices.size());
        EXPECT_TRUE(is_closed(mesh));
        EXPECT_GT(mass_of(mesh).volume, 0);
        EXPECT_EQ(count_crossings(mesh), 0u);
    }
}

TEST(ClosedMeshes, CrossingsAreSeenWhereThereAreSome)
{
    // A tube too thick for its knot: its strands are 0.76 apart.
    EXPECT_GT(count_crossings(built(tube_mesh(torus_knot(kTrefoil, 96), 0.45, 10))), 10u);
}

TEST(ClosedMeshes, TubesHoldTheirSectionTimesTheWayOfTheirMiddle)
{
    struct Case {
        const char* name;
        std::vector<CurvePoint> curve, fine;
    };
    const Case all[] = {
        {"trefoil", torus_knot(kTrefoil, 400), torus_knot(kTrefoil, 20000)},
        {"cinquefoil", torus_knot(kCinquefoil, 600), torus_knot(kCinquefoil, 20000)},
        {"ring", torus_knot(kRing, 200), torus_knot(kRing, 20000)},
    };
    for (const Case& of : all) {
        const double tube = 0.15, section = kPi * tube * tube * polygon_part(16);
        const double expected = section * length_of(of.fine);
        // Chords are short of their arc by a 24th of the square of its angle, of 0.06 at most.
        EXPECT_NEAR(volume_of(tube_mesh(of.curve, tube, 16)) / expected, 1, 1e-3) << of.name;
    }
    // A torus is one of them.
    const double ring = volume_of(tube_mesh(torus_knot(kRing, 96), 0.25, 32));
    EXPECT_NEAR(ring, volume_of(torus_mesh(1, 0.25, 96, 32)), 1e-12);
}

TEST(ClosedMeshes, TorusAndLinkHaveTheVolumesOfTheirFormulas)
{
    const double tube = 0.25, section = kPi * tube * tube * polygon_part(64);
    // Round the ring as well there are chords in place of arcs.
    EXPECT_NEAR(volume_of(torus_mesh(1, tube, 256, 64)), section * 2 * kPi * polygon_part(256),
                1e-12);
    EXPECT_NEAR(volume_of(torus_mesh(1, tube, 256, 128)), 2 * kPi * kPi * tube * tube, 7e-4);
    const double link = volume_of(tube_mesh(link_curve(0.7, 1, 128), tube, 64));
    EXPECT_NEAR(link, section * (2 * kPi * polygon_part(256) + 4 * 0.7), 1e-12);
}

TEST(ClosedMeshes, LinkIsAsLongAsItSays)
{
    const auto curve = link_curve(0.7, 0.5, 32);
    EXPECT_NEAR(length_of(curve), 4 * 0.7 + kPi, 2e-3 * kPi);
    Box3 box;
    for (const CurvePoint& point : curve) {
        box.lower = box.lower.cwiseMin(point.place);
        box.upper = box.upper.cwiseMax(point.place);
        EXPECT_NEAR(point.along.norm(), 1, 1e-15);
    }
    EXPECT_LT((box.upper - Vec3(1.2, 0.5, 0)).norm(), 1e-15);
    EXPECT_LT((box.lower + Vec3(1.2, 0.5, 0)).norm(), 1e-15);
}

// All of a tube's vertices are on the tube, and its frames do not wring it: a row of vertices goes
// no further than a parallel of the middle line may.
TEST(ClosedMeshes, TubesAreRoundAndNotWrung)
{
    const std::uint32_t around = 400, across = 8;
    const auto curve = torus_knot(kTrefoil, around);
    const TriangleSoup mesh = tube_mesh(curve, 0.2, across);
    for (std::uint32_t i = 0; i < around; ++i)
        for (std::uint32_t k = 0; k < across; ++k) {
            const Vec3 out = mesh.vertices[i * across + k] - curve[i].place;
            ASSERT_NEAR(out.norm(), 0.2, 1e-12);
            ASSERT_NEAR(out.dot(curve[i].along), 0, 1e-12);
            const Vec3& next = mesh.vertices[(i + 1) % around * across + k];
            const double step = (curve[(i + 1) % around].place - curve[i].place).norm();
            // Curvature is at most 2.2 here, so that a parallel at 0.2 is at most 1.5 times as
            // long.
            ASSERT_LT((next - mesh.vertices[i * across + k]).norm(), 1.6 * step);
        }
}

TEST(NoisyBalls, HaveAboutAsManyTrianglesAsAskedFor)
{
    for (const std::uint32_t wanted : {20u, 100u, 1000u, 20000u, 500000u}) {
        const auto count = static_cast<double>(noisy_ball(1, 0.3, wanted, 1).triangles.size());
        // From one number of cuts to the next there are 40 cuts + 20 triangles; half of it at most.
        EXPECT_NEAR(count, wanted, 20 * std::sqrt(wanted / 20.0) + 15);
    }
}

TEST(NoisyBalls, ApproachTheBallTheyWouldBeWithoutNoise)
{
    const double ball = 4 * kPi / 3;
    double last = 0;
    for (const std::uint32_t cuts : {2u, 4u, 8u, 16u, 32u}) {
        const double missing = 1 - volume_of(geodesic_ball(1, cuts)) / ball;
        EXPECT_GT(missing, 0);
        // Second order: a fourth with every doubling.
        if (last > 0) {
            EXPECT_NEAR(last / missing, 4, 0.6) << cuts;
        }
        last = missing;
    }
    EXPECT_LT(last, 1e-3);
}

TEST(NoisyBalls, AreRoughAsAskedForAndDifferBySeed)
{
    const TriangleSoup lump = noisy_ball(2, 0.3, 5000, 7);
    double least = 2, greatest = 2;
    for (const Vec3& vertex : lump.vertices) {
        least = std::min(least, vertex.norm());
        greatest = std::max(greatest, vertex.norm());
    }
    EXPECT_GE(least, 2 * 0.7);
    EXPECT_LE(greatest, 2 * 1.3);
    EXPECT_GT(greatest - least, 2 * 0.3) << "hardly any hills";
    EXPECT_EQ(lump.vertices, noisy_ball(2, 0.3, 5000, 7).vertices);
    EXPECT_NE(lump.vertices, noisy_ball(2, 0.3, 5000, 8).vertices);

    // The hills are smooth: more triangles change the volume ever less.
    const double coarse = volume_of(lump), fine = volume_of(noisy_ball(2, 0.3, 40000, 7));
    EXPECT_NEAR(coarse / fine, 1, 5e-3);
}

TEST(Threads, BoltAndNutHoldWhatTheirSectionsSay)
{
    const double shaft = 0.05, height = 0.016;
    const double hexagon = 2 * std::numbers::sqrt3 * std::pow(wrench_radius(kThread), 2);
    const double depth = kThread.radius - kThread.root_radius();
    // Off both ends goes at most a ring as high and wide as the cut of 45 degrees.
    const double cut = std::pow(depth + kThread.pitch / 8, 2) * 2 * kPi * kThread.radius;
    for (const std::uint32_t around : {24u, 96u}) {
        const double chords = polygon_part(around);
        const double bolt = kThread.section() * chords * shaft + hexagon * head_height(kThread);
        const double found = volume_of(bolt_mesh(kThread, shaft, around));
        EXPECT_LT(found, bolt);
        EXPECT_GT(found, bolt - cut);

        Thread hole = kThread;
        hole.radius += kThread.nut_offset();
        const double out = 1 / std::pow(std::cos(kPi / around), 2);
        const double nut = (hexagon - hole.section() * out * chords) * height;
        const double nut_found = volume_of(nut_mesh(kThread, height, around));
        EXPECT_LT(nut_found, nut);
        EXPECT_GT(nut_found, nut - 2 * cut * 1.3);  // the hole is wider than the shaft
    }
}

// Wherever the bolt is on its way down the thread, to shortly before its head is on the nut.
TEST(Threads, BoltKeepsItsClearanceFromTheNut)
{
    const double pitch = kThread.pitch;
    const TriangleSoup bolt = bolt_mesh(kThread, 8 * pitch, 24);
    Mesh nut = built(nut_mesh(kThread, 3.2 * pitch, 24));
    find_vertex_normals(nut);
    for (const double turns : {0.0, 0.013, 0.37, 1.5, 2.71}) {
        const double angle = -2 * kPi * turns, down = pitch * (6 - turns);
        const Pose pose{{0, 0, down}, Quat(Eigen::AngleAxisd(angle, Vec3::UnitZ()))};
        double least = 1;
        for (const auto& [a, b, c] : bolt.triangles) {
            const Vec3 p = pose * bolt.vertices[a], q = pose * bolt.vertices[b],
                       r = pose * bolt.vertices[c];
            for (const Vec3& at : {p, Vec3((p + q) / 2), Vec3((p + q + r) / 3)})
                least = std::min(least, signed_distance(nut, at));
        }
        EXPECT_GE(least, kThread.clearance) << turns;
        EXPECT_LT(least, 1.5 * kThread.clearance) << turns;
    }
}

// A bolt that is pushed by more than its play without a turn is stopped by the flanks.
TEST(Threads, BoltDoesNotGoDownWithoutTurning)
{
    Mesh nut = built(nut_mesh(kThread, 3.2 * kThread.pitch, 24));
    find_vertex_normals(nut);
    const TriangleSoup bolt = bolt_mesh(kThread, 8 * kThread.pitch, 24);
    double least = 1;
    for (const Vec3& vertex : bolt.vertices)
        least = std::min(least, signed_distance(nut, vertex + Vec3(0, 0, 5.7) * kThread.pitch));
    EXPECT_LT(least, -0.1 * kThread.pitch);
}

}  // namespace
}  // namespace throng
