#include "cooking/sphere_trees/solid_cores.hpp"

#include "cooking/fields/surface_points.hpp"
#include "kernels/geometry/mesh_distance.hpp"
#include "tests/support/closed_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace throng {
namespace {

std::vector<SolidCore> cores_of(const Mesh& mesh, double spacing)
{
    return build_solid_cores(mesh, build_surface_points(mesh, spacing));
}

// None sticks out, and none is much smaller than where it is would let it be.
void expect_within(const Mesh& mesh, const std::vector<SolidCore>& cores)
{
    for (const SolidCore& core : cores)
        EXPECT_LE(signed_distance(mesh, core.center), -core.radius * (1 - 1e-12));
}

TEST(SolidCores, AreAllRoundARing)
{
    const Mesh ring = closed(torus_mesh(0.1, 0.01, 16, 8));
    const std::vector<SolidCore> cores = cores_of(ring, 0.005);
    expect_within(ring, cores);
    for (int i = 0; i < 64; ++i) {
        const double angle = 2 * std::numbers::pi * i / 64;
        const Vec3 place(0.1 * std::cos(angle), 0.1 * std::sin(angle), 0);
        double nearest = 1;
        for (const SolidCore& core : cores)
            nearest = std::min(nearest, (core.center - place).norm());
        EXPECT_LT(nearest, 0.04) << angle;
    }
    for (const SolidCore& core : cores) EXPECT_GT(core.radius, 0.003);
}

TEST(SolidCores, OfABallAreOne)
{
    const Mesh ball = closed(ball_mesh(0.5, 32, 16));
    const std::vector<SolidCore> cores = cores_of(ball, 0.05);
    ASSERT_EQ(cores.size(), 1u);
    EXPECT_LT(cores[0].center.norm(), 0.02);
    EXPECT_GT(cores[0].radius, 0.47);
}

TEST(SolidCores, OfARodAreOneAfterAnother)
{
    const Mesh rod = closed(box_mesh({1, 0.05, 0.05}));
    const std::vector<SolidCore> cores = cores_of(rod, 0.05);
    expect_within(rod, cores);
    const auto left = [](const SolidCore& a, const SolidCore& b) {
        return a.center.x() < b.center.x();
    };
    const auto [first, last] = std::minmax_element(cores.begin(), cores.end(), left);
    EXPECT_LT(first->center.x(), -0.9);
    EXPECT_GT(last->center.x(), 0.9);
    EXPECT_GE(cores.size(), 12u);
    EXPECT_LE(cores.size(), 16u);
}

TEST(SolidCores, AreTheSameEachTime)
{
    const Mesh mesh = closed(noisy_ball(7, 0.5, 0.1));
    const std::vector<SolidCore> once = cores_of(mesh, 0.05), again = cores_of(mesh, 0.05);
    ASSERT_EQ(once.size(), again.size());
    for (std::size_t i = 0; i < once.size(); ++i) {
        EXPECT_EQ(once[i].center, again[i].center);
        EXPECT_EQ(once[i].radius, again[i].radius);
    }
}

}  // namespace
}  // namespace throng
