// SimBenchmark's scenes are what its definitions say, and what their sizes make of them.
#include "tests/scene/catalog/scene_bodies.hpp"
#include "throng/catalog.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace throng {
namespace {

double friction(const Scene& scene, std::uint32_t a, std::uint32_t b)
{
    return std::sqrt(scene.materials[a].friction * scene.materials[b].friction);
}

TEST(SimBenchmark, RollingPullsABoxFromUnderItsBalls)
{
    const Scene scene = make_scene("rolling", 25);
    const BodyDescription& box = scene.bodies[1];
    const BodyDescription& ball = scene.instances[0].common;
    EXPECT_EQ(scene.instances[0].count(), 25u);
    EXPECT_EQ(box.mass, 10);
    EXPECT_EQ(ball.mass, 1);
    EXPECT_NEAR(box.force.norm(), 150, 1e-12);
    EXPECT_NEAR(box.force.y() / box.force.x(), std::sqrt(3), 1e-12);
    EXPECT_NEAR(friction(scene, scene.bodies[0].material, box.material), 0.4, 1e-15);
    EXPECT_NEAR(friction(scene, box.material, ball.material), 0.8, 1e-15);
    for (std::size_t id = 2; id < scene.body_count(); ++id)
        EXPECT_DOUBLE_EQ(body_at(scene, id).position.z(), 0.3);  // on the box, touching
    // However many balls there are, the force moves them, and they stay on for 4 s.
    for (const int size : {1, 2, 100, 3000}) {
        const Scene other = make_scene("rolling", size);
        const double weight = (10 + size) * 9.81;
        EXPECT_GT(other.bodies[1].force.norm(), 1.05 * 0.4 * weight) << size;
        const double width =
            std::get<BoxShape>(other.shapes[other.bodies[1].shape].shape).half_extents.x();
        for (std::size_t id = 2; id < other.body_count(); ++id)
            ASSERT_LT(body_at(other, id).position.cwiseAbs().head<2>().maxCoeff() + 8, width);
    }
}

TEST(SimBenchmark, BouncingHasTheEnergyThatIsPublished)
{
    const Scene scene = make_scene("bouncing", 49);
    double energy = 0;
    for (std::size_t id = 1; id < scene.body_count(); ++id)
        energy += *scene.instances[0].common.mass * 9.81 * body_at(scene, id).position.z();
    EXPECT_NEAR(energy, 24034.5, 1e-8);
    EXPECT_EQ(scene.materials[0].restitution, 1);
    EXPECT_EQ(scene.materials[0].friction, 0);
}

TEST(SimBenchmark, CubesOfBallsAreMovedByUpToAMillimeter)
{
    for (const auto& [name, lowest, restitution] :
         {std::tuple("ball_cube", 0.101, 0.0), std::tuple("elastic_ball_cube", 1.101, 1.0)}) {
        const Scene scene = make_scene(name, 216, 42);
        EXPECT_EQ(scene.materials[0].restitution, restitution);
        EXPECT_EQ(scene.materials[0].friction, 0);
        EXPECT_EQ(scene.instances[0].common.mass, 10);
        double least = 1, most = 0;
        for (int i = 0; i < 216; ++i) {
            const Vec3 grid(i % 6, i / 6 % 6, i / 36);
            const Vec3 shift = body_at(scene, static_cast<std::size_t>(i) + 1).position
                - 0.21 * grid - Vec3(0, 0, lowest);
            least = std::min(least, shift.minCoeff());
            most = std::max(most, shift.maxCoeff());
        }
        EXPECT_GT(least, -1e-12);
        EXPECT_LT(least, 1e-4);
        EXPECT_LT(most, 1e-3);
        EXPECT_GT(most, 9e-4);
    }
}

TEST(SimBenchmark, EveryPlankOfKaplaLiesOnWhatIsBelow)
{
    for (const int size : {1, 30, 102}) {
        const Scene scene = make_scene("kapla", size);
        std::vector<Box3> planks;
        for (std::size_t id = 1; id < scene.body_count(); ++id)
            planks.push_back(part_bounds(scene, id).front());
        for (const Box3& plank : planks) {
            if (plank.lower.z() < 1e-12) continue;
            double held = 0;  // m2
            for (const Box3& below : planks)
                if (std::abs(below.upper.z() - plank.lower.z()) < 1e-12) {
                    const Vec3 shared =
                        plank.upper.cwiseMin(below.upper) - plank.lower.cwiseMax(below.lower);
                    held += std::max(shared.x(), 0.0) * std::max(shared.y(), 0.0);
                }
            EXPECT_GT(held, 1e-3) << size;
        }
    }
    EXPECT_NEAR(part_bounds(make_scene("kapla", 102), 102).front().upper.z(), 1.2, 1e-12);
}

}  // namespace
}  // namespace throng
