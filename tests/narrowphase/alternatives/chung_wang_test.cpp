#include "narrowphase/alternatives/chung_wang.hpp"

#include "kernels/geometry/epa.hpp"
#include "tests/support/polytope_pairs.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

constexpr MethodStart kStarts[] = {MethodStart::plain, MethodStart::cold, MethodStart::cached};

// Where they are apart the normal must part them, by the plainest of means.
void expect_parted(const ConvexPair& pair, const MethodAnswer& answer)
{
    ASSERT_TRUE(answer.normal.allFinite());
    ASSERT_NEAR(answer.normal.norm(), 1, 1e-12);
    if (answer.overlap != OverlapState::apart) return;
    const ConvexCorePair& cores = pair.cores();
    ASSERT_GT(separation_along(cores, answer.normal),
              cores.a.convex_radius + cores.b.convex_radius);
}

struct Tally {
    int asked = 0, undecided = 0, apart = 0;
};

// All starts in turn, the cached one from what the cold one left behind.
void expect_truth(const ConvexPair& pair, OverlapState truth, Tally& tally)
{
    MethodMemory memory;
    for (const MethodStart start : kStarts) {
        const MethodAnswer answer = query_chung_wang(pair, 1e30, start, memory);
        ++tally.asked;
        tally.apart += answer.overlap == OverlapState::apart;
        tally.undecided += answer.overlap == OverlapState::undecided;
        ASSERT_EQ(answer.overlap == OverlapState::undecided, answer.cut_short);
        if (answer.overlap == OverlapState::undecided) continue;
        ASSERT_EQ(answer.overlap, truth);
        ASSERT_NO_FATAL_FAILURE(expect_parted(pair, answer));
    }
}

void expect_truth_both_ways(const Shapes& shapes, const PolytopeCase& pair, Tally& tally)
{
    const ConvexPair straight(shapes, pair.a, pair.b, pair.b_in_a);
    ASSERT_NO_FATAL_FAILURE(expect_truth(straight, truth_of(pair.clearance), tally));
    const ConvexPair swapped(shapes, pair.b, pair.a, inverse(pair.b_in_a));
    ASSERT_NO_FATAL_FAILURE(expect_truth(swapped, truth_of(pair.clearance), tally));
}

}  // namespace

TEST(ChungWang, AgreesWithSeparatingAxes)
{
    const Shapes shapes = pool_of_polytopes(71, 1);
    RandomPairs pairs(shapes, 72, 1);
    Tally tally;
    for (int i = 0; i < 20000; ++i) {
        SCOPED_TRACE("seeds 71 and 72, pair " + std::to_string(i));
        const PolytopeCase pair = pairs.next();
        if (!is_clear(pair, 1)) continue;
        ASSERT_NO_FATAL_FAILURE(expect_truth_both_ways(shapes, pair, tally));
    }
    EXPECT_GT(tally.asked, 100000);
    EXPECT_GT(tally.apart, tally.asked / 5);
    EXPECT_LT(tally.apart, tally.asked * 4 / 5);
    // None has been seen; directions left are halved each round or better.
    EXPECT_LE(tally.undecided, tally.asked / 10000);
}

TEST(ChungWang, AnswersAlikeAtEveryScale)
{
    for (const double scale : {1e-6, 1.0, 1e6}) {
        const Shapes shapes = pool_of_polytopes(73, scale);
        RandomPairs pairs(shapes, 74, scale);
        Tally tally;
        for (int i = 0; i < 1500; ++i) {
            SCOPED_TRACE("seeds 73 and 74, scale " + std::to_string(scale) + ", pair "
                         + std::to_string(i));
            const PolytopeCase pair = pairs.next();
            if (!is_clear(pair, scale)) continue;
            ASSERT_NO_FATAL_FAILURE(expect_truth_both_ways(shapes, pair, tally));
        }
        EXPECT_LE(tally.undecided, 1);
    }
}

TEST(ChungWang, HardBoxesAtEveryScaleAndBothWaysRound)
{
    int asked = 0;
    for_hard_boxes([&](const Shapes& shapes, const PolytopeCase& pair) {
        Tally tally;
        ASSERT_NO_FATAL_FAILURE(expect_truth_both_ways(shapes, pair, tally));
        EXPECT_EQ(tally.undecided, 0);
        asked += tally.asked;
    });
    EXPECT_GT(asked, 0);
}

TEST(ChungWang, ClimbingIsNotFooledByFacesThatAreNotQuiteFlat)
{
    // By the axes of the planes alone they may seem to touch; climbing may stop short of a vertex.
    const Shapes shapes = uneven_prisms(79);
    RandomShapes random(79);
    Tally tally;
    for (int i = 0; i < 2000; ++i) {
        SCOPED_TRACE("seed 79, pair " + std::to_string(i));
        const PolytopeCase pair = face_to_face(shapes, random);
        const ConvexPair shown(shapes, pair.a, pair.b, pair.b_in_a);
        const Distance cores = gjk(shown.cores(), 1);
        if (cores.apart ? cores.distance < 1e-10 : epa(shown.cores()).depth < 1e-10) continue;
        const OverlapState truth = cores.apart ? OverlapState::apart : OverlapState::touching;
        ASSERT_NO_FATAL_FAILURE(expect_truth(shown, truth, tally));
    }
    EXPECT_GT(tally.asked, 5000);
    EXPECT_EQ(tally.undecided, 0);
}

TEST(ChungWang, RoundShapesAgreeWithGjk)
{
    RandomShapes random(75);
    Shapes shapes = pool_of_polytopes(75, 1);
    for (int i = 0; i < 24; ++i) {
        shapes.spheres.push_back({random.number(0.05, 1)});
        shapes.capsules.push_back({random.number(0.05, 0.5), random.number(0.05, 0.5)});
        shapes.cylinders.push_back({random.number(0.05, 0.6), random.number(0.05, 0.6)});
    }
    constexpr ShapeKind kKinds[] = {ShapeKind::sphere, ShapeKind::capsule, ShapeKind::cylinder,
                                    ShapeKind::box, ShapeKind::hull};
    const auto any = [&](int kind) {
        return ShapeRef{kKinds[kind], static_cast<std::uint32_t>(random.number(0, 24))};
    };
    Tally tally;
    for (int i = 0; i < 20000; ++i) {
        SCOPED_TRACE("seed 75, pair " + std::to_string(i));
        const ShapeRef a = any(i % 5), b = any(i / 5 % 5);
        Pose pose = random.pose(1);
        const Distance cores = gjk(ConvexCorePair(shapes, a, b, pose), 1e30);
        double clearance = -1;
        ConvexPair pair(shapes, a, b, pose);
        const double radii = pair.cores().a.convex_radius + pair.cores().b.convex_radius;
        if (cores.apart) {
            // Moved along the line of their nearest points, cores keep that line.
            clearance = std::pow(10, random.number(-9, -1)) * (i % 2 == 0 ? 1 : -1);
            clearance = std::max(clearance, -0.9 * radii);
            if (clearance == 0) continue;
            pose.position += cores.normal * (clearance + radii - cores.distance);
            pair.place(pose);
        }
        ASSERT_NO_FATAL_FAILURE(expect_truth(pair, truth_of(clearance), tally));
    }
    EXPECT_GT(tally.asked, 50000);
    EXPECT_LE(tally.undecided, tally.asked / 10000);
}

TEST(ChungWang, RoundsDropWithWhatIsRemembered)
{
    // One hull tumbles past another, in and out of touch.
    Shapes shapes;
    RandomShapes random(76);
    shapes.hulls = {random.hull(60, 0.5), random.hull(60, 0.5)};
    const ShapeRef a{ShapeKind::hull, 0}, b{ShapeKind::hull, 1};
    MethodMemory memory;
    int cached = 0, cold = 0, steps = 0, changes = 0;
    OverlapState last = OverlapState::undecided;
    for (double x = -1.2; x < 1.2; x += 0.002) {
        const Pose pose{{x, 0.3, 0.5}, Quat(Eigen::AngleAxisd(3 * x, Vec3(1, 2, 3).normalized()))};
        const ConvexPair pair(shapes, a, b, pose);
        MethodMemory fresh;
        const MethodAnswer warm = query_chung_wang(pair, 1, MethodStart::cached, memory);
        const MethodAnswer first = query_chung_wang(pair, 1, MethodStart::cold, fresh);
        ASSERT_EQ(warm.overlap, first.overlap) << x;
        changes += warm.overlap != last;
        last = warm.overlap;
        cached += warm.rounds;
        cold += first.rounds;
        ++steps;
    }
    EXPECT_GE(changes, 3);
    EXPECT_LT(cached, cold);
    EXPECT_LT(cached, 1.1 * steps);
    EXPECT_GT(cold, 1.2 * steps);
}

TEST(ChungWang, MemoryOfAnotherPairDoesNoHarm)
{
    const Shapes shapes = pool_of_polytopes(77, 1);
    RandomPairs pairs(shapes, 78, 1);
    MethodMemory memory;
    for (int i = 0; i < 3000; ++i) {
        SCOPED_TRACE("seeds 77 and 78, pair " + std::to_string(i));
        const PolytopeCase pair = pairs.next();
        if (!is_clear(pair, 1)) continue;
        const ConvexPair shown(shapes, pair.a, pair.b, pair.b_in_a);
        const MethodAnswer answer = query_chung_wang(shown, 1, MethodStart::cached, memory);
        ASSERT_EQ(answer.overlap, truth_of(pair.clearance));
        ASSERT_NO_FATAL_FAILURE(expect_parted(shown, answer));
    }
}

TEST(ChungWang, EndsForShapesOfNoThicknessAndPosesThatAreNotNumbers)
{
    const double none = std::numeric_limits<double>::quiet_NaN();
    for (const Vec3& half : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0)}) {
        for (const Vec3& other : {Vec3(0, 0, 0), Vec3(0, 2, 0), Vec3(1, 1, 0)}) {
            const Shapes shapes = two_boxes(half, other);
            for (const double x : {0.0, 1e-12, 0.5, none}) {
                const ConvexPair pair(shapes, kBoxA, kBoxB, at(x, x, x));
                MethodMemory memory;
                for (const MethodStart start : kStarts) {
                    const MethodAnswer answer = query_chung_wang(pair, 1, start, memory);
                    EXPECT_TRUE(answer.normal.allFinite());
                    EXPECT_LE(answer.rounds, 96);
                }
                if (x == 0) {
                    EXPECT_EQ(query_chung_wang(pair, 1, MethodStart::cold, memory).overlap,
                              OverlapState::touching);
                }
            }
        }
    }
}

}  // namespace throng
