// Shared volume: the resolutions against the truth, and the ways against one another.
#include "narrowphase/alternatives/shared_volume.hpp"

#include "cooking/repair/build_mesh.hpp"
#include "kernels/geometry/mesh.hpp"
#include "kernels/geometry/mesh_distance.hpp"
#include "kernels/geometry/voxel_bricks.hpp"
#include "narrowphase/alternatives/clip_volume.hpp"
#include "narrowphase/alternatives/exact_volume.hpp"
#include "scene/catalog/closed_meshes.hpp"
#include "tests/support/polyhedra.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace throng {
namespace {

constexpr double kLens = 0.400981462330915;  // of the two balls below
constexpr double kCubes = 0.75;              // of the two cubes below

Mesh mesh_of(const TriangleSoup& soup) { return build_mesh(soup.vertices, soup.triangles).mesh; }

struct Two {
    Shapes shapes;
    Pose b_in_a;

    VolumePair pair(ShapeKind kind) const { return {shapes, {kind, 0}, {kind, 1}, b_in_a}; }
};

Two lens()
{
    Two two;
    two.shapes.spheres = {{1.0}, {0.7}};
    two.b_in_a.position = 1.1 * Vec3(0.36, 0.48, 0.8);
    return two;
}

// Unit cubes about one center, the one turned by 60 degrees about (1, 1, 1).
Two cubes()
{
    Two two;
    for (int i = 0; i < 2; ++i) {
        two.shapes.boxes.push_back({Vec3::Constant(0.5)});
        two.shapes.meshes.push_back(mesh_of(box_mesh(Vec3::Constant(0.5))));
    }
    two.b_in_a.orientation =
        Quat(std::sqrt(3.0) / 2, std::sqrt(1 / 12.0), std::sqrt(1 / 12.0), std::sqrt(1 / 12.0));
    return two;
}

Two meshes(const TriangleSoup& a, const TriangleSoup& b, const Pose& b_in_a)
{
    Two two;
    two.shapes.meshes = {mesh_of(a), mesh_of(b)};
    two.b_in_a = b_in_a;
    return two;
}

// The slope of log error over log resolution, doubling from 8 on.
template <class Volume>
double order_of(double truth, int doublings, Volume volume)
{
    RandomShapes random(45);
    double sum_x = 0, sum_y = 0, sum_xx = 0, sum_xy = 0;
    for (int i = 0; i < doublings; ++i) {
        double squares = 0;
        constexpr int kOffsets = 24;
        for (int k = 0; k < kOffsets; ++k) {
            const double error = volume(8 << i, random.vector(0, 1)) / truth - 1;
            squares += error * error / kOffsets;
        }
        const double x = i, y = 0.5 * std::log2(squares);
        sum_x += x;
        sum_y += y;
        sum_xx += x * x;
        sum_xy += x * y;
    }
    return -(doublings * sum_xy - sum_x * sum_y) / (doublings * sum_xx - sum_x * sum_x);
}

TEST(DepthImageVolume, ConvergesWithTheSquareOfTheResolution)
{
    const auto of = [](const VolumePair& pair, const Vec3& view = Vec3::UnitZ()) {
        return [=](int rays, const Vec3& offset) {
            return look_along(pair, view, rays, Layers::all, {offset.x(), offset.y()}).volume;
        };
    };
    const Two balls = lens(), boxes = cubes();
    EXPECT_NEAR(order_of(kLens, 5, of(balls.pair(ShapeKind::sphere))), 2, 0.3);
    EXPECT_NEAR(order_of(kCubes, 5, of(boxes.pair(ShapeKind::box))), 2, 0.3);
    EXPECT_NEAR(order_of(kCubes, 5, of(boxes.pair(ShapeKind::mesh))), 2, 0.3);
    // No face lies along these rays, so that lengths do not jump: better than that.
    const Vec3 skew = Vec3(0.3, -0.5, 0.81).normalized();
    EXPECT_NEAR(order_of(kLens, 5, of(balls.pair(ShapeKind::sphere), skew)), 2, 0.3);
    EXPECT_GT(order_of(kCubes, 5, of(boxes.pair(ShapeKind::mesh), skew)), 2);
}

TEST(VoxelVolume, ConvergesWithTheSquareOfTheResolution)
{
    const Two balls = lens();
    const auto volume = [&](int cells, const Vec3& offset) {
        return shared_by_voxels(balls.pair(ShapeKind::sphere), cells, offset).volume;
    };
    EXPECT_NEAR(order_of(kLens, 4, volume), 2, 0.3);
}

TEST(DepthImageVolume, TellsTheDepthAndNormalOfALens)
{
    const Two two = lens();
    const SharedVolume shared = shared_by_images(two.pair(ShapeKind::sphere), 64);
    EXPECT_NEAR(shared.volume / kLens, 1, 1e-3);
    EXPECT_NEAR((shared.normal - Vec3(0.36, 0.48, 0.8)).norm(), 0, 0.02);
    // A lens is 1.25 wide; half a pixel beside its axis it is thinner by the square of that.
    EXPECT_NEAR(shared.depth, 0.6, 1e-3);
}

TEST(SharedVolume, OfCubesIsTheSameByEachWay)
{
    const Two two = cubes();
    for (const ShapeKind kind : {ShapeKind::box, ShapeKind::mesh}) {
        EXPECT_NEAR(shared_exactly(two.pair(kind)).volume, kCubes, 1e-12);
        EXPECT_NEAR(shared_by_images(two.pair(kind), 128).volume, kCubes, 1e-3);
        EXPECT_NEAR(shared_by_images(two.pair(kind), 128, Layers::single).volume, kCubes, 1e-3);
        EXPECT_NEAR(shared_by_voxels(two.pair(kind), 64, {0.3, 0.6, 0.1}).volume, kCubes, 2e-3);
    }
}

TEST(SharedVolume, AgreesWithClippedHulls)
{
    RandomShapes random(7);
    int met = 0;
    for (int i = 0; i < 24; ++i) {
        Two two;
        two.shapes.hulls = {random.hull(12, 0.6), random.hull(20, 0.4)};
        two.b_in_a = random.pose(0.4);
        const VolumePair pair = two.pair(ShapeKind::hull);
        const ConvexPair convex(two.shapes, pair.a, pair.b, two.b_in_a);
        MethodMemory memory;
        const MethodAnswer truth = query_clip_volume(convex, 0, MethodStart::cold, memory);
        if (truth.overlap != OverlapState::touching || truth.volume < 1e-3) continue;
        ++met;
        const SharedVolume exact = shared_exactly(pair), seen = shared_by_images(pair, 96);
        EXPECT_NEAR(exact.volume, truth.volume, 1e-12);
        EXPECT_NEAR((exact.center - truth.center).norm(), 0, 1e-10);
        // A hundredth of a pixel over the whole of a surface that is no larger than 3 m2.
        EXPECT_NEAR(seen.volume / truth.volume, 1, 4e-3) << i;
        EXPECT_NEAR((seen.center - truth.center).norm(), 0, 2e-3) << i;
        EXPECT_LT((seen.normal - truth.normal).norm(), 0.05) << i;
    }
    EXPECT_GT(met, 10);
}

TEST(SharedVolume, IsTheSameSeenFromEitherSide)
{
    const Pose pose{{0.7, 0.2, 0.1}, Quat(1, 0.3, 0.2, -0.5).normalized()};
    const TriangleSoup ring = torus_mesh(0.7, 0.25, 24, 12), block = box_mesh({0.4, 0.5, 0.3});
    const Two ab = meshes(ring, block, pose);
    const Pose back{pose.to_local(Vec3::Zero()), pose.orientation.conjugate()};
    const Two ba = meshes(block, ring, back);
    const SharedVolume exact = shared_exactly(ab.pair(ShapeKind::mesh));
    const SharedVolume exact_back = shared_exactly(ba.pair(ShapeKind::mesh));
    EXPECT_NEAR(exact.volume, exact_back.volume, 1e-12);
    EXPECT_NEAR((exact.center - pose * exact_back.center).norm(), 0, 1e-11);
    const SharedVolume seen = shared_by_images(ab.pair(ShapeKind::mesh), 128);
    const SharedVolume seen_back = shared_by_images(ba.pair(ShapeKind::mesh), 128);
    EXPECT_NEAR(seen.volume / exact.volume, 1, 3e-3);
    EXPECT_NEAR(seen_back.volume / exact.volume, 1, 3e-3);
    EXPECT_NEAR((seen.center - exact.center).norm(), 0, 1e-3);
    EXPECT_LT((seen.normal + pose.orientation * seen_back.normal).norm(), 0.02);
}

TEST(SharedVolume, ATorusOverAPegSharesNothingButForASingleLayer)
{
    const Two two = meshes(torus_mesh(0.7, 0.2, 32, 16), ball_mesh(0.4, 24, 12),
                           Pose{{0.02, 0.01, 0.0}, Quat::Identity()});
    const VolumePair pair = two.pair(ShapeKind::mesh);
    EXPECT_EQ(shared_by_images(pair, 64).volume, 0);
    EXPECT_EQ(shared_by_voxels(pair, 48).volume, 0);
    EXPECT_NEAR(shared_exactly(pair).volume, 0, 1e-12);
    // Across the ring a ray goes through the hole, which a single layer fills.
    const double ball = 4.0 / 3 * std::numbers::pi * 0.4 * 0.4 * 0.4;
    EXPECT_GT(shared_by_images(pair, 64, Layers::single).volume, 0.2 * ball);
}

TEST(SharedVolume, OfWhatIsApartOrWithinIsPlain)
{
    Two two = cubes();
    two.b_in_a.position = {3, 0, 0};
    EXPECT_EQ(shared_by_images(two.pair(ShapeKind::box), 32).volume, 0);
    EXPECT_EQ(shared_by_voxels(two.pair(ShapeKind::box), 32).volume, 0);
    EXPECT_EQ(shared_exactly(two.pair(ShapeKind::mesh)).volume, 0);
    two.shapes.boxes[1].half_extents = Vec3::Constant(0.1);
    two.b_in_a.position = {0.2, 0, 0};
    const SharedVolume within = shared_by_images(two.pair(ShapeKind::box), 64);
    EXPECT_NEAR(within.volume, 0.008, 1e-5);
    EXPECT_EQ(within.normal, Vec3(Vec3::Zero()));
    EXPECT_EQ(within.depth, 0);
}

TEST(SharedVolume, OfFieldsIsThatOfTheirShapes)
{
    const auto ball = [](double radius) {
        return bake_bricks({Vec3::Constant(-radius), Vec3::Constant(radius)}, radius / 32,
                           radius / 4, [=](const Vec3& p) { return p.norm() - radius; });
    };
    // Between its values a field tells an eighth of a voxel squared times its curvature, 2 /
    // radius, too much: 1.3e-4 m over 2.6 m2 of surface, and counting errs by some 5e-4.
    const double volume = shared_by_fields(ball(1), ball(0.7), lens().b_in_a, 128).volume;
    EXPECT_NEAR(volume / kLens, 1, 2e-3);
}

TEST(SharedVolume, TakesAMeshThatLacksATriangle)
{
    TriangleSoup ball = ball_mesh(0.5, 24, 12);
    const Two whole = meshes(ball, box_mesh(Vec3::Constant(1)), {});
    const double volume = shared_by_images(whole.pair(ShapeKind::mesh), 64).volume;
    ball.triangles.erase(ball.triangles.begin() + 200);
    const Two holed = meshes(ball, box_mesh(Vec3::Constant(1)), {});
    const double less = shared_by_images(holed.pair(ShapeKind::mesh), 64).volume;
    // The columns behind one of 528 triangles, and nothing behind the hole on the rays' way on.
    EXPECT_LT(less, volume);
    EXPECT_GT(less, 0.98 * volume);
}

}  // namespace
}  // namespace throng
