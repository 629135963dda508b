// Peer scene: what another engine is given, and how its answer is judged.
#include "apps/throng/bench/peer_quality.hpp"
#include "throng/catalog.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace throng::bench {
namespace {

class EveryPeerScene : public ::testing::TestWithParam<const char*> { };

TEST_P(EveryPeerScene, ThrongsOwnStateIsJudgedAsItsWorldIs)
{
    const Scene scene = make_scene(GetParam(), 60);
    World world(scene);
    world.step(90);
    const Quality own = quality_of(scene, world), judged = quality_of(scene, peer_states(world));
    EXPECT_EQ(judged.overlapping_pairs, own.overlapping_pairs);
    EXPECT_NEAR(judged.mean_overlap, own.mean_overlap, 1e-9);
    EXPECT_NEAR(judged.greatest_overlap, own.greatest_overlap, 1e-9);
    EXPECT_NEAR(judged.kinetic_energy, own.kinetic_energy, 1e-6 * (1 + own.kinetic_energy));
    EXPECT_NEAR(judged.mean_height, own.mean_height, 1e-9);
}

TEST_P(EveryPeerScene, HasTheBodiesOfTheWorld)
{
    const Scene scene = make_scene(GetParam(), 60);
    const World world(scene);
    const PeerScene given = peer_scene(world, scene);
    ASSERT_EQ(given.bodies.size(), world.body_count());
    std::size_t at = 0;
    for (const BodyId id : world.bodies()) {
        const PeerBody& body = given.bodies[at++];
        EXPECT_EQ(body.motion, world.motion(id));
        EXPECT_EQ(body.mass, world.mass(id));
        EXPECT_GE(body.shapes, 1u);
        EXPECT_EQ(body.friction, 0.5);
        EXPECT_EQ(body.restitution, 0);
        if (body.motion == Motion::dynamic) {
            EXPECT_GT(body.inertia.xx, 0);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(
    Catalogue,
    EveryPeerScene,
    ::testing::Values(
        "pile", "spheres", "hulls", "wall", "pyramid", "stacks", "tumbler", "crowd", "sparse"),
    [](const auto& test) { return std::string(test.param); });

TEST(PeerScene, ACrowdIsDrivenAndMayNotTurn)
{
    const Scene scene = make_scene("crowd", 10);
    const PeerScene given = peer_scene(World(scene), scene);
    const PeerBody& person = given.bodies.back();
    EXPECT_TRUE(person.lock_rotation);
    EXPECT_TRUE(person.drive[0] && person.drive[1] && !person.drive[2]);
    EXPECT_EQ(given.shapes.back().kind, ShapeKind::capsule);
}

TEST(PeerScene, ForcesAndPlanesAreGiven)
{
    Scene scene = make_scene("rolling", 4);
    auto& ground = std::get<PlaneShape>(scene.shapes[scene.bodies[0].shape].shape);
    ground.normal = Vec3(0, 0.6, 0.8);
    ground.offset = -20;
    const PeerScene given = peer_scene(World(scene), scene);
    EXPECT_EQ(given.bodies[1].force, scene.bodies[1].force);
    EXPECT_EQ(given.bodies[2].force, Vec3::Zero());
    const PeerShape& plane = given.shapes[given.bodies[0].first_shape];
    EXPECT_EQ(plane.kind, ShapeKind::plane);
    EXPECT_TRUE(plane.size.isApprox(Vec3(0, 0.6, 0.8), 1e-12));
    EXPECT_NEAR(plane.size.dot(plane.local.position), -20, 1e-12);
}

TEST(PeerScene, AHullHasItsTrianglesOutward)
{
    const Scene scene = make_scene("hulls", 10);
    const PeerScene given = peer_scene(World(scene), scene);
    ASSERT_FALSE(given.hulls.empty());
    for (const PeerTriangles& hull : given.hulls) {
        EXPECT_EQ(hull.triangles.size(), 2 * hull.vertices.size() - 4);  // Euler's formula
        for (const auto& triangle : hull.triangles) {
            const Vec3 &a = hull.vertices[triangle[0]], &b = hull.vertices[triangle[1]],
                       &c = hull.vertices[triangle[2]];
            EXPECT_GT((b - a).cross(c - a).dot(a), 0);
        }
    }
}

TEST(PeerScene, MeshesThatMoveAreGivenAsTheirConvexParts)
{
    Scene scene = make_scene("knots", 3);
    scene.settings.max_parts = 6;
    const Scene taken = scene_of_peers(scene);
    const World world(taken);
    const PeerScene given = peer_scene(world, taken);
    std::size_t compounds = 0;
    for (const PeerBody& body : given.bodies) {
        if (body.motion != Motion::dynamic) continue;
        EXPECT_LE(body.shapes, 6u);
        compounds += body.shapes > 1 ? 1 : 0;
        for (std::uint32_t k = 0; k < body.shapes; ++k)
            EXPECT_EQ(given.shapes[body.first_shape + k].kind, ShapeKind::hull);
    }
    EXPECT_EQ(compounds, 3u);
    scene.settings.nonconvex = NonConvex::hull;
    EXPECT_EQ(scene_of_peers(scene).settings.nonconvex, NonConvex::hull);
}

TEST(PeerScene, AStateThatIsNotFiniteIsInfinitelyBad)
{
    const Scene scene = make_scene("pile", 5);
    std::vector<PeerState> states = peer_states(World(scene));
    states.back().pose.position.x() = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(quality_of(scene, states).mean_overlap, std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace throng::bench
