// How shapes lie on one another: the number of points, where they are, and that they stay the same.
#include "cooking/hulls/hull.hpp"
#include "narrowphase/dispatch.hpp"
#include "tests/support/direction_search.hpp"

#include <gtest/gtest.h>

#include <set>

namespace throng {
namespace {

using given::random_direction;
using given::random_turn;

constexpr ShapeRef kSphere = {ShapeKind::sphere, 0};
constexpr ShapeRef kCapsule = {ShapeKind::capsule, 0};
constexpr ShapeRef kCylinder = {ShapeKind::cylinder, 0};
constexpr ShapeRef kBox = {ShapeKind::box, 0};
constexpr ShapeRef kSlab = {ShapeKind::box, 1};
constexpr ShapeRef kHull = {ShapeKind::hull, 0};
constexpr ShapeRef kPlane = {ShapeKind::plane, 0};

Shapes some_shapes()
{
    Shapes shapes;
    shapes.spheres = {{0.5}};
    shapes.capsules = {{0.25, 0.6}};
    shapes.cylinders = {{0.3, 0.5}};
    shapes.boxes = {{Vec3(0.5, 0.4, 0.3)}, {Vec3(3, 3, 0.2)}};
    std::vector<Vec3> corners;
    for (int i = 0; i < 8; ++i) {
        corners.emplace_back(i & 1 ? 0.5 : -0.5, i & 2 ? 0.4 : -0.4, i & 4 ? 0.3 : -0.3);
    }
    shapes.hulls = {build_hull(corners).hull};
    shapes.planes = {{Vec3(0, 0, 1), 0.25}};
    return shapes;
}

LocalManifold<double>
collide(ShapeRef a, ShapeRef b, const Pose& b_in_a, double speculative_margin = 0.02)
{
    PairCache cache;
    LocalManifold<double> manifold;
    collide<double>({some_shapes(), a, b, b_in_a, speculative_margin}, cache, manifold);
    return manifold;
}

Pose inverse_of(const Pose& pose)
{
    const Quat back = pose.orientation.conjugate();
    return {-(back * pose.position), back};
}

Quat turn_about(const Vec3& axis, double angle)
{
    return Quat(Eigen::AngleAxisd(angle, axis.normalized()));
}

// z turned onto y.
Quat lying() { return turn_about(Vec3(1, 0, 0), -std::acos(0.0)); }

std::set<std::uint32_t> features_of(const LocalManifold<double>& manifold)
{
    std::set<std::uint32_t> features;
    for (int i = 0; i < manifold.count; ++i) {
        features.insert(manifold.points[static_cast<std::size_t>(i)].feature);
    }
    return features;
}

double area_of(const LocalManifold<double>& manifold)
{
    double most = 0;
    for (int i = 0; i < manifold.count; ++i) {
        for (int k = 0; k < i; ++k) {
            for (int j = 0; j < k; ++j) {
                const auto at = [&](int p) -> const Vec3& {
                    return manifold.points[static_cast<std::size_t>(p)].position;
                };
                most = std::max(most, (at(i) - at(j)).cross(at(k) - at(j)).norm());
            }
        }
    }
    return most;  // twice the greatest triangle: the area, of a parallelogram
}

TEST(ConvexPlane, EachKindRestsOnItsPoints)
{
    struct Resting {
        ShapeRef shape;
        double height;
        Quat turn;
        int points;
    };
    const std::vector<Resting> rests = {
        {kSphere, 0.5, Quat::Identity(), 1},
        {kCapsule, 0.25, lying(), 2},
        {kCapsule, 0.85, Quat::Identity(), 1},
        {kCylinder, 0.3, lying(), 2},
        {kCylinder, 0.5, Quat::Identity(), 4},
        {kBox, 0.3, Quat::Identity(), 4},
        {kBox, 0.4, lying(), 4},
        {kHull, 0.3, Quat::Identity(), 4},
    };
    for (const Resting& rest : rests) {
        const Pose body = {Vec3(7, -3, rest.height + 0.25 - 0.001), rest.turn};
        const LocalManifold<double> manifold = collide(rest.shape, kPlane, inverse_of(body));
        EXPECT_EQ(manifold.count, rest.points);
        EXPECT_LT((body.orientation * manifold.normal - Vec3(0, 0, -1)).norm(), 1e-12);
        for (int i = 0; i < manifold.count; ++i) {
            const auto& point = manifold.points[static_cast<std::size_t>(i)];
            EXPECT_NEAR(point.separation, -0.001, 1e-12);
            EXPECT_NEAR((body * point.position).z(), 0.25 - 0.0005, 1e-12);
        }
        EXPECT_EQ(static_cast<int>(features_of(manifold).size()), manifold.count);
    }
}

TEST(ConvexPlane, DeepestPointIsTheTrueLowestWhateverTheTurn)
{
    const Shapes shapes = some_shapes();
    std::mt19937 random(5);
    for (int i = 0; i < 400; ++i) {
        for (const ShapeRef shape : {kSphere, kCapsule, kCylinder, kBox, kHull}) {
            const Pose body = {Vec3(1, 2, 0.6), random_turn(random)};
            const LocalManifold<double> manifold = collide(shape, kPlane, inverse_of(body), 10);
            const auto outline = given::outline_of(shapes, shape);
            const double lowest =
                0.6 - 0.25 - outline.extent(body.orientation.conjugate() * Vec3(0, 0, -1));
            double least = 1e300;
            for (int k = 0; k < manifold.count; ++k) {
                least = std::min(least, manifold.points[static_cast<std::size_t>(k)].separation);
            }
            EXPECT_NEAR(least, lowest, 1e-12) << "seed 5, case " << i;
            EXPECT_NEAR(penetration_depth(shapes, shape, kPlane, inverse_of(body)),
                        std::max(0.0, -lowest), 1e-12);
        }
    }
}

TEST(ConvexPlane, PlaneFarAlongItselfIsTheSameInFloat)
{
    const Shapes shapes = some_shapes();
    const Pose ground = {Vec3(0, 0, 0), Quat::Identity()};
    const Pose body = {Vec3(1e7, -3e6, 0.3 + 0.25 - 0.001), turn_about(Vec3(0, 0, 1), 0.7)};
    const Pose seen = pose_seen_from_a(shapes, kPlane, body, ground);
    PairCache cache;
    LocalManifold<float> manifold;
    const PoseT<float> pose = {seen.position.cast<float>(), seen.orientation.cast<float>()};
    collide<float>({shapes, kBox, kPlane, pose, 0.02F}, cache, manifold);
    ASSERT_EQ(manifold.count, 4);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(manifold.points[i].separation, -0.001, 1e-6);
}

// A card that leans by more than its thickness over its length has its four lowest corners all at
// one end; sunk deep, it must be held at both, or it turns about that end and sinks on.
TEST(ConvexPlane, SunkenCardIsHeldAtAllFourCornersOfItsSide)
{
    Shapes shapes = some_shapes();
    shapes.boxes[0].half_extents = Vec3(0.2, 0.125, 0.001);
    for (const double lean : {0.004, 0.03, -0.03}) {
        const Pose card = {Vec3(0, 0, 0.25 - 0.06), turn_about(Vec3(0, 1, 0), lean)};
        PairCache cache;
        LocalManifold<double> manifold;
        collide<double>({shapes, kBox, kPlane, inverse_of(card), 0.02}, cache, manifold);
        ASSERT_EQ(manifold.count, 4) << lean;
        EXPECT_GT(area_of(manifold), 0.9 * 0.4 * 0.25) << lean;
    }
}

// A drum whose rims are rounded in steps of a sixteenth of a quarter turn; its first ring is the
// lower flat end's.
Hull rounded_drum(double radius, double rim, std::size_t around)
{
    std::vector<Vec3> points;
    constexpr int kSteps = 16;
    for (const int end : {-1, 1})
        for (int i = 0; i <= kSteps; ++i)
            for (std::size_t k = 0; k < around; ++k) {
                const double steep = std::acos(0.0) * i / kSteps;
                const double at =
                    4 * std::acos(0.0) * static_cast<double>(k) / static_cast<double>(around);
                const double wide = radius - rim * (1 - std::sin(steep));
                points.emplace_back(wide * std::cos(at), wide * std::sin(at),
                                    end * (radius - rim * (1 - std::cos(steep))));
            }
    return build_hull(points).hull;
}

// However far it looks round, and however deep it has sunk: the many corners a hair above the
// lowest do not take the place of those that bear it.
TEST(ConvexPlane, FinelyRoundedDrumStandsOnItsFlatEnd)
{
    for (const double radius : {2.5e-3, 0.5, 25.0}) {
        Shapes shapes = some_shapes();
        shapes.hulls[0] = rounded_drum(radius, 0.1 * radius, 32);
        for (const double speculative_margin : {0.02, 0.5, 3.0})
            for (const double sunk : {-0.01, 1e-5, 0.01}) {
                const Pose drum = {Vec3(1, 2, 0.25 + (1 - sunk) * radius),
                                   turn_about(Vec3(0.6, 0.8, 0), 1e-6)};
                PairCache cache;
                LocalManifold<double> manifold;
                collide<double>(
                    {shapes, kHull, kPlane, inverse_of(drum), speculative_margin * radius}, cache,
                    manifold);
                ASSERT_EQ(manifold.count, 4) << radius << ' ' << speculative_margin << ' ' << sunk;
                for (std::size_t i = 0; i < 4; ++i)
                    EXPECT_NEAR(manifold.points[i].separation, -sunk * radius, 1e-5 * radius);
                EXPECT_GT(area_of(manifold), 1.8 * std::pow(0.9 * radius, 2));
            }
    }
}

// It comes down on one side of its rim: the other is held as well, before it falls through.
TEST(ConvexPlane, DrumThatTipsIsHeldOnEitherSideOfItsMiddle)
{
    Shapes shapes = some_shapes();
    shapes.hulls[0] = rounded_drum(0.5, 0.05, 32);
    for (const double tilt : {0.01, 0.03, 0.06}) {
        const Pose drum = {Vec3(1, 2, 0.25 + 0.5 + 0.45 * tilt), turn_about(Vec3(0, 1, 0), tilt)};
        PairCache cache;
        LocalManifold<double> manifold;
        collide<double>({shapes, kHull, kPlane, inverse_of(drum), 2 * tilt}, cache, manifold);
        double first = 0, last = 0;
        for (int i = 0; i < manifold.count; ++i) {
            const double x = manifold.points[static_cast<std::size_t>(i)].position.x();
            first = std::min(first, x);
            last = std::max(last, x);
        }
        EXPECT_LT(first, -0.4) << tilt;
        EXPECT_GT(last, 0.4) << tilt;
    }
}

TEST(SpherePairs, CenterInsideLeavesByTheNearestWay)
{
    const LocalManifold<double> box =
        collide(kSphere, kBox, {Vec3(0.1, 0, -0.2), Quat::Identity()});
    EXPECT_EQ(box.normal, Vec3(0, 0, -1));
    EXPECT_NEAR(box.points[0].separation, -0.1 - 0.5, 1e-12);
    const LocalManifold<double> hull =
        collide(kSphere, kHull, {Vec3(0.1, 0, -0.2), Quat::Identity()});
    EXPECT_LT((hull.normal - Vec3(0, 0, -1)).norm(), 1e-9);
    EXPECT_NEAR(hull.points[0].separation, -0.1 - 0.5, 1e-9);
    const LocalManifold<double> can =
        collide(kSphere, kCylinder, {Vec3(-0.2, 0, 0.1), Quat::Identity()});
    EXPECT_LT((can.normal - Vec3(-1, 0, 0)).norm(), 1e-12);
    EXPECT_NEAR(can.points[0].separation, -0.1 - 0.5, 1e-12);
}

TEST(SpherePairs, CoincidentCentersPartUpwards)
{
    const LocalManifold<double> manifold = collide(kSphere, kSphere, {});
    EXPECT_EQ(manifold.normal, Vec3(0, 0, 1));
    EXPECT_NEAR(manifold.points[0].separation, -1, 1e-15);
}

TEST(CapsulePairs, SideBySideTouchAtBothEndsOfTheSharedStretch)
{
    const LocalManifold<double> manifold =
        collide(kCapsule, kCapsule, {Vec3(0.499, 0, 0.4), Quat::Identity()});
    ASSERT_EQ(manifold.count, 2);
    EXPECT_LT((manifold.normal - Vec3(1, 0, 0)).norm(), 1e-12);
    EXPECT_NEAR(manifold.points[0].position.z(), -0.2, 1e-12);
    EXPECT_NEAR(manifold.points[1].position.z(), 0.6, 1e-12);
    for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(manifold.points[i].separation, -0.001, 1e-12);
}

TEST(CapsulePairs, CrossingAxesPartSideways)
{
    for (const Quat& turn : {Quat(1, 0, 0, 0), lying(), turn_about(Vec3(1, 1, 0), 0.3)}) {
        const LocalManifold<double> manifold = collide(kCapsule, kCapsule, {Vec3::Zero(), turn});
        ASSERT_GT(manifold.count, 0);
        EXPECT_NEAR(manifold.normal.z(), 0, 1e-12);
        EXPECT_NEAR(manifold.points[0].separation, -0.5, 1e-12);
        EXPECT_NEAR(penetration_depth(some_shapes(), kCapsule, kCapsule, {Vec3::Zero(), turn}), 0.5,
                    1e-9);
    }
}

TEST(CapsulePairs, LyingOnABoxTouchesAtBothEnds)
{
    for (const ShapeRef floor : {kBox, kSlab}) {
        const double top = floor == kBox ? 0.3 : 0.2;
        const Pose box = {Vec3(0, 0, -(top + 0.25 - 0.001)), Quat::Identity()};
        // The capsule's own axis is z, so the box is turned instead.
        const Quat turn = lying();
        const LocalManifold<double> manifold =
            collide(kCapsule, floor, {turn * box.position, turn * box.orientation});
        ASSERT_EQ(manifold.count, 2);
        for (std::size_t i = 0; i < 2; ++i) {
            EXPECT_NEAR(manifold.points[i].separation, -0.001, 1e-9);
        }
    }
}

TEST(CylinderPairs, LogsSideBySideTouchAlongALine)
{
    for (const double clearance : {-0.01, -1e-6, 0.0, 1e-6, 0.01}) {
        for (const double angle : {0.0, 0.4, 2.0}) {
            const Vec3 towards(std::cos(angle), std::sin(angle), 0);
            const Pose pose = {towards * (0.6 + clearance) + Vec3(0, 0, 0.3),
                               turn_about(Vec3(0, 0, 1), 1)};
            const LocalManifold<double> manifold = collide(kCylinder, kCylinder, pose);
            ASSERT_EQ(manifold.count, 2) << clearance;
            EXPECT_LT((manifold.normal - towards).norm(), 1e-9);
            const double low =
                std::min(manifold.points[0].position.z(), manifold.points[1].position.z());
            const double high =
                std::max(manifold.points[0].position.z(), manifold.points[1].position.z());
            EXPECT_NEAR(low, -0.2, 1e-9);
            EXPECT_NEAR(high, 0.5, 1e-9);
            for (std::size_t i = 0; i < 2; ++i) {
                EXPECT_NEAR(manifold.points[i].separation, clearance, 1e-12);
            }
        }
    }
}

TEST(CylinderPairs, LogsKeepTheirFeaturesUnderNoise)
{
    std::mt19937 random(9);
    const std::set<std::uint32_t> names =
        features_of(collide(kCylinder, kCylinder, {Vec3(0.599, 0, 0.3), Quat::Identity()}));
    for (int i = 0; i < 40; ++i) {
        const Pose pose = {Vec3(0.599, 0, 0.3) + 1e-5 * random_direction(random),
                           turn_about(random_direction(random), 1e-5)};
        const LocalManifold<double> manifold = collide(kCylinder, kCylinder, pose);
        EXPECT_EQ(features_of(manifold), names);
        const given::OutlinePair clearance = {given::outline_of(some_shapes(), kCylinder),
                                              given::outline_of(some_shapes(), kCylinder), pose};
        const double truth = given::greatest_separation(clearance, {manifold.normal}, 10);
        EXPECT_NEAR(clearance.along(manifold.normal), truth, 1e-10) << "seed 9, case " << i;
    }
}

TEST(CylinderPairs, StandingOnABoxSpreadsFourPoints)
{
    std::mt19937 random(10);
    std::set<std::uint32_t> names;
    for (int i = 0; i < 100; ++i) {
        const Quat turn = turn_about(random_direction(random), 1e-6);
        const Pose pose = {Vec3(0.3, 0.2, -(0.5 + 0.2 - 0.001)), turn};
        const LocalManifold<double> manifold = collide(kCylinder, kSlab, pose);
        ASSERT_EQ(manifold.count, 4);
        EXPECT_GT(area_of(manifold), 0.9 * 2 * 0.3 * 0.3);
        if (i == 0) names = features_of(manifold);
        EXPECT_EQ(features_of(manifold), names) << "seed 10, case " << i;
    }
}

TEST(CylinderPairs, CansStackOnFourPoints)
{
    std::mt19937 random(11);
    for (int i = 0; i < 100; ++i) {
        const Pose pose = {Vec3(0.003, -0.002, 0.999), turn_about(random_direction(random), 1e-4)};
        const LocalManifold<double> manifold = collide(kCylinder, kCylinder, pose);
        ASSERT_EQ(manifold.count, 4);
        EXPECT_GT(area_of(manifold), 0.8 * 2 * 0.3 * 0.3);
        EXPECT_LT((manifold.normal - Vec3(0, 0, 1)).norm(), 1e-3);
    }
}

TEST(CylinderPairs, LeaningCanIsHeldEitherSideOfWhereItsFlatSideTouchesARim)
{
    // Another stands beside its middle, and the rim of that is nearest straight below its axis.
    for (const double direction : {0.0, 0.4, 2.0}) {
        const Vec3 along(std::cos(direction), std::sin(direction), 0);
        const double lean = 0.15;
        const Quat turn = turn_about(Vec3::UnitZ().cross(along), lean);
        const Vec3 nearest = along * 0.3 + Vec3::UnitZ() * 0.5;
        const Vec3 middle = nearest + turn * Vec3(along * 0.05 + Vec3::UnitZ() * 0.499);
        const LocalManifold<double> manifold = collide(kCylinder, kCylinder, {middle, turn}, 0.1);
        ASSERT_GE(manifold.count, 3) << direction;
        const Vec3 beside = Vec3::UnitZ().cross(along);
        double left = 0, right = 0, deepest = 1;
        for (int i = 0; i < manifold.count; ++i) {
            const auto& point = manifold.points[static_cast<std::size_t>(i)];
            deepest = std::min(deepest, point.separation);
            // Near enough for a tilt of a tenth to bring it down.
            if (point.separation > 0.1 * 0.3) continue;
            left = std::max(left, point.position.dot(beside));
            right = std::min(right, point.position.dot(beside));
        }
        EXPECT_NEAR(deepest, -0.001, 1e-4) << direction;
        EXPECT_GT(left, 0.1) << direction;
        EXPECT_LT(right, -0.1) << direction;
    }
}

TEST(CylinderPairs, OverhangingLogRestsOnTheEdgesOfTheBox)
{
    // A box narrower than the log is long: points at the box's sides, not at the log's ends.
    Shapes shapes = some_shapes();
    shapes.boxes[0].half_extents = Vec3(0.5, 0.2, 0.3);
    const Quat turn = lying();
    const Pose pose = {turn * Vec3(0, 0, -(0.3 + 0.3 - 0.001)), turn};
    PairCache cache;
    LocalManifold<double> manifold;
    collide<double>({shapes, kCylinder, kBox, pose, 0.02}, cache, manifold);
    ASSERT_EQ(manifold.count, 2);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_NEAR(std::abs(manifold.points[i].position.z()), 0.2, 1e-6);
        EXPECT_NEAR(manifold.points[i].separation, -0.001, 1e-9);
    }
}

TEST(CylinderPairs, TippedCylinderTouchesWithItsRim)
{
    const Quat turn = turn_about(Vec3(1, 0.3, 0), 0.3);
    const double drop = 0.5 * std::cos(0.3) + 0.3 * std::sin(0.3) + 0.2 - 0.001;
    const Pose pose = {turn * Vec3(0, 0, -drop), turn};
    const LocalManifold<double> manifold = collide(kCylinder, kSlab, pose, 0.0);
    ASSERT_EQ(manifold.count, 1);
    EXPECT_NEAR(manifold.points[0].separation, -0.001, 1e-9);
    EXPECT_LT((manifold.normal - turn * Vec3(0, 0, -1)).norm(), 1e-9);
}

}  // namespace
}  // namespace throng
