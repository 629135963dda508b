#include "narrowphase/convex/wide/box_pairs.hpp"

#include "cost/hard_cases/broken_pairs.hpp"
#include "narrowphase/manifold/contact_points.hpp"
#include "tests/narrowphase/convex/wide/placed_boxes.hpp"
#include "tests/support/polyhedra.hpp"

#include <gtest/gtest.h>

#include <cstring>

namespace throng {
namespace {

using Manifolds = std::vector<LocalManifold<float>>;

Manifolds collide_all(const BoxKernels& kernels, const std::vector<PlacedPair>& pairs)
{
    std::vector<BoxPair> rounded;
    for (const PlacedPair& pair : pairs) rounded.push_back(pair.rounded());
    Manifolds out(pairs.size());
    for (auto& manifold : out) {
        manifold.points.fill({Vec3T<float>::Zero(), 0, 0});
        manifold.count = 9;
    }
    collide_boxes(kernels, rounded, out);
    return out;
}
LocalManifold<float> collide_one(const PlacedPair& pair)
{
    return collide_all(box_kernels(), {pair})[0];
}

bool same_bits(const LocalManifold<float>& x, const LocalManifold<float>& y)
{
    if (x.count != y.count) return false;
    const auto at = [](const LocalManifold<float>& m) { return static_cast<const void*>(&m); };
    return x.count == 0 || std::memcmp(at(x), at(y), sizeof(x)) == 0;
}

// Area of the points' outline seen along the normal: half of the greatest cross product of two
// lines between them.
template <class Real>
double outline(const LocalManifold<Real>& manifold)
{
    std::vector<Vec3> p;
    for (int i = 0; i < manifold.count; ++i)
        p.push_back(manifold.points[static_cast<std::size_t>(i)].position.template cast<double>());
    const Vec3 normal = manifold.normal.template cast<double>();
    double most = 0;
    for (const Vec3& a : p)
        for (const Vec3& b : p)
            for (const Vec3& c : p)
                for (const Vec3& d : p) {
                    most = std::max(most, std::abs((b - a).cross(d - c).dot(normal)) / 2);
                }
    return most;
}

template <class Real>
std::vector<std::uint32_t> features(const LocalManifold<Real>& manifold)
{
    std::vector<std::uint32_t> found;
    for (int i = 0; i < manifold.count; ++i)
        found.push_back(manifold.points[static_cast<std::size_t>(i)].feature);
    std::sort(found.begin(), found.end());
    return found;
}

// Greatest distance of points of the same feature.
double points_differ(const LocalManifold<float>& x, const LocalManifold<double>& y)
{
    double most = 0;
    for (int i = 0; i < x.count; ++i)
        for (int k = 0; k < y.count; ++k) {
            const auto& p = x.points[static_cast<std::size_t>(i)];
            const auto& q = y.points[static_cast<std::size_t>(k)];
            if (p.feature != q.feature) continue;
            most = std::max(most, (p.position.cast<double>() - q.position).norm());
            most = std::max(most, std::abs(static_cast<double>(p.separation) - q.separation));
        }
    return most;
}

// How far a point lies outside a box; 0 inside.
double outside(const Vec3& half, const Vec3& point)
{
    return (point.cwiseAbs() - half).cwiseMax(0).norm();
}

// Every point lies between two places, one on either box.
void expect_points_on_both(const PlacedPair& pair, const LocalManifold<float>& found)
{
    const Vec3 normal = found.normal.cast<double>();
    // Corners this far beyond a side stay corners; edges that are apart may be nearest askew.
    const bool edges = found.points[0].feature >> 31 != 0;
    const double slack = 1e-3 * std::max(pair.half_a.minCoeff(), pair.half_b.minCoeff())
        + 1e-5 * pair.size() + (edges ? pair.speculative_margin / 2 : 0);
    for (int k = 0; k < found.count; ++k) {
        const auto& point = found.points[static_cast<std::size_t>(k)];
        const Vec3 middle = point.position.cast<double>();
        const Vec3 half = normal * (static_cast<double>(point.separation) / 2);
        ASSERT_LE(point.separation, pair.speculative_margin * (1 + 1e-6));
        ASSERT_LE(outside(pair.half_a, middle - half), slack);
        ASSERT_LE(outside(pair.half_b, pair.pose.to_local(middle + half)), slack);
    }
}

// How answers compare with the twin's, by whether b's face leads.
struct Tally {
    int touching[2] = {0, 0};  // both found points
    int same[2] = {0, 0};      // and the same ones
};

void compare(const PlacedPair& pair, const LocalManifold<float>& found, Tally& tally)
{
    const auto expected = pair.twin();
    const double rounding = 3e-6 * pair.size();
    ASSERT_TRUE(all_finite(found));
    ASSERT_TRUE(features_differ(found));
    if ((found.count == 0) != (expected.count == 0)) {
        // Only where the answer hangs on a rounding.
        PlacedPair wider = pair, tighter = pair;
        wider.speculative_margin += rounding, tighter.speculative_margin -= rounding;
        ASSERT_NE(wider.twin().count == 0, tighter.twin().count == 0);
        return;
    }
    if (found.count == 0) return;
    const std::uint32_t first = expected.points[0].feature;
    const bool b_leads = first >> 31 == 0 && (first >> 12 & 1) != 0;
    ++tally.touching[b_leads];
    ASSERT_NEAR(found.normal.norm(), 1, 1e-5);
    ASSERT_NEAR(deepest(found), deepest(expected), rounding + 3 * pair.bias());
    expect_points_on_both(pair, found);
    if ((found.normal.cast<double>() - expected.normal).norm() > 1e-3) return;
    if (features(found) == features(expected)) {
        ASSERT_LE(points_differ(found, expected), 30 * rounding + pair.bias() / 2);
        ++tally.same[b_leads];
        return;
    }
    // Of many points others may have been chosen, the slanted direction being the leading box's.
    ASSERT_NEAR(deepest(found), deepest(expected), rounding + kDrawn<double> * pair.size());
    if (found.count == 4 && expected.count == 4) {
        ASSERT_GE(outline(found), 0.75 * outline(expected));
    }
}

}  // namespace

TEST(BoxPairs, AgreeWithOnePairAtATime)
{
    for (const Kind kind : kKinds) {
        SCOPED_TRACE(kNames[static_cast<int>(kind)]);
        const auto pairs = random_pairs(21, kind, 3000);
        const Manifolds found = collide_all(box_kernels(), pairs);
        Tally tally;
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            SCOPED_TRACE("seed 21, pair " + std::to_string(i));
            compare(pairs[i], found[i], tally);
            if (testing::Test::HasFatalFailure()) return;
        }
        EXPECT_GE(tally.touching[0], 500);
        EXPECT_GE(tally.same[0], 0.99 * tally.touching[0]);
        EXPECT_GE(tally.same[1], 0.8 * tally.touching[1]);
    }
}

TEST(BoxPairs, EveryWidthGivesTheSameBits)
{
    const BoxKernels& scalar = *box_kernels_of("scalar");
    EXPECT_EQ(scalar.lanes, 1);
    for (const char* width : {"avx2", "avx512"}) {
        const BoxKernels* const wide = box_kernels_of(width);
        if (wide == nullptr) {
            std::printf("this machine has no %s\n", width);
            continue;
        }
        EXPECT_EQ(wide->lanes, width == std::string("avx2") ? 8 : 16);
        for (const Kind kind : kKinds) {
            const auto pairs = random_pairs(22, kind, 1000);
            const Manifolds narrow = collide_all(scalar, pairs), broad = collide_all(*wide, pairs);
            for (std::size_t i = 0; i < pairs.size(); ++i)
                ASSERT_TRUE(same_bits(narrow[i], broad[i]))
                    << width << ", " << kNames[static_cast<int>(kind)] << ", seed 22, pair " << i;
        }
    }
    EXPECT_EQ(box_kernels_of("mmx"), nullptr);
}

TEST(BoxPairs, AnswerHangsOnThePairAlone)
{
    std::vector<PlacedPair> pairs;
    for (const Kind kind : kKinds)
        for (const PlacedPair& pair : random_pairs(23, kind, 70)) pairs.push_back(pair);
    const Manifolds all = collide_all(box_kernels(), pairs);
    RandomShapes random(23);
    for (std::size_t count = 0; count <= pairs.size(); count += 1 + count / 8) {
        std::vector<std::size_t> from;
        std::vector<PlacedPair> some;
        for (std::size_t i = 0; i < count; ++i) {
            from.push_back(static_cast<std::size_t>(
                random.number(0, static_cast<double>(pairs.size()) - 0.5)));
            some.push_back(pairs[from.back()]);
        }
        const Manifolds found = collide_all(box_kernels(), some);
        for (std::size_t i = 0; i < count; ++i)
            ASSERT_TRUE(same_bits(found[i], all[from[i]])) << count << " pairs, pair " << i;
    }
}

TEST(BoxPairs, FindTouchExactlyWhereBoxesOverlap)
{
    RandomShapes random(24);
    std::vector<PlacedPair> pairs;
    for (int i = 0; i < 6000; ++i)
        pairs.push_back({random.vector(0.05, 1), random.vector(0.05, 1), random.pose(1.2), 0});
    const Manifolds found = collide_all(box_kernels(), pairs);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const BoxPolytope a(pairs[i].half_a), b(pairs[i].half_b);
        const double truth = polytope_separation(a.view(), b.view(), pairs[i].pose, nullptr);
        if (std::abs(truth) < 1e-6) continue;
        ASSERT_EQ(found[i].count > 0, truth < 0) << "seed 24, pair " << i;
        if (truth > 0) continue;
        ASSERT_NEAR(deepest(found[i]), truth, 1e-6 + 2 * pairs[i].bias()) << "seed 24, pair " << i;
    }
}

TEST(BoxPairs, AnswerPairsThatBrokeOthers)
{
    for (const BrokenPair& broken : broken_pairs()) {
        for (const double scale : {1e-6, 1.0, 1e6}) {
            SCOPED_TRACE(std::string(broken.name) + ", scale " + std::to_string(scale));
            PlacedPair pair{broken.a.size * (scale / 2), broken.b.size * (scale / 2),
                            inverse(broken.a.pose) * broken.b.pose, 0};
            pair.pose.position *= scale;
            pair.speculative_margin = 2e-5 * pair.size();
            const auto found = collide_one(pair);
            ASSERT_TRUE(all_finite(found));
            if (broken.separation * scale > 2 * pair.speculative_margin) {
                EXPECT_EQ(found.count, 0);
                continue;
            }
            ASSERT_GT(found.count, 0);
            EXPECT_NEAR(deepest(found), broken.separation * scale,
                        pair.speculative_margin + 2 * pair.bias());
        }
    }
}

TEST(BoxPairs, AnySizeIsAnsweredAlike)
{
    for (const Kind kind : kKinds) {
        const auto pairs = random_pairs(25, kind, 300);
        const Manifolds plain = collide_all(box_kernels(), pairs);
        // Powers of two change no digit.
        for (const double scale : {0x1p-20, 0x1p20}) {
            auto scaled = pairs;
            for (PlacedPair& pair : scaled) {
                pair.half_a *= scale, pair.half_b *= scale, pair.speculative_margin *= scale;
                pair.pose.position *= scale;
            }
            const Manifolds found = collide_all(box_kernels(), scaled);
            for (std::size_t i = 0; i < pairs.size(); ++i) {
                ASSERT_EQ(found[i].count, plain[i].count);
                for (int k = 0; k < found[i].count; ++k) {
                    const auto at = static_cast<std::size_t>(k);
                    ASSERT_EQ(found[i].points[at].feature, plain[i].points[at].feature);
                    ASSERT_EQ(found[i].points[at].separation,
                              plain[i].points[at].separation * static_cast<float>(scale));
                }
            }
        }
    }
}

TEST(BoxPairs, NeedlesPlatesAndFlatBoxesGiveFiniteAnswers)
{
    RandomShapes random(26);
    const Vec3 cube = Vec3::Constant(0.5);
    const std::vector<Vec3> halves = {
        {1000, 0.0005, 0.0005}, {500, 500, 0.0005}, {1e3, 1e-3, 1}, {1, 1, 0}, {1, 0, 0}, {0, 0, 0},
        {1e6, 1e6, 1},          {1e-6, 1e-6, 1e-6}, {1e6, 1e6, 1e6}};
    for (const Vec3& half_a : halves)
        for (const Vec3& half_b : halves)
            for (int i = 0; i < 60; ++i) {
                PlacedPair pair{half_a, half_b, {random.vector(-0.4, 0.4), random.turn()}, 0.01};
                if (i % 3 == 0) pair.pose.orientation.setIdentity();
                if (i % 3 == 1) pair.pose.position.setZero();
                const auto found = collide_one(pair);
                ASSERT_TRUE(all_finite(found) && found.count >= 0 && found.count <= 4)
                    << half_a.transpose() << ", " << half_b.transpose() << ", try " << i;
            }
    for (const Vec3& half : {halves[0], halves[1]}) {
        for (int i = 0; i < 1000; ++i) {
            const PlacedPair pair{half, cube, {random.vector(-0.4, 0.4), random.turn()}, 0};
            const auto found = collide_one(pair);
            ASSERT_TRUE(all_finite(found) && found.count > 0) << "seed 26, pair " << i;
            const BoxPolytope a(half), b(cube);
            const double truth = polytope_separation(a.view(), b.view(), pair.pose, nullptr);
            ASSERT_NEAR(deepest(found), truth, 2 * pair.bias() + 1e-6 * pair.size())
                << "seed 26, pair " << i;
        }
    }
}

TEST(BoxPairs, RestingBoxesKeepTheirFeaturesThroughNoise)
{
    RandomShapes random(27);
    const Vec3 half(0.5, 0.5, 0.5);
    for (const Pose& rest : {at(0, 0, 0.9999), at(0.2, 0.1, 0.9999),
                             Pose{{0, 0, 0.9999}, about(Vec3::UnitZ(), 0.3)}}) {
        const auto first = collide_one({half, half, rest, 0.01});
        ASSERT_EQ(first.count, 4);
        for (int i = 0; i < 200; ++i) {
            Pose noisy = rest;
            noisy.position += random.vector(-1e-5, 1e-5);
            noisy.orientation = about(random.vector(-1, 1), 1e-6) * noisy.orientation;
            const auto found = collide_one({half, half, noisy, 0.01});
            std::vector<std::uint32_t> kept;
            std::ranges::set_intersection(features(found), features(first),
                                          std::back_inserter(kept));
            // The turned one is the same from eight sides, but for noise.
            ASSERT_EQ(found.count, 4);
            ASSERT_GE(kept.size(), rest.orientation.z() > 0 ? 3u : 4u) << "seed 27, try " << i;
        }
    }
}

TEST(BoxPairs, NormalTurnsNoFasterThanTheBox)
{
    const Vec3 half(0.5, 0.4, 0.3);
    for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(1, 0.3, 0.7)}) {
        for (const double angle : {1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2}) {
            const auto found =
                collide_one({half, half, {{0.1, 0.05, 0.599}, about(axis, angle)}, 0.02});
            EXPECT_GE(found.count, 4) << angle;
            EXPECT_LE((found.normal - Vec3T<float>::UnitZ()).norm(), 10 * angle + 1e-6) << angle;
        }
    }
}

TEST(BoxPairs, SwappingTheBoxesMirrorsTheManifold)
{
    int compared = 0;
    for (const Kind kind : kKinds) {
        for (const PlacedPair& pair : random_pairs(28, kind, 500)) {
            const PlacedPair swapped{pair.half_b, pair.half_a, inverse(pair.pose),
                                     pair.speculative_margin};
            const auto one = collide_one(pair), two = collide_one(swapped);
            if (one.count == 0 || two.count == 0) continue;
            const Vec3 back = pair.pose.orientation * -two.normal.cast<double>();
            ASSERT_NEAR(deepest(one), deepest(two), 3 * pair.bias() + 1e-5);
            // Within the bias either box's face may lead.
            if ((back - one.normal.cast<double>()).norm() > 1e-4) continue;
            ++compared;
            ASSERT_NEAR(outline(one), outline(two), 0.3 * outline(one) + 1e-4);
        }
    }
    EXPECT_GT(compared, 1000);
}

}  // namespace throng
