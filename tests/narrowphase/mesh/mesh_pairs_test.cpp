#include "cooking/repair/build_mesh.hpp"
#include "kernels/geometry/closest_points.hpp"
#include "kernels/geometry/mesh.hpp"
#include "kernels/math/turn_between.hpp"
#include "narrowphase/dispatch.hpp"
#include "narrowphase/mesh/mesh_sides.hpp"
#include "narrowphase/mesh/triangle_contacts.hpp"
#include "scene/catalog/closed_meshes.hpp"
#include "scene/catalog/sheets.hpp"
#include "tests/support/dice.hpp"
#include "tests/support/polyhedra.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace throng {
namespace {

constexpr ShapeRef kMesh{ShapeKind::mesh, 0};

Mesh grid_of(int cells, const std::function<Vec3(int, int)>& corner)
{
    const TriangleSoup soup = sheet_mesh(cells, corner);
    return build_mesh(soup.vertices, soup.triangles).mesh;
}

// A flat floor of side `cells`, cell 1 m, about the origin; with a step up of `rise` for x > 0.
Mesh floor_of(int cells, double rise = 0)
{
    return grid_of(cells, [&](int i, int j) {
        return Vec3(i - cells / 2, j - cells / 2, 2 * i > cells ? rise : 0);
    });
}

struct Slider {
    const char* name;
    ShapeRef shape;
    double height;  // of the center when its lowest point is at 0
    Quat turn;
};

// One of each kind that slides, lying flat.
std::vector<Slider> sliders(Shapes& shapes)
{
    const double root = std::sqrt(0.5);
    shapes.spheres = {{0.4}};
    shapes.capsules = {{0.3, 0.6}};
    shapes.cylinders = {{0.4, 0.5}};
    shapes.boxes = {{{0.7, 0.55, 0.3}}};
    std::vector<Vec3> points = corners_of({0.6, 0.5, 0.4});
    points.emplace_back(0, 0, 0.8);
    points.emplace_back(0.9, 0.1, 0);
    shapes.hulls = {build_hull(points).hull};
    const Quat flat = Quat::Identity(), lying(root, root, 0, 0);
    return {{"sphere", {ShapeKind::sphere, 0}, 0.4, flat},
            {"capsule", {ShapeKind::capsule, 0}, 0.3, lying},
            {"standing cylinder", {ShapeKind::cylinder, 0}, 0.5, flat},
            {"lying cylinder", {ShapeKind::cylinder, 0}, 0.4, lying},
            {"box", {ShapeKind::box, 0}, 0.3, flat},
            {"hull", {ShapeKind::hull, 0}, 0.4, flat}};
}

std::vector<PartManifold>
touch_mesh(const Shapes& shapes, ShapeRef shape, const Pose& pose, double speculative_margin)
{
    std::vector<PartManifold> found;
    collide_mesh({shapes, kMesh, shape, pose, speculative_margin}, found);
    return found;
}

// Of a box and the triangles of a mesh: the separation by the axis that parts each best, where it
// is least. All axes there are, and no mesh: the answer sheet of what lies on a peak.
double separation_from(const Mesh& mesh, const Vec3& half, const Pose& pose)
{
    const Mat3 turn = pose.orientation.toRotationMatrix();
    double least = std::numeric_limits<double>::max();
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        std::array<Vec3, 3> corners;
        for (std::size_t k = 0; k < 3; ++k) corners[k] = mesh.vertices[mesh.triangles[t][k]];
        std::vector<Vec3> axes{mesh.normals[t], turn.col(0), turn.col(1), turn.col(2)};
        for (std::size_t e = 0; e < 3; ++e)
            for (int k = 0; k < 3; ++k) {
                const Vec3 axis = (corners[(e + 1) % 3] - corners[e]).cross(Vec3(turn.col(k)));
                if (axis.norm() > 1e-6) axes.push_back(axis.normalized());
            }
        double best = -std::numeric_limits<double>::max();
        for (const Vec3& axis : axes) {
            const double speculative_margin = (turn.transpose() * axis).cwiseAbs().dot(half);
            double low = std::numeric_limits<double>::max(), high = -low;
            for (const Vec3& corner : corners) {
                low = std::min(low, axis.dot(corner - pose.position));
                high = std::max(high, axis.dot(corner - pose.position));
            }
            best = std::max({best, low - speculative_margin, -high - speculative_margin});
        }
        least = std::min(least, best);
    }
    return least;
}

// What the bounds of the tree leave out is beyond reach.
TEST(MeshPairs, KDopsLoseNoContactThatTouches)
{
    Shapes shapes;
    const std::vector<Slider> all = sliders(shapes);
    Mesh rough = floor_of(12);
    test::Dice dice(9);
    std::vector<Vec3> vertices = rough.vertices;
    for (Vec3& vertex : vertices) vertex.z() = dice.between(-0.2, 0.2);
    rough = build_mesh(vertices, rough.triangles).mesh;
    std::size_t touching = 0;
    for (int i = 0; i < 200; ++i)
        for (const Slider& slider : all) {
            const Vec3 at(dice.between(-3, 3), dice.between(-3, 3), dice.between(0, 0.6));
            const Pose pose{at, dice.turn()};
            std::vector<std::vector<PartManifold>> told;
            for (const int k : {6, 14, 26}) {
                shapes.meshes = {rough};
                if (k > 6) bound_by_k_dops(shapes.meshes[0], k);
                told.push_back(touch_mesh(shapes, slider.shape, pose, 0.02));
                std::erase_if(told.back(), [](const auto& one) {
                    const auto& points = one.manifold.points;
                    return std::none_of(points.begin(), points.begin() + one.manifold.count,
                                        [](const auto& point) { return point.separation <= 0; });
                });
            }
            touching += told[0].size();
            for (const auto& others : told) {
                ASSERT_EQ(others.size(), told[0].size()) << slider.name;
                for (std::size_t t = 0; t < others.size(); ++t) {
                    EXPECT_EQ(others[t].part, told[0][t].part);
                    EXPECT_EQ(others[t].manifold.normal, told[0][t].manifold.normal);
                }
            }
        }
    EXPECT_GT(touching, 500u);
}

}  // namespace

TEST(MeshPairs, SlidingOverSeamsMeetsNoBumps)
{
    Shapes shapes;
    shapes.meshes = {floor_of(20)};
    RandomShapes random(31);
    for (const Slider& slider : sliders(shapes)) {
        for (const double sunk : {0.0, 0.001, 0.02, 0.1}) {
            const Quat spin =
                (Quat(random.number(0.2, 1), 0, 0, random.number(-1, 1))).normalized();
            for (int i = 0; i < 120; ++i) {
                SCOPED_TRACE(std::string("seed 31, ") + slider.name + ", step "
                             + std::to_string(i));
                const Pose pose{{-8 + 0.13 * i, -6 + 0.1 * i, slider.height - sunk},
                                spin * slider.turn};
                const auto found = touch_mesh(shapes, slider.shape, pose, 0.01);
                ASSERT_FALSE(found.empty());
                double least = 1;
                for (const auto& one : found) {
                    ASSERT_LT((one.manifold.normal - Vec3::UnitZ()).norm(), 1e-6);
                    ASSERT_TRUE(features_differ(one.manifold));
                    least = std::min(least, deepest(one.manifold));
                }
                ASSERT_NEAR(least, -sunk, 1e-6);
            }
        }
    }
}

// Every triangle that its shape touches is asked, whatever is told of it beforehand.
TEST(MeshPairs, LeavesNoTriangleOutThatWouldTouch)
{
    constexpr double kMargin = 0.05;
    Shapes shapes;
    const std::vector<Slider> all = sliders(shapes);
    RandomShapes random(43);
    shapes.meshes = {grid_of(20, [&](int i, int j) {
        return Vec3(0.4 * (i - 10), 0.4 * (j - 10), random.number(0, 0.3));
    })};
    const Mesh& mesh = shapes.meshes[0];
    int touching = 0;
    for (int round = 0; round < 400; ++round) {
        const ShapeRef shape = all[static_cast<std::size_t>(round) % all.size()].shape;
        const bool prism = shape.kind == ShapeKind::cylinder;  // its own, and another's each time
        const Vec3 at = Vec3(0, 0, 0.55) + random.vector(-1, 1).cwiseProduct(Vec3(3, 3, 0.25));
        const Pose pose{at, random.turn()};
        const std::vector<PartManifold> found = touch_mesh(shapes, shape, pose, kMargin);
        for (std::uint32_t t = 0; t < mesh.triangles.size() && !prism; ++t) {
            const MeshTriangle triangle(mesh, t);
            LocalManifold<double> alone;
            if (shape.kind == ShapeKind::sphere) {
                collide_triangle_ball(triangle, at, shapes.spheres[0].radius, kMargin, alone);
            } else if (shape.kind == ShapeKind::capsule) {
                const Vec3 half(0, 0, shapes.capsules[0].half_length);
                collide_triangle_capsule(triangle, pose * Vec3(-half), pose * half,
                                         shapes.capsules[0].radius, kMargin, alone);
            } else {
                collide_triangle_polytope(triangle, PolytopeShape(shapes, shape).view(), pose,
                                          kMargin, alone);
            }
            if (alone.count == 0 || triangle.height(at) < 0) continue;
            ++touching;
            const auto same = std::find_if(found.begin(), found.end(),
                                           [&](const PartManifold& one) { return one.part == t; });
            ASSERT_NE(same, found.end()) << "seed 43, round " << round << ", triangle " << t;
            EXPECT_EQ(same->manifold.count, alone.count);
            EXPECT_EQ(same->manifold.normal, alone.normal);
        }
    }
    EXPECT_GT(touching, 500);
}

TEST(MeshPairs, TiltedShapesStillGetTheFloorsNormal)
{
    Shapes shapes;
    shapes.meshes = {floor_of(20)};
    RandomShapes random(32);
    for (const Slider& slider : sliders(shapes)) {
        for (int i = 0; i < 100; ++i) {
            SCOPED_TRACE(std::string("seed 32, ") + slider.name + ", pose " + std::to_string(i));
            Pose pose{random.vector(-5, 5), random.turn()};
            pose.position.z() = slider.height - 0.05;
            for (const auto& one : touch_mesh(shapes, slider.shape, pose, 0.01)) {
                ASSERT_LT((one.manifold.normal - Vec3::UnitZ()).norm(), 1e-6);
            }
        }
    }
}

// Its ends may both be further from the floor than it is thick.
TEST(MeshPairs, ARodThroughAFaceIsPushedOutAsFarAsItReachesBelow)
{
    Shapes shapes;
    std::vector<Vec3> square = {{-9, -8, 0}, {9, -8, 0}, {0, 9, 0}};
    shapes.meshes = {build_mesh(square, {{0, 1, 2}}).mesh};
    shapes.capsules = {{0.01, 0.5}};
    RandomShapes random(35);
    int deep = 0;
    for (int i = 0; i < 300; ++i) {
        SCOPED_TRACE("seed 35, pose " + std::to_string(i));
        Pose pose{random.vector(-1, 1), random.turn()};
        const double up = 0.5 * std::abs((pose.orientation * Vec3::UnitZ()).z());
        pose.position.z() = 0.9 * up * random.number(0, 1);
        const auto found = touch_mesh(shapes, {ShapeKind::capsule, 0}, pose, 0.01);
        ASSERT_EQ(found.size(), 1U);
        ASSERT_LT((found[0].manifold.normal - Vec3::UnitZ()).norm(), 1e-9);
        ASSERT_NEAR(deepest(found[0].manifold), pose.position.z() - up - 0.01, 1e-9);
        deep += up - pose.position.z() > 0.05 ? 1 : 0;
    }
    EXPECT_GT(deep, 50);
}

TEST(MeshPairs, DeepestPointOnAFloorIsTheLowestPoint)
{
    Shapes shapes;
    shapes.meshes = {floor_of(20)};
    sliders(shapes);
    RandomShapes random(33);
    for (int i = 0; i < 300; ++i) {
        SCOPED_TRACE("seed 33, pose " + std::to_string(i));
        const bool is_box = i % 2 == 0;
        Pose pose{random.vector(-5, 5), random.turn()};
        pose.position.z() = 0;
        const std::vector<Vec3> corners =
            is_box ? corners_of(shapes.boxes[0].half_extents) : shapes.hulls[0].vertices;
        const double lowest = -extent_of(corners, pose)(-Vec3::UnitZ());
        pose.position.z() = -lowest - 0.02;
        const auto found =
            touch_mesh(shapes, {is_box ? ShapeKind::box : ShapeKind::hull, 0}, pose, 0.01);
        double least = 1;
        for (const auto& one : found) least = std::min(least, deepest(one.manifold));
        ASSERT_NEAR(least, -0.02, 1e-9);
    }
}

TEST(MeshPairs, FromBehindAnOpenMeshPushesTheOtherWay)
{
    Shapes shapes;
    shapes.meshes = {floor_of(4)};
    for (const Slider& slider : sliders(shapes)) {
        const Pose below{{0.3, 0.2, -0.3}, slider.turn};
        const auto found = touch_mesh(shapes, slider.shape, below, 0.01);
        EXPECT_FALSE(found.empty()) << slider.name;
        for (const auto& one : found) EXPECT_LT(one.manifold.normal.z(), -0.99) << slider.name;
    }
}

TEST(MeshPairs, ARimStopsWhatComesFromTheSide)
{
    Shapes shapes;
    shapes.meshes = {floor_of(4)};
    sliders(shapes);
    // The floor ends at x = 2; the center is above it and out to the side.
    const auto box = touch_mesh(shapes, {ShapeKind::box, 0}, at(2.69, 0.3, 0.1), 0.01);
    ASSERT_FALSE(box.empty());
    for (const auto& one : box) EXPECT_GT(one.manifold.normal.x(), 0.99);
    const auto ball = touch_mesh(shapes, {ShapeKind::sphere, 0}, at(2.3, 0.3, 0.2), 0.01);
    ASSERT_FALSE(ball.empty());
    for (const auto& one : ball) {
        EXPECT_NEAR(one.manifold.normal.x(), 0.3 / std::sqrt(0.13), 1e-9);
        EXPECT_NEAR(deepest(one.manifold), std::sqrt(0.13) - 0.4, 1e-9);
    }
}

TEST(MeshPairs, AClosedMeshPushesLikeTheHullItIs)
{
    // A cube as a mesh against balls and boxes round it: the best triangle knows the depth.
    Shapes shapes;
    shapes.spheres = {{0.3}};
    shapes.boxes = {{{0.5, 0.5, 0.5}}, {{0.25, 0.2, 0.3}}};
    const BoxPolytope cube(shapes.boxes[0].half_extents);
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (std::size_t f = 0; f < 6; ++f) {
        const PolytopeView view = cube.view();
        const auto face = view.face(f);
        triangles.push_back({face[0], face[1], face[2]});
        triangles.push_back({face[0], face[2], face[3]});
    }
    shapes.meshes = {build_mesh({cube.vertices.begin(), cube.vertices.end()}, triangles).mesh};
    RandomShapes random(34);
    int touched = 0;
    for (int i = 0; i < 2000; ++i) {
        SCOPED_TRACE("seed 34, pose " + std::to_string(i));
        const Pose pose = random.pose(0.9);
        const Vec3 inside = pose.position.cwiseAbs();
        if (inside.maxCoeff() < 0.5) continue;
        const auto balls = touch_mesh(shapes, {ShapeKind::sphere, 0}, pose, 0);
        const double distance = (inside - inside.cwiseMin(0.5)).norm() - 0.3;
        if (std::abs(distance) < 1e-4) continue;
        ASSERT_EQ(!balls.empty(), distance < 0);
        for (const auto& one : balls) ASSERT_NEAR(deepest(one.manifold), distance, 1e-4);
        touched += distance < 0;

        // A box that overlaps is always pushed, along a way that is outward.
        const auto exact = run<double>(box_box<double>, shapes, kBoxA, kBoxB, pose, 0);
        const auto boxes = touch_mesh(shapes, kBoxB, pose, 0);
        if (exact.count > 0 && deepest(exact) < -1e-3) {
            ASSERT_FALSE(boxes.empty());
            double least = 1;
            for (const auto& one : boxes) least = std::min(least, deepest(one.manifold));
            ASSERT_LT(least, 0);
        }
        if (exact.count > 0) continue;
        ASSERT_TRUE(boxes.empty());
    }
    EXPECT_GT(touched, 100);
}

// Boxes whose corners below are cut, aslant to the face that they still belong to, hang over the
// rim of a floor: such an edge and the rim seem to part the two where only another corner touches.
TEST(MeshPairs, AHullIsAsDeepAsItLiesHoweverUnevenItsFaces)
{
    const std::vector<Vec3> corners{{-4, -4, 0}, {0, -4, 0}, {0, 4, 0}, {-4, 4, 0}};
    const std::vector<std::array<std::uint32_t, 3>> triangles{{0, 1, 2}, {0, 2, 3}};
    const double stray = 3.5e-5;
    RandomShapes random(35);
    int uneven = 0, slivers = 0;
    for (int i = 0; i < 2000; ++i) {
        SCOPED_TRACE("seed 35, pose " + std::to_string(i));
        std::vector<Vec3> points = corners_of({2, 1, 0.5});
        for (std::size_t k = 0; k < 4; ++k) {
            const Vec3 out(points[k].x() > 0 ? 1 : -1, points[k].y() > 0 ? 1 : -1, 0);
            const Vec3 cut(random.number(0, 2e-3), -random.number(1e-3, 3e-3), 0);
            points.emplace_back(points[k].x() + out.x() * cut.x(),
                                points[k].y() + out.y() * cut.y(), -0.5 - random.number(0, stray));
        }
        Shapes shapes;
        shapes.meshes = {build_mesh(corners, triangles).mesh};
        shapes.hulls = {build_hull(points).hull};
        const double depth = random.number(0.002, 0.02);
        const Pose pose{{random.number(-1, 1), random.number(-1, 1), 0.5 - depth},
                        Quat(random.number(-1, 1), 0, 0, random.number(-1, 1)).normalized()};
        // Some cut corners have a sliver of a face of their own below, beside the floor at times.
        const auto& normals = shapes.hulls[0].normals;
        const auto is_below = [](const Vec3& normal) { return normal.z() < -0.9; };
        const auto below = std::count_if(normals.begin(), normals.end(), is_below);
        ++(below == 1 ? uneven : slivers);
        double least = 1;
        for (const auto& one : touch_mesh(shapes, {ShapeKind::hull, 0}, pose, 0))
            least = std::min(least, deepest(one.manifold));
        ASSERT_NEAR(least, -depth, 2 * stray);
    }
    EXPECT_GT(uneven, 1000);
    EXPECT_GT(slivers, 300);
}

// Of a fast body all triangles of a small mesh are within the margin, those too that look at it
// over the hollow of the mesh or from behind the next one.
TEST(MeshPairs, WhatIsApartDoesNotOverlapHoweverFarTheReach)
{
    const double ring = 0.4, tube = 0.1;
    const TriangleSoup soup = torus_mesh(ring, tube, 32, 16);
    Shapes shapes;
    shapes.meshes = {build_mesh(soup.vertices, soup.triangles).mesh};
    // A bar, and what is round within it.
    shapes.boxes = {{{0.1, 0.05, 0.5}}};
    shapes.capsules = {{0.05, 0.45}};
    shapes.cylinders = {{0.05, 0.5}};
    RandomShapes random(36);
    int through = 0;
    for (int i = 0; i < 120; ++i) {
        SCOPED_TRACE("seed 36, pose " + std::to_string(i));
        // Through the hole, within a cylinder that is.
        const Vec3 lean(random.number(-0.2, 0.2), random.number(-0.2, 0.2), 1);
        const Quat turn = turn_between(Vec3::UnitZ(), lean)
            * Quat(Eigen::AngleAxisd(random.number(-3, 3), Vec3::UnitZ()));
        const Pose pose{random.number(-0.5, 0.5) * lean.normalized(), turn};
        double widest = 0;
        for (const Vec3& corner : corners_of(shapes.boxes[0].half_extents))
            widest = std::max(widest, (pose * corner).head<2>().norm());
        if (widest > ring - tube - 0.01) continue;
        ++through;
        for (const ShapeKind kind : {ShapeKind::box, ShapeKind::capsule, ShapeKind::cylinder}) {
            const auto found = touch_mesh(shapes, {kind, 0}, pose, 0.3);
            EXPECT_FALSE(found.empty());
            for (const auto& one : found) ASSERT_GE(deepest(one.manifold), 0);
        }
    }
    EXPECT_GT(through, 50);
}

// A box on the rim of a block, leaning inward by a hair: no side of the block pushes it out
// sideways, though it is half behind one and a little below its edge.
TEST(MeshPairs, WhatLiesOnARimIsNotPushedOffSideways)
{
    const TriangleSoup soup = box_mesh({1, 1, 1});
    Shapes shapes;
    shapes.meshes = {build_mesh(soup.vertices, soup.triangles).mesh};
    shapes.boxes = {{{0.5, 0.4, 0.3}}};
    RandomShapes random(37);
    int leaning = 0;
    for (int i = 0; i < 1000; ++i) {
        SCOPED_TRACE("seed 37, pose " + std::to_string(i));
        const Quat turn(1, random.number(-1e-3, 1e-3), random.number(-1e-3, 1e-3),
                        random.number(-0.5, 0.5));
        Pose pose{{random.number(0.6, 1.2), random.number(-0.3, 0.3), 0}, turn.normalized()};
        double lowest = 0;
        for (const Vec3& corner : corners_of(shapes.boxes[0].half_extents))
            if (const Vec3 at = pose * corner; at.x() < 1) lowest = std::min(lowest, at.z());
        const double depth = random.number(0.001, 0.004);
        pose.position.z() = 1 - lowest - depth;
        const auto found = touch_mesh(shapes, {ShapeKind::box, 0}, pose, 0);
        ASSERT_FALSE(found.empty());
        for (const auto& one : found) {
            ASSERT_GT(one.manifold.normal.z(), 0.99);
            // What hangs over the rim may be lower by as much as the box leans; a side leaves to
            // the top what is a fifth as deep there.
            ASSERT_GT(deepest(one.manifold), 5 * (-depth - 0.003));
        }
        leaning += pose.position.x() > 1;
    }
    EXPECT_GT(leaning, 200);
}

TEST(MeshPairs, WhatIsToldOfATriangleIsNearIt)
{
    test::Dice dice(78);
    Shapes shapes;
    shapes.boxes = {{{0.7, 0.2, 0.1}}};
    constexpr double kBias = 1e-3 * 0.1, kMargin = 0.01;
    shapes.meshes = {grid_of(20, [&](int i, int k) {
        return Vec3(0.15 * (i - 10), 0.15 * (k - 10), dice.between(-0.03, 0.03));
    })};
    const Mesh& mesh = shapes.meshes[0];
    int told = 0;
    for (int i = 0; i < 500; ++i) {
        const Quat lean(
            Eigen::AngleAxisd(dice.between(0, 0.2), Vec3(dice.between(-1, 1), 1, 0).normalized()));
        const Pose pose{
            Vec3(dice.between(-0.5, 0.5), dice.between(-0.5, 0.5), dice.between(0.09, 0.14)), lean};
        for (const auto& touched : touch_mesh(shapes, {ShapeKind::box, 0}, pose, kMargin)) {
            const auto& ids = mesh.triangles[touched.part & ~kBehind];
            for (int k = 0; k < touched.manifold.count; ++k) {
                const auto& point = touched.manifold.points[static_cast<std::size_t>(k)];
                const auto nearest =
                    closest_on_triangle<double>(point.position, mesh.vertices[ids[0]],
                                                mesh.vertices[ids[1]], mesh.vertices[ids[2]]);
                const double most = kMargin + 2 * kBias + std::abs(point.separation);
                EXPECT_LE((nearest.point - point.position).norm(), most);
                ++told;
            }
        }
    }
    EXPECT_GT(told, 1000);
}

// A ring's flat side under a slab a thousand times as wide, level but for a hair: what it bears is
// told where the ring is, and along the slab's normal.
TEST(MeshPairs, AWideSlabTouchesASmallMeshWhereTheMeshIs)
{
    const TriangleSoup soup = torus_mesh(0.05, 0.02, 17, 8);
    Shapes shapes;
    shapes.meshes = {build_mesh(soup.vertices, soup.triangles).mesh};
    const Vec3 half(200, 200, 0.03);
    shapes.boxes = {{half}};
    test::Dice dice(77);
    double top = 0;
    for (const Vec3& vertex : soup.vertices) top = std::max(top, vertex.z());
    for (int i = 0; i < 50; ++i) {
        const Vec3 axis = dice.turn() * Vec3::UnitX();
        const Quat lean(Eigen::AngleAxisd(i % 5 * 1e-7, Vec3(axis.x(), axis.y(), 0).normalized()));
        const Vec3 up = lean * Vec3::UnitZ();
        const double lowest = [&] {
            double least = -1;
            for (const Vec3& vertex : soup.vertices) least = std::max(least, up.dot(vertex));
            return least;
        }();
        ASSERT_NEAR(lowest, top, 1e-6);
        const Pose pose{(lowest + 1e-6 + half.z()) * up, lean};
        const auto found = touch_mesh(shapes, {ShapeKind::box, 0}, pose, 1e-5);
        int points = 0;
        for (const auto& touched : found) {
            const LocalManifold<double>& manifold = touched.manifold;
            points += manifold.count;
            EXPECT_NEAR((manifold.normal - up).norm(), 0, 1e-9);
            for (int k = 0; k < manifold.count; ++k) {
                const auto& point = manifold.points[static_cast<std::size_t>(k)];
                EXPECT_LT(point.position.norm(), 0.08);
                EXPECT_NEAR(point.separation, 1e-6, 1e-7);
            }
        }
        EXPECT_GE(points, 8);
    }
}

// A face that leans over a peak is before all triangles round it but those that it leans to, and no
// edge on the near side takes it for what lies deep behind.
TEST(MeshPairs, WhatLeansOverAPeakIsNoDeeperThanItLies)
{
    const double depth = 1e-3;
    RandomShapes random(41);
    int held = 0;
    for (int i = 0; i < 2000; ++i) {
        SCOPED_TRACE("seed 41, pose " + std::to_string(i));
        const TriangleSoup soup = [&] {
            TriangleSoup ground;
            for (int x = -1; x <= 1; ++x)
                for (int y = -1; y <= 1; ++y)
                    ground.vertices.emplace_back(10 * x, 10 * y,
                                                 x == 0 && y == 0 ? 0.5 : random.number(-1, 0.6));
            for (std::uint32_t x = 0; x < 2; ++x)
                for (std::uint32_t y = 0; y < 2; ++y) {
                    const std::uint32_t at = 3 * x + y;
                    ground.triangles.push_back({at, at + 3, at + 4});
                    ground.triangles.push_back({at, at + 4, at + 1});
                }
            return ground;
        }();
        Shapes shapes;
        shapes.meshes = {build_mesh(soup.vertices, soup.triangles).mesh};
        shapes.boxes = {{{random.number(0.5, 2), random.number(0.5, 2), random.number(0.5, 2)}}};
        const Vec3 up(random.number(-0.06, 0.06), random.number(-0.06, 0.06), 1);
        Pose pose{{random.number(-0.3, 0.3), random.number(-0.3, 0.3), 0},
                  turn_between(Vec3::UnitZ(), up)
                      * Quat(Eigen::AngleAxisd(random.number(-3, 3), Vec3::UnitZ()))};
        double low = 0, high = 5;
        while (high - low > 1e-9) {
            pose.position.z() = (low + high) / 2;
            const double apart =
                separation_from(shapes.meshes[0], shapes.boxes[0].half_extents, pose);
            (apart > -depth ? high : low) = pose.position.z();
        }
        double deepest_of_all = 0;
        for (const auto& one : touch_mesh(shapes, {ShapeKind::box, 0}, pose, 0.05))
            deepest_of_all = std::min(deepest_of_all, deepest(one.manifold));
        ASSERT_GE(deepest_of_all, -6 * depth);
        if (deepest_of_all < -0.9 * depth) ++held;
    }
    EXPECT_EQ(held, 2000);
}

TEST(MeshPairs, ABallCrossingAConvexRidgeIsHeldThroughout)
{
    // A roof along y: two slopes that meet at x = 0. The ball rolls over it at constant distance.
    Shapes shapes;
    shapes.spheres = {{0.5}};
    shapes.meshes = {
        build_mesh({{-4, -4, -2}, {0, -4, 0}, {0, 4, 0}, {-4, 4, -2}, {4, -4, -2}, {4, 4, -2}},
                   {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}})
            .mesh};
    for (int i = -1000; i <= 1000; ++i) {
        const double x = i * 1e-3;
        const double slope = std::sqrt(1.25), edge = 0.49 / slope * 0.5;
        const double z =
            std::abs(x) <= edge ? std::sqrt(0.49 * 0.49 - x * x) : 0.49 * slope - std::abs(x) / 2;
        const auto found = touch_mesh(shapes, {ShapeKind::sphere, 0}, at(x, 0.1, z), 0);
        ASSERT_FALSE(found.empty()) << x;
        for (const auto& one : found) ASSERT_NEAR(deepest(one.manifold), -0.01, 1e-6) << x;
    }
}

TEST(MeshPairs, ALyingCylinderShowsItsLowestLineAlone)
{
    // However far the margin sees: points up its side would brake it as it rolls.
    Shapes shapes;
    shapes.cylinders = {{0.4, 0.5}};
    shapes.meshes = {floor_of(8)};
    const double root = std::sqrt(0.5);
    for (const Quat& lying : {Quat(root, root, 0, 0), Quat(root, -root, 0, 0)})
        for (int i = 0; i < 200; ++i) {
            const double turned = 0.05 * i;
            Pose pose = at(0.01 * i - 1, 0.3, 0.39);
            pose.orientation = Quat(Eigen::AngleAxisd(turned, Vec3::UnitZ())) * lying
                * Quat(Eigen::AngleAxisd(0.1 * i, Vec3::UnitZ()));
            const auto found = touch_mesh(shapes, {ShapeKind::cylinder, 0}, pose, 0.4);
            ASSERT_FALSE(found.empty()) << i;
            for (const auto& one : found)
                for (int k = 0; k < one.manifold.count; ++k)
                    ASSERT_NEAR(one.manifold.points[static_cast<std::size_t>(k)].separation, -0.01,
                                1e-6)
                        << i;
        }
}

}  // namespace throng
