// Slender bodies: however thin they are, what stops them stops them, and falling over they win
// nothing.
#include "kernels/math/rotation.hpp"
#include "throng/world.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace throng {
namespace {

constexpr double kHalf = 1;  // m, of all lengths

BodyDescription& add(Scene& scene, decltype(ShapeDescription::shape) shape, const Pose& pose)
{
    BodyDescription& body = scene.bodies.emplace_back();
    body.shape = static_cast<std::uint32_t>(scene.shapes.size());
    scene.shapes.push_back({"s" + std::to_string(body.shape), std::move(shape)});
    body.position = pose.position;
    body.orientation = pose.orientation;
    return body;
}

// A bar along x, raised by half a radian, above a box that it would lie on.
double deepest_of_swing(double radius, bool pivots, Solver solver)
{
    Scene scene;
    scene.settings.sleep = false;
    scene.settings.solver = solver;
    const double arm = pivots ? 1.5 : 0.7;
    add(scene, BoxShape{Vec3::Constant(0.1)}, {Vec3(arm, 0, -0.1 - radius), Quat::Identity()})
        .motion = Motion::static_;
    const Quat raised = exponential(Vec3(0, std::acos(0.0) - 0.5, 0));
    const Vec3 middle = pivots ? Vec3(raised * Vec3(0, 0, kHalf)) : Vec3(Vec3::Zero());
    BodyDescription& bar = add(scene, CapsuleShape{radius, kHalf}, {middle, raised});
    bar.mass = 1;
    if (pivots) {
        bar.pivot = Vec3(0, 0, -kHalf);
    } else {
        bar.lock_position = true;
        bar.angular_velocity = Vec3(0, 3, 0);
    }
    World world(scene);
    double deepest = 0;
    for (int step = 0; step < 90; ++step) {
        world.step();
        const Vec3 along = world.pose(world.bodies()[1]).orientation * Vec3::UnitZ();
        deepest = std::max(deepest, -arm * along.z());
    }
    return deepest;
}

TEST(SlenderBodies, ThatOnlyTurnAreStoppedHoweverSlenderTheyAre)
{
    for (const double radius : {0.1, 0.02, 2e-3})
        for (const bool pivots : {true, false})
            for (const Solver solver : {Solver::soft_step, Solver::pgs, Solver::direct})
                EXPECT_LT(deepest_of_swing(radius, pivots, solver), radius / 2)
                    << radius << (pivots ? " on a pivot" : " locked");
}

// What a body that stood on its end, leaning a little, wins back of its energy as it falls over, J.
double won_in_fall(decltype(ShapeDescription::shape) shape, double thin, double friction)
{
    constexpr double kLean = 0.05;
    Scene scene;
    scene.settings.sleep = false;
    scene.materials.emplace_back().friction = friction;
    BodyDescription& floor = add(scene, PlaneShape{}, {Vec3::Zero(), Quat::Identity()});
    floor.motion = Motion::static_;
    floor.material = 0;
    const Pose pose = {Vec3(0, 0, kHalf * std::cos(kLean) + thin), exponential(Vec3(0, kLean, 0))};
    BodyDescription& body = add(scene, std::move(shape), pose);
    body.mass = 1;
    body.material = 0;
    World world(scene);
    double least = std::numeric_limits<double>::infinity(), won = 0;
    for (int step = 0; step < 120; ++step) {
        world.step();
        const Measures measures = world.measure();
        const double energy = measures.kinetic_energy + measures.potential_energy;
        least = std::min(least, energy);
        won = std::max(won, energy - least);
    }
    EXPECT_LT(least, 0.1) << "it lies";
    return won;
}

TEST(SlenderBodies, ThatTipOverWinNoEnergy)
{
    const double thin = 2e-3, fall = 9.81;
    for (const double friction : {0.0, 0.5}) {
        EXPECT_LT(won_in_fall(CapsuleShape{thin, kHalf}, thin, friction), 0.01 * fall);
        EXPECT_LT(won_in_fall(BoxShape{Vec3(thin, kHalf / 2, kHalf)}, thin, friction), 0.01 * fall);
    }
}

}  // namespace
}  // namespace throng
