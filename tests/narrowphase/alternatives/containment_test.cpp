#include "narrowphase/alternatives/containment.hpp"

#include "tests/support/polytope_pairs.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

constexpr double kQuarter = 1.5707963267948966;

OverlapState ask(const ConvexPair& pair, MethodStart start, MethodMemory& memory)
{
    const MethodAnswer answer = query_containment(pair, 1e30, start, memory);
    EXPECT_FALSE(answer.cut_short);
    return answer.overlap;
}

// Whether nearly flat faces, of which planes are all that counts, have no say either.
bool is_clear_of_planes(const Shapes& shapes, const PolytopeCase& pair, double scale)
{
    const PolytopeShape a(shapes, pair.a), b(shapes, pair.b);
    const double stray = stray_of(a.view()) + stray_of(b.view());
    return is_clear(pair, scale)
        && (stray < 1e-12 * scale || std::abs(pair.clearance) > 1e-4 * scale);
}

// Cold, and again from what that left behind.
void expect_walked(const ConvexPair& pair, OverlapState truth)
{
    MethodMemory memory;
    ASSERT_EQ(ask(pair, MethodStart::cold, memory), truth);
    ASSERT_EQ(ask(pair, MethodStart::cached, memory), truth);
}

// All starts, both ways round.
void expect_touch(
    const Shapes& shapes, ShapeRef a, ShapeRef b, const Pose& pose, OverlapState truth)
{
    const ConvexPair pair(shapes, a, b, pose), swapped(shapes, b, a, inverse(pose));
    MethodMemory memory;
    ASSERT_EQ(ask(pair, MethodStart::plain, memory), truth);
    ASSERT_NO_FATAL_FAILURE(expect_walked(pair, truth));
    ASSERT_NO_FATAL_FAILURE(expect_walked(swapped, truth));
}

// How many corners the two share, by every vertex and edge against every face.
std::size_t corners_of_one_side(const PolytopePair& pair)
{
    const auto height = [&](std::size_t face, std::size_t vertex) {
        const Vec3 point = pair.turn * pair.b.vertices[vertex] + pair.shift;
        return pair.a.normals[face].dot(point) - pair.a.offsets[face];
    };
    const std::size_t faces = pair.a.normals.size();
    std::size_t count = 0;
    for (std::size_t vertex = 0; vertex < pair.b.vertices.size(); ++vertex) {
        bool inside = true;
        for (std::size_t face = 0; face < faces; ++face) inside &= height(face, vertex) <= 0;
        count += inside;
    }
    for (const Hull::Edge& edge : pair.b.edges) {
        double from = 0, to = 1;
        for (std::size_t face = 0; face < faces; ++face) {
            const double here = height(face, edge.from), there = height(face, edge.to);
            if (here > 0 && there > 0)
                from = 2;
            else if (here > 0)
                from = std::max(from, here / (here - there));
            else if (there > 0)
                to = std::min(to, here / (here - there));
        }
        if (from <= to) count += std::size_t{from > 0} + std::size_t{to < 1};
    }
    return count;
}

}  // namespace

TEST(Containment, AgreesWithSeparatingAxes)
{
    const Shapes shapes = pool_of_polytopes(91, 1);
    RandomPairs pairs(shapes, 92, 1);
    int asked = 0, touching = 0;
    for (int i = 0; i < 20000; ++i) {
        SCOPED_TRACE("seeds 91 and 92, pair " + std::to_string(i));
        const PolytopeCase pair = pairs.next();
        if (!is_clear_of_planes(shapes, pair, 1)) continue;
        ++asked;
        touching += pair.clearance <= 0;
        ASSERT_NO_FATAL_FAILURE(
            expect_touch(shapes, pair.a, pair.b, pair.b_in_a, truth_of(pair.clearance)));
    }
    EXPECT_GT(asked, 19000);
    EXPECT_GT(touching, asked / 5);
    EXPECT_LT(touching, asked * 4 / 5);
}

TEST(Containment, AnswersAlikeAtEveryScale)
{
    for (const double scale : {1e-6, 1.0, 1e6}) {
        const Shapes shapes = pool_of_polytopes(93, scale);
        RandomPairs pairs(shapes, 94, scale);
        for (int i = 0; i < 1500; ++i) {
            SCOPED_TRACE("seeds 93 and 94, scale " + std::to_string(scale) + ", pair "
                         + std::to_string(i));
            const PolytopeCase pair = pairs.next();
            if (!is_clear_of_planes(shapes, pair, scale)) continue;
            ASSERT_NO_FATAL_FAILURE(
                expect_touch(shapes, pair.a, pair.b, pair.b_in_a, truth_of(pair.clearance)));
        }
    }
}

TEST(Containment, FindsEdgesThatCrossWithNoVertexNear)
{
    // Two beams, each standing on its edge, laid across one another.
    const Shapes shapes = two_boxes({3, 0.1, 0.1}, {3, 0.1, 0.1});
    const Quat on_edge(Eigen::AngleAxisd(kQuarter / 2, Vec3::UnitX()));
    const Quat across(Eigen::AngleAxisd(kQuarter, Vec3::UnitZ()));
    const double height = 0.2 * std::sqrt(2.0);
    for (const double clearance : {1e-9, 1e-4, 0.1, -1e-9, -1e-4, -0.1, -0.2}) {
        const Pose up{Vec3(0.013, 0.017, height + clearance), across * on_edge};
        const Pose pose{on_edge.conjugate() * up.position, on_edge.conjugate() * up.orientation};
        ASSERT_NO_FATAL_FAILURE(expect_touch(shapes, kBoxA, kBoxB, pose, truth_of(clearance)))
            << clearance;
    }
}

TEST(Containment, FindsEdgesThatPierceFaces)
{
    // A rod through the middle of a plate: no vertex inside, and no edge of the plate meets the
    // rod.
    const Shapes shapes = two_boxes({1, 1, 0.01}, {0.05, 0.05, 2});
    for (const double x : {0.0, 0.3, 0.9, 1.0499}) {
        ASSERT_NO_FATAL_FAILURE(
            expect_touch(shapes, kBoxA, kBoxB, at(x, 0.1, 0.2), OverlapState::touching));
    }
    ASSERT_NO_FATAL_FAILURE(
        expect_touch(shapes, kBoxA, kBoxB, at(1.0501, 0.1, 0.2), OverlapState::apart));
}

TEST(Containment, HardBoxesAtEveryScaleAndBothWaysRound)
{
    int asked = 0;
    for_hard_boxes([&](const Shapes& shapes, const PolytopeCase& pair) {
        ASSERT_NO_FATAL_FAILURE(
            expect_touch(shapes, pair.a, pair.b, pair.b_in_a, truth_of(pair.clearance)));
        ++asked;
    });
    EXPECT_GE(asked, 30);
}

TEST(Containment, FacesThatAreNotQuiteFlatMatterNoFurtherThanTheyStray)
{
    const Shapes shapes = uneven_prisms(102);
    RandomShapes random(102);
    int asked = 0, touching = 0;
    for (int i = 0; i < 2500; ++i) {
        SCOPED_TRACE("seed 102, pair " + std::to_string(i));
        const PolytopeCase pair = face_to_face(shapes, random);
        const PolytopeShape a(shapes, pair.a), b(shapes, pair.b);
        const double stray = stray_of(a.view()) + stray_of(b.view());
        if (std::abs(pair.clearance) < 2 * stray) continue;
        ++asked;
        touching += pair.clearance <= 0;
        ASSERT_NO_FATAL_FAILURE(
            expect_touch(shapes, pair.a, pair.b, pair.b_in_a, truth_of(pair.clearance)));
    }
    EXPECT_GT(asked, 400);
    EXPECT_GT(touching, 250);
    EXPECT_LT(touching, asked - 100);
}

TEST(Containment, FindsOneWhollyInsideTheOther)
{
    RandomShapes random(95);
    Shapes shapes;
    shapes.boxes = {{Vec3(1, 1, 1)}, {Vec3(0.01, 0.02, 0.03)}};
    shapes.hulls = {random.hull(40, 1), random.hull(30, 0.02)};
    for (int i = 0; i < 500; ++i) {
        SCOPED_TRACE("seed 95, case " + std::to_string(i));
        const ShapeKind outer = i % 2 == 0 ? ShapeKind::box : ShapeKind::hull;
        const ShapeKind inner = i % 3 == 0 ? ShapeKind::box : ShapeKind::hull;
        Pose pose = random.pose(i % 2 == 0 ? 0.94 : 0.4);
        if (i % 5 == 0) pose.position.setZero();
        ASSERT_NO_FATAL_FAILURE(
            expect_touch(shapes, {outer, 0}, {inner, 1}, pose, OverlapState::touching));
    }
}

TEST(Containment, FindsFacesThatLieFlat)
{
    // Alike in two directions, so that rounding may put every vertex a hair outside.
    const Shapes shapes = two_boxes({0.5, 0.3, 0.7}, {0.5, 0.3, 0.7});
    for (const Vec3& along : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
        const double full = 2 * along.dot(Vec3(0.5, 0.3, 0.7));
        for (const double clearance : {1e-9, 1e-3, -1e-9, -1e-3, -0.1, -full}) {
            for (const double tilt : {0.0, 1e-17, 3e-16}) {
                const Vec3 place = along * (full + clearance);
                const Pose pose{place, Quat(1, tilt, -tilt, tilt)};
                ASSERT_NO_FATAL_FAILURE(
                    expect_touch(shapes, kBoxA, kBoxB, pose, truth_of(clearance)))
                    << clearance;
            }
        }
    }
}

TEST(Containment, LooksDropWithWhatIsKnown)
{
    // One hull tumbles past another, in and out of touch.
    Shapes shapes;
    RandomShapes random(96);
    shapes.hulls = {random.hull(60, 0.5), random.hull(60, 0.5)};
    const ShapeRef a{ShapeKind::hull, 0}, b{ShapeKind::hull, 1};
    MethodMemory memory;
    int plain = 0, cold = 0, cached = 0, changes = 0;
    OverlapState last = OverlapState::undecided;
    for (double x = -1.0; x < 1.0; x += 0.004) {
        const Pose pose{{x, 0.3, 0.6}, Quat(Eigen::AngleAxisd(3 * x, Vec3(1, 2, 3).normalized()))};
        const ConvexPair pair(shapes, a, b, pose);
        MethodMemory fresh;
        const MethodAnswer warm = query_containment(pair, 1, MethodStart::cached, memory);
        const MethodAnswer first = query_containment(pair, 1, MethodStart::cold, fresh);
        const MethodAnswer every = query_containment(pair, 1, MethodStart::plain, fresh);
        ASSERT_EQ(warm.overlap, every.overlap) << x;
        ASSERT_EQ(first.overlap, every.overlap) << x;
        changes += every.overlap != last;
        last = every.overlap;
        plain += every.rounds;
        cold += first.rounds;
        cached += warm.rounds;
    }
    EXPECT_GE(changes, 3);
    EXPECT_LT(cold, plain / 100);
    EXPECT_LT(cached, cold / 2);
}

TEST(Containment, MemoryOfAnotherPairDoesNoHarm)
{
    const Shapes shapes = pool_of_polytopes(97, 1);
    RandomPairs pairs(shapes, 98, 1);
    MethodMemory memory;
    for (int i = 0; i < 3000; ++i) {
        SCOPED_TRACE("seeds 97 and 98, pair " + std::to_string(i));
        const PolytopeCase pair = pairs.next();
        if (!is_clear_of_planes(shapes, pair, 1)) continue;
        const ConvexPair shown(shapes, pair.a, pair.b, pair.b_in_a);
        ASSERT_EQ(ask(shown, MethodStart::cached, memory), truth_of(pair.clearance));
    }
}

TEST(Containment, PointsAreTheCornersOfWhatIsShared)
{
    const Shapes shapes = pool_of_polytopes(99, 1);
    RandomPairs pairs(shapes, 100, 1);
    std::size_t most = 0;
    for (int i = 0; i < 3000; ++i) {
        SCOPED_TRACE("seeds 99 and 100, pair " + std::to_string(i));
        const PolytopeCase drawn = pairs.next();
        // Of faces in one plane it is up to rounding which corners there are.
        if (!is_clear_of_planes(shapes, drawn, 1) || i % 8 == 3 || i % 8 == 4) continue;
        const PolytopeShape a(shapes, drawn.a), b(shapes, drawn.b);
        const PolytopePair pair(a.view(), b.view(), drawn.b_in_a);
        ContainmentPoints found;
        containment_points(pair, found);
        ASSERT_EQ(found.count > 0, drawn.clearance <= 0);
        ASSERT_EQ(found.count + found.dropped,
                  drawn.clearance > 0
                      ? 0
                      : corners_of_one_side(pair) + corners_of_one_side(pair.mirrored()));
        most = std::max(most, found.count);
        const PolytopePair mirrored = pair.mirrored();
        for (std::size_t k = 0; k < found.count; ++k) {
            const ContainmentPoints::Point& point = found.points[k];
            // On or in both, and as deep beneath the face as it says.
            const Vec3 in_b = mirrored.turn * point.position + mirrored.shift;
            double above = -1e300;
            for (std::size_t f = 0; f < pair.a.normals.size(); ++f)
                above = std::max(above, pair.a.normals[f].dot(point.position) - pair.a.offsets[f]);
            for (std::size_t f = 0; f < pair.b.normals.size(); ++f)
                above = std::max(above, pair.b.normals[f].dot(in_b) - pair.b.offsets[f]);
            ASSERT_LE(above, 1e-12);
            const PolytopeView& planes = point.of_b ? pair.a : pair.b;
            const Vec3& local = point.of_b ? point.position : in_b;
            ASSERT_NEAR(planes.offsets[point.face] - planes.normals[point.face].dot(local),
                        point.depth, 1e-12);
            ASSERT_GE(point.depth, -1e-12);
            ASSERT_EQ(point.from == point.to, point.kind == ContainmentPoints::Kind::vertex);
            ASSERT_LE(point.from, point.to);
        }
    }
    EXPECT_GT(most, 30U);
}

TEST(Containment, PointsOfSquareBoxesAreEightCorners)
{
    const BoxPolytope a({1, 1, 1}), b({1, 1, 1});
    const PolytopePair pair(a.view(), b.view(), at(1.5, 1.25, -0.75));
    ContainmentPoints found;
    containment_points(pair, found);
    ASSERT_EQ(found.count, 8U);
    int vertices = 0;
    for (std::size_t i = 0; i < found.count; ++i) {
        const Vec3& at = found.points[i].position;
        EXPECT_TRUE(std::abs(at.x() - 0.5) < 1e-12 || std::abs(at.x() - 1) < 1e-12);
        EXPECT_TRUE(std::abs(at.y() - 0.25) < 1e-12 || std::abs(at.y() - 1) < 1e-12);
        EXPECT_TRUE(std::abs(at.z() + 1) < 1e-12 || std::abs(at.z() - 0.25) < 1e-12);
        vertices += found.points[i].kind == ContainmentPoints::Kind::vertex;
        for (std::size_t k = 0; k < i; ++k) EXPECT_GT((at - found.points[k].position).norm(), 0.1);
    }
    EXPECT_EQ(vertices, 2);
}

TEST(Containment, PointsBeyondTheRoomAreCounted)
{
    RandomShapes random(101);
    const Hull hull = random.hull(200, 1);
    const PolytopePair pair(view_of(hull), view_of(hull), {Vec3::Zero(), random.turn()});
    ContainmentPoints found;
    containment_points(pair, found);
    EXPECT_EQ(found.count, ContainmentPoints::kCapacity);
    EXPECT_EQ(found.count + found.dropped,
              corners_of_one_side(pair) + corners_of_one_side(pair.mirrored()));
}

TEST(Containment, EndsForShapesOfNoThicknessAndPosesThatAreNotNumbers)
{
    const double none = std::numeric_limits<double>::quiet_NaN();
    for (const Vec3& half : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0)}) {
        const Shapes shapes = two_boxes(half, {1, 1, 0});
        ASSERT_NO_FATAL_FAILURE(
            expect_touch(shapes, kBoxA, kBoxB, at(0, 0, 0), OverlapState::touching));
        ASSERT_NO_FATAL_FAILURE(
            expect_touch(shapes, kBoxA, kBoxB, at(0, 0, 1e-9), OverlapState::apart));
        const ConvexPair pair(shapes, kBoxA, kBoxB, at(none, none, none));
        MethodMemory memory;
        for (const MethodStart start : {MethodStart::plain, MethodStart::cold, MethodStart::cached})
            EXPECT_EQ(ask(pair, start, memory), OverlapState::undecided);
    }
}

}  // namespace throng
