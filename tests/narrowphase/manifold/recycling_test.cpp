// Recycling: a manifold told from where its points are now, against points moved in double and
// against one that is found anew.
#include "narrowphase/manifold/recycling.hpp"

#include "kernels/geometry/separating_axes.hpp"
#include "tests/support/polyhedra.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

constexpr ShapeRef kA{ShapeKind::hull, 0}, kB{ShapeKind::hull, 1};
constexpr double kReach = 0.02, kBound = 0.002;

struct Touching {
    Shapes shapes;
    Pose pose;
    double radius_b = 0;
};

// Two stones that overlap by a little.
Touching touching(RandomShapes& random)
{
    Touching made;
    made.shapes.hulls = {random.hull(24, 0.5), random.hull(24, 0.5)};
    const PolytopeView a = view_of(made.shapes.hulls[0]), b = view_of(made.shapes.hulls[1]);
    made.pose = random.pose(0.5);
    for (int i = 0; i < 6; ++i) {
        Vec3 normal = Vec3::UnitZ();
        const double separation = polytope_separation(a, b, made.pose, &normal);
        made.pose.position += (-0.003 - separation) * normal;
    }
    made.radius_b = b.center.norm() + b.outer_radius;
    return made;
}

template <class Real>
CachedManifold<Real> find(const Touching& pair)
{
    return {run<Real>(hull_hull<Real>, pair.shapes, kA, kB, pair.pose, kReach),
            cast<Real>(pair.pose), static_cast<Real>(kReach)};
}

template <class Real>
bool again(const CachedManifold<Real>& found,
           const Touching& pair,
           const Pose& pose,
           double speculative_margin,
           LocalManifold<Real>& out)
{
    return recycle<Real>(found, cast<Real>(pose), static_cast<Real>(speculative_margin),
                         static_cast<Real>(pair.radius_b), static_cast<Real>(kBound), out);
}

// b moved by about this much as a whole and as much again by turning.
Pose nudged(RandomShapes& random, const Touching& pair, double by)
{
    const Vec3 axis = random.vector(-1, 1).normalized() * (by / pair.radius_b / 2);
    Pose moved = pair.pose;
    moved.position += random.vector(-1, 1).normalized() * by;
    moved.orientation = Quat(1, axis.x(), axis.y(), axis.z()).normalized() * moved.orientation;
    return moved;
}

template <class Real>
class RecycleOf : public ::testing::Test { };
using Reals = ::testing::Types<float, double>;
TYPED_TEST_SUITE(RecycleOf, Reals);

}  // namespace

TYPED_TEST(RecycleOf, WhoeverStaysHasTheSameManifoldToTheBit)
{
    RandomShapes random(61);
    for (int i = 0; i < 100; ++i) {
        const Touching pair = touching(random);
        const auto found = find<TypeParam>(pair);
        ASSERT_GT(found.manifold.count, 0);
        LocalManifold<TypeParam> same;
        ASSERT_TRUE(again(found, pair, pair.pose, kReach, same));
        ASSERT_EQ(same.count, found.manifold.count);
        ASSERT_EQ(same.normal, found.manifold.normal);
        for (std::size_t k = 0; k < static_cast<std::size_t>(same.count); ++k) {
            ASSERT_EQ(same.points[k].position, found.manifold.points[k].position);
            ASSERT_EQ(same.points[k].separation, found.manifold.points[k].separation);
            ASSERT_EQ(same.points[k].feature, found.manifold.points[k].feature);
        }
    }
}

TYPED_TEST(RecycleOf, PointsGoWithTheirBodies)
{
    const double near = std::is_same_v<TypeParam, float> ? 1e-6 : 1e-14;
    RandomShapes random(62);
    for (int i = 0; i < 200; ++i) {
        SCOPED_TRACE("seed 62, pair " + std::to_string(i));
        const Touching pair = touching(random);
        const auto found = find<TypeParam>(pair);
        const Pose moved = nudged(random, pair, kBound / 2.1);
        LocalManifold<TypeParam> out;
        ASSERT_TRUE(again(found, pair, moved, kReach, out));
        // The plain way: either half of a point in its own body's frame, then put together again.
        const Vec3 normal = found.manifold.normal.template cast<double>();
        int at = 0;
        for (int k = 0; k < found.manifold.count; ++k) {
            const auto& point = found.manifold.points[static_cast<std::size_t>(k)];
            const Vec3 middle = point.position.template cast<double>();
            const Vec3 half = normal * (double{point.separation} / 2);
            const Vec3 on_a = middle - half;
            const Vec3 on_b = moved * pair.pose.to_local(middle + half);
            const double separation = normal.dot(on_b - on_a);
            if (separation > kReach) continue;
            const auto& told = out.points[static_cast<std::size_t>(at++)];
            ASSERT_EQ(told.feature, point.feature);
            ASSERT_NEAR(double{told.separation}, separation, near);
            ASSERT_LT((told.position.template cast<double>() - (on_a + on_b) / 2).norm(), near);
        }
        ASSERT_EQ(out.count, at);
    }
}

TYPED_TEST(RecycleOf, IsAsDeepAsWhatIsFoundAnew)
{
    RandomShapes random(63);
    int compared = 0;
    double sum = 0;
    for (int i = 0; i < 300; ++i) {
        SCOPED_TRACE("seed 63, pair " + std::to_string(i));
        const Touching pair = touching(random);
        const auto found = find<TypeParam>(pair);
        const Pose moved = nudged(random, pair, kBound / 2.1);
        LocalManifold<TypeParam> out;
        ASSERT_TRUE(again(found, pair, moved, kReach, out));
        const auto anew = run<TypeParam>(hull_hull<TypeParam>, pair.shapes, kA, kB, moved, kReach);
        ASSERT_GT(anew.count, 0);
        const double unlike = std::abs(deepest(out) - deepest(anew));
        ASSERT_LE(unlike, 2 * kBound);
        sum += unlike;
        ++compared;
    }
    // Most go on touching where they did.
    EXPECT_LT(sum / compared, kBound / 10);
}

TYPED_TEST(RecycleOf, WhoeverMovedFurtherIsFoundAnew)
{
    RandomShapes random(64);
    for (int i = 0; i < 100; ++i) {
        const Touching pair = touching(random);
        const auto found = find<TypeParam>(pair);
        LocalManifold<TypeParam> out;
        EXPECT_FALSE(again(found, pair, nudged(random, pair, kBound / 1.9), kReach, out));
        // The same turn told by the other quaternion is no turn at all.
        Pose same = pair.pose;
        same.orientation.coeffs() = -same.orientation.coeffs();
        EXPECT_TRUE(again(found, pair, same, kReach, out));
        // A greater reach may find what was left out.
        EXPECT_TRUE(again(found, pair, same, kReach + kBound * 0.9, out));
        EXPECT_FALSE(again(found, pair, same, kReach + kBound * 1.1, out));
        Pose nowhere = pair.pose;
        nowhere.position.x() = std::numeric_limits<double>::quiet_NaN();
        EXPECT_FALSE(again(found, pair, nowhere, kReach, out));
    }
}

// b may reach as far as it will, or have no end: what of it is near a has not moved further.
TYPED_TEST(RecycleOf, NothingOfBThatIsNearAMovedFurtherThanIsTold)
{
    using Real = TypeParam;
    RandomShapes random(66);
    const double slack = 1e3 * static_cast<double>(std::numeric_limits<Real>::epsilon());
    for (int i = 0; i < 100; ++i) {
        const Touching pair = touching(random);
        const Pose then{pair.pose.position + Vec3(20, 0, 0), pair.pose.orientation};
        const Pose now = nudged(random, {{}, then, pair.radius_b}, kBound);
        for (const Real radius_b : {Real(30), std::numeric_limits<Real>::infinity()}) {
            const auto told = static_cast<double>(
                furthest_moved_near(cast<Real>(then), cast<Real>(now), Real(2), radius_b));
            for (int k = 0; k < 20; ++k) {
                const Vec3 place = random.vector(-1, 1).normalized() * 2;
                const double moved = (now * then.to_local(place) - place).norm();
                ASSERT_LE(moved, told + slack) << "seed 66, pair " << i;
            }
        }
        EXPECT_LE(furthest_moved_near(cast<Real>(then), cast<Real>(then), Real(2),
                                      std::numeric_limits<Real>::infinity()),
                  static_cast<Real>(slack));
    }
}

TYPED_TEST(RecycleOf, PointsOutOfReachAreLeftOut)
{
    RandomShapes random(65);
    const Touching pair = touching(random);
    const auto found = find<TypeParam>(pair);
    LocalManifold<TypeParam> out;
    ASSERT_TRUE(again(found, pair, pair.pose, -0.002, out));
    EXPECT_GT(out.count, 0);
    ASSERT_TRUE(again(found, pair, pair.pose, -0.004, out));
    EXPECT_EQ(out.count, 0);
}

}  // namespace throng
