#include "cost/hard_cases/broken_pairs.hpp"
#include "kernels/geometry/separating_axes.hpp"
#include "kernels/math/rotation.hpp"
#include "narrowphase/dispatch.hpp"
#include "narrowphase/manifold/contact_points.hpp"
#include "tests/support/polyhedra.hpp"

#include <gtest/gtest.h>

#include <random>

namespace throng {
namespace {

constexpr ShapeRef kHullA{ShapeKind::hull, 0}, kHullB{ShapeKind::hull, 1};

double bias_of(const Hull& a, const Hull& b) { return 1e-3 * (a.inner_radius + b.inner_radius); }

}  // namespace

TEST(HullHull, AgreesWithDirectionSweep)
{
    RandomShapes random(21);
    for (int i = 0; i < 40; ++i) {
        SCOPED_TRACE("seed 21, pair " + std::to_string(i));
        Shapes shapes;
        shapes.hulls = {random.hull(24, 0.5), random.hull(8 + i, 0.6)};
        const Pose pose = random.pose(0.5);
        const double swept =
            sweep_directions(extent_of(shapes.hulls[0].vertices, Pose{}),
                             extent_of(shapes.hulls[1].vertices, pose), 16, nullptr);
        const auto found = run<double>(hull_hull<double>, shapes, kHullA, kHullB, pose, 0);
        ASSERT_EQ(found.count > 0, swept <= 0);
        if (swept > 0) continue;
        const double bias = bias_of(shapes.hulls[0], shapes.hulls[1]);
        EXPECT_GE(deepest(found), swept - 2 * bias - 1e-9);
        EXPECT_LE(deepest(found), swept + 2 * bias + 1e-9);
    }
}

TEST(HullHull, AgreesWithEveryAxis)
{
    RandomShapes random(22);
    Shapes shapes;
    shapes.hulls.resize(2);
    for (int i = 0; i < 600; ++i) {
        SCOPED_TRACE("seed 22, pair " + std::to_string(i));
        shapes.hulls[0] = random.hull(6 + i % 60, 0.5);
        shapes.hulls[1] = random.hull(6 + i % 43, 0.5);
        const Pose pose = random.pose(0.6);
        const double exact =
            polytope_separation(view_of(shapes.hulls[0]), view_of(shapes.hulls[1]), pose, nullptr);
        const auto found = run<double>(hull_hull<double>, shapes, kHullA, kHullB, pose, 0);
        const auto rounded = run<float>(hull_hull<float>, shapes, kHullA, kHullB, pose, 0);
        ASSERT_TRUE(all_finite(found) && features_differ(found));
        ASSERT_EQ(found.count > 0, exact <= 0);
        if (exact > 0) continue;
        const double bias = bias_of(shapes.hulls[0], shapes.hulls[1]);
        ASSERT_GE(deepest(found), exact - 2 * bias - 1e-9);
        ASSERT_LE(deepest(found), exact + 2 * bias + 1e-9);
        if (exact > -1e-5) continue;
        ASSERT_NEAR(deepest(rounded), exact, 2 * bias + 1e-5);
    }
}

// Beyond some hundred vertices GJK tells where to look, and axes tell the rest.
TEST(HullHull, LargeHullsAgreeWithEveryAxis)
{
    RandomShapes random(27);
    Shapes shapes;
    shapes.boxes = {{{0.4, 0.3, 0.35}}};
    int touched = 0;
    for (int i = 0; i < 150; ++i) {
        SCOPED_TRACE("seed 27, pair " + std::to_string(i));
        const ShapeRef a = i % 5 == 0 ? kBoxA : kHullA;
        shapes.hulls = {random.hull(96 + i % 60, 0.5), random.hull(190 + i % 43, 0.5)};
        const Pose pose = random.pose(0.9);
        const PolytopeShape shape_a(shapes, a);
        const double exact =
            polytope_separation(shape_a.view(), view_of(shapes.hulls[1]), pose, nullptr);
        const double inner = shape_a.view().inner_radius + shapes.hulls[1].inner_radius;
        const auto found = run<double>(hull_hull<double>, shapes, a, kHullB, pose, 0);
        const auto rounded = run<float>(hull_hull<float>, shapes, a, kHullB, pose, 0);
        ASSERT_TRUE(all_finite(found) && features_differ(found));
        ASSERT_EQ(found.count > 0, exact <= 0);
        if (exact > 0) continue;
        ++touched;
        ASSERT_NEAR(deepest(found), exact, 2e-3 * inner + 1e-9);
        if (exact > -1e-5) continue;
        ASSERT_NEAR(deepest(rounded), exact, 2e-3 * inner + 1e-5);
    }
    EXPECT_GT(touched, 30);
}

// Where they touch as bodies at rest do, GJK leads to the very points that all axes lead to.
TEST(HullHull, LargeHullsTouchWhereAllAxesSayWhateverTheyRemember)
{
    RandomShapes random(28);
    Shapes shapes;
    shapes.hulls = {random.hull(120, 0.5), random.hull(150, 0.5)};
    int same = 0, steps = 0;
    for (int i = 0; i < 60; ++i) {
        Pose pose = random.pose(0.8);
        Vec3 normal;
        const double clearance =
            polytope_separation(view_of(shapes.hulls[0]), view_of(shapes.hulls[1]), pose, &normal);
        pose.position -= normal * clearance;
        PairCache searched, looked;
        for (int step = 0; step < 10; ++step, ++steps) {
            pose.position += random.vector(-0.003, 0.003);
            LocalManifold<double> warm, by_axes;
            const auto cold = run<double>(hull_hull<double>, shapes, kHullA, kHullB, pose, 0.02);
            hull_hull<double>({shapes, kHullA, kHullB, pose, 0.02}, searched, warm);
            hull_hull_by_axes({shapes, kHullA, kHullB, pose, 0.02}, looked, by_axes);
            ASSERT_EQ(searched.kind & kFellBack, 0U);
            for (const auto& found : {cold, warm}) {
                bool agrees = found.count == by_axes.count;
                for (int k = 0; agrees && k < found.count; ++k) {
                    const auto at = static_cast<std::size_t>(k);
                    agrees = found.points[at].feature == by_axes.points[at].feature
                        && found.points[at].separation == by_axes.points[at].separation;
                }
                same += agrees;
            }
        }
    }
    // All but those apart whose corners are further from one another than any axis shows.
    EXPECT_GE(same, 2 * steps * 98 / 100);
}

TEST(HullHull, ABoxIsAHull)
{
    RandomShapes random(23);
    for (int i = 0; i < 2000; ++i) {
        SCOPED_TRACE("seed 23, pair " + std::to_string(i));
        const Vec3 half_a = random.vector(0.2, 1), half_b = random.vector(0.2, 1);
        const Shapes shapes = two_boxes(half_a, half_b);
        const Pose pose = random.pose(0.9);
        const auto one = run<double>(box_box<double>, shapes, kBoxA, kBoxB, pose, 0);
        const auto two = run<double>(hull_hull<double>, shapes, kBoxA, kBoxB, pose, 0);
        ASSERT_EQ(one.count, two.count);
        if (one.count == 0) continue;
        ASSERT_LT((one.normal - two.normal).norm(), 1e-9);
        // Of more than four corners each keeps its own four.
        ASSERT_NEAR(deepest(one), deepest(two),
                    one.count < 4 ? 1e-12 : kDrawn<double> * (half_a + half_b).norm());
    }
}

TEST(HullHull, AnswersPairsThatBrokeOthers)
{
    for (const BrokenPair& pair : broken_pairs()) {
        SCOPED_TRACE(pair.name);
        Shapes shapes = two_boxes(pair.a.size / 2, pair.b.size / 2);
        shapes.hulls = {build_hull(corners_of(pair.a.size / 2)).hull,
                        build_hull(corners_of(pair.b.size / 2)).hull};
        const Pose pose = inverse(pair.a.pose) * pair.b.pose;
        const double size = std::max(pair.a.size.maxCoeff(), pair.b.size.maxCoeff());
        const double bias = bias_of(shapes.hulls[0], shapes.hulls[1]);
        for (const ShapeRef a : {kBoxA, kHullA}) {
            const auto found = run<double>(hull_hull<double>, shapes, a, kHullB, pose, 1e-9 * size);
            ASSERT_TRUE(all_finite(found));
            ASSERT_EQ(found.count > 0, pair.separation < 2e-9 * size);
            if (found.count == 0) continue;
            const double expected = std::min(pair.separation, 1e-9 * size);
            EXPECT_GE(deepest(found), expected - 2 * bias - 1e-9 * size);
            EXPECT_LE(deepest(found), expected + 2 * bias + 1e-9 * size);
        }
    }
}

TEST(HullHull, RememberingNeverChangesTheAnswer)
{
    RandomShapes random(24);
    Shapes shapes;
    shapes.hulls = {random.hull(24, 0.5), random.hull(60, 0.5)};
    for (int i = 0; i < 100; ++i) {
        Pose pose = random.pose(0.8);
        PairCache cache;
        for (int step = 0; step < 10; ++step) {
            pose.position += random.vector(-0.05, 0.05);
            LocalManifold<double> warm;
            const auto cold = run<double>(hull_hull<double>, shapes, kHullA, kHullB, pose, 0.02);
            hull_hull<double>({shapes, kHullA, kHullB, pose, 0.02}, cache, warm);
            ASSERT_EQ(warm.count, cold.count) << "seed 24, pair " << i;
            for (int k = 0; k < warm.count; ++k) {
                const auto at = static_cast<std::size_t>(k);
                ASSERT_EQ(warm.points[at].feature, cold.points[at].feature);
                ASSERT_EQ(warm.points[at].separation, cold.points[at].separation);
            }
        }
    }
}

TEST(HullHull, ClimbingFindsTheFurthestVertex)
{
    RandomShapes random(25);
    const Hull hull = random.hull(3000, 0.5);
    const PolytopeView view = view_of(hull);
    for (int i = 0; i < 500; ++i) {
        const Vec3 direction = random.vector(-1, 1);
        double most = -1;
        for (const Vec3& vertex : hull.vertices) most = std::max(most, direction.dot(vertex));
        const auto start =
            static_cast<std::uint16_t>(static_cast<std::size_t>(i) % hull.vertices.size());
        const std::uint16_t found = support_vertex(view, direction, start);
        ASSERT_EQ(direction.dot(hull.vertices[found]), most) << "seed 25, direction " << i;
    }
}

TEST(HullHull, ManyCorneredFacesKeepFourSpreadPoints)
{
    // A drum with 200 corners on each cap, made by stepping round a circle.
    std::vector<Vec3> points;
    Eigen::Vector2d at(0.5, 0);
    const double c = 1 - 2 * 0.0157073173 * 0.0157073173, s = std::sqrt(1 - c * c);
    for (int i = 0; i < 200; ++i) {
        points.emplace_back(at.x(), at.y(), -0.1);
        points.emplace_back(at.x(), at.y(), 0.1);
        at = {c * at.x() - s * at.y(), s * at.x() + c * at.y()};
    }
    Shapes shapes;
    shapes.hulls = {build_hull(points).hull, build_hull(points).hull};
    const auto found = run<double>(hull_hull<double>, shapes, kHullA, kHullB,
                                   {{0.05, 0, 0.199}, Quat::Identity()}, 0);
    ASSERT_EQ(found.count, 4);
    EXPECT_NEAR(deepest(found), -0.001, 1e-6);
    Vec3 low = Vec3::Constant(1), high = Vec3::Constant(-1);
    for (const auto& point : found.points) {
        low = low.cwiseMin(point.position);
        high = high.cwiseMax(point.position);
    }
    EXPECT_GT((high - low).head<2>().minCoeff(), 0.6);
}

// Not all corners of so round a face are looked at, but the deepest is.
TEST(HullHull, ADrumTippedOverIsAsDeepAsItsLowestCorner)
{
    std::vector<Vec3> rim;
    for (int i = 0; i < 120; ++i) {
        const SinCos turn = sin_cos(i * 0.052359877559829887);
        for (const double z : {-0.2, 0.2}) rim.emplace_back(turn.cos, turn.sin, z);
    }
    Shapes shapes;
    shapes.hulls = {build_hull(corners_of({3, 3, 0.2})).hull, build_hull(rim).hull};
    const double bias = bias_of(shapes.hulls[0], shapes.hulls[1]);
    for (int i = 0; i < 12; ++i) {
        const Quat tip = exponential(Vec3(0.35, 0, 0)), roll = exponential(Vec3(0, 0, 0.02 * i));
        const Pose pose{{0.1, 0.2, 0.7}, tip * roll};
        const double exact =
            polytope_separation(view_of(shapes.hulls[0]), view_of(shapes.hulls[1]), pose, nullptr);
        const auto found = run<double>(hull_hull<double>, shapes, kHullA, kHullB, pose, 0);
        ASSERT_NEAR(deepest(found), exact, bias + 1e-9) << "roll " << i;
    }
}

// a's face leads by the bias alone, and nothing of b's face lies over it.
TEST(HullHull, WhatIsDeepHasContactsThoughTheLeadingFaceHasNothingOverIt)
{
    const Vec3 a[] = {{1, 0.5, 0.5},  {0.5, -1, -1}, {-1, -1, -1},  {-0.5, 1, 0.5},  {-0.5, 0, -1},
                      {1, 0, 1},      {1, 0, -1},    {0, 1, 0.5},   {-1, -0.5, 1},   {0.5, 0.5, 1},
                      {0.5, -1, 0.5}, {1, -1, -1},   {-0.5, -1, 0}, {-1, -0.5, 0.5}, {-1, 1, -0.5}};
    const Vec3 b[] = {{-0.99981689453125, -0.875, -1},
                      {-0.99859619140625, 0.0262451171875, 0.50909423828125},
                      {-0.88983154296875, -0.861419677734375, 0.835723876953125},
                      {-0.749969482421875, -0.96875, -0.9920654296875},
                      {-0.979400634765625, -0.068939208984375, 0.5716552734375},
                      {0.585357666015625, 0.602874755859375, 0.679656982421875},
                      {0.9951171875, -0.25, -0.917510986328125},
                      {0.124053955078125, -0.9920654296875, -0.984344482421875},
                      {-0.43011474609375, 0.68170166015625, -0.398162841796875},
                      {0.757904052734375, -0.976470947265625, -0.96856689453125},
                      {-0.9375, -1, -0.99993896484375},
                      {-0.522491455078125, 0.304412841796875, -0.561614990234375},
                      {-0.41448974609375, 0.400848388671875, -0.47625732421875},
                      {-0.999969482421875, -0.88671875, -0.151702880859375},
                      {-0.9998779296875, -0.98712158203125, 0.93133544921875},
                      {-0.769561767578125, -1, -0.95263671875},
                      {-1, -1, -0.968658447265625},
                      {-0.0078125, -0.99981689453125, -0.875},
                      {-0.038970947265625, -0.976470947265625, -0.999908447265625},
                      {-0.9921875, -0.9842529296875, -1},
                      {-0.999969482421875, -0.999969482421875, -0.976531982421875}};
    Shapes shapes;
    shapes.hulls = {build_hull(a).hull, build_hull(b).hull};
    const ShapeRef hull_a{ShapeKind::hull, 0}, hull_b{ShapeKind::hull, 1};
    const Vec3 offset(1.4273090760989557, -0.53942442021032644, -0.9033355310769744);
    const double depth = penetration_depth(shapes, hull_a, hull_b, {offset, Quat::Identity()});
    ASSERT_NEAR(depth, 0.572, 1e-3);
    PairCache cache, wide_cache;
    LocalManifold<double> exact;
    LocalManifold<float> wide;
    hull_hull<double>({shapes, hull_a, hull_b, {offset, Quat::Identity()}, 0.5}, cache, exact);
    hull_hull<float>(
        {shapes, hull_a, hull_b, {offset.cast<float>(), QuatT<float>::Identity()}, 0.5F},
        wide_cache, wide);
    ASSERT_GT(exact.count, 0);
    ASSERT_GT(wide.count, 0);
    double deepest = 0, wide_deepest = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(exact.count); ++i)
        deepest = std::min(deepest, exact.points[i].separation);
    for (std::size_t i = 0; i < static_cast<std::size_t>(wide.count); ++i)
        wide_deepest = std::min(wide_deepest, double{wide.points[i].separation});
    EXPECT_NEAR(deepest, -depth, 2e-3);
    EXPECT_NEAR(wide_deepest, -depth, 2e-3);
}

// A face of the box leads by the bias alone, has nothing over it, and the two touch by less than
// that.
TEST(HullHull, WhatIsShallowHasContactsThoughTheLeadingFaceHasNothingOverIt)
{
    const Vec3 corners[] = {
        {-0.28052199141686424, 0.49769798622488259, 0.41012989709939757},
        {0.14001979770448741, -0.046229106655567495, 0.75608902371184095},
        {0.43813819073972937, -0.015921059027056959, -0.62535946546216081},
        {0.37545951316184223, 0.56620549740761328, 0.029999964635480096},
        {-0.062325513202153626, 0.61124413319938264, -0.27027507540668888},
        {-0.19556936915570233, 0.22943592188749581, 0.69411444638032771},
        {-0.12706314291983165, -0.22296500137684619, -0.71368729525960994},
        {-0.48355529610167575, 0.48613145188421586, 0.13818140234550677},
        {-0.60883369749069427, 0.21672901129278618, -0.36919190081119346},
        {-0.038363438285676614, -0.46007659098175874, -0.54797280531094805},
    };
    Shapes shapes;
    shapes.hulls = {build_hull(corners).hull};
    shapes.boxes = {{Vec3(0.93383758928053862, 0.36127158423582229, 0.30898756252401383)}};
    const ShapeRef hull{ShapeKind::hull, 0}, box{ShapeKind::box, 0};
    const Pose box_in_hull{
        Vec3(-0.77387397471998487, -0.31954754913078809, 0.013452337956385563),
        Quat(-0.85737060985470459, -0.14616900883047421, 0.47257611031603886, -0.1422043535671523)};
    const double depth = penetration_depth(shapes, hull, box, box_in_hull);
    ASSERT_NEAR(depth, 3.28e-4, 1e-6);
    PairCache cache, wide_cache;
    LocalManifold<double> exact;
    LocalManifold<float> wide;
    collide<double>({shapes, hull, box, box_in_hull, 0}, cache, exact);
    collide<float>({shapes,
                    hull,
                    box,
                    {box_in_hull.position.cast<float>(), box_in_hull.orientation.cast<float>()},
                    0},
                   wide_cache, wide);
    ASSERT_GT(exact.count, 0);
    ASSERT_GT(wide.count, 0);
    // What takes its place does not push.
    const double bias = 1e-3 * (shapes.hulls[0].inner_radius + 0.30898756252401383);
    EXPECT_NEAR(deepest(exact), 4 * bias - depth, 1e-9);
    EXPECT_NEAR(deepest(wide), 4 * bias - depth, 1e-6);
}

// Corners that stray a little from their faces lead nobody to think that edges part what is deep.
TEST(HullHull, WhatIsDeepHasContactsHoweverUnevenTheFaces)
{
    std::mt19937 random(11);
    std::uniform_int_distribution<int> place(-2, 2), count(12, 34);
    std::uniform_real_distribution<double> noise(-1e-6, 1e-6), offset(-1, 1);
    const auto cloud = [&](double stray) {
        std::vector<Vec3> points(static_cast<std::size_t>(count(random)));
        for (Vec3& point : points)
            for (int k = 0; k < 3; ++k)
                point[k] = 0.5 * place(random) + stray * 1e6 * noise(random);
        return points;
    };
    int deep = 0;
    for (int i = 0; i < 3000; ++i) {
        Shapes shapes;
        shapes.hulls = {build_hull(cloud(0)).hull, build_hull(cloud(1e-6)).hull};
        if (shapes.hulls[0].vertices.empty() || shapes.hulls[1].vertices.empty()) continue;
        const ShapeRef a{ShapeKind::hull, 0}, b{ShapeKind::hull, 1};
        const Pose pose{{offset(random), offset(random), offset(random)}, Quat::Identity()};
        if (penetration_depth(shapes, a, b, pose) < 1e-2) continue;
        ++deep;
        PairCache cache, wide_cache;
        LocalManifold<double> exact;
        LocalManifold<float> wide;
        hull_hull<double>({shapes, a, b, pose, 0.4}, cache, exact);
        hull_hull<float>(
            {shapes, a, b, {pose.position.cast<float>(), QuatT<float>::Identity()}, 0.4F},
            wide_cache, wide);
        EXPECT_GT(exact.count, 0) << i;
        EXPECT_GT(wide.count, 0) << i;
    }
    EXPECT_GT(deep, 1000);
}

}  // namespace throng
