// Answers: hand-made states of scenes whose motion is known, and what is told of them.
#include "cost/answers/answers.hpp"

#include "throng/catalog.hpp"
#include "throng/world.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace throng {
namespace {

Scene scene_of(std::string_view name, int size) { return make_scene(name, size, 42); }

std::vector<PeerState> at_first(const Scene& scene) { return peer_states(World(scene)); }

double error_of(const Scene& scene,
                std::string_view name,
                double now,
                const std::vector<PeerState>& states)
{
    RunError error(*find_answer(name), scene);
    error.add(now, states);
    return error.mean();
}

TEST(Answers, AreOfScenesOfTheCatalogue)
{
    for (const SceneAnswer& answer : scene_answers()) {
        EXPECT_NE(find_scene(answer.scene), nullptr) << answer.scene;
        EXPECT_EQ(find_answer(answer.scene), &answer);
        EXPECT_GT(answer.time, 0);
    }
    EXPECT_EQ(find_answer("pile"), nullptr);
    EXPECT_EQ(find_answer("kapla"), nullptr);
}

// Box and balls as SimBenchmark has them: 12.66 N are left of the force, for 10 kg and 25 times
// 2/7 kg.
std::vector<PeerState> rolled(const Scene& scene, double now)
{
    std::vector<PeerState> states = at_first(scene);
    const Vec3 along(0.5, std::sqrt(0.75), 0);
    states[1].velocity = 0.7385 * now * along;
    for (std::size_t i = 2; i < states.size(); ++i) states[i].velocity = 0.211 * now * along;
    return states;
}

TEST(Answers, BoxAndBallsThatRollAreRight)
{
    const Scene scene = scene_of("rolling", 25);
    EXPECT_LT(error_of(scene, "rolling", 3, rolled(scene, 3)), 1e-25);
}

TEST(Answers, AVelocityThatIsOffIsSeen)
{
    const Scene scene = scene_of("rolling", 25);
    std::vector<PeerState> states = rolled(scene, 3);
    states[1].velocity.z() += 0.1;
    EXPECT_NEAR(error_of(scene, "rolling", 3, states), 0.01, 1e-12);
    states = rolled(scene, 3);
    states[20].velocity.x() -= 0.5;  // one of 25 balls
    EXPECT_NEAR(error_of(scene, "rolling", 3, states), 0.25 / 25, 1e-12);
    // A box that stays where it is, as in a pyramid of friction.
    EXPECT_NEAR(error_of(scene, "rolling", 4, at_first(scene)),
                16 * (0.7385 * 0.7385 + 0.211 * 0.211), 1e-9);
}

TEST(Answers, EnergyOfWhatFallsIsKept)
{
    const Scene scene = scene_of("bouncing", 9);
    std::vector<PeerState> states = at_first(scene);
    for (PeerState& ball : states) {
        ball.pose.position.z() -= 1.25;
        ball.velocity = Vec3(0, 0, -std::sqrt(2 * 9.81 * 1.25));
    }
    EXPECT_LT(error_of(scene, "bouncing", 0.5, states), 1e-20);
}

TEST(Answers, EnergyThatIsOffIsSeen)
{
    const Scene scene = scene_of("bouncing", 9);
    std::vector<PeerState> states = at_first(scene);
    states[3].velocity.x() = 0.2;  // 10 kg: 0.2 J
    EXPECT_NEAR(error_of(scene, "bouncing", 0, states), 0.04, 1e-9);
    states[3].velocity.x() = 0;
    states[3].angular_velocity.y() = 10;  // 2/5 of 10 kg (0.1 m)2: 2 J
    EXPECT_NEAR(error_of(scene, "bouncing", 0, states), 4, 1e-9);
    states = at_first(scene);
    states[4].pose.position.z() -= 0.01;  // 0.981 J
    EXPECT_NEAR(error_of(scene, "bouncing", 0, states), 0.981 * 0.981, 1e-9);
    const Scene cube = scene_of("elastic_ball_cube", 30);
    EXPECT_LT(error_of(cube, "elastic_ball_cube", 0, at_first(cube)), 1e-20);
}

TEST(Answers, OverlapsAreSeenBetweenBallsAndInTheGround)
{
    const Scene scene = scene_of("ball_cube", 40);
    std::vector<PeerState> states = at_first(scene);
    EXPECT_EQ(error_of(scene, "ball_cube", 0, states), 0);
    for (std::size_t i = 1; i < states.size(); ++i)
        states[i].pose.position = Vec3(static_cast<double>(i % 7), static_cast<double>(i / 7), 1);
    states[5].pose.position.z() = 0.08;  // 20 mm in the ground
    states[33].pose.position = states[21].pose.position + 0.19 * Vec3(0.48, 0.6, -0.64);
    EXPECT_NEAR(error_of(scene, "ball_cube", 0, states), 4e-4 + 1e-4, 1e-12);
    states[12].pose.position = states[11].pose.position;
    EXPECT_NEAR(error_of(scene, "ball_cube", 0, states), 4e-4 + 1e-4 + 4e-2, 1e-12);
}

TEST(RunError, IsTheMeanOverTheSteps)
{
    const Scene scene = scene_of("ball_cube", 2);
    RunError error(*find_answer("ball_cube"), scene);
    EXPECT_EQ(error.mean(), 0);
    std::vector<PeerState> states = at_first(scene);
    error.add(0.01, states);
    states[2].pose.position = states[1].pose.position + Vec3(0.1, 0, 0);
    error.add(0.02, states);
    EXPECT_NEAR(error.mean(), 0.01 / 2, 1e-12);
}

TEST(RunError, IsInfiniteOnceAStateIsNotFinite)
{
    const Scene scene = scene_of("ball_cube", 5);
    RunError error(*find_answer("ball_cube"), scene);
    std::vector<PeerState> states = at_first(scene);
    states[2].pose.position.x() = std::numeric_limits<double>::quiet_NaN();
    error.add(0.01, states);
    error.add(0.02, at_first(scene));
    EXPECT_EQ(error.mean(), std::numeric_limits<double>::infinity());
}

TEST(RunError, RefusesOtherBodies)
{
    const Scene scene = scene_of("bouncing", 5);
    RunError error(*find_answer("bouncing"), scene);
    EXPECT_THROW(error.add(0.01, at_first(scene_of("bouncing", 4))), std::invalid_argument);
}

}  // namespace
}  // namespace throng
