// Polytopes by the wide kernels: against the plain arithmetic of double, at every size and width.
#include "kernels/geometry/separating_axes.hpp"
#include "kernels/math/turn_between.hpp"
#include "narrowphase/convex/wide/hull_kernels.hpp"
#include "narrowphase/convex/wide_shapes.hpp"
#include "tests/support/polyhedra.hpp"
#include "tests/support/same_bytes.hpp"

#include <gtest/gtest.h>

#include <cstring>

namespace throng {
namespace {

constexpr ShapeRef kHullA{ShapeKind::hull, 0}, kHullB{ShapeKind::hull, 1};
constexpr ShapeRef kBox{ShapeKind::box, 0};

double bias_of(const PolytopeView& a, const PolytopeView& b)
{
    return 1e-3 * (a.inner_radius + b.inner_radius);
}

// Stones, slabs and needles; corners all over a ball drawn long or flat.
Hull random_stone(RandomShapes& random, double scale)
{
    const Vec3 semi_axes = random.vector(0.1, 1) * scale;
    const int corners = static_cast<int>(random.number(6, 50));
    std::vector<Vec3> cloud;
    const Vec3 center = random.vector(-0.2, 0.2) * scale;
    for (int i = 0; i < corners; ++i)
        cloud.push_back(center + random.vector(-1, 1).normalized().cwiseProduct(semi_axes));
    return build_hull(cloud).hull;
}

// A pair moved along its best axis to a wanted separation.
Pose parted_by(const PolytopeView& a, const PolytopeView& b, Pose pose, double wanted)
{
    for (int i = 0; i < 6; ++i) {
        Vec3 normal = Vec3::UnitZ();
        const double separation = polytope_separation(a, b, pose, &normal);
        pose.position += (wanted - separation) * normal;
    }
    return pose;
}

bool same(const LocalManifold<float>& one, const LocalManifold<float>& two)
{
    if (one.count != two.count) return false;
    if (one.count > 0 && one.normal != two.normal) return false;
    for (int k = 0; k < one.count; ++k) {
        const auto& p = one.points[static_cast<std::size_t>(k)];
        const auto& q = two.points[static_cast<std::size_t>(k)];
        if (p.position != q.position || p.separation != q.separation || p.feature != q.feature)
            return false;
    }
    return true;
}

}  // namespace

TEST(WideHull, AgreesWithEveryAxisAtEverySize)
{
    for (const double scale : {1e-6, 1.0, 1e6}) {
        RandomShapes random(31);
        for (int i = 0; i < 120; ++i) {
            SCOPED_TRACE("seed 31, scale " + std::to_string(scale) + ", pair " + std::to_string(i));
            Shapes shapes;
            shapes.hulls = {random_stone(random, scale), random_stone(random, scale)};
            shapes.boxes = {{random.vector(0.1, 1) * scale}};
            const bool box = i % 3 == 0;
            const BoxPolytope a_box(shapes.boxes[0].half_extents);
            const PolytopeView a = box ? a_box.view() : view_of(shapes.hulls[0]);
            const PolytopeView b = view_of(shapes.hulls[1]);
            ASSERT_TRUE(WideShape(shapes, kHullB).suited());
            Pose pose = random.pose(scale);
            const double wanted[] = {-0.2, -0.01, -1e-4, 1e-3};
            if (i % 5 != 0) pose = parted_by(a, b, pose, wanted[i % 4] * scale);
            const double speculative_margin = 0.005 * scale;
            const double exact = polytope_separation(a, b, pose, nullptr);
            const auto found = run<float>(hull_hull<float>, shapes, box ? kBox : kHullA, kHullB,
                                          pose, speculative_margin);
            ASSERT_TRUE(all_finite(found) && features_differ(found));
            const double size = a.outer_radius + b.outer_radius + a.center.norm() + b.center.norm();
            const double near = 1e-5 * size, bias = bias_of(a, b);
            ASSERT_TRUE(found.count == 0 || exact <= speculative_margin + near);
            ASSERT_TRUE(found.count > 0 || exact >= -near);
            if (found.count == 0) continue;
            ASSERT_NEAR(found.normal.norm(), 1, 1e-5);
            // Where they overlap the normal is a way out that is hardly longer than the shortest.
            if (exact > 0) continue;
            ASSERT_NEAR(deepest(found), exact, 2 * bias + near);
            const Vec3 normal = found.normal.cast<double>();
            const double along = -extent_of({b.vertices.begin(), b.vertices.end()}, pose)(-normal)
                - extent_of({a.vertices.begin(), a.vertices.end()}, Pose{})(normal);
            // A face may stand in for edges whose normal leans a fiftieth from its own.
            ASSERT_GE(along, exact - 2 * bias - near - 0.02 * size);
            ASSERT_LE(along, exact + near);
        }
    }
}

// Faces are favored over edges that are a little better, and a's faces over b's; but that tells
// where they touch, and not whether.
TEST(WideHull, TellsWhoTouchesHoweverLittleAnAxisLeads)
{
    RandomShapes random(37);
    int apart = 0, deep = 0, too_many = 0, missed = 0;
    for (int i = 0; i < 4000; ++i) {
        Shapes shapes;
        shapes.hulls = {random.hull(8 + i % 5, 1), random.hull(6 + i % 7, 1)};
        shapes.boxes = {{random.vector(0.2, 1)}};
        const ShapeRef first = i % 3 == 0 ? kBox : kHullA;
        const PolytopeShape a_shape(shapes, first), b_shape(shapes, kHullB);
        const PolytopeView &a = a_shape.view(), &b = b_shape.view();
        const double size = std::max(a.outer_radius, b.outer_radius);
        const double speculative_margin = i % 2 == 0 ? 0 : 0.02;
        const double beyond = random.number(-6e-4, 3e-4) * size;
        Pose pose = random.pose(2);
        // A face all but along a face.
        const Quat tilt(1, random.number(-1e-2, 1e-2), random.number(-1e-2, 1e-2), 0);
        if (i % 4 < 2)
            pose.orientation = tilt.normalized()
                * turn_between(b.normals[static_cast<std::size_t>(i) % b.normals.size()],
                               -a.normals.back());
        pose = parted_by(a, b, pose, beyond > 0 ? speculative_margin + beyond : beyond);
        const double exact = polytope_separation(a, b, pose, nullptr);
        const auto coarse =
            run<float>(hull_hull<float>, shapes, first, kHullB, pose, speculative_margin);
        const auto fine =
            run<double>(hull_hull<double>, shapes, first, kHullB, pose, speculative_margin);
        // Within reach and apart, edges may still pass one another by further.
        if (exact > speculative_margin + 1e-5 * size) {
            ++apart;
            too_many += (coarse.count > 0) + (fine.count > 0);
        } else if (exact < -1e-5 * size) {
            ++deep;
            missed += (coarse.count == 0) + (fine.count == 0);
        }
    }
    EXPECT_GT(apart, 1000);
    EXPECT_GT(deep, 2000);
    EXPECT_EQ(too_many, 0) << "seed 37";
    // What a face's lead hides is left until it is four leads deep, and none of these is: a contact
    // that comes and goes would rock a body at rest.
    EXPECT_LE(missed, 2) << "seed 37";
}

TEST(WideHull, SameNormalAsInDoubleWhereOneFeatureLeads)
{
    RandomShapes random(32);
    int compared = 0, unlike_counts = 0;
    for (int i = 0; i < 200; ++i) {
        SCOPED_TRACE("seed 32, pair " + std::to_string(i));
        Shapes shapes;
        shapes.hulls = {random_stone(random, 1), random_stone(random, 1)};
        const PolytopeView a = view_of(shapes.hulls[0]), b = view_of(shapes.hulls[1]);
        const Pose pose = parted_by(a, b, random.pose(1), -0.01);
        const auto coarse = run<float>(hull_hull<float>, shapes, kHullA, kHullB, pose, 0.02);
        const auto fine = run<double>(hull_hull<double>, shapes, kHullA, kHullB, pose, 0.02);
        ASSERT_GT(coarse.count, 0);
        ASSERT_GT(fine.count, 0);
        // Two features may be as good as one another, and edges nearly parallel.
        const double unlike = (coarse.normal.cast<double>() - fine.normal).norm();
        if (unlike > 1e-3) continue;
        ++compared;
        ASSERT_LT(unlike, 1e-5);
        ASSERT_NEAR(deepest(coarse), deepest(fine), 1e-5);
        // A point may be just within the slack of a side for one of them.
        unlike_counts += coarse.count != fine.count ? 1 : 0;
    }
    EXPECT_GT(compared, 195);
    EXPECT_LT(unlike_counts, 4);
}

TEST(WideHull, RememberingNeverChangesABit)
{
    RandomShapes random(33);
    for (int i = 0; i < 80; ++i) {
        Shapes shapes;
        shapes.hulls = {random_stone(random, 1), random_stone(random, 1)};
        shapes.boxes = {{random.vector(0.1, 1)}};
        const bool box = i % 3 == 0;
        const ShapeRef a = box ? kBox : kHullA;
        const BoxPolytope a_box(shapes.boxes[0].half_extents);
        Pose pose = parted_by(box ? a_box.view() : view_of(shapes.hulls[0]),
                              view_of(shapes.hulls[1]), random.pose(1), -0.005);
        PairCache cache;
        for (int step = 0; step < 30; ++step) {
            pose.position += random.vector(-0.01, 0.01);
            const Quat turn(1, random.number(-0.02, 0.02), random.number(-0.02, 0.02), 0);
            pose.orientation = (turn.normalized() * pose.orientation).normalized();
            const auto cold = run<float>(hull_hull<float>, shapes, a, kHullB, pose, 0.02);
            LocalManifold<float> warm;
            hull_hull<float>({shapes, a, kHullB, cast<float>(pose), 0.02F}, cache, warm);
            ASSERT_TRUE(same(cold, warm)) << "seed 33, pair " << i << ", step " << step;
            // What is remembered of another pair is no worse than nothing.
            PairCache other{static_cast<std::uint32_t>(random.number(0, 300)),
                            static_cast<std::uint32_t>(random.number(0, 300)),
                            static_cast<std::uint32_t>(random.number(0, 5))};
            LocalManifold<float> misled;
            hull_hull<float>({shapes, a, kHullB, cast<float>(pose), 0.02F}, other, misled);
            ASSERT_TRUE(same(cold, misled)) << "seed 33, pair " << i << ", step " << step;
        }
    }
}

HullPair pair_of(const WideShape& a, const WideShape& b, const Pose& b_in_a)
{
    const Mat3 turn = b_in_a.orientation.toRotationMatrix();
    const Vec3 offset = turn * b.center() + b_in_a.position - a.center();
    HullPair pair{a.view(), b.view(), {}, {}, 0.02F, 1e-3F * (a.view().inner + b.view().inner)};
    for (int k = 0; k < 9; ++k) pair.turn[k] = static_cast<float>(turn(k / 3, k % 3));
    for (int k = 0; k < 3; ++k) pair.offset[k] = static_cast<float>(offset[k]);
    return pair;
}

TEST(WideHull, EveryWidthGivesTheSameBits)
{
    RandomShapes random(34);
    for (int i = 0; i < 300; ++i) {
        SCOPED_TRACE("seed 34, pair " + std::to_string(i));
        Shapes shapes;
        shapes.hulls = {random_stone(random, 1), random_stone(random, 1)};
        shapes.boxes = {{random.vector(0.1, 1)}};
        const WideShape a(shapes, i % 3 == 0 ? kBox : kHullA), b(shapes, kHullB);
        const Pose pose = random.pose(0.8);
        const HullPair pair = pair_of(a, b, pose);
        HullGuess plain_guess;
        HullOverlap plain;
        (*hull_kernel_of("scalar"))(pair, plain_guess, plain);
        for (const char* width : {"avx2", "avx512"}) {
            const HullKernel* const kernel = hull_kernel_of(width);
            if (!kernel) continue;
            HullGuess guess;
            HullOverlap wide;
            (*kernel)(pair, guess, wide);
            ASSERT_EQ(wide.count, plain.count) << width;
            ASSERT_TRUE(given::same_bytes(guess, plain_guess)) << width;
            if (wide.count == 0) continue;
            ASSERT_TRUE(given::same_bytes(wide.normal, plain.normal)) << width;
            const auto bytes = sizeof plain.points[0] * static_cast<std::size_t>(plain.count);
            ASSERT_EQ(std::memcmp(wide.points, plain.points, bytes), 0) << width;
        }
    }
}

TEST(WideHull, WhatIsKnownToBeApartIsSoAtEveryWidthAlike)
{
    RandomShapes random(36);
    int apart = 0;
    for (int i = 0; i < 300; ++i) {
        SCOPED_TRACE("seed 36, pair " + std::to_string(i));
        Shapes shapes;
        shapes.hulls = {random_stone(random, 1), random_stone(random, 1)};
        const WideShape a(shapes, kHullA), b(shapes, kHullB);
        const Pose pose = random.pose(1.2);
        const HullPair pair = pair_of(a, b, pose);
        HullGuess first_guess;
        HullOverlap plain;
        (*hull_kernel_of("scalar"))(pair, first_guess, plain);
        if (plain.count > 0) continue;
        const double exact =
            polytope_separation(view_of(shapes.hulls[0]), view_of(shapes.hulls[1]), pose, nullptr);
        ASSERT_LE(double{plain.apart}, exact + 1e-6);
        apart += plain.apart > pair.speculative_margin ? 1 : 0;
        for (const char* width : {"avx2", "avx512"}) {
            const HullKernel* const kernel = hull_kernel_of(width);
            if (!kernel) continue;
            HullGuess guess;
            HullOverlap wide;
            (*kernel)(pair, guess, wide);
            ASSERT_EQ(wide.count, 0) << width;
            ASSERT_EQ(wide.apart, plain.apart) << width;
        }
    }
    EXPECT_GT(apart, 100);
}

TEST(WideHull, FourCornersOfEqualBoxesLyingOnOneAnother)
{
    RandomShapes random(35);
    Shapes shapes;
    shapes.hulls = {build_hull(corners_of({0.5, 0.4, 0.3})).hull,
                    build_hull(corners_of({0.5, 0.4, 0.3})).hull};
    std::uint32_t names = 0;
    for (int i = 0; i < 200; ++i) {
        Pose pose = at(0, 0, 0.599);
        pose.position += random.vector(-1e-5, 1e-5);
        pose.orientation = Quat(1, random.number(-1e-5, 1e-5), random.number(-1e-5, 1e-5),
                                random.number(-1e-5, 1e-5))
                               .normalized();
        const auto found = run<float>(hull_hull<float>, shapes, kHullA, kHullB, pose, 0.02);
        ASSERT_EQ(found.count, 4) << "seed 35, pair " << i;
        std::uint32_t sum = 0;
        for (const auto& point : found.points) sum += point.feature;
        if (i == 0) names = sum;
        ASSERT_EQ(sum, names) << "seed 35, pair " << i;
        EXPECT_LT((found.normal - Vec3T<float>(0, 0, 1)).norm(), 1e-4);
    }
}

TEST(WideHull, ThinAndUnlikeShapesGoByDouble)
{
    Shapes shapes;
    shapes.hulls = {build_hull(corners_of({1, 1, 1e-5})).hull,
                    build_hull(corners_of({0.5, 0.4, 0.3})).hull};
    shapes.boxes = {{{1000, 1000, 0.5}}};
    EXPECT_FALSE(WideShape(shapes, kHullA).suited());
    for (const ShapeRef a : {kHullA, kBox}) {
        const double top = a == kBox ? 0.5 : 1e-5;
        const auto found =
            run<float>(hull_hull<float>, shapes, a, kHullB, at(0.1, 0, top + 0.3 - 1e-6), 1e-3);
        ASSERT_EQ(found.count, 4);
        EXPECT_NEAR(deepest(found), -1e-6, 5e-7);
    }
}

}  // namespace throng
