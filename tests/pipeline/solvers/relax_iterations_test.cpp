// Relaxing iterations: how many soft_step makes is told, and can be set.
#include "tests/support/small_scenes.hpp"
#include "throng/dials.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

double iterations(const Scene& scene)
{
    World world(scene);
    world.step(3);
    return world.report().relax_iterations;
}

// Two boxes on a floor, and so many balls beside them: by default each island is relaxed by what
// most of its contacts are, whatever is beside it.
given::SceneOf boxes_and_balls(int balls)
{
    given::SceneOf made;
    made.floor();
    made.scene.settings.sleep = false;
    for (const int i : {0, 1}) made.box(Vec3::Constant(0.5), Vec3(0, 0, 0.5 + i));
    for (int i = 0; i < balls; ++i) made.ball(0.5, Vec3(2 + 2 * i, 0, 0.5));
    return made;
}

constexpr double kOfTwentyTwo = (2 * 2 + 20 * 1) / 22.0;  // contacts: the mean

TEST(RelaxIterations, AreTwoWhereMostContactsAreFacesAndOneElsewhere)
{
    EXPECT_EQ(iterations(boxes_and_balls(0).scene), 2);
    EXPECT_DOUBLE_EQ(iterations(boxes_and_balls(20).scene), kOfTwentyTwo);
}

TEST(RelaxIterations, AreTwoByManySubsteps)
{
    Scene scene = boxes_and_balls(20).scene;
    scene.settings.substeps = 16;
    EXPECT_DOUBLE_EQ(iterations(scene), kOfTwentyTwo);
    scene.settings.substeps = 17;
    EXPECT_EQ(iterations(scene), 2);
}

// Of thirty dominoes, those that lean after 2 s.
int fallen(int substeps)
{
    given::SceneOf made;
    made.floor();
    for (int i = 0; i < 30; ++i) made.box(Vec3(0.125, 0.25, 0.5), Vec3(0.9 * i, 0, 0.5)).mass = 250;
    made.scene.bodies[1].angular_velocity = Vec3(0, 2, 0);
    made.scene.bodies[1].velocity = Vec3(1, 0, 0.25);
    made.scene.settings.substeps = substeps;
    World world(made.scene);
    world.step(120);
    int count = 0;
    for (const BodyId body : world.bodies())
        count += (world.pose(body).orientation * Vec3::UnitZ()).x() > 0.25 ? 1 : 0;
    return count;
}

TEST(RelaxIterations, KeepAWaveOfDominoesAsFastByManySubsteps)
{
    EXPECT_EQ(fallen(4), 5);
    EXPECT_EQ(fallen(16), 5);
    EXPECT_EQ(fallen(64), 5);
}

TEST(RelaxIterations, AreWhatTheDialSaysAndNoneOfOtherSolvers)
{
    Scene scene = boxes_and_balls(0).scene;
    ASSERT_EQ(set_dial(scene.settings, "relax_iterations", "5"), "");
    EXPECT_EQ(iterations(scene), 5);
    ASSERT_EQ(set_dial(scene.settings, "solver", "pgs"), "");
    EXPECT_EQ(iterations(scene), 0);
    for (const char* wrong : {"0", "101", "-1", "2.5", "many"})
        EXPECT_NE(set_dial(scene.settings, "relax_iterations", wrong), "") << wrong;
}

}  // namespace
}  // namespace throng
