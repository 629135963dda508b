// Who closes in on somebody light before what stands still, through the public door.
#include "tests/support/small_scenes.hpp"
#include "throng/world.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace throng {
namespace {

using given::SceneOf;

struct Way {
    std::string name;
    Settings settings;
};

std::vector<Way> all_ways()
{
    std::vector<Way> ways = {{"default", {}}, {"pgs", {}},     {"direct", {}},
                             {"penalty", {}}, {"back_up", {}}, {"subdivide", {}}};
    ways[1].settings.solver = Solver::pgs;
    ways[2].settings.solver = Solver::direct;
    ways[3].settings.response = Response::penalty;
    ways[4].settings.overlap = Overlap::back_up;
    ways[5].settings.overlap = Overlap::subdivide;
    return ways;
}

// Balls of 1 and 100 kg meet thirty-one times, walls among them: Galperin, Playing pool with pi.
TEST(ClosingIn, HeavyBallIsTurnedBackByALightOneBeforeAWall)
{
    for (const Way& way : all_ways()) {
        SceneOf made;
        made.scene.settings = way.settings;
        made.scene.gravity.setZero();
        made.scene.materials[0] = {.name = "stuff", .friction = 0, .restitution = 1};
        made.floor();
        made.ball(0.05, Vec3(0, 0, 0.07)).mass = 1;
        BodyDescription& heavy = made.ball(0.1, Vec3(0, 0, 0.8));
        heavy.mass = 100;
        heavy.velocity = Vec3(0, 0, -2);
        World world(made.scene);
        world.step(90);
        const auto bodies = world.bodies();
        const double fast = world.velocity(bodies[2]).z(), slow = world.velocity(bodies[1]).z();
        EXPECT_NEAR(100 * fast * fast + slow * slow, 400, 1e-2) << way.name;
        // Each of sixteen meetings turns (10 fast, slow) by twice the same angle.
        EXPECT_NEAR(fast, -2 * std::cos(32 * std::atan(0.1)), 1e-3) << way.name;
    }
}

double energy_of(const World& world, const std::vector<double>& masses)
{
    double energy = 0;
    for (std::size_t i = 0; i < masses.size(); ++i) {
        const BodyId body = world.bodies()[i + 1];
        energy += masses[i]
            * (0.5 * world.velocity(body).squaredNorm() + 9.81 * world.pose(body).position.z());
    }
    return energy;
}

// The escalated solve has few steps for it.
TEST(ClosingIn, HeavyBodyThatFallsOnALightOneIsNotThrown)
{
    struct Fall {
        bool boxes;
        double times, height, beside, restitution, dt;
    };
    const Fall falls[] = {{false, 26, 0.02, 0.05, 1, 1.0 / 60},
                          {false, 26, 0.5, 0, 1, 1.0 / 60},
                          {false, 100, 0.5, 0, 1, 1.0 / 60},
                          {true, 50, 0.1, 0.05, 0.5, 1.0 / 240},
                          {true, 50, 0.02, 0, 0.9, 1.0 / 240}};
    for (const Fall& fall : falls) {
        SceneOf made;
        made.scene.settings.dt = fall.dt;
        made.scene.materials[0] = {
            .name = "stuff", .friction = 0.5, .restitution = fall.restitution};
        made.floor();
        const double small = 0.1 / fall.times;
        const Vec3 above(fall.beside * small, 0, 2 * small + 0.1 + fall.height);
        const auto add = [&](double size, const Vec3& at) -> BodyDescription& {
            return fall.boxes ? made.box(Vec3::Constant(size), at) : made.ball(size, at);
        };
        const std::vector<double> masses = {1, std::pow(fall.times, 3)};
        add(small, Vec3(0, 0, small)).mass = masses[0];
        add(0.1, above).mass = masses[1];
        World world(made.scene);
        const double before = energy_of(world, masses), drop = masses[1] * 9.81 * fall.height;
        for (int k = 0; k < 12; ++k) {
            world.step(static_cast<int>(1 / fall.dt / 6));
            EXPECT_LT(energy_of(world, masses), before + 0.03 * drop)
                << fall.boxes << " " << fall.times << " " << fall.height << " " << k;
        }
    }
}

}  // namespace
}  // namespace throng
