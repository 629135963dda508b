#include "narrowphase/convex/query_gjk.hpp"

#include "kernels/geometry/epa.hpp"
#include "kernels/geometry/separating_axes.hpp"
#include "tests/support/polytope_pairs.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

constexpr double kFar = 1e300;

MethodAnswer ask(const ConvexPair& pair, MethodStart start, double speculative_margin = kFar)
{
    MethodMemory memory;
    return query_gjk(pair, speculative_margin, start, memory);
}

// How far a point of a's frame lies outside a polytope of a frame placed there.
double outside(const PolytopeView& shape, const Vec3& local)
{
    double most = -kFar;
    for (std::size_t i = 0; i < shape.normals.size(); ++i)
        most = std::max(most, shape.normals[i].dot(local) - shape.offsets[i]);
    return most;
}

// Two points on the shapes as far apart as a plane between them shows room: no less, no more.
void expect_proven_distance(const ConvexPair& pair, const MethodAnswer& answer)
{
    const double small = 1e-9 * (pair.size() + pair.cores().b_position.norm());
    const PolytopePair& shapes = *pair.polytopes();
    EXPECT_NEAR(separation_along(pair.cores(), answer.normal), answer.separation, small);
    EXPECT_NEAR((answer.on_b - answer.on_a).norm(), answer.separation, small);
    EXPECT_LE(outside(shapes.a, answer.on_a), small);
    EXPECT_LE(outside(shapes.b, shapes.turn.transpose() * (answer.on_b - shapes.shift)), small);
}

void expect_agree(const MethodAnswer& one, const MethodAnswer& other, double small)
{
    EXPECT_EQ(one.overlap, other.overlap);
    EXPECT_NEAR(one.separation, other.separation, small);
}

void expect_right_on(const MeetingPairs& cases, const ConvexPair& pair)
{
    const double size = pair.size() + cases.b_in_a.position.norm();
    const MethodAnswer answer = ask(pair, MethodStart::cold);
    const PolytopePair& shapes = *pair.polytopes();
    const double clearance = polytope_separation(shapes.a, shapes.b, cases.b_in_a, nullptr);
    ASSERT_NEAR(answer.normal.norm(), 1, 1e-12);
    ASSERT_FALSE(answer.cut_short);
    if (std::abs(clearance) > 1e-9 * size) {
        ASSERT_EQ(answer.overlap, clearance > 0 ? OverlapState::apart : OverlapState::touching);
    }
    if (answer.overlap == OverlapState::apart) {
        expect_proven_distance(pair, answer);
        EXPECT_LE(answer.rounds, 128);
    } else {
        EXPECT_NEAR(answer.separation, clearance, 1e-9 * size);
        EXPECT_NEAR(separation_along(pair.cores(), answer.normal), clearance, 1e-9 * size);
    }
    expect_agree(ask(pair, MethodStart::plain), answer, 1e-12 * size);
}

// Twenty thousand pairs, a quarter of them at each of two other scales.
TEST(QueryGjk, RightOnPolytopesHoweverTheyMeet)
{
    for (const double scale : {1e-6, 1.0, 1e6}) {
        MeetingPairs cases(81, scale);
        const int pairs = scale == 1 ? 10000 : 5000;
        for (int i = 0; i < pairs && !testing::Test::HasFailure(); ++i) {
            SCOPED_TRACE("seed 81, scale " + std::to_string(scale) + ", pair " + std::to_string(i));
            cases.next();
            const ConvexPair pair(cases.shapes(), cases.a, cases.b, cases.b_in_a);
            expect_right_on(cases, pair);
        }
    }
}

TEST(QueryGjk, SwappedTheySayTheSame)
{
    MeetingPairs cases(82, 1);
    for (int i = 0; i < 2000; ++i) {
        SCOPED_TRACE("seed 82, pair " + std::to_string(i));
        cases.next();
        const ConvexPair pair(cases.shapes(), cases.a, cases.b, cases.b_in_a);
        const ConvexPair turned(cases.shapes(), cases.b, cases.a, inverse(cases.b_in_a));
        const double size = pair.size() + cases.b_in_a.position.norm();
        const MethodAnswer one = ask(pair, MethodStart::cold);
        const MethodAnswer other = ask(turned, MethodStart::cold);
        if (std::abs(one.separation) > 1e-12 * size) {
            ASSERT_EQ(one.overlap, other.overlap);
        }
        ASSERT_NEAR(one.separation, other.separation, 1e-12 * size);
        // Of a distance there is one direction, told the better the longer it is.
        if (one.separation > 1e-3 * size) {
            const Vec3 back = -(cases.b_in_a.orientation * other.normal);
            ASSERT_LT((one.normal - back).norm(), 1e-10);
        }
    }
}

// b as it drifts and turns past a, touching it on the way.
Pose passing(int step, double speed)
{
    const double t = speed * step;
    const Quat turn(Eigen::AngleAxisd(3 * t, Vec3(1, 2, 3).normalized()));
    return {Vec3(1.2 - t, 0.3 * std::sin(2 * t), 0.5 - 0.4 * t), turn};
}

TEST(QueryGjk, WhatIsRememberedChangesNothing)
{
    RandomShapes random(83);
    Shapes shapes;
    shapes.boxes = {{{0.4, 0.3, 0.5}}};
    shapes.spheres = {{0.4}};
    shapes.capsules = {{0.2, 0.4}};
    shapes.cylinders = {{0.3, 0.4}};
    shapes.hulls = {random.hull(10, 0.5), random.hull(60, 0.5), random.hull(1000, 0.5)};
    const std::vector<ShapeRef> all = {{ShapeKind::box, 0},     {ShapeKind::sphere, 0},
                                       {ShapeKind::capsule, 0}, {ShapeKind::cylinder, 0},
                                       {ShapeKind::hull, 0},    {ShapeKind::hull, 1},
                                       {ShapeKind::hull, 2}};
    for (const ShapeRef a : all) {
        for (const ShapeRef b : all) {
            SCOPED_TRACE(std::to_string(static_cast<int>(a.kind)) + " "
                         + std::to_string(static_cast<int>(b.kind)));
            const bool curved = a.kind == ShapeKind::cylinder || b.kind == ShapeKind::cylinder;
            MethodMemory memory;
            ConvexPair pair(shapes, a, b, passing(0, 0.02));
            for (int step = 0; step < 120; ++step) {
                pair.place(passing(step, 0.02));
                const MethodAnswer warm = query_gjk(pair, kFar, MethodStart::cached, memory);
                const MethodAnswer cold = ask(pair, MethodStart::cold);
                expect_agree(warm, cold, (curved ? 2e-6 : 1e-12) * pair.size());
                EXPECT_NEAR(cold.normal.norm(), 1, 1e-12);
                expect_agree(ask(pair, MethodStart::plain), cold, 1e-12 * pair.size());
            }
        }
    }
}

// Memory of another pair, or of a pose long past, is a bad start and no more.
TEST(QueryGjk, AWrongMemoryDoesNoHarm)
{
    MeetingPairs cases(84, 1);
    MethodMemory memory;
    for (int i = 0; i < 2000; ++i) {
        SCOPED_TRACE("seed 84, pair " + std::to_string(i));
        cases.next();
        const ConvexPair pair(cases.shapes(), cases.a, cases.b, cases.b_in_a);
        const double size = pair.size() + cases.b_in_a.position.norm();
        const MethodAnswer warm = query_gjk(pair, kFar, MethodStart::cached, memory);
        const MethodAnswer cold = ask(pair, MethodStart::cold);
        if (std::abs(cold.separation) > 1e-12 * size) {
            ASSERT_EQ(warm.overlap, cold.overlap);
        }
        ASSERT_NEAR(warm.separation, cold.separation, 1e-12 * size);
        ASSERT_LE(warm.rounds, 128);
    }
}

TEST(QueryGjk, BeyondTheMarginOneDirectionIsEnough)
{
    RandomShapes random(85);
    Shapes shapes;
    shapes.hulls = {random.hull(32, 0.5), random.hull(32, 0.5)};
    const ShapeRef a{ShapeKind::hull, 0}, b{ShapeKind::hull, 1};
    MethodMemory memory;
    ConvexPair pair(shapes, a, b, Pose{});
    int asked = 0;
    for (int step = 0; step < 200; ++step) {
        const double angle = 0.01 * step;
        pair.place({Vec3(1.3 * std::cos(angle), 1.3 * std::sin(angle), 0), random.turn()});
        const MethodAnswer exact = ask(pair, MethodStart::cold);
        const double speculative_margin = 0.5 * exact.separation;
        const MethodAnswer warm = query_gjk(pair, speculative_margin, MethodStart::cached, memory);
        ASSERT_EQ(warm.overlap, OverlapState::apart) << "seed 85, step " << step;
        ASSERT_GT(warm.separation, speculative_margin);
        ASSERT_LE(warm.separation, exact.separation + 1e-12);
        ASSERT_NEAR(separation_along(pair.cores(), warm.normal), warm.separation, 0.3);
        if (step > 0) asked += warm.rounds;
    }
    EXPECT_LE(asked, 2 * 199);
}

// What climbing takes of a warm question about two hulls that move slowly.
HillClimbingCount climbing_of(int points)
{
    RandomShapes random(88);
    Shapes shapes;
    shapes.hulls = {random.hull(points, 0.5), random.hull(points, 0.5)};
    ConvexPair pair(shapes, {ShapeKind::hull, 0}, {ShapeKind::hull, 1}, Pose{});
    MethodMemory memory;
    HillClimbingCount count;
    for (int step = 0; step < 1000; ++step) {
        const double t = 0.005 * step;
        const Quat turn(Eigen::AngleAxisd(t, Vec3(1, 2, 3).normalized()));
        pair.place({Vec3(1.2 * std::cos(t), 1.2 * std::sin(t), 0.1), turn});
        if (step == 1) count = {};
        query_gjk(pair, kFar, MethodStart::cached, memory, count);
    }
    return count;
}

TEST(QueryGjk, WarmQuestionsHardlyGrowWithTheHull)
{
    const auto mean = [](const HillClimbingCount& count) {
        return static_cast<double>(count.steps) / static_cast<double>(count.supports);
    };
    const HillClimbingCount few = climbing_of(32);
    for (const int points : {128, 1000, 10000}) {
        const HillClimbingCount many = climbing_of(points);
        EXPECT_LT(mean(many), 2 * mean(few)) << points;
        EXPECT_LT(mean(many), 3) << points;
        EXPECT_LT(many.looked, 3 * few.looked) << points;
    }
}

// Pairs that are apart, moved together along their normal until a hair is left, and a hair deep.
TEST(QueryGjk, AHairApartIsMeasuredAsWellAsAMeter)
{
    MeetingPairs cases(90, 1);
    int pairs = 0;
    for (int i = 0; i < 1500; ++i) {
        cases.next();
        ConvexPair pair(cases.shapes(), cases.a, cases.b, cases.b_in_a);
        const MethodAnswer apart = ask(pair, MethodStart::cold);
        if (apart.separation < 0.01) continue;
        ++pairs;
        for (const double clearance :
             {1e-4, 1e-6, 1e-8, 1e-10, 1e-12, -1e-12, -1e-10, -1e-7, -1e-4}) {
            SCOPED_TRACE("seed 90, pair " + std::to_string(i) + ", gap "
                         + std::to_string(clearance));
            Pose pose = cases.b_in_a;
            pose.position -= apart.normal * (apart.separation - clearance);
            pair.place(pose);
            const double small = 1e-14 * (pair.size() + cases.b_in_a.position.norm());
            const MethodAnswer answer = ask(pair, MethodStart::cold);
            ASSERT_EQ(answer.overlap, clearance > 0 ? OverlapState::apart : OverlapState::touching);
            const double shown = separation_along(pair.cores(), answer.normal);
            ASSERT_NEAR(shown, answer.separation, 100 * small);
            // One corner in another overlap by less than they were moved.
            if (clearance > 0) {
                ASSERT_NEAR(answer.separation, clearance, small);
            } else {
                ASSERT_GE(answer.separation, clearance - small);
            }
        }
    }
    EXPECT_GT(pairs, 300);
}

// Apart by rounding alone, where the walk has come to an end and EPA tells the depth: 0 lies beside
// the face that it found.
TEST(QueryGjk, PointsFaceOneAnotherWhereTheSeparationIsRounding)
{
    const std::array<Vec3, 8> corners = {
        Vec3(-0.671875, 0.8828125, -0.15625),   Vec3(-0.3984375, -0.9453125, 0.703125),
        Vec3(-0.984375, -0.96875, -0.515625),   Vec3(-0.6484375, -0.1328125, -0.515625),
        Vec3(-0.484375, 0.8828125, -0.9296875), Vec3(0.75, 0.1015625, -0.03125),
        Vec3(0.796875, -0.2578125, -0.8046875), Vec3(0.15625, 0.15625, 0.15625)};
    Shapes shapes;
    shapes.hulls = {build_hull(corners).hull};
    shapes.boxes = {{Vec3::Constant(0.328125)}};
    const Pose pose{Vec3(-0.18683567890075287, 1.2109375000000016, -0.26605536016402509),
                    Quat(0.97106399791693887, 0, 0.23881941284068869, 0)};
    const ConvexPair pair(shapes, {ShapeKind::hull, 0}, {ShapeKind::box, 0}, pose);
    for (const MethodStart start : {MethodStart::cold, MethodStart::plain}) {
        const MethodAnswer answer = ask(pair, start);
        EXPECT_NEAR(answer.separation, 0, 1e-14);
        const Vec3 between = answer.on_b - answer.on_a;
        EXPECT_NEAR((between - answer.normal * answer.separation).norm(), 0, 1e-13);
    }
}

// Round cores have no corners that tell where the points are.
TEST(QueryGjk, PointsOfDrumsAHairApartFaceOneAnother)
{
    RandomShapes random(88);
    Shapes shapes;
    shapes.cylinders = {{0.01, 0.01}, {0.3, 0.2}};
    for (int i = 0; i < 2000; ++i) {
        SCOPED_TRACE("seed 88, pair " + std::to_string(i));
        const std::uint32_t other = i % 2 == 0 ? 0 : 1;
        const double both = 0.01 + shapes.cylinders[other].half_length;
        const double off = std::pow(10, random.number(-7, -3));
        const Quat turn(Eigen::AngleAxisd(random.number(-3, 3), Vec3::UnitZ()));
        const double clearance = random.number(-1, 1) * 1e-14;
        const Pose pose{Vec3(off, random.number(-1, 1) * off, both + clearance), turn};
        const ConvexPair pair(shapes, {ShapeKind::cylinder, 0}, {ShapeKind::cylinder, other}, pose);
        for (const MethodStart start : {MethodStart::plain, MethodStart::cold}) {
            const MethodAnswer answer = ask(pair, start);
            const Vec3 along = answer.normal * answer.separation;
            ASSERT_LE((answer.on_b - answer.on_a - along).norm(), 1e-12 * both);
        }
    }
}

// The gain from the last corner to the edge behind it is below rounding, the turn is not.
TEST(QueryGjk, TheNormalIsSquareToAnEdgeThatHardlyHelps)
{
    Shapes shapes;
    shapes.boxes = {{Vec3::Constant(0.001)}, {Vec3::Constant(1)}};
    const Pose pose{
        Vec3(2.9795390624997022, 1.0010000000003014, 2.9795390625000002),
        Quat(-1.9531252886751343e-09, 2.8867513515863157e-16, -2.8867513403099435e-16, 1)};
    const ConvexPair pair(shapes, {ShapeKind::box, 0}, {ShapeKind::box, 1}, pose);
    for (const MethodStart start : {MethodStart::cold, MethodStart::plain}) {
        const MethodAnswer answer = ask(pair, start);
        EXPECT_NEAR(separation_along(pair.cores(), answer.normal), answer.separation, 1e-11);
        EXPECT_NEAR((answer.on_b - answer.on_a).norm(), answer.separation, 1e-14);
    }
}

// A million times longer than thick, and against SAT's exhaustive search.
TEST(QueryGjk, NeedlesAndPlatesAreRight)
{
    RandomShapes random(89);
    Shapes shapes;
    shapes.boxes = {{Vec3::Constant(0.5)}, {{1000, 0.0005, 0.0005}}, {{500, 500, 0.0005}}};
    for (int i = 0; i < 2000; ++i) {
        SCOPED_TRACE("seed 89, pair " + std::to_string(i));
        const Quat turn = random.turn();
        const Vec3 shift = turn * Vec3(200 * random.number(-1, 1), 0, random.number(-1.2, 1.2));
        const ConvexPair pair(shapes, {ShapeKind::box, 0}, {ShapeKind::box, i % 2 == 0 ? 1u : 2u},
                              {shift, turn});
        const double small = 1e-11 * pair.size();
        const MethodAnswer answer = ask(pair, MethodStart::cold);
        const PolytopePair& two = *pair.polytopes();
        const double clearance = polytope_separation(two.a, two.b, {shift, turn}, nullptr);
        if (std::abs(clearance) > small) {
            ASSERT_EQ(answer.overlap, clearance > 0 ? OverlapState::apart : OverlapState::touching);
        }
        if (answer.overlap == OverlapState::apart) {
            ASSERT_NEAR(separation_along(pair.cores(), answer.normal), answer.separation, small);
        } else {
            ASSERT_NEAR(answer.separation, clearance, small);
        }
    }
}

TEST(QueryGjk, BoxesOfNoThicknessGiveFiniteAnswers)
{
    MethodMemory memory;
    for (const Vec3& half : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0)}) {
        for (const Vec3& other : {Vec3(0, 0, 0), Vec3(0, 2, 0), Vec3(0, 1, 1), Vec3(1, 1, 0)}) {
            for (const Vec3& shift : {Vec3(0, 0, 0), Vec3(0, 0, 1e-12), Vec3(0.5, 0.5, 0.5)}) {
                const Shapes shapes = two_boxes(half, other);
                const ConvexPair pair(shapes, kBoxA, kBoxB, {shift, Quat::Identity()});
                for (const MethodStart start :
                     {MethodStart::plain, MethodStart::cold, MethodStart::cached}) {
                    const MethodAnswer answer = query_gjk(pair, kFar, start, memory);
                    EXPECT_TRUE(std::isfinite(answer.separation));
                    EXPECT_NEAR(answer.normal.norm(), 1, 1e-12);
                    EXPECT_NEAR(answer.separation, separation_along(pair.cores(), answer.normal),
                                1e-12);
                }
            }
        }
    }
}

// Radii are taken off exactly: balls and rods against their own formulas.
TEST(QueryGjk, RoundShapesAreExact)
{
    RandomShapes random(86);
    for (const double scale : {1e-6, 1.0, 1e6}) {
        Shapes shapes;
        shapes.spheres = {{0.4 * scale}, {0.3 * scale}};
        shapes.boxes = {{Vec3(0.5, 0.4, 0.3) * scale}};
        const ShapeRef ball{ShapeKind::sphere, 0}, other{ShapeKind::sphere, 1};
        const ShapeRef box{ShapeKind::box, 0};
        for (int i = 0; i < 300; ++i) {
            SCOPED_TRACE("seed 86, pair " + std::to_string(i));
            Pose pose = random.pose(0.8);
            pose.position *= scale;
            const ConvexPair balls(shapes, ball, other, pose);
            const MethodAnswer of_balls = ask(balls, MethodStart::cold);
            ASSERT_NEAR(of_balls.separation, pose.position.norm() - 0.7 * scale, 1e-14 * scale);
            ASSERT_LT(
                (of_balls.on_b - of_balls.on_a - of_balls.normal * of_balls.separation).norm(),
                1e-14 * scale);

            // A ball against a box: outside by the box's nearest point, inside by the nearest face.
            const ConvexPair pair(shapes, box, ball, pose);
            const Vec3 half = shapes.boxes[0].half_extents;
            const Vec3 beyond = pose.position.cwiseAbs() - half;
            const double truth =
                beyond.maxCoeff() > 0 ? beyond.cwiseMax(0.0).norm() : beyond.maxCoeff();
            ASSERT_NEAR(ask(pair, MethodStart::cold).separation, truth - 0.4 * scale,
                        1e-13 * scale);
        }
    }
}

// Cores that have no volume, one on the other: the radii are the depth, whatever the direction.
TEST(QueryGjk, CoresThatCrossAreAsDeepAsTheirRadii)
{
    Shapes shapes;
    shapes.spheres = {{0.3}};
    shapes.capsules = {{0.2, 0.5}};
    const ShapeRef ball{ShapeKind::sphere, 0}, rod{ShapeKind::capsule, 0};
    for (const double angle : {0.0, 1e-9, 0.3, 1.5}) {
        const Pose pose{Vec3::Zero(), Quat(Eigen::AngleAxisd(angle, Vec3::UnitX()))};
        for (const auto& [a, b, depth] :
             {std::tuple(ball, ball, 0.6), std::tuple(ball, rod, 0.5), std::tuple(rod, rod, 0.4)}) {
            const ConvexPair pair(shapes, a, b, pose);
            const MethodAnswer answer = ask(pair, MethodStart::cold);
            EXPECT_EQ(answer.overlap, OverlapState::touching);
            EXPECT_NEAR(answer.separation, -depth, 1e-12);
            EXPECT_NEAR(answer.normal.norm(), 1, 1e-12);
        }
    }
}

// However much longer one is than the other, so that their differences are all but a line.
TEST(QueryGjk, RodsOfAnyLengthsThatCrossAreAsDeepAsTheirRadii)
{
    RandomShapes random(87);
    for (int i = 0; i < 5000; ++i) {
        SCOPED_TRACE("seed 87, pair " + std::to_string(i));
        Shapes shapes;
        for (const double radius : {0.1, 0.05})
            shapes.capsules.push_back({radius, std::pow(10, random.number(-6, 0))});
        const Pose pose{Vec3::Zero(), random.turn()};
        const ConvexPair pair(shapes, {ShapeKind::capsule, 0}, {ShapeKind::capsule, 1}, pose);
        ASSERT_LE(std::abs(epa(pair.cores()).depth), 1e-13 * pair.size());
        for (const MethodStart start : {MethodStart::plain, MethodStart::cold})
            ASSERT_NEAR(ask(pair, start).separation, -0.15, 1e-13 * pair.size());
    }
}

// Drums against boxes, swept by brute force over directions.
TEST(QueryGjk, CylindersAgreeWithDirectionSweep)
{
    RandomShapes random(87);
    Shapes shapes;
    shapes.cylinders = {{0.4, 0.3}};
    shapes.boxes = {{{0.3, 0.5, 0.2}}};
    const ShapeRef drum{ShapeKind::cylinder, 0}, box{ShapeKind::box, 0};
    for (int i = 0; i < 60; ++i) {
        SCOPED_TRACE("seed 87, pair " + std::to_string(i));
        const ConvexPair pair(shapes, drum, box, random.pose(0.8));
        const ConvexCorePair& cores = pair.cores();
        const double swept = sweep_directions(
            [&](const Vec3& n) { return n.dot(support<double>(cores.a, n).position); },
            [&](const Vec3& n) {
                return n.dot(cores.b_position)
                    + n.dot(cores.b_turn
                            * support<double>(cores.b, cores.b_turn.transpose() * n).position);
            },
            24, nullptr);
        const MethodAnswer answer = ask(pair, MethodStart::cold);
        EXPECT_GE(answer.separation, swept - 2e-6);
        EXPECT_LE(answer.separation, swept + 2e-3);
        EXPECT_NEAR(separation_along(cores, answer.normal), answer.separation, 2e-6);
    }
}

}  // namespace
}  // namespace throng
