#include "narrowphase/ccd/impact_of_spheres.hpp"

#include "narrowphase/solid/sphere_separations.hpp"
#include "tests/support/closed_meshes.hpp"
#include "tests/support/moving_pairs.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

// Two rings, and one of each kind of shape that they may meet.
const Shapes& shapes()
{
    static const Shapes made = [] {
        Shapes all;
        all.solids.push_back(in_spheres(torus_mesh(0.35, 0.15, 24, 12)));
        all.solids.push_back(in_spheres(noisy_ball(7, 0.4, 0.1)));
        const Vec3 half(0.5, 0.4, 0.3);
        all.boxes = {{half}};
        all.capsules = {{0.2, 0.3}};
        all.planes = {{Vec3::UnitX() * -1, -2.5}};
        all.meshes = {closed(box_mesh(half))};
        return all;
    }();
    return made;
}

constexpr ShapeRef kRing{ShapeKind::solid, 0};
constexpr ShapeRef kOthers[] = {{ShapeKind::solid, 1},
                                {ShapeKind::box, 0},
                                {ShapeKind::capsule, 0},
                                {ShapeKind::plane, 0},
                                {ShapeKind::mesh, 0}};

// m, of the two at a time, no more than `speculative_margin`.
double separation_at(const MovingShape& ring,
                     const MovingShape& other,
                     double time,
                     double speculative_margin)
{
    const Pose a = ring.trajectory.at(time), b = other.trajectory.at(time);
    std::vector<LocalManifold<double>> found;
    find_sphere_separations({shapes(),
                             ring.shape,
                             other.shape,
                             {a.to_local(b.position), a.orientation.conjugate() * b.orientation},
                             speculative_margin},
                            found);
    double least = speculative_margin;
    for (const auto& manifold : found) least = std::min(least, manifold.points[0].separation);
    return least;
}

MovingShape on_its_way(test::Dice& dice, ShapeRef shape, const Vec3& at, const Vec3& way)
{
    MovingShape moving;
    moving.shape = shape;
    moving.pieces = shape.kind == ShapeKind::solid;
    moving.trajectory = {{at, dice.turn()}, way, dice.point(2)};
    if (shape.kind == ShapeKind::plane) moving.trajectory = {};
    return moving;
}

TEST(ImpactOfSpheres, IsNeverLateAndNeverEarlierThanTheTolerance)
{
    const double tolerance = 1e-3;
    test::Dice dice(41);
    int met = 0, missed = 0;
    for (const ShapeRef shape : kOthers)
        for (const ToiMethod method : test::kToiMethods)
            for (int i = 0; i < 8; ++i) {
                const MovingShape ring =
                    on_its_way(dice, kRing, dice.point(0.5), Vec3(2, 0, 0) + dice.point(0.7));
                const MovingShape other = on_its_way(dice, shape, Vec3(1.9, 0, 0), dice.point(0.5));
                const Impact impact =
                    time_of_impact(shapes(), ring, other, 0, 1, impact_rule(method, tolerance));
                const bool meets = impact.state == ToiState::hit;
                (meets ? met : missed) += 1;
                for (int k = 0; k <= 50; ++k)
                    ASSERT_GT(separation_at(ring, other, impact.time * k / 50, 1),
                              tolerance * 0.49);
                if (meets && !impact.cut_short) {
                    EXPECT_LE(separation_at(ring, other, impact.time, 1), tolerance * 1.01);
                }
                const Impact turned =
                    time_of_impact(shapes(), other, ring, 0, 1, impact_rule(method, tolerance));
                EXPECT_EQ(turned.state, impact.state);
                EXPECT_NEAR(turned.time, impact.time, tolerance);
            }
    EXPECT_GT(met, 40);
    EXPECT_GT(missed, 10);
}

// A ring rests on a plane with one of its spheres; the others are found as it tips over.
TEST(ImpactOfSpheres, LeavesOutOnlyTheSpheresThatTouchAsItBegins)
{
    const double tolerance = 1e-3;
    MovingShape ring, plane;
    ring.shape = kRing;
    ring.pieces = true;
    ring.trajectory.begin.orientation = Quat(std::cos(0.2), std::sin(0.2), 0, 0);
    plane.shape = {ShapeKind::plane, 0};
    plane.trajectory.begin.orientation = Quat(std::sqrt(0.5), 0, std::sqrt(0.5), 0);
    ring.trajectory.begin.position.z() -= separation_at(ring, plane, 0, 10) - tolerance / 2;
    ASSERT_NEAR(separation_at(ring, plane, 0, 1), tolerance / 2, 1e-9);
    const ImpactRule rule = impact_rule(ToiMethod::newton, tolerance);
    EXPECT_EQ(time_of_impact(shapes(), ring, plane, 0, 1, rule).state, ToiState::separated);
    ring.trajectory.turn = Vec3(-0.8, 0, 0);
    ring.trajectory.shift = Vec3(0, 0, -0.05);
    const Impact impact = time_of_impact(shapes(), ring, plane, 0, 1, rule);
    EXPECT_EQ(impact.state, ToiState::hit);
    EXPECT_GT(impact.time, 0.01);
    EXPECT_LT(impact.time, 1);
}

}  // namespace
}  // namespace throng
