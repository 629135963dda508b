// What overlap=back_up and subdivide keep to for bodies that need not be convex.
#include "kernels/data/bounds.hpp"
#include "kernels/geometry/closest_points.hpp"
#include "scene/catalog/noisy_balls.hpp"
#include "tests/pipeline/event_driven/carried_scenes.hpp"
#include "tests/support/solid_scenes.hpp"
#include "throng/dials.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

using given::block_under;
using given::carried;
using given::energy_of;
using given::hash_after;
using given::mesh_of;
using given::place_of;
using given::SceneOf;
using given::velocity_of;
using given::voxels_of;

constexpr double kDt = 0.01;

SceneOf solids(Overlap overlap, NonConvex way)
{
    SceneOf made = carried(overlap, 0.5, 0);
    made.scene.settings.dt = kDt;
    made.scene.settings.nonconvex = way;
    made.scene.settings.sphere_levels = 3;
    made.scene.settings.voxel_size = 0.03;
    return made;
}

// Rings that fall on one another, with a lump, a box and a ball.
void add_rings(SceneOf& made)
{
    const std::uint32_t ring = made.shape(mesh_of(torus_mesh(0.3, 0.12, 12, 6)));
    for (int i = 0; i < 3; ++i) {
        const double lean = 0.1 + 0.2 * i;
        made.body(ring, Vec3(0.05 * i, -0.03 * i, 0.3 + 0.45 * i)).orientation =
            Quat(std::cos(lean), 0.8 * std::sin(lean), 0.6 * std::sin(lean), 0);
    }
    made.body(made.shape(mesh_of(noisy_ball(0.2, 0.3, 80, 5))), Vec3(0.2, 0, 1.8));
    made.box(Vec3(0.2, 0.15, 0.1), Vec3(-0.2, 0.1, 1.7));
    made.ball(0.1, Vec3(0.05, 0, 2.2));
}

// ---- whether triangles cross, the plain way ----

struct Surface {
    std::vector<Vec3> places;  // in world axes
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<Box3> boxes;
};

Surface surface_of(const Scene& scene, const World& world, std::size_t body)
{
    const BodyDescription& made = scene.bodies[body];
    const auto& shape = scene.shapes[made.shape].shape;
    Surface surface;
    if (const auto* mesh = std::get_if<MeshShape>(&shape)) {
        surface.places = mesh->vertices;
        surface.triangles = mesh->triangles;
    } else if (const auto* box = std::get_if<BoxShape>(&shape)) {
        TriangleSoup soup = box_mesh(box->half_extents);
        surface.places = std::move(soup.vertices);
        surface.triangles = std::move(soup.triangles);
    }
    const Pose pose = world.pose(world.bodies()[body]);
    for (Vec3& place : surface.places) place = pose * place;
    for (const auto& [u, v, w] : surface.triangles) {
        const Vec3 &a = surface.places[u], &b = surface.places[v], &c = surface.places[w];
        surface.boxes.push_back({a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)});
    }
    return surface;
}

bool pierces(const Vec3& from, const Vec3& to, const Vec3& a, const Vec3& b, const Vec3& c)
{
    const Vec3 normal = (b - a).cross(c - a).normalized();
    const double begin = normal.dot(from - a), end = normal.dot(to - a);
    if (!(begin * end < 0)) return false;
    const Vec3 place = from + (to - from) * (begin / (begin - end));
    return (closest_on_triangle<double>(place, a, b, c).point - place).norm() < 1e-12;
}

bool crosses(const Surface& one, const Surface& other)
{
    for (std::size_t i = 0; i < one.triangles.size(); ++i)
        for (std::size_t k = 0; k < other.triangles.size(); ++k) {
            if (!one.boxes[i].overlaps(other.boxes[k])) continue;
            const auto& [a, b, c] = other.triangles[k];
            for (std::size_t e = 0; e < 3; ++e)
                if (pierces(one.places[one.triangles[i][e]],
                            one.places[one.triangles[i][(e + 1) % 3]], other.places[a],
                            other.places[b], other.places[c]))
                    return true;
        }
    return false;
}

// Of all that has triangles, and of their corners and the floor.
int crossings(const Scene& scene, const World& world, double floor)
{
    std::vector<Surface> surfaces;
    int count = 0;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        surfaces.push_back(surface_of(scene, world, i));
        for (const Vec3& place : surfaces.back().places)
            count += scene.bodies[i].motion == Motion::dynamic && place.z() <= floor ? 1 : 0;
        for (std::size_t k = 0; k < i; ++k)
            count += crosses(surfaces[i], surfaces[k]) || crosses(surfaces[k], surfaces[i]) ? 1 : 0;
    }
    return count;
}

// Pairs that are not apart: of spheres by what is measured, of others by their triangles.
int overlapping(const Scene& scene, const World& world, double floor)
{
    if (scene.settings.nonconvex == NonConvex::spheres)
        return static_cast<int>(world.measure().overlapping_pairs);
    return crossings(scene, world, floor);
}

Scene falling_rings(Overlap overlap, NonConvex way)
{
    SceneOf made = solids(overlap, way);
    made.floor();
    add_rings(made);
    return made.scene;
}

constexpr NonConvex kWays[] = {NonConvex::spheres, NonConvex::voxels};

class CarriedSolids : public testing::TestWithParam<NonConvex> { };
INSTANTIATE_TEST_SUITE_P(Ways, CarriedSolids, testing::ValuesIn(kWays));

TEST_P(CarriedSolids, NeverOverlapByBackUp)
{
    const Scene scene = falling_rings(Overlap::back_up, GetParam());
    World world(scene);
    ASSERT_TRUE(world.effects().on.has(Effect::no_overlap));
    double before = energy_of(world);
    for (int step = 0; step < 45; ++step) {
        world.step();
        ASSERT_EQ(overlapping(scene, world, 0), 0) << "step " << step;
        const double energy = energy_of(world);
        ASSERT_LT(energy, before * (1 + 1e-6)) << "step " << step;
        before = energy;
    }
    EXPECT_LT(place_of(world, 4).z(), 1.4);  // the lump is down on the rings
    EXPECT_EQ(world.report().fallbacks, 0u);
}

TEST_P(CarriedSolids, OverlapNoMoreThanTheToleranceBySubdivide)
{
    const Scene scene = falling_rings(Overlap::subdivide, GetParam());
    World world(scene);
    ASSERT_TRUE(world.effects().on.has(Effect::little_overlap));
    // The tolerance of the largest that may meet, and what any two close in the shortest piece.
    const double most = 1e-4 * 0.2 + 2 * std::sqrt(2 * 9.81 * 2.2) * kDt / 4096;
    for (int step = 0; step < 45; ++step) {
        world.step();
        if (GetParam() != NonConvex::spheres) continue;  // of others a field measures less well
        ASSERT_LE(world.measure().greatest_overlap, most) << "step " << step;
    }
    EXPECT_LE(world.report().deepest, most);
    EXPECT_LT(place_of(world, 4).z(), 1.4);
    EXPECT_EQ(world.report().fallbacks, 0u);
}

// Faces on faces, all of whose corners and edges touch at once.
TEST_P(CarriedSolids, ComeToRest)
{
    SceneOf made = solids(Overlap::back_up, GetParam());
    made.floor();
    const std::uint32_t box = made.shape(mesh_of(box_mesh(Vec3(0.3, 0.2, 0.1))));
    for (int i = 0; i < 2; ++i) made.body(box, Vec3(0.03 * i, 0.02 * i, 0.2 + 0.25 * i));
    World world(made.scene);
    for (int step = 0; step < 150; ++step) {
        world.step();
        ASSERT_EQ(overlapping(made.scene, world, 0), 0) << "step " << step;
    }
    EXPECT_LT(given::greatest_speed(world), 1e-6);
    EXPECT_EQ(world.report().fallbacks, 0u);
}

TEST_P(CarriedSolids, AreHeldApartFromStaticMeshesAndWhatMovesByItself)
{
    for (const Overlap overlap : {Overlap::back_up, Overlap::subdivide}) {
        SceneOf made = solids(overlap, GetParam());
        MeshShape valley;
        valley.vertices = {{-3, -3, 1}, {0, -3, 0}, {3, -3, 1}, {-3, 3, 1}, {0, 3, 0}, {3, 3, 1}};
        valley.triangles = {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}};
        made.body(made.shape(valley), Vec3(0, 0, -0.5)).motion = Motion::static_;
        BodyDescription& paddle = made.box(Vec3(0.1, 0.5, 0.3), Vec3(-1, 0, 0.5));
        paddle.motion = Motion::kinematic;
        paddle.velocity = Vec3(0.5, 0, 0);
        paddle.angular_velocity = Vec3(0, 0, 1);
        add_rings(made);
        World world(made.scene);
        for (int step = 0; step < 24; ++step) {
            world.step();
            if (overlap == Overlap::back_up) {
                ASSERT_EQ(overlapping(made.scene, world, -0.5), 0) << "step " << step;
            }
        }
        for (std::size_t i = 2; i < 8; ++i) EXPECT_GT(place_of(world, i).z(), -0.5);
        EXPECT_EQ(world.report().fallbacks, 0u);
    }
}

TEST_P(CarriedSolids, SameBitsForAnyNumberOfThreads)
{
    for (const Overlap overlap : {Overlap::back_up, Overlap::subdivide}) {
        const Scene scene = falling_rings(overlap, GetParam());
        EXPECT_EQ(hash_after(scene, 4, 25), hash_after(scene, 1, 25));
    }
}

// A thin ring on its way through another at many times its thickness a step.
TEST_P(CarriedSolids, FastOnesDoNotPassThroughOneAnother)
{
    for (const Overlap overlap : {Overlap::back_up, Overlap::subdivide}) {
        SceneOf made = solids(overlap, GetParam());
        made.scene.gravity = Vec3::Zero();
        made.scene.settings.sphere_levels = 4;
        const std::uint32_t ring = made.shape(mesh_of(torus_mesh(0.3, 0.03, 16, 6)));
        made.body(ring, Vec3::Zero());
        made.body(ring, Vec3(-3, 0.3, 0)).velocity = Vec3(100, 0, 0);
        World world(made.scene);
        world.step(10);
        EXPECT_GT(velocity_of(world, 0).x(), 10);  // it was struck
        if (overlap == Overlap::back_up) {
            EXPECT_EQ(overlapping(made.scene, world, -1e9), 0);
        }
    }
}

// Of all ways but spheres the triangles are held apart, whatever else would tell of them.
TEST(CarriedSolidsByImages, GoTheWayOfVoxels)
{
    const std::string wanted =
        hash_after(falling_rings(Overlap::back_up, NonConvex::voxels), 1, 20);
    EXPECT_EQ(hash_after(falling_rings(Overlap::back_up, NonConvex::depth_image), 1, 20), wanted);
}

// A ring by spheres and one by voxels, and ground that is a level set.
TEST(CarriedSolidsOfManyWays, AreHeldApart)
{
    SceneOf made = solids(Overlap::back_up, NonConvex::voxels);
    const auto level = [](double, double) { return 0.0; };
    made.body(made.shape(voxels_of(block_under(level, 4, 0.5), 0.15, 0.6)), Vec3::Zero()).motion =
        Motion::static_;
    add_rings(made);
    MeshShape ring = mesh_of(torus_mesh(0.3, 0.12, 12, 6));
    ring.nonconvex = "spheres";
    made.body(made.shape(ring), Vec3(-0.1, 0.05, 2.4));
    World world(made.scene);
    ASSERT_TRUE(world.effects().on.has(Effect::no_overlap));
    for (int step = 0; step < 25; ++step) {
        world.step();
        // The level set is off by a little of a voxel.
        ASSERT_EQ(crossings(made.scene, world, -0.01), 0) << "step " << step;
    }
    EXPECT_EQ(world.report().fallbacks, 0u);
}

TEST_P(CarriedSolids, NothingIsSaidOfThem)
{
    Scene scene = falling_rings(Overlap::back_up, GetParam());
    scene.dials_set = {"overlap"};
    EXPECT_TRUE(unused_dials(scene).empty());
}

}  // namespace
}  // namespace throng
