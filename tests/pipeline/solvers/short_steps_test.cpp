// Short steps: what rounding would do to contacts where weight hardly presses them in.
#include "tests/support/small_scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace throng {
namespace {

// A ball that slips on a great box, far from its middle.
Scene slipping_ball(double substep)
{
    given::SceneOf made;
    made.box(Vec3(1000, 1000, 1), Vec3(-700, 0, -1)).motion = Motion::static_;
    BodyDescription& ball = made.ball(0.5, Vec3(0, 0, 0.5));
    ball.mass = 1;
    ball.velocity = Vec3(3, 0, 0);
    made.scene.materials[0].friction = 0.2;
    made.scene.settings.dt = 4 * substep;
    return made.scene;
}

TEST(ShortSteps, FrictionOnABallIsWhatItShouldBeFarAlongAFloor)
{
    for (const double substep : {2.5e-4, 2e-5}) {
        World world(slipping_ball(substep));
        const int steps = 300;
        world.step(steps);
        const double wanted = 0.2 * 9.8 * steps * 4 * substep;
        EXPECT_NEAR((3 - world.velocity(world.bodies().back()).x()) / wanted, 1, 0.01) << substep;
    }
}

TEST(ShortSteps, InFloatAreWarnedOf)
{
    const auto warnings = [](double substep, Precision precision) {
        Scene scene = slipping_ball(substep);
        scene.settings.precision = precision;
        return World(scene).warnings().size();
    };
    EXPECT_EQ(warnings(1.1e-5, Precision::float_), 0u);
    EXPECT_EQ(warnings(9e-6, Precision::float_), 1u);
    EXPECT_EQ(warnings(9e-6, Precision::double_), 0u);
}

}  // namespace
}  // namespace throng
