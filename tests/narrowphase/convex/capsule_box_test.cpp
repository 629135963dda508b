#include "kernels/math/turn_between.hpp"
#include "tests/narrowphase/convex/round_pairs.hpp"

namespace throng {
namespace {

using given::collide;
using given::deepest_of;
using given::Placement;
using given::random_direction;
using given::random_turn;

constexpr ShapeRef kCapsule = {ShapeKind::capsule, 0}, kBox = {ShapeKind::box, 0};

double uniform(std::mt19937& random, double from, double to)
{
    return std::uniform_real_distribution<double>(from, to)(random);
}

// Sizes that differ by up to 10 to the `spread`, times a scale.
Placement random_placement(std::mt19937& random, double scale, double spread)
{
    const auto size = [&] { return scale * std::pow(10.0, uniform(random, -spread, 0)); };
    Placement pair;
    pair.a = kCapsule;
    pair.b = kBox;
    pair.shapes.capsules = {{size(), size()}};
    pair.shapes.boxes = {{Vec3(size(), size(), size())}};
    // Near a random point of the box's bounds, or well within.
    const Vec3& box = pair.shapes.boxes[0].half_extents;
    const Capsule& capsule = pair.shapes.capsules[0];
    const double out = uniform(random, 0, 1.2);
    const Vec3 place = random_direction(random).cwiseProduct(box) * out
        + random_direction(random) * uniform(random, 0, 1.5)
            * (capsule.radius + capsule.half_length);
    const Quat turn = random_turn(random);
    pair.b_in_a = {-(turn * place), turn};
    return pair;
}

// The capsule's axis along a direction of the box, its middle at a place in the box's frame.
Placement placed(const Capsule& capsule, const Vec3& box, const Vec3& middle, const Vec3& along)
{
    Placement pair;
    pair.a = kCapsule;
    pair.b = kBox;
    pair.shapes.capsules = {capsule};
    pair.shapes.boxes = {{box}};
    const Quat turn = turn_between(along, Vec3(0, 0, 1));
    pair.b_in_a = {-(turn * middle), turn};
    return pair;
}

void expect_as_searched(const Placement& pair, double exact, double coarse)
{
    given::expect_as_searched(capsule_box<double>, capsule_box<float>, pair, exact, coarse);
}

}  // namespace

TEST(CapsuleBox, AgreesWithTheSearchWhateverTheSize)
{
    std::mt19937 random(41);
    for (const double scale : {1e-6, 1.0, 1e6}) {
        for (int i = 0; i < 2000; ++i) {
            SCOPED_TRACE("seed 41, case " + std::to_string(i));
            expect_as_searched(random_placement(random, scale, 1), 1e-9, 4e-6);
            if (HasFailure()) return;
        }
    }
}

TEST(CapsuleBox, AgreesWithTheSearchForNeedlesAndPlates)
{
    std::mt19937 random(42);
    for (int i = 0; i < 3000; ++i) {
        SCOPED_TRACE("seed 42, case " + std::to_string(i));
        expect_as_searched(random_placement(random, 1, 1 + i % 6), 1e-8, 4e-6);
        if (HasFailure()) return;
    }
}

TEST(CapsuleBox, AxesAlongTheBoxAgreeWithTheSearch)
{
    std::mt19937 random(43);
    for (int i = 0; i < 3000; ++i) {
        SCOPED_TRACE("seed 43, case " + std::to_string(i));
        Vec3 along = Vec3::Unit(i % 3);
        if (i % 2) along += std::pow(10.0, -uniform(random, 2, 16)) * random_direction(random);
        const Vec3 box(0.5, 0.8, 0.3), middle = uniform(random, 0, 2) * random_direction(random);
        const Capsule capsule = {0.1, uniform(random, 0.1, 1.5)};
        expect_as_searched(placed(capsule, box, middle, along.normalized()), 1e-8, 4e-6);
        if (HasFailure()) return;
    }
}

// An end above a point of the surface, in a direction that has that point for its nearest: what
// comes out is that direction.
TEST(CapsuleBox, NormalsAreTrueOverFacesEdgesAndCorners)
{
    std::mt19937 random(44);
    for (int i = 0; i < 3000; ++i) {
        SCOPED_TRACE("seed 44, case " + std::to_string(i));
        const double scale = std::pow(10.0, i % 13 - 6);
        const Vec3 box = scale * Vec3(0.5, 0.8, 0.3);
        const int sharp = 1 + i % 3;  // coordinates at the rim: 1 a face, 2 an edge, 3 a corner
        Vec3 point, out = Vec3::Zero();
        for (int k = 0; k < 3; ++k) {
            const int axis = (k + i / 3) % 3;
            const double side = uniform(random, -1, 1);
            const bool at_rim = k < sharp;
            point[axis] = box[axis] * (at_rim ? std::copysign(1.0, side) : 0.99 * side);
            if (at_rim) out[axis] = side;
        }
        out.normalize();
        Vec3 along = random_direction(random);
        if (along.dot(out) < 0) along = -along;
        const Capsule capsule = {0.1 * scale, 0.7 * scale};
        const double clearance = uniform(random, 0.01, 0.3) * scale;
        const Vec3 middle = point + clearance * out + capsule.half_length * along;
        const Placement pair = placed(capsule, box, middle, along);
        const Vec3 normal = pair.b_in_a.orientation * -out;
        const auto found = collide<double>(capsule_box<double>, pair, 10 * scale);
        const auto rounded = collide<float>(capsule_box<float>, pair, 10 * scale);
        ASSERT_GT(found.count, 0);
        ASSERT_GT(rounded.count, 0);
        EXPECT_LT((found.normal - normal).norm(), 1e-11);
        EXPECT_LT((rounded.normal.cast<double>() - normal).norm(), 1e-4);
        EXPECT_NEAR(deepest_of(found) / scale, clearance / scale - 0.1, 1e-13);
        EXPECT_NEAR(deepest_of(rounded) / scale, clearance / scale - 0.1, 2e-6);
        if (found.count > 1) continue;
        const Vec3 between = point + out * (clearance / 2 - 0.05 * scale);
        const Vec3 where = pair.b_in_a * between;
        EXPECT_LT((found.points[0].position - where).norm(), 1e-12 * scale);
        EXPECT_LT((rounded.points[0].position.cast<double>() - where).norm(), 2e-5 * scale);
    }
}

TEST(CapsuleBox, LyingTouchesWithBothEnds)
{
    for (const double depth : {-0.01, 0.0, 0.01, 0.1, 0.15}) {
        const Placement pair = placed({0.1, 0.4}, {1, 1, 0.5}, {0.1, 0.2, 0.6 - depth}, {0, 1, 0});
        const auto found = collide<double>(capsule_box<double>, pair, 0.02);
        ASSERT_EQ(found.count, 2) << depth;
        for (std::size_t i = 0; i < 2; ++i) {
            EXPECT_EQ(found.points[i].feature, i);
            EXPECT_NEAR(found.points[i].separation, -depth, 1e-12);
            EXPECT_NEAR(found.points[i].position.z(), i == 0 ? -0.4 : 0.4, 1e-12);
        }
        EXPECT_LT((pair.b_in_a.orientation.conjugate() * found.normal - Vec3(0, 0, -1)).norm(),
                  1e-12);
    }
}

TEST(CapsuleBox, OverhangingEndTouchesAtTheEdge)
{
    const Placement pair = placed({0.1, 0.4}, {1, 0.3, 0.5}, {0.1, 0.2, 0.6}, {0, 1, 0});
    const auto found = collide<double>(capsule_box<double>, pair, 0.02);
    ASSERT_EQ(found.count, 2);
    EXPECT_NEAR(found.points[0].position.z(), -0.4, 1e-12);
    EXPECT_NEAR(found.points[1].position.z(), 0.1, 1e-12);
    EXPECT_EQ(found.points[0].feature, 0U);
    EXPECT_EQ(found.points[1].feature, 1U);
}

TEST(CapsuleBox, LyingAlongAnEdgeTouchesTwiceFromWhicheverSide)
{
    for (int i = 0; i <= 40; ++i) {
        // From over the face, round the edge, to beside the next face.
        const double angle = i * std::acos(0.0) / 40;
        const Vec3 out(std::sin(angle), 0, std::cos(angle));
        const Vec3 middle = Vec3(1, 0.2, 0.5) + 0.099 * out;
        for (const double noise : {0.0, 1e-4, -1e-4}) {
            const Vec3 along = Vec3(noise, 1, -noise / 2).normalized();
            const Placement pair = placed({0.1, 0.4}, {1, 1, 0.5}, middle, along);
            EXPECT_EQ(collide<double>(capsule_box<double>, pair, 0.02).count, 2) << i;
            EXPECT_EQ(collide<float>(capsule_box<float>, pair, 0.02).count, 2) << i;
        }
    }
}

TEST(CapsuleBox, CrossingAnEdgeTouchesOnce)
{
    const Vec3 out = Vec3(1, 0, 1).normalized();
    const Vec3 along = Vec3(1, 1, -1).normalized();
    const Placement pair = placed({0.1, 0.4}, {1, 1, 0.5}, Vec3(1, 0, 0.5) + 0.099 * out, along);
    const auto found = collide<double>(capsule_box<double>, pair, 0.02);
    ASSERT_EQ(found.count, 1);
    EXPECT_EQ(found.points[0].feature, 2U);
    EXPECT_NEAR(found.points[0].separation, -0.001, 1e-12);
}

// Tips over a rim, yaws and slides: between two moments nothing jumps further than they moved.
TEST(CapsuleBox, NothingJumpsAsItTips)
{
    std::mt19937 random(45);
    for (int run = 0; run < 60; ++run) {
        const Vec3 box(1, 0.8, 0.5);
        const Capsule capsule = {0.1, uniform(random, 0.05, 0.6)};
        const double step = 1e-4, yaw = uniform(random, -3, 3);
        // Its middle outside the box by less than the radius, so that the axis stays outside too.
        Vec3 before = Vec3::Zero();
        double deepest = 0;
        for (int i = 0; i < 3000; ++i) {
            const double tip = (i - 1500) * step;
            const Vec3 along(std::cos(yaw) * std::cos(tip), std::sin(yaw) * std::cos(tip),
                             std::sin(tip));
            const double lift = capsule.half_length * std::abs(std::sin(tip)) + 0.095;
            const Vec3 middle(0.9, 0.7, 0.5 + lift);
            const Placement pair = placed(capsule, box, middle, along);
            const auto found = collide<double>(capsule_box<double>, pair, 1);
            const auto rounded = collide<float>(capsule_box<float>, pair, 1);
            ASSERT_GT(found.count, 0);
            const Vec3 normal = pair.b_in_a.orientation.conjugate() * found.normal;
            EXPECT_LT((rounded.normal.cast<double>() - found.normal).norm(), 1e-4);
            if (i > 0) {
                EXPECT_LT((normal - before).norm(), 20 * step) << "run " << run << ", step " << i;
                EXPECT_LT(std::abs(deepest_of(found) - deepest), 2 * step);
            }
            before = normal;
            deepest = deepest_of(found);
        }
        if (HasFailure()) return;
    }
}

TEST(CapsuleBox, AxisInsideLeavesByTheShortestWay)
{
    std::mt19937 random(46);
    for (int i = 0; i < 2000; ++i) {
        SCOPED_TRACE("seed 46, case " + std::to_string(i));
        const double scale = std::pow(10.0, i % 13 - 6);
        const Vec3 box = scale * Vec3(0.5, 0.8, 0.3);
        const Vec3 middle = random_direction(random).cwiseProduct(box) * uniform(random, 0, 1);
        const Capsule capsule = {0.1 * scale, uniform(random, 0, 1) * scale};
        expect_as_searched(placed(capsule, box, middle, random_direction(random)), 1e-9, 4e-6);
        if (HasFailure()) return;
    }
}

TEST(CapsuleBox, MirroredPlacementsGiveMirroredAnswers)
{
    std::mt19937 random(47);
    for (int i = 0; i < 500; ++i) {
        const Vec3 box(0.5, 0.8, 0.3), flip(1, -1, 1);
        const Vec3 middle = random_direction(random), along = random_direction(random);
        const Placement one = placed({0.1, 0.4}, box, middle, along);
        const Placement two =
            placed({0.1, 0.4}, box, middle.cwiseProduct(flip), along.cwiseProduct(flip));
        const auto here = collide<double>(capsule_box<double>, one, 10);
        const auto there = collide<double>(capsule_box<double>, two, 10);
        ASSERT_EQ(here.count, there.count) << "seed 47, case " << i;
        EXPECT_NEAR(deepest_of(here), deepest_of(there), 1e-12);
    }
}

TEST(CapsuleBox, WildNumbersStayFinite)
{
    std::mt19937 random(48);
    const auto wild = [&] { return std::pow(10.0, uniform(random, -9, 12)); };
    for (int i = 0; i < 5000; ++i) {
        Placement pair = random_placement(random, 1, 1);
        pair.shapes.capsules = {{i % 5 ? wild() : 0, i % 7 ? wild() : 0}};
        pair.shapes.boxes = {{Vec3(wild(), wild(), wild())}};
        pair.b_in_a.position = random_direction(random) * (i % 11 ? wild() : 0);
        if (i % 3 == 0) pair.b_in_a.orientation = Quat::Identity();
        const double speculative_margin = i % 2 ? wild() : 0;
        EXPECT_TRUE(all_finite(collide<double>(capsule_box<double>, pair, speculative_margin)))
            << "case " << i;
        EXPECT_TRUE(all_finite(collide<float>(capsule_box<float>, pair, speculative_margin)))
            << "case " << i;
    }
}

}  // namespace throng
