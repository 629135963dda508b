#include "kernels/geometry/gjk.hpp"

#include "cost/hard_cases/broken_pairs.hpp"
#include "kernels/geometry/epa.hpp"
#include "narrowphase/convex/contact_axis.hpp"
#include "narrowphase/convex/pair_functions.hpp"
#include "narrowphase/manifold/contact_points.hpp"
#include "tests/support/direction_search.hpp"
#include "tests/support/polyhedra.hpp"

#include <gtest/gtest.h>

#include <random>

namespace throng {
namespace {

using given::outline_of;
using given::OutlinePair;
using given::random_direction;
using given::random_turn;

struct BoxPair {
    Shapes shapes;
    ShapeRef a = {ShapeKind::box, 0}, b = {ShapeKind::box, 1};
    Pose b_in_a;

    double size() const
    {
        return std::max(shapes.boxes[0].half_extents.norm(), shapes.boxes[1].half_extents.norm());
    }
    ConvexCorePair cores() const { return {shapes, a, b, b_in_a}; }
};

BoxPair boxes(const Vec3& half_a, const Vec3& half_b, const Pose& b_in_a)
{
    BoxPair pair;
    pair.shapes.boxes = {{half_a}, {half_b}};
    pair.b_in_a = b_in_a;
    return pair;
}

BoxPair boxes(const PlacedBox& a, const PlacedBox& b, double scale)
{
    const Quat back = a.pose.orientation.conjugate();
    const Vec3 offset = a.pose.to_local(b.pose.position);
    return boxes(a.size / 2 * scale, b.size / 2 * scale,
                 {offset * scale, back * b.pose.orientation});
}

double separation_of(const BoxPair& pair)
{
    ContactAxis axis;
    EXPECT_TRUE(search_axis(pair.cores(), 1e30, axis));
    EXPECT_NEAR(axis.normal.norm(), 1, 1e-12);
    return axis.separation;
}

template <class Real>
double manifold_separation(const BoxPair& pair)
{
    PairCache cache;
    LocalManifold<Real> out;
    const PoseT<Real> pose = {pair.b_in_a.position.cast<Real>(),
                              pair.b_in_a.orientation.cast<Real>()};
    const auto extent = static_cast<Real>(10 * pair.size());
    convex_convex<Real>({pair.shapes, pair.a, pair.b, pose, extent}, cache, out);
    EXPECT_GT(out.count, 0);
    double least = 1e300;
    for (int i = 0; i < out.count; ++i) {
        const auto& point = out.points[static_cast<std::size_t>(i)];
        EXPECT_TRUE(point.position.allFinite());
        least = std::min(least, static_cast<double>(point.separation));
    }
    return least;
}

// Every face normal and every edge by every edge: what depth of two boxes can depend on.
double exhaustive_separation(const BoxPair& pair)
{
    const OutlinePair clearance = {outline_of(pair.shapes, pair.a), outline_of(pair.shapes, pair.b),
                                   pair.b_in_a};
    const Mat3 turn = pair.b_in_a.orientation.toRotationMatrix();
    double best = -1e300;
    const auto consider = [&](const Vec3& axis) {
        best = std::max({best, clearance.along(axis), clearance.along(-axis)});
    };
    for (int i = 0; i < 3; ++i) {
        consider(Vec3::Unit(i));
        consider(turn.col(i));
        for (int k = 0; k < 3; ++k) {
            const Vec3 across = Vec3::Unit(i).cross(turn.col(k));
            if (across.norm() > 1e-7) consider(across.normalized());
        }
    }
    return best;
}

TEST(Gjk, HardBoxesAtEveryScaleAndBothWaysRound)
{
    for (const BrokenPair& hard : broken_pairs()) {
        for (const double scale : {1e-6, 1.0, 1e6}) {
            for (const bool swapped : {false, true}) {
                const BoxPair pair =
                    swapped ? boxes(hard.b, hard.a, scale) : boxes(hard.a, hard.b, scale);
                const double size = pair.size();
                const double truth = hard.separation * scale;
                const double found = separation_of(pair);
                // Some poses are given to 1e-8 only and are made orthonormal here.
                const double given = 1e-9;
                EXPECT_NEAR(found, truth, given * size) << hard.name << ", scale " << scale;
                EXPECT_NEAR(manifold_separation<double>(pair), truth, given * size) << hard.name;
                EXPECT_NEAR(manifold_separation<float>(pair), truth, 1e-5 * size) << hard.name;
                if (std::abs(truth) > 1e-12 * size) {
                    EXPECT_EQ(found > 0, truth > 0) << hard.name;
                }
            }
        }
    }
}

TEST(Gjk, EndsWithinItsRounds)
{
    for (const BrokenPair& hard : broken_pairs()) {
        const BoxPair pair = boxes(hard.a, hard.b, 1);
        EXPECT_LE(gjk(pair.cores(), 1e30).iterations, 64) << hard.name;
        EXPECT_LE(epa(pair.cores()).iterations, 124) << hard.name;
    }
}

TEST(Gjk, OverlapOfRandomBoxesIsExact)
{
    std::mt19937 random(11);
    std::uniform_real_distribution<double> size(0.05, 1.0);
    int exact = 0, overlapping = 0;
    for (int i = 0; i < 3000; ++i) {
        const BoxPair pair = boxes(Vec3(size(random), size(random), size(random)),
                                   Vec3(size(random), size(random), size(random)),
                                   {random_direction(random) * size(random), random_turn(random)});
        const double truth = exhaustive_separation(pair);
        if (truth > 0) continue;
        EXPECT_NEAR(separation_of(pair), truth, 1e-12) << "seed 11, case " << i;
        // Of more than four points the deepest may be left out by a little.
        const double told = manifold_separation<double>(pair);
        EXPECT_GE(told, truth - 1e-9) << "seed 11, case " << i;
        EXPECT_LE(told, truth + kDrawn<double> * pair.size()) << "seed 11, case " << i;
        exact += std::abs(told - truth) < 1e-9;
        ++overlapping;
    }
    EXPECT_GT(exact, 0.99 * overlapping);
}

TEST(Gjk, NeedlesAMillionTimesLongerThanThick)
{
    std::mt19937 random(12);
    std::uniform_real_distribution<double> place(-1.2, 1.2);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 thin = i % 2 == 0 ? Vec3(1000, 0.0005, 0.0005) : Vec3(500, 500, 0.0005);
        const Quat turn = random_turn(random);
        const Vec3 across = turn * Vec3(0, 0, 1);
        const Vec3 shift = across * place(random) + turn * Vec3(place(random) * 200, 0, 0);
        const BoxPair pair = boxes(Vec3::Constant(0.5), thin, {shift, turn});
        const double truth = exhaustive_separation(pair);
        if (truth > 0) continue;
        EXPECT_NEAR(separation_of(pair), truth, 1e-9) << "seed 12, case " << i;
        EXPECT_TRUE(std::isfinite(manifold_separation<float>(pair)));
    }
}

TEST(Gjk, NearlyParallelBoxesKeepTheirNormal)
{
    for (double tilt = 1e-15; tilt < 2e-2; tilt *= 10) {
        for (const bool both : {false, true}) {
            const Quat turn = Quat(1, tilt / 2, both ? tilt / 3 : 0, 0).normalized();
            const BoxPair pair =
                boxes(Vec3(0.5, 0.4, 0.3), Vec3(0.5, 0.4, 0.3), {Vec3(0.1, 0.05, 0.598), turn});
            ContactAxis axis;
            ASSERT_TRUE(search_axis(pair.cores(), 1e30, axis));
            EXPECT_LE((axis.normal - Vec3::UnitZ()).norm(), 10 * tilt);
            EXPECT_NEAR(axis.separation, exhaustive_separation(pair), 1e-12);
        }
    }
}

TEST(Gjk, ConcentricBoxesLeaveByTheNearestFace)
{
    std::mt19937 random(13);
    for (const double ratio : {1.0, 2.0, 10.0, 100.0}) {
        for (int i = 0; i < 50; ++i) {
            const Quat turn = i == 0 ? Quat(1, 0, 0, 0) : random_turn(random);
            const BoxPair pair =
                boxes(Vec3(0.5, 0.6, 0.7), Vec3(0.5, 0.4, 0.3) / ratio, {Vec3::Zero(), turn});
            EXPECT_NEAR(separation_of(pair), exhaustive_separation(pair), 1e-9);
        }
    }
}

TEST(Gjk, MeasuredFromWherePlanesOfBoxesTouchExactly)
{
    // Sharing a face, an edge and a corner.
    for (const Vec3& shift : {Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(1, 1, 1), Vec3(1, 0.3, -0.2)}) {
        const BoxPair pair =
            boxes(Vec3::Constant(0.5), Vec3::Constant(0.5), {shift, Quat::Identity()});
        EXPECT_NEAR(separation_of(pair), 0, 1e-14);
        EXPECT_NEAR(manifold_separation<double>(pair), 0, 1e-9);
    }
}

TEST(Gjk, BoxesOfNoThicknessGiveFiniteAnswers)
{
    for (const Vec3& half : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0)}) {
        for (const Vec3& other : {Vec3(0, 0, 0), Vec3(0, 2, 0), Vec3(0, 1, 1), Vec3(1, 1, 0)}) {
            for (const Vec3& shift : {Vec3(0, 0, 0), Vec3(0, 0, 1e-12), Vec3(0.5, 0.5, 0.5)}) {
                const BoxPair pair = boxes(half, other, {shift, Quat::Identity()});
                EXPECT_TRUE(std::isfinite(separation_of(pair)));
            }
        }
    }
}

TEST(Gjk, LimitStopsEarlyWithATrueBound)
{
    std::mt19937 random(14);
    for (int i = 0; i < 500; ++i) {
        const BoxPair pair = boxes(Vec3(0.5, 0.4, 0.3), Vec3(0.2, 0.3, 0.4),
                                   {random_direction(random) * 2, random_turn(random)});
        const double exact = gjk(pair.cores(), 1e30).distance;
        const Distance stopped = gjk(pair.cores(), 0.5 * exact);
        EXPECT_TRUE(stopped.beyond);
        EXPECT_LE(stopped.distance, exact + 1e-12);
        EXPECT_FALSE(gjk(pair.cores(), 1.001 * exact).beyond);
    }
}

constexpr double kNoLimit = 1e30;

TEST(SweptGjk, ABulletNeverPassesUnseen)
{
    // A plate of a tenth of a millimeter, a cube of a centimeter, a hundred meters on.
    const BoxPair pair =
        boxes({1, 1, 5e-5}, {5e-3, 5e-3, 5e-3}, {Vec3(0.3, -0.2, 50), Quat::Identity()});
    EXPECT_FALSE(swept_gjk(pair.cores(), {0, 0, -100}, kNoLimit).nearest.apart);
    EXPECT_TRUE(swept_gjk(pair.cores(), {0, 0, -49}, kNoLimit).nearest.apart);
    EXPECT_TRUE(swept_gjk(pair.cores(), {0, 0, 100}, kNoLimit).nearest.apart);
}

TEST(SweptGjk, TellsHowNearItPassedAndWhen)
{
    // A corner's width beside the edge, halfway.
    const BoxPair pair = boxes({1, 1, 1}, {0.5, 0.5, 0.5}, {Vec3(1.75, -9, 0), Quat::Identity()});
    const SweptDistance swept = swept_gjk(pair.cores(), {0, 18, 0}, kNoLimit);
    ASSERT_TRUE(swept.nearest.apart);
    EXPECT_NEAR(swept.nearest.distance, 0.25, 1e-14);
    EXPECT_NEAR((swept.nearest.normal - Vec3::UnitX()).norm(), 0, 1e-12);
    EXPECT_GE(swept.at, (9 - 1.5) / 18 - 1e-12);
    EXPECT_LE(swept.at, (9 + 1.5) / 18 + 1e-12);
}

TEST(SweptGjk, IsAsNearAsTheNearestMoment)
{
    std::mt19937 random(7);
    std::uniform_real_distribution<double> size(0.1, 1), place(-4, 4);
    const auto vector = [&](auto& of) -> Vec3 { return {of(random), of(random), of(random)}; };
    int apart = 0, through = 0;
    for (int i = 0; i < 300; ++i) {
        const Vec3 position = vector(place), motion = vector(place) - position;
        const Quat turn = Quat(place(random), place(random), place(random), 1).normalized();
        BoxPair pair = boxes(vector(size), vector(size), {position, turn});
        const SweptDistance swept = swept_gjk(pair.cores(), motion, kNoLimit);
        constexpr int kMoments = 400;
        double nearest = kNoLimit;
        for (int k = 0; k <= kMoments; ++k) {
            pair.b_in_a.position = position + motion * (static_cast<double>(k) / kMoments);
            const Distance now = gjk(pair.cores(), kNoLimit);
            nearest = std::min(nearest, now.apart ? now.distance : 0.0);
        }
        const double found = swept.nearest.apart ? swept.nearest.distance : 0;
        EXPECT_LE(found, nearest + 1e-12);
        EXPECT_GE(found, nearest - motion.norm() / kMoments);
        (swept.nearest.apart ? apart : through)++;
        if (!swept.nearest.apart) continue;
        pair.b_in_a.position = position + motion * swept.at;
        EXPECT_NEAR(gjk(pair.cores(), kNoLimit).distance, found, 1e-9);
    }
    EXPECT_GT(apart, 50);
    EXPECT_GT(through, 50);
}

TEST(SweptGjk, WithoutMotionIsGjk)
{
    const BoxPair pair = boxes({1, 2, 1}, {0.5, 0.5, 0.7},
                               {Vec3(2, 2.9, 0.4), Quat(0.9, 0.1, 0.2, 0.3).normalized()});
    const Distance still = gjk(pair.cores(), kNoLimit);
    const SweptDistance swept = swept_gjk(pair.cores(), Vec3::Zero(), kNoLimit);
    EXPECT_EQ(still.distance, swept.nearest.distance);
    EXPECT_EQ(still.on_b, swept.nearest.on_b);
}

}  // namespace
}  // namespace throng
