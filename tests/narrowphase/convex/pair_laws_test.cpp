// What every pair of convex kinds promises, whichever function answers for it.
#include "cooking/hulls/hull.hpp"
#include "narrowphase/dispatch.hpp"
#include "tests/support/direction_search.hpp"

#include <gtest/gtest.h>

#include <set>

namespace throng {
namespace {

using given::greatest_separation;
using given::outline_of;
using given::OutlinePair;
using given::random_direction;
using given::random_turn;

struct KindPair {
    ShapeKind a, b;
};

const char* name_of(ShapeKind kind)
{
    constexpr std::array<const char*, 5> kNames = {"sphere", "capsule", "cylinder", "box", "hull"};
    return kNames[static_cast<std::size_t>(kind)];
}

std::ostream& operator<<(std::ostream& out, const KindPair& kinds)
{
    return out << name_of(kinds.a) << "_" << name_of(kinds.b);
}

ShapeRef add_random(Shapes& shapes, ShapeKind kind, std::mt19937& random)
{
    std::uniform_real_distribution<double> size(0.1, 1.0);
    const auto last = [&](const auto& list) {
        return ShapeRef{kind, static_cast<std::uint32_t>(list.size() - 1)};
    };
    switch (kind) {
    case ShapeKind::sphere:
        shapes.spheres.push_back({size(random)});
        return last(shapes.spheres);
    case ShapeKind::capsule:
        shapes.capsules.push_back({size(random), size(random)});
        return last(shapes.capsules);
    case ShapeKind::cylinder:
        shapes.cylinders.push_back({size(random), size(random)});
        return last(shapes.cylinders);
    case ShapeKind::box:
        shapes.boxes.push_back({Vec3(size(random), size(random), size(random))});
        return last(shapes.boxes);
    default: {
        std::vector<Vec3> points;
        for (int i = 0; i < 16; ++i) points.push_back(random_direction(random) * size(random));
        shapes.hulls.push_back(build_hull(points).hull);
        return last(shapes.hulls);
    }
    }
}

struct Case {
    Shapes shapes;
    ShapeRef a, b;
    Pose b_in_a;

    OutlinePair clearance() const { return {outline_of(shapes, a), outline_of(shapes, b), b_in_a}; }

    template <class Real>
    LocalManifold<Real> collide_in(Real speculative_margin) const
    {
        PairCache cache;
        LocalManifold<Real> manifold;
        const PoseT<Real> pose = {b_in_a.position.cast<Real>(), b_in_a.orientation.cast<Real>()};
        throng::collide<Real>({shapes, a, b, pose, speculative_margin}, cache, manifold);
        return manifold;
    }
};

// Shapes turned anyhow, moved apart or together along their best direction to a wanted gap.
Case random_case(KindPair kinds, std::mt19937& random)
{
    Case one;
    one.a = add_random(one.shapes, kinds.a, random);
    one.b = add_random(one.shapes, kinds.b, random);
    std::uniform_real_distribution<double> away(0.0, 2.5);
    one.b_in_a = {random_direction(random) * away(random), random_turn(random)};
    return one;
}

template <class Real>
double deepest_of(const LocalManifold<Real>& manifold)
{
    double deepest = std::numeric_limits<double>::infinity();
    for (int i = 0; i < manifold.count; ++i) {
        const auto& point = manifold.points[static_cast<std::size_t>(i)];
        deepest = std::min(deepest, static_cast<double>(point.separation));
    }
    return deepest;
}

class PairLaws : public ::testing::TestWithParam<KindPair> {
protected:
    static constexpr unsigned kSeed = 20;
    static constexpr double kReach = 10;  // greater than any case is apart
};

TEST_P(PairLaws, DeepestPointAgreesWithDirectionSearch)
{
    std::mt19937 random(kSeed);
    for (int i = 0; i < 40; ++i) {
        const Case one = random_case(GetParam(), random);
        const LocalManifold<double> manifold = one.collide_in<double>(kReach);
        ASSERT_GT(manifold.count, 0) << "seed " << kSeed << ", case " << i;
        const double truth = greatest_separation(one.clearance(), {manifold.normal}, 800);
        EXPECT_NEAR(deepest_of(manifold), truth, 1e-6) << "seed " << kSeed << ", case " << i;
    }
}

TEST_P(PairLaws, OverlapDepthAgreesWithDirectionSearch)
{
    std::mt19937 random(kSeed + 1);
    for (int i = 0; i < 40; ++i) {
        Case one = random_case(GetParam(), random);
        one.b_in_a.position *= 0.4;
        const double depth = penetration_depth(one.shapes, one.a, one.b, one.b_in_a);
        const Vec3 normal = one.collide_in<double>(10).normal;
        const double truth = greatest_separation(one.clearance(), {normal}, 1500);
        EXPECT_NEAR(depth, std::max(0.0, -truth), 1e-6) << "seed " << kSeed << ", case " << i;
    }
}

TEST_P(PairLaws, NormalSeparatesByWhatTheDeepestPointSays)
{
    // Eight corners stand for a cap's rim, within 1e-5 of the size, and of more than four points
    // the deepest may lie beside the one that is told.
    const bool rim = GetParam().a == ShapeKind::cylinder || GetParam().b == ShapeKind::cylinder;
    std::mt19937 random(kSeed + 2);
    for (int i = 0; i < 300; ++i) {
        const Case one = random_case(GetParam(), random);
        const LocalManifold<double> manifold = one.collide_in<double>(kReach);
        ASSERT_GT(manifold.count, 0);
        const double tolerance = !rim ? 1e-9 : manifold.count < 4 ? 2e-5 : 1e-4;
        EXPECT_NEAR(manifold.normal.norm(), 1, 1e-12);
        const OutlinePair clearance = one.clearance();
        const double along = clearance.along(manifold.normal);
        EXPECT_NEAR(deepest_of(manifold), along, tolerance) << "seed " << kSeed << ", case " << i;
        std::set<std::uint32_t> features;
        for (int k = 0; k < manifold.count; ++k) {
            const auto& point = manifold.points[static_cast<std::size_t>(k)];
            features.insert(point.feature);
            if (point.separation > along + tolerance) continue;
            // Midway between the two surfaces.
            const double height = manifold.normal.dot(point.position);
            EXPECT_NEAR(height, clearance.a.extent(manifold.normal) + along / 2, tolerance);
        }
        EXPECT_EQ(static_cast<int>(features.size()), manifold.count) << "case " << i;
    }
}

TEST_P(PairLaws, TurnedRoundGivesTheSameContact)
{
    std::mt19937 random(kSeed + 3);
    for (int i = 0; i < 200; ++i) {
        const Case one = random_case(GetParam(), random);
        const Quat back = one.b_in_a.orientation.conjugate();
        const Case other = {one.shapes, one.b, one.a, {-(back * one.b_in_a.position), back}};
        const LocalManifold<double> there = one.collide_in<double>(kReach);
        const LocalManifold<double> back_again = other.collide_in<double>(kReach);
        ASSERT_GT(there.count, 0);
        ASSERT_GT(back_again.count, 0);
        // Where round meets sharp the search ends within 1e-13 of the distance; the direction is
        // known by the root of that, times how sharp the turn is.
        const bool rim = GetParam().a == ShapeKind::cylinder || GetParam().b == ShapeKind::cylinder;
        EXPECT_NEAR(deepest_of(there), deepest_of(back_again), rim ? 1e-7 : 1e-9) << "case " << i;
        if (deepest_of(there) < 1e-3) continue;  // deep ones may have two equal ways out
        const Vec3 normal = -(one.b_in_a.orientation * back_again.normal);
        EXPECT_LT((normal - there.normal).norm(), rim ? 2e-5 : 1e-7)
            << "seed " << kSeed << ", case " << i;
    }
}

TEST_P(PairLaws, FloatAgreesWithDouble)
{
    std::mt19937 random(kSeed + 4);
    for (int i = 0; i < 200; ++i) {
        const Case one = random_case(GetParam(), random);
        const double exact = deepest_of(one.collide_in<double>(kReach));
        const double coarse = deepest_of(one.collide_in<float>(static_cast<float>(kReach)));
        EXPECT_NEAR(exact, coarse, 1e-5) << "seed " << kSeed + 4 << ", case " << i;
    }
}

TEST_P(PairLaws, NothingBeyondReach)
{
    std::mt19937 random(kSeed + 5);
    for (int i = 0; i < 100; ++i) {
        const Case one = random_case(GetParam(), random);
        const double separation = deepest_of(one.collide_in<double>(kReach));
        if (separation < 0.01) continue;
        EXPECT_EQ(one.collide_in<double>(separation * 0.99).count, 0) << "case " << i;
        const LocalManifold<double> within = one.collide_in<double>(separation * 1.01);
        EXPECT_GT(within.count, 0) << "case " << i;
    }
}

TEST_P(PairLaws, AnswersScaleWithTheShapes)
{
    for (const double scale : {1e-6, 1e6}) {
        std::mt19937 random(kSeed + 6);
        for (int i = 0; i < 50; ++i) {
            const Case one = random_case(GetParam(), random);
            Case other = one;
            for (auto& s : other.shapes.spheres) s.radius *= scale;
            for (auto& s : other.shapes.capsules) s = {s.radius * scale, s.half_length * scale};
            for (auto& s : other.shapes.cylinders) s = {s.radius * scale, s.half_length * scale};
            for (auto& s : other.shapes.boxes) s.half_extents *= scale;
            for (auto& s : other.shapes.hulls) {
                for (auto& vertex : s.vertices) vertex *= scale;
                for (auto& offset : s.offsets) offset *= scale;
                s.center *= scale;
                s.inner_radius *= scale;
                s.outer_radius *= scale;
            }
            other.b_in_a.position *= scale;
            const double here = deepest_of(one.collide_in<double>(kReach));
            const double there = deepest_of(other.collide_in<double>(kReach * scale)) / scale;
            EXPECT_NEAR(here, there, 1e-7) << "scale " << scale << ", case " << i;
        }
    }
}

TEST_P(PairLaws, CoincidentAndConcentricShapesGiveAUnitNormal)
{
    std::mt19937 random(kSeed + 7);
    for (int i = 0; i < 40; ++i) {
        Case one = random_case(GetParam(), random);
        one.b_in_a.position.setZero();
        if (i % 2 == 0) one.b_in_a.orientation.setIdentity();
        const LocalManifold<double> manifold = one.collide_in<double>(0);
        ASSERT_GT(manifold.count, 0);
        EXPECT_NEAR(manifold.normal.norm(), 1, 1e-12);
        EXPECT_LT(deepest_of(manifold), 0);
        const LocalManifold<double> again = one.collide_in<double>(0);
        EXPECT_EQ(manifold.normal, again.normal);
        const double truth = greatest_separation(one.clearance(), {manifold.normal}, 1500);
        const double depth = penetration_depth(one.shapes, one.a, one.b, one.b_in_a);
        EXPECT_NEAR(depth, -truth, 1e-6) << "case " << i;
        const LocalManifold<float> coarse = one.collide_in<float>(0);
        EXPECT_TRUE(coarse.normal.allFinite());
        EXPECT_GT(coarse.count, 0);
    }
}

TEST_P(PairLaws, FarAndHugelyDifferentShapesStayFinite)
{
    std::mt19937 random(kSeed + 8);
    for (int i = 0; i < 60; ++i) {
        Case one = random_case(GetParam(), random);
        const double ratio = std::pow(10.0, i % 13 - 6);
        if (one.b.kind == ShapeKind::box) one.shapes.boxes.back().half_extents *= ratio;
        if (one.b.kind == ShapeKind::sphere) one.shapes.spheres.back().radius *= ratio;
        if (one.b.kind == ShapeKind::cylinder) one.shapes.cylinders.back().half_length *= ratio;
        if (one.b.kind == ShapeKind::capsule) one.shapes.capsules.back().half_length *= ratio;
        if (i % 3 == 0) one.b_in_a.position *= 1e9;
        for (const double speculative_margin : {0.0, 1e12}) {
            const LocalManifold<double> exact = one.collide_in<double>(speculative_margin);
            const LocalManifold<float> coarse =
                one.collide_in<float>(static_cast<float>(speculative_margin));
            EXPECT_TRUE(exact.normal.allFinite() && coarse.normal.allFinite());
            for (int k = 0; k < exact.count; ++k) {
                const auto& point = exact.points[static_cast<std::size_t>(k)];
                EXPECT_TRUE(point.position.allFinite() && std::isfinite(point.separation));
            }
            for (int k = 0; k < coarse.count; ++k) {
                const auto& point = coarse.points[static_cast<std::size_t>(k)];
                EXPECT_TRUE(point.position.allFinite() && std::isfinite(point.separation));
            }
        }
    }
}

// Two polytopes answer with a separating axis, which is a distance only where they overlap; they
// have tests of their own.
std::vector<KindPair> all_pairs()
{
    const auto is_polytope = [](int kind) { return kind >= static_cast<int>(ShapeKind::box); };
    std::vector<KindPair> pairs;
    for (int a = 0; a < 5; ++a) {
        for (int b = 0; b < 5; ++b) {
            if (is_polytope(a) && is_polytope(b)) continue;
            pairs.push_back({static_cast<ShapeKind>(a), static_cast<ShapeKind>(b)});
        }
    }
    return pairs;
}

INSTANTIATE_TEST_SUITE_P(AllKinds,
                         PairLaws,
                         ::testing::ValuesIn(all_pairs()),
                         [](const ::testing::TestParamInfo<KindPair>& kinds) {
                             return std::string(name_of(kinds.param.a)) + "_"
                                 + name_of(kinds.param.b);
                         });

TEST(PenetrationDepth, OfPolytopesAgreesWithDirectionSearch)
{
    std::mt19937 random(3);
    for (int i = 0; i < 60; ++i) {
        const std::array<ShapeKind, 2> kinds = {ShapeKind::box, ShapeKind::hull};
        Case one = random_case(
            {kinds[static_cast<std::size_t>(i % 2)], kinds[static_cast<std::size_t>(i / 2 % 2)]},
            random);
        one.b_in_a.position *= 0.4;
        const double depth = penetration_depth(one.shapes, one.a, one.b, one.b_in_a);
        const Vec3 normal = one.collide_in<double>(10).normal;
        const double truth = greatest_separation(one.clearance(), {normal}, 1500);
        EXPECT_NEAR(depth, std::max(0.0, -truth), 1e-6) << "case " << i;
    }
}

}  // namespace
}  // namespace throng
