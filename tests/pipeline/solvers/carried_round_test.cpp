// What lies on plates that turn, through the public door.
#include "tests/support/small_scenes.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

using given::SceneOf;

constexpr double kRate = 2;

// A plate, and a box 1 m from its middle that goes with it.
Scene turntable(const Settings& settings, Motion motion = Motion::kinematic, double mass = 1000)
{
    SceneOf made;
    made.scene.settings = settings;
    BodyDescription& plate = made.box(Vec3(2, 2, 0.1), Vec3(0, 0, -0.1));
    plate.motion = motion;
    if (motion == Motion::dynamic) {
        plate.mass = mass;
        plate.lock_position = true;
    }
    plate.angular_velocity = Vec3(0, 0, kRate);
    BodyDescription& box = made.box(Vec3::Constant(0.1), Vec3(1, 0, 0.1));
    box.mass = 1;
    box.velocity = Vec3(0, kRate, 0);
    box.angular_velocity = Vec3(0, 0, kRate);
    return made.scene;
}

double radius_after(const Scene& scene, double time)
{
    World world(scene);
    world.step(static_cast<int>(std::lround(time / scene.settings.dt)));
    const Vec3 at = world.pose(world.bodies().back()).position;
    return std::hypot(at.x(), at.y());
}

TEST(CarriedRound, ABoxStaysWhereItIsByEverySolver)
{
    Settings usual, plain, direct, penalty, apart, halved, at_points;
    plain.solver = Solver::pgs;
    direct.solver = Solver::direct;
    penalty.response = Response::penalty;
    apart.overlap = Overlap::back_up;
    halved.overlap = Overlap::subdivide;
    at_points.friction_at = FrictionAt::points;
    for (const Settings& settings : {usual, plain, direct, apart, halved, at_points})
        EXPECT_NEAR(radius_after(turntable(settings), 3), 1, 1e-3);
    // Of springs it lies a little further out.
    EXPECT_NEAR(radius_after(turntable(penalty), 3), 1, 1e-2);
}

TEST(CarriedRound, MoreSubstepsHelp)
{
    double before = 1e-3;
    for (const int substeps : {1, 4, 16}) {
        Settings settings;
        settings.substeps = substeps;
        const double off = std::abs(radius_after(turntable(settings), 3) - 1);
        EXPECT_LT(off, substeps == 1 ? 2e-3 : before / 2) << substeps;
        before = off;
    }
}

TEST(CarriedRound, HeavyBodiesThatTurnCarryToo)
{
    EXPECT_NEAR(radius_after(turntable({}, Motion::dynamic), 3), 1, 2e-3);
}

}  // namespace
}  // namespace throng
