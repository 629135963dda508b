#include "cooking/hulls/hull.hpp"
#include "kernels/math/turn_between.hpp"
#include "tests/narrowphase/convex/round_pairs.hpp"

namespace throng {
namespace {

using given::deepest_of;
using given::Placement;
using given::random_direction;
using given::random_turn;

constexpr ShapeRef kCapsule = {ShapeKind::capsule, 0}, kSphere = {ShapeKind::sphere, 0},
                   kHull = {ShapeKind::hull, 0};

double uniform(std::mt19937& random, double from, double to)
{
    return std::uniform_real_distribution<double>(from, to)(random);
}

// A hull flattened by up to a hundred, and a round shape near it.
Placement random_placement(ShapeRef round, std::mt19937& random, double scale)
{
    Placement pair;
    pair.a = round;
    pair.b = kHull;
    pair.shapes.capsules = {{scale * uniform(random, 0.05, 0.5), scale * uniform(random, 0, 1)}};
    pair.shapes.spheres = {{scale * uniform(random, 0.05, 0.5)}};
    const Vec3 flat(1, std::pow(10.0, -uniform(random, 0, 2)), uniform(random, 0.1, 1));
    std::vector<Vec3> points;
    for (int i = 0; i < 20; ++i)
        points.push_back(scale * random_direction(random).cwiseProduct(flat));
    pair.shapes.hulls = {build_hull(points).hull};
    pair.b_in_a = {scale * uniform(random, 0.01, 2) * random_direction(random),
                   random_turn(random)};
    return pair;
}

template <class Real>
bool same(const LocalManifold<Real>& one, const LocalManifold<Real>& two)
{
    bool equal = one.count == two.count && (one.count == 0 || one.normal == two.normal);
    for (std::size_t i = 0; equal && i < static_cast<std::size_t>(one.count); ++i) {
        equal = one.points[i].position == two.points[i].position
            && one.points[i].separation == two.points[i].separation
            && one.points[i].feature == two.points[i].feature;
    }
    return equal;
}

// Moves the round shape a little at a time and asks with and without what the pair remembers.
template <class Real>
void expect_cache_never_tells(PairFunction<Real> function, Placement pair, std::mt19937& random)
{
    PairCache cache;
    for (int i = 0; i < 40; ++i) {
        pair.b_in_a.position += 0.05 * random_direction(random);
        const PoseT<Real> pose = {pair.b_in_a.position.cast<Real>(),
                                  QuatT<Real>(pair.b_in_a.orientation.cast<Real>())};
        LocalManifold<Real> warm;
        function({pair.shapes, pair.a, pair.b, pose, Real(0.5)}, cache, warm);
        EXPECT_TRUE(same(warm, given::collide<Real>(function, pair, 0.5))) << "step " << i;
    }
}

}  // namespace

TEST(RoundHull, AgreesWithTheSearchWhateverTheSize)
{
    // A hull's face may stand for a few that lean from it by a millionth or so.
    constexpr double kExact = 1e-5, kCoarse = 1e-5;
    std::mt19937 random(61);
    for (const double scale : {1e-6, 1.0, 1e6}) {
        for (int i = 0; i < 500; ++i) {
            SCOPED_TRACE("seed 61, case " + std::to_string(i));
            given::expect_as_searched(capsule_hull<double>, capsule_hull<float>,
                                      random_placement(kCapsule, random, scale), kExact, kCoarse);
            given::expect_as_searched(sphere_hull<double>, sphere_hull<float>,
                                      random_placement(kSphere, random, scale), kExact, kCoarse);
            if (HasFailure()) return;
        }
    }
}

TEST(RoundHull, WhatThePairRemembersNeverChangesTheAnswer)
{
    std::mt19937 random(62);
    for (int i = 0; i < 100; ++i) {
        SCOPED_TRACE("seed 62, case " + std::to_string(i));
        expect_cache_never_tells<double>(capsule_hull<double>,
                                         random_placement(kCapsule, random, 1), random);
        expect_cache_never_tells<float>(capsule_hull<float>, random_placement(kCapsule, random, 1),
                                        random);
        expect_cache_never_tells<double>(sphere_hull<double>, random_placement(kSphere, random, 1),
                                         random);
        expect_cache_never_tells<float>(sphere_hull<float>, random_placement(kSphere, random, 1),
                                        random);
    }
}

// The hull of a box answers as the box does.
TEST(RoundHull, CapsuleLyingOnAHullTouchesAsOnTheBoxThatItIs)
{
    std::mt19937 random(63);
    const Vec3 half(1, 0.5, 0.4);
    std::vector<Vec3> corners;
    for (int i = 0; i < 8; ++i) {
        corners.push_back(half.cwiseProduct(Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
    }
    for (int i = 0; i < 300; ++i) {
        const double angle = uniform(random, 0, 7);
        const Quat turn = turn_between(
            Vec3(std::cos(angle), std::sin(angle), uniform(random, -0.02, 0.02)).normalized(),
            Vec3(0, 0, 1));
        const Vec3 middle(uniform(random, -1, 1), uniform(random, -0.5, 0.5), 0.5);
        Placement pair;
        pair.a = kCapsule;
        pair.b = kHull;
        pair.b_in_a = {-(turn * middle), turn};
        pair.shapes.capsules = {{0.1, 0.3}};
        pair.shapes.boxes = {{half}};
        pair.shapes.hulls = {build_hull(corners).hull};
        const auto on_hull = given::collide<double>(capsule_hull<double>, pair, 0.02);
        pair.b = {ShapeKind::box, 0};
        const auto on_box = given::collide<double>(capsule_box<double>, pair, 0.02);
        ASSERT_GT(on_hull.count, 0);
        EXPECT_NEAR(deepest_of(on_hull), deepest_of(on_box), 1e-9) << "seed 63, case " << i;
        EXPECT_LT((on_hull.normal - on_box.normal).norm(), 1e-7);
        if (on_hull.points[0].feature > 2) continue;  // over the edge, and searched for
        ASSERT_EQ(on_hull.count, on_box.count) << "seed 63, case " << i;
        for (std::size_t k = 0; k < static_cast<std::size_t>(on_hull.count); ++k) {
            EXPECT_LT((on_hull.points[k].position - on_box.points[k].position).norm(), 1e-9);
            EXPECT_EQ(on_hull.points[k].feature, on_box.points[k].feature);
        }
    }
}

}  // namespace throng
