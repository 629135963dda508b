// Voxel pairs: depths within a stated part of a voxel, nothing missed, nothing pushed sideways.
#include "narrowphase/solids/voxel_pairs.hpp"

#include "narrowphase/solids/solid_pairs.hpp"
#include "narrowphase/solids/surface_walk.hpp"
#include "tests/narrowphase/solids/small_solids.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace throng::test {
namespace {

constexpr ShapeRef kFirst{ShapeKind::solid, 0}, kSecond{ShapeKind::solid, 1};

SurfaceTouch deepest(const Shapes& shapes, ShapeRef other, const Pose& pose, double reach)
{
    std::vector<SurfaceTouch> touches;
    touch_by_voxels(shapes, shapes.solids[0], other, pose, reach, touches);
    SurfaceTouch most;
    most.separation = 1e300;
    for (const SurfaceTouch& touch : touches)
        if (touch.separation < most.separation) most = touch;
    return most;
}

// The greatest error of depth, and of the sine of the normal, over many ways that two balls touch.
std::array<double, 2> ball_errors(int voxels_in_radius)
{
    const double voxel = 1.0 / voxels_in_radius;
    Shapes shapes;
    shapes.solids = {small_ball(1, voxel), small_ball(0.75, voxel)};
    Dice dice{std::mt19937_64(91)};
    std::array<double, 2> worst{0, 0};
    for (int i = 0; i < 60; ++i) {
        const Vec3 way = dice.point(1).normalized();
        const double separation = dice.between(-0.1, 0.02);
        const Pose pose{way * (1.75 + separation), dice.turn()};
        const SurfaceTouch touch = deepest(shapes, kSecond, pose, 0.1);
        worst[0] = std::max(worst[0], std::abs(touch.separation - separation));
        worst[1] = std::max(worst[1], touch.normal.cross(way).norm());
    }
    return worst;
}

TEST(VoxelPairs, BallsAreAsDeepAsTheyAreAndOfSecondOrder)
{
    const auto coarse = ball_errors(8), fine = ball_errors(16);
    RecordProperty("coarse_voxels", std::to_string(coarse[0] * 8));
    RecordProperty("fine_voxels", std::to_string(fine[0] * 16));
                fine[1]);
    EXPECT_LT(coarse[0] * 8, 0.25);
    EXPECT_LT(fine[0], coarse[0] / 2.8);
}

}  // namespace
}  // namespace throng::test
