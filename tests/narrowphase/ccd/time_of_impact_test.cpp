#include "narrowphase/ccd/time_of_impact.hpp"

#include "cooking/hulls/hull.hpp"
#include "cooking/repair/build_mesh.hpp"
#include "narrowphase/ccd/moving_cores.hpp"
#include "scene/catalog/sheets.hpp"
#include "tests/support/moving_pairs.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace throng {
namespace {

using test::Dice;
using test::kToiMethods;
using test::MovingPair;

constexpr double kPi = 3.14159265358979323846;
constexpr double kTolerance = 1e-4;

Impact impact_of(const MovingPair& pair, ToiMethod method, double tolerance)
{
    return time_of_impact(pair.shapes, pair.a, pair.b, 0, 1, impact_rule(method, tolerance));
}

MovingPair
spheres(double radius, const Vec3& a, const Vec3& way_a, const Vec3& b, const Vec3& way_b)
{
    MovingPair pair;
    pair.shapes.spheres = {{radius}};
    pair.a.trajectory = {{a, Quat::Identity()}, way_a, Vec3::Zero()};
    pair.b.trajectory = {{b, Quat::Identity()}, way_b, Vec3::Zero()};
    return pair;
}

// A capsule along x about the origin that turns about z, beside a wall that begins at x = wall.
MovingPair rod_beside_wall(double radius, double turn, double wall, ShapeKind kind)
{
    MovingPair pair;
    pair.shapes.capsules = {{radius, 1 - radius}};
    pair.shapes.planes = {{-Vec3::UnitX(), -wall}};
    pair.shapes.boxes = {{{0.01, 3, 3}}};
    pair.a.shape = {ShapeKind::capsule, 0};
    pair.a.trajectory.begin.orientation = exponential(Vec3(-kPi / 2, 0, 0));
    pair.a.trajectory.turn = Vec3(0, 0, -turn);
    pair.b.shape = {kind, 0};
    if (kind == ShapeKind::box) pair.b.trajectory.begin.position.x() = wall + 0.01;
    return pair;
}

// Until the time told the two stay apart, and then they have come near: what was found is neither
// late nor early. Sampled so that a touch of a hundredth of the size's depth shows.
void expect_neither_late_nor_early(const MovingPair& pair, ToiMethod method)
{
    const double tolerance = kTolerance * impact_size(pair.shapes, pair.a.shape, pair.b.shape);
    const Impact impact = impact_of(pair, method, tolerance);
    if (impact.state == ToiState::touching_at_start) {
        EXPECT_LE(test::distance_at(pair, 0), tolerance * (1 + 1e-9));
        EXPECT_EQ(impact.time, 0);
        return;
    }
    const test::Sampled seen = test::sample(pair, impact.time, tolerance, 200);
    EXPECT_GE(seen.least, tolerance / 2 * (1 - 1e-9));
    if (impact.state == ToiState::separated) {
        EXPECT_EQ(impact.time, 1);
        return;
    }
    EXPECT_FALSE(impact.cut_short);
    EXPECT_LE(test::distance_at(pair, impact.time), tolerance * (1 + 1e-9));
}

TEST(TimeOfImpact, IsNeitherLateNorEarlyForAllConvexShapes)
{
    Dice dice(1);
    for (int i = 0; i < 400; ++i) {
        const MovingPair pair = test::random_pair(dice, i % 3 == 0 ? 0 : 4, i % 2 == 0 ? 0 : 5);
        for (const ToiMethod method : kToiMethods) expect_neither_late_nor_early(pair, method);
    }
}

TEST(TimeOfImpact, MeetsWhereDenseSamplesTouch)
{
    Dice dice(2);
    int met = 0;
    for (int i = 0; i < 300; ++i) {
        const MovingPair pair = test::random_pair(dice, 3, i % 2 == 0 ? 0 : 3);
        const double tolerance = kTolerance * impact_size(pair.shapes, pair.a.shape, pair.b.shape);
        const test::Sampled seen = test::sample(pair, 1, tolerance, 400);
        for (const ToiMethod method : kToiMethods) {
            const Impact impact = impact_of(pair, method, tolerance);
            // No later than the first sample that touches, no earlier than the first that may.
            EXPECT_LE(impact.time, std::min(1.0, seen.first_touch));
            if (impact.state == ToiState::hit) {
                EXPECT_GE(impact.time, seen.first_near - 1.0 / 400);
            }
            if (seen.first_touch <= 1) {
                EXPECT_NE(impact.state, ToiState::separated);
            }
        }
        met += seen.first_touch <= 1 ? 1 : 0;
    }
    EXPECT_GT(met, 20);  // the dice give enough of them
}

TEST(TimeOfImpact, IsTheSameTurnedRound)
{
    Dice dice(3);
    for (int i = 0; i < 100; ++i) {
        const MovingPair pair = test::random_pair(dice, 3);
        const ImpactRule rule = impact_rule(ToiMethod::newton, 1e-5);
        const Impact one = time_of_impact(pair.shapes, pair.a, pair.b, 0, 1, rule);
        const Impact other = time_of_impact(pair.shapes, pair.b, pair.a, 0, 1, rule);
        ASSERT_EQ(one.state, other.state);
        // Both stop between half the tolerance and all of it, wherever that is on the way.
        if (one.state != ToiState::hit) continue;
        EXPECT_LE(test::distance_at(pair, one.time), 1.01e-5);
        EXPECT_LE(test::distance_at(pair, other.time), 1.01e-5);
    }
}

TEST(TimeOfImpact, OfSpheresIsExact)
{
    // In parts of 10 ms: 10 m at 1000 m/s each.
    const Vec3 ahead(10, 0, 0);
    for (const ToiMethod method : kToiMethods) {
        const auto time = [&](double aside) {
            const MovingPair pair = spheres(0.01, {-5, aside, 0}, ahead, {5, 0, 0}, -ahead);
            return impact_of(pair, method, 1e-4 * 0.01);
        };
        const double way = 20;  // m, of one against the other
        EXPECT_NEAR(time(0).time, 0.499, 1e-6 / way);
        EXPECT_LE(time(0).time, 0.499);
        const double exact = (10 - std::sqrt(0.02 * 0.02 - 0.015 * 0.015)) / way;
        // The slope of the distance there is the cosine of the angle to the line of centers.
        const double slope = std::sqrt(1 - 0.75 * 0.75) * way;
        EXPECT_LE(time(0.015).time, exact);
        EXPECT_NEAR(time(0.015).time, exact, 1.1e-6 / slope);
        EXPECT_EQ(time(0.0201).state, ToiState::separated);
        EXPECT_EQ(time(0.020002).state, ToiState::separated);
        EXPECT_EQ(time(0.019999).state, ToiState::hit);
    }
}

TEST(TimeOfImpact, SeesARodTurnIntoAWallWithinAStep)
{
    // Half a turn less a sixth in one step: neither end of it touches.
    const double turn = 50 * kPi / 60;
    for (const ShapeKind kind : {ShapeKind::box, ShapeKind::plane})
        for (const ToiMethod method : kToiMethods)
            for (const auto& [radius, wall] :
                 {std::pair(1e-9, 0.6), std::pair(0.02, 0.6), std::pair(1e-9, 0.9999)}) {
                const MovingPair pair = rod_beside_wall(radius, turn, wall, kind);
                const double angle = std::asin((wall - radius) / (1 - radius));
                const Impact impact = impact_of(pair, method, 1e-6);
                ASSERT_EQ(impact.state, ToiState::hit);
                EXPECT_LE(impact.time, angle / turn);
                const double slope = turn * std::cos(angle);
                // Where the rod comes in all but along the wall the distance is nearly flat.
                EXPECT_NEAR(impact.time, angle / turn, 1.1e-6 / slope + 1e-12);
            }
}

TEST(TimeOfImpact, MissesByAHair)
{
    // The tip comes to 1 - radius, and to radius beyond that.
    for (const ToiMethod method : kToiMethods) {
        const MovingPair near = rod_beside_wall(0.02, 5, 1.0000011, ShapeKind::box);
        EXPECT_EQ(impact_of(near, method, 1e-6).state, ToiState::separated);
        const MovingPair graze = rod_beside_wall(0.02, 5, 0.9999999, ShapeKind::box);
        EXPECT_EQ(impact_of(graze, method, 1e-6).state, ToiState::hit);
    }
}

// A billion turns in the time looked at: no search follows them.
TEST(TimeOfImpact, EndsWithinItsWorkHoweverFastTheTwoTurn)
{
    for (const ToiMethod method : kToiMethods) {
        MovingPair pair = rod_beside_wall(0.1, 6e9, 1.2, ShapeKind::box);
        pair.a.trajectory.shift = Vec3(0.5, 0, 0);
        const Impact impact = impact_of(pair, method, 1e-5);
        EXPECT_EQ(impact.state, ToiState::hit);
        EXPECT_LT(impact.evaluations, 40000);
        EXPECT_GT(test::distance_at(pair, impact.time), 0);
    }
}

TEST(TimeOfImpact, SaysWhereTheTwoTouchFromTheStart)
{
    for (const ToiMethod method : kToiMethods)
        for (const double apart : {-0.5, 0.0, 0.9e-6}) {
            const MovingPair pair =
                spheres(0.5, {0, 0, 0}, {0, 0, 0}, {1 + apart, 0, 0}, {1, 0, 0});
            const Impact impact = impact_of(pair, method, 1e-6);
            EXPECT_EQ(impact.state, ToiState::touching_at_start);
            EXPECT_EQ(impact.time, 0);
        }
}

TEST(TimeOfImpact, IsThatOfAPartOfTheTime)
{
    const MovingPair pair = spheres(0.5, {0, 0, 0}, {10, 0, 0}, {6, 0, 0}, {0, 0, 0});
    const ImpactRule rule = impact_rule(ToiMethod::newton, 1e-6);
    EXPECT_EQ(time_of_impact(pair.shapes, pair.a, pair.b, 0, 0.4, rule).state, ToiState::separated);
    const Impact impact = time_of_impact(pair.shapes, pair.a, pair.b, 0.4, 1, rule);
    EXPECT_NEAR(impact.time, 0.5, 1e-7);
    EXPECT_EQ(time_of_impact(pair.shapes, pair.a, pair.b, 0.6, 1, rule).state,
              ToiState::touching_at_start);
}

TEST(TimeOfImpact, StopsBeforeASheetOfTriangles)
{
    Shapes shapes;
    shapes.meshes.push_back(
        build_mesh({{0, -1, -1}, {0, 1, -1}, {0, 1, 1}, {0, -1, 1}}, {{0, 1, 2}, {0, 2, 3}}).mesh);
    shapes.spheres = {{0.005}};
    shapes.boxes = {{{0.1, 0.2, 0.3}}};
    MovingShape sheet{{ShapeKind::mesh, 0}, {}, {}};
    for (const ToiMethod method : kToiMethods)
        for (const double side : {-1.0, 1.0}) {
            MovingShape bullet{{ShapeKind::sphere, 0}, {}, {}};
            bullet.trajectory = {{{side * 10, 0.3, 0.2}, Quat::Identity()},
                                 {-side * 1000 / 60.0, 0, 0},
                                 Vec3::Zero()};
            const ImpactRule rule = impact_rule(method, 1e-4 * 0.005);
            const double exact = (10 - 0.005) / (1000 / 60.0);
            const Impact impact = time_of_impact(shapes, sheet, bullet, 0, 1, rule);
            ASSERT_EQ(impact.state, ToiState::hit);
            EXPECT_LE(impact.time, exact);
            EXPECT_NEAR(impact.time, exact, 1e-7);
            EXPECT_NEAR(impact.normal.x(), side, 1e-9);
            // A sheet that turns on its way, past a body that stands: its edge comes round.
            MovingShape turning = sheet;
            turning.trajectory.turn = Vec3(0, 0, 3);
            MovingShape box{{ShapeKind::box, 0}, {}, {}};
            box.trajectory.begin.position = Vec3(side * 0.8, 0, 0);
            EXPECT_EQ(time_of_impact(shapes, box, turning, 0, 1, rule).state, ToiState::hit);
            bullet.trajectory.begin.position.y() = 1.01;
            EXPECT_EQ(time_of_impact(shapes, bullet, sheet, 0, 1, rule).state, ToiState::separated);
        }
}

// Of what is far from its body's middle, and from its own frame's origin, as the parts of a tree
// that falls: no triangle is missed that would be met.
TEST(TimeOfImpact, OfAPartFarOutIsThatOfAllTriangles)
{
    Dice dice(9);
    const auto in_box = [&](double half) {
        return Vec3(dice.between(-half, half), dice.between(-half, half),
                    dice.between(-half, half));
    };
    int met = 0;
    for (int i = 0; i < 300; ++i) {
        MovingPair pair;
        const TriangleSoup soup =
            sheet_mesh(12, [&](int x, int y) { return Vec3(x - 6, y - 6, dice.between(0, 0.5)); });
        pair.shapes.meshes = {build_mesh(soup.vertices, soup.triangles).mesh};
        std::vector<Vec3> points;
        const Vec3 off = in_box(3);
        for (int k = 0; k < 12; ++k) points.push_back(off + in_box(0.3));
        pair.shapes.hulls = {build_hull(points).hull};
        pair.a.shape = {ShapeKind::mesh, 0};
        pair.b.shape = {ShapeKind::hull, 0};
        pair.b.local = {in_box(2), exponential(in_box(2))};
        RigidTrajectory& way = pair.b.trajectory;
        way = {{in_box(2) + Vec3(0, 0, 4), exponential(in_box(3))}, in_box(3), in_box(1.5)};
        if (i % 3 == 0) way.spin = in_box(2);
        const ImpactRule rule = impact_rule(ToiMethod::newton, 1e-4);
        const Impact found = time_of_impact(pair.shapes, pair.a, pair.b, 0, 1, rule);

        const ConvexCore<double> core = moving_core(pair.shapes, pair.b);
        double least = 1;
        for (const auto& [u, v, w] : pair.shapes.meshes[0].triangles) {
            const auto& vertices = pair.shapes.meshes[0].vertices;
            const Vec3 corners[] = {vertices[u], vertices[v], vertices[w]};
            const MovingCores cores(convex_core_of_points(std::span<const Vec3>(corners)), pair.a,
                                    core, pair.b);
            const Impact alone = impact_of_cores(cores, 0, 1, rule);
            if (alone.state != ToiState::separated) least = std::min(least, alone.time);
        }
        EXPECT_EQ(found.state == ToiState::separated, least == 1) << "seed 9, round " << i;
        EXPECT_NEAR(found.time, least, 1e-3) << "seed 9, round " << i;
        met += found.state == ToiState::hit ? 1 : 0;
    }
    EXPECT_GT(met, 40);
}

TEST(TimeOfImpact, FollowsAPlaneThatTurns)
{
    // A half-space that tilts about the origin until its surface has come up to a ball.
    MovingPair pair;
    pair.shapes.planes = {{Vec3::UnitZ(), 0}};
    pair.shapes.spheres = {{0.1}};
    pair.a = {{ShapeKind::plane, 0}, {}, {}};
    pair.a.trajectory.turn = Vec3(0, -1, 0);
    pair.b.trajectory.begin.position = Vec3(2, 0, 1);
    const double distance = std::sqrt(5.0);
    const double exact = std::atan2(1, 2) - std::asin(0.1 / distance);
    for (const ToiMethod method : kToiMethods) {
        const Impact impact = impact_of(pair, method, 1e-6);
        ASSERT_EQ(impact.state, ToiState::hit);
        EXPECT_LE(impact.time, exact);
        EXPECT_NEAR(impact.time, exact, 1e-6);
    }
}

TEST(TimeOfImpact, IsThatOfTheOriginFarFromIt)
{
    Dice dice(5);
    for (int i = 0; i < 50; ++i) {
        MovingPair pair = test::random_pair(dice, 2);
        const Impact here = impact_of(pair, ToiMethod::newton, 1e-5);
        // Places that differ by whole powers of two lose no digits that are asked for.
        for (MovingShape* moving : {&pair.a, &pair.b})
            moving->trajectory.begin.position += Vec3(0x1p20, -0x1p19, 0x1p18);
        const Impact there = impact_of(pair, ToiMethod::newton, 1e-5);
        EXPECT_EQ(here.state, there.state);
        if (here.state != ToiState::hit) continue;
        EXPECT_NEAR(here.time, there.time, 1e-4);
    }
}

TEST(TrajectoryBetween, EndsWhereItShould)
{
    Dice dice(6);
    for (int i = 0; i < 200; ++i) {
        const Vec3 turn = dice.point(i % 2 == 0 ? 6 : 1e-7);
        const RigidTrajectory given{{dice.point(1), dice.turn()}, dice.point(2), turn};
        // The angular velocity is known but roughly.
        const RigidTrajectory found = trajectory_between(given.at(0), given.at(1), 1.02 * turn);
        EXPECT_LE((found.turn - turn).norm(), 1e-9 * std::max(1.0, turn.norm()));
        EXPECT_LE((found.shift - given.shift).norm(), 1e-14);
        const Quat off = found.at(1).orientation * given.at(1).orientation.conjugate();
        EXPECT_LE(off.vec().norm(), 1e-12);
    }
}

TEST(TrajectoryBetween, SpinsAndEndsWhereItShould)
{
    Dice dice(7);
    for (int i = 0; i < 200; ++i) {
        RigidTrajectory given{{dice.point(1), dice.turn()}, dice.point(2), dice.point(4)};
        given.spin = dice.point(8);
        const RigidTrajectory found =
            trajectory_between(given.at(0), given.at(1), 1.02 * given.turn, given.spin);
        EXPECT_LE((found.turn - given.turn).norm(), 1e-9);
        const double time = dice.between(0, 1), soon = 1e-6;
        const Quat by = given.at(time + soon).orientation * given.at(time).orientation.conjugate();
        EXPECT_LE((2 / soon * by.vec() - given.angular_velocity(time)).norm(), 1e-3);
    }
}

// Of a rod that spins many times round as it tips over, and of a disc that wobbles.
TEST(TrajectoryOf, IsThatOfAFreeTop)
{
    Dice dice(8);
    for (int i = 0; i < 200; ++i) {
        const double along = i % 2 == 0 ? 0.01 : 2;
        Masses masses;
        masses.gyroscopic_kind = {1};
        masses.inertia = {{1, 1, along}};
        masses.symmetry_axis = {Vec3::UnitZ()};
        const Quat begin = dice.turn();
        const Vec3 own(dice.between(-1, 1), dice.between(-1, 1), dice.between(-9, 9));
        const Vec3 momentum = begin * Vec3(own.x(), own.y(), along * own.z());
        const auto at = [&](double time) {
            return Quat(exponential(time * momentum) * begin
                        * exponential(time * (1 - along) * Vec3(0, 0, own.z())));
        };
        const Vec3 turn = momentum + at(1) * Vec3(0, 0, (1 - along) * own.z());
        const RigidTrajectory found =
            trajectory_of(masses, 0, {Vec3::Zero(), begin}, {Vec3::Zero(), at(1)}, turn);
        for (const double time : {0.2, 0.5, 0.9}) {
            const Quat off = found.at(time).orientation * at(time).conjugate();
            // One that turns by less than a radian is told by one axis.
            EXPECT_LE(off.vec().norm(), turn.norm() > 1 ? 1e-9 : 0.1);
        }
    }
}

}  // namespace
}  // namespace throng
