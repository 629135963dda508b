// Friction: where it acts and within which cone, as the dials have it.
#include "tests/support/small_scenes.hpp"
#include "throng/catalog.hpp"
#include "throng/dials.hpp"
#include "throng/world.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace throng {
namespace {

constexpr double kGravity = 10, kFriction = 0.4;
const Vec3 kHalf(0.5, 0.5, 0.1);  // of the box, m

struct Kind {
    Solver solver;
    Precision precision;
    FrictionAt at;
    FrictionCone cone;
};

std::vector<Kind> every_kind()
{
    std::vector<Kind> kinds;
    for (const Solver solver : {Solver::soft_step, Solver::pgs})
        for (const Precision precision : {Precision::float_, Precision::double_})
            for (const FrictionAt at : {FrictionAt::manifold, FrictionAt::points})
                for (const FrictionCone cone : {FrictionCone::cone, FrictionCone::pyramid})
                    kinds.push_back({solver, precision, at, cone});
    return kinds;
}

void choose(const Kind& kind, Settings& settings)
{
    settings.solver = kind.solver;
    settings.precision = kind.precision;
    settings.friction_at = kind.at;
    settings.friction_cone = kind.cone;
}

std::string text_of(const Kind& kind)
{
    return std::string(kind.solver == Solver::pgs ? "pgs" : "soft_step")
        + (kind.precision == Precision::float_ ? " float" : " double")
        + (kind.at == FrictionAt::points ? " at points" : "")
        + (kind.cone == FrictionCone::pyramid ? " within a pyramid" : "");
}

// A flat box that lies on a floor, so flat that it never tips.
Scene box_on_floor(const Kind& kind, const Vec3& velocity, double spin)
{
    Scene scene;
    scene.gravity = Vec3(0, 0, -kGravity);
    choose(kind, scene.settings);
    scene.settings.dt = 1.0 / 240;
    scene.settings.sleep = false;
    scene.materials.push_back({"m", 1000, kFriction, 0, 0});
    scene.shapes.push_back({"floor", PlaneShape{}});
    scene.shapes.push_back({"box", BoxShape{kHalf}});
    BodyDescription floor, box;
    floor.shape = floor.material = 0;
    floor.motion = Motion::static_;
    box.shape = 1;
    box.material = 0;
    box.mass = 3;
    box.position = Vec3(0, 0, kHalf.z());
    box.velocity = velocity;
    box.angular_velocity = Vec3(0, 0, spin);
    scene.bodies = {floor, box};
    return scene;
}

struct Slid {
    Vec3 velocity = Vec3::Zero(), place = Vec3::Zero();
    double spin = 0;
};

Slid slide(const Scene& scene, int steps)
{
    World world(scene);
    world.step(steps);
    const BodyId box = world.bodies().back();
    return {world.velocity(box), world.pose(box).position, world.angular_velocity(box).z()};
}

// The first steps settle the load; what is compared is what the rest of a half second takes away.
Vec3 slowing(const Kind& kind, const Vec3& velocity)
{
    const Scene scene = box_on_floor(kind, velocity, 0);
    return (slide(scene, 24).velocity - slide(scene, 120).velocity) / 0.4;
}

TEST(Friction, SlowsASlidingBoxByItsCoefficientAndInAPyramidAlongEachSide)
{
    const double slows = kFriction * kGravity;
    for (const Kind& kind : every_kind()) {
        SCOPED_TRACE(text_of(kind));
        const double tolerance = 2e-3 * slows;
        const Vec3 straight = slowing(kind, Vec3(5, 0, 0));
        EXPECT_NEAR(straight.x(), slows, tolerance);
        EXPECT_NEAR(straight.y(), 0, tolerance);
        const Vec3 aslant = slowing(kind, Vec3(4, 4, 0));
        const double share = kind.cone == FrictionCone::pyramid ? 1 : std::sqrt(0.5);
        EXPECT_NEAR(aslant.x(), slows * share, tolerance);
        EXPECT_NEAR(aslant.y(), slows * share, tolerance);
    }
}

// What four corners do that each bear a quarter of the weight: the law of friction at each, in
// short steps.
Slid corners(const Vec3& velocity, double spin, double time)
{
    constexpr int kSteps = 20000;
    const double h = time / kSteps;
    const double gyration = (kHalf.x() * kHalf.x() + kHalf.y() * kHalf.y()) / 3;  // m2
    Slid state{velocity, Vec3::Zero(), spin};
    double angle = 0;
    for (int step = 0; step < kSteps; ++step) {
        Vec3 force = Vec3::Zero();
        double torque = 0;
        for (int k = 0; k < 4; ++k) {
            const double at = angle + std::atan2(k < 2 ? 1 : -1, k % 2 == 0 ? 1 : -1);
            const double speculative_margin = std::hypot(kHalf.x(), kHalf.y());
            const Vec3 arm(speculative_margin * std::cos(at), speculative_margin * std::sin(at), 0);
            const Vec3 slip = state.velocity + Vec3(-state.spin * arm.y(), state.spin * arm.x(), 0);
            if (slip.norm() < 1e-9) continue;
            const Vec3 push = -0.25 * kFriction * kGravity * slip.normalized();
            force += push;
            torque += arm.cross(push).z();
        }
        state.velocity += h * force;
        state.spin += h * torque / gyration;
        state.place += h * state.velocity;
        angle += h * state.spin;
    }
    return state;
}

TEST(Friction, AtPointsSlowsASpinningBoxAsItsCornersDo)
{
    for (const Kind& kind : every_kind()) {
        if (kind.cone == FrictionCone::pyramid) continue;
        SCOPED_TRACE(text_of(kind));
        const Slid got = slide(box_on_floor(kind, Vec3::Zero(), 8), 120);
        const Slid wanted = corners(Vec3::Zero(), 8, 0.5);
        EXPECT_NEAR(got.spin, wanted.spin, 0.02 * (8 - wanted.spin));
        EXPECT_LT(got.place.head<2>().norm(), 2e-3);
    }
}

TEST(Friction, AtPointsKnowsThatSpinningEasesSlidingWhereTheMiddleDoesNot)
{
    for (const Kind& kind : every_kind()) {
        if (kind.cone == FrictionCone::pyramid) continue;
        SCOPED_TRACE(text_of(kind));
        const Slid got = slide(box_on_floor(kind, Vec3(2, 0, 0), 20), 96);
        const Slid wanted = corners(Vec3(2, 0, 0), 20, 0.4);
        const double slowed = 2 - wanted.velocity.norm();
        if (kind.at == FrictionAt::points) {
            EXPECT_NEAR(got.velocity.x(), wanted.velocity.x(), 0.05 * slowed);
            EXPECT_NEAR(got.spin, wanted.spin, 0.02 * (20 - wanted.spin));
        } else {
            EXPECT_LT(got.velocity.norm(), 2 - 1.5 * slowed);
        }
    }
}

TEST(Friction, OfEveryKindHoldsATowerAtRest)
{
    for (const Kind& kind : every_kind()) {
        SCOPED_TRACE(text_of(kind));
        Scene scene = box_on_floor(kind, Vec3::Zero(), 0);
        scene.settings.dt = 1.0 / 60;
        // With friction of any kind towers of more creep by pgs.
        const int boxes = kind.solver == Solver::pgs ? 2 : 8;
        for (int i = 1; i < boxes; ++i) {
            scene.bodies.push_back(scene.bodies.back());
            scene.bodies.back().position.z() += 2 * kHalf.z();
        }
        World world(scene);
        world.step(240);
        for (const BodyId body : world.bodies()) {
            EXPECT_LT(world.velocity(body).norm(), 1e-3);
            EXPECT_LT(world.pose(body).position.head<2>().norm(), 1e-3);
        }
    }
}

TEST(Friction, HoldsOnASlopeUpToItsLimitAndSlidesBeyond)
{
    for (const Kind& kind : every_kind()) {
        SCOPED_TRACE(text_of(kind));
        // Down along x, a side of the pyramid.
        for (const double share : {0.97, 1.03}) {
            Scene scene = box_on_floor(kind, Vec3::Zero(), 0);
            scene.gravity = Vec3(share * kFriction * kGravity, 0, -kGravity);
            const Slid slid = slide(scene, 240);
            if (share < 1)
                EXPECT_LT(slid.velocity.norm(), 1e-4);
            else
                EXPECT_NEAR(slid.velocity.x(), 0.03 * kFriction * kGravity, 0.012);
        }
    }
}

TEST(Friction, OfEveryKindHasTheSameBitsOnAnyNumberOfThreads)
{
    for (const Kind& kind : every_kind()) {
        if (kind.at == FrictionAt::manifold && kind.cone == FrictionCone::cone) continue;
        SCOPED_TRACE(text_of(kind));
        Scene scene = make_scene("pile", 60);
        choose(kind, scene.settings);
        const std::string wanted = given::hash_after(scene, 1, 40);
        EXPECT_EQ(given::hash_after(scene, 2, 40), wanted);
        EXPECT_EQ(given::hash_after(scene, 3, 40), wanted);
    }
}

TEST(Friction, DialsThatTheDirectSolverDoesNotReadChangeNothingAndAreNamed)
{
    Scene scene = make_scene("pile", 12);
    scene.settings.solver = Solver::direct;
    scene.settings.direct_limit = 4;  // so that some islands go by soft_step
    const std::string hash = given::hash_after(scene, 1, 40);
    scene.settings.friction_at = FrictionAt::points;
    scene.settings.friction_cone = FrictionCone::pyramid;
    scene.dials_set = {"friction_at", "friction_cone"};
    EXPECT_EQ(given::hash_after(scene, 1, 40), hash);
    const std::vector<std::string> named = {
        "friction_at: unused, solver direct has friction at every point",
        "friction_cone: unused, solver direct holds a round cone"};
    EXPECT_EQ(unused_dials(scene), named);
}

}  // namespace
}  // namespace throng
