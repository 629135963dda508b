// Recipes: each scene is what it says it is.
#include "scene/catalog/recipes.hpp"

#include "tests/scene/catalog/scene_bodies.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace throng {
namespace {

// Bodies of the scenes of size 100 and seed 1 by id: the first that moves, one in the middle, the
// last, and the last one that does not move before those. Computed with an independent program in
// Python, on Python's own random module; printed with 9 digits. Size: half extents, or radius and
// half length, or the first corner of a hull.
struct Known {
    std::string_view scene;
    std::size_t id;
    std::array<double, 3> position;
    std::array<double, 4> orientation;  // w, x, y, z
    std::array<double, 3> velocity, angular_velocity, size;
};

// clang-format off
const Known kKnown[] = {
    {"pile", 4, {0, 5.425, 4.24}, {1, 0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {3.425, 2, 4.24}},
    {"pile", 5, {-2.71462543, -2.68610265, 0.7}, {0.00661631346, -0.778416469, 0.155868555, -0.608053467}, {-0.10101787, 0.303185945, 0}, {0, 0, 0}, {0.440943655, 0.313767256, 0.373858772}},
    {"pile", 55, {-2.68215578, -2.68121603, 3.4}, {0.604725474, -0.578345759, -0.545273723, -0.0499985088}, {0.343292322, -0.762706727, 0}, {0, 0, 0}, {0.275792462, 0.388208465, 0.354907307}},
    {"pile", 104, {2.69009598, 2.69224854, 4.75}, {0.97160829, -0.153953683, 0.165329659, 0.0702972062}, {0.267408748, -0.902801229, 0}, {0, 0, 0}, {0.371896037, 0.487701811, 0.323628739}},
    {"spheres", 4, {0, 4.675, 4.15}, {1, 0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {2.675, 2, 4.15}},
    {"spheres", 5, {-2.11462543, -2.08610265, 0.6}, {1, 0, 0, 0}, {0.527549238, -0.489861949, 0}, {0, 0, 0}, {0.5, 0, 0}},
    {"spheres", 55, {-2.10698617, -2.08513514, 2.7}, {1, 0, 0, 0}, {0.799356539, -0.963814033, 0}, {0, 0, 0}, {0.5, 0, 0}},
    {"spheres", 104, {2.09915308, 2.08900248, 3.75}, {1, 0, 0, 0}, {-0.175507734, 0.120814869, 0}, {0, 0, 0}, {0.5, 0, 0}},
    {"hulls", 4, {0, 5.05, 4.6}, {1, 0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {3.05, 2, 4.6}},
    {"hulls", 5, {-2.39836318, -2.4135099, 0.7}, {0.305362653, 0.051571356, -0.921774229, -0.233294484}, {0.0446504789, -0.14690228, 0}, {0, 0, 0}, {-0.125060016, 0.443465298, -0.0394243671}},
    {"hulls", 55, {-2.38070906, -2.38647782, 3.1}, {0.521203054, -0.40377873, -0.751264428, 0.0301972227}, {0.367133216, 0.295648026, 0}, {0, 0, 0}, {-0.156850319, 0.334924381, 0.16931033}},
    {"hulls", 104, {2.38325069, 2.38116624, 4.3}, {0.943406284, -0.213784657, 0.0852970803, 0.238757434}, {-0.971875377, -0.396224908, 0}, {0, 0, 0}, {0.404154923, 0.274886896, 0.0713197107}},
    {"pyramid", 0, {0, 0, -2}, {1, 0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {26.3, 26.3, 2}},
    {"pyramid", 1, {-2.625, -2.625, 0.5}, {1, 0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0.5, 0.5, 0.5}},
    {"pyramid", 46, {-1.05, 2.1, 1.5}, {1, 0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0.5, 0.5, 0.5}},
    {"pyramid", 91, {0, 0, 5.5}, {1, 0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0.5, 0.5, 0.5}},
    {"wall", 0, {0, 0, -2}, {1, 0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {20.1, 20, 2}},
    {"wall", 1, {-9.595, 0, 0.25}, {1, 0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0.5, 0.25, 0.25}},
    {"wall", 51, {0.505, 0, 1.25}, {1, 0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0.5, 0.25, 0.25}},
    {"wall", 100, {9.595, 0, 2.25}, {1, 0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0.5, 0.25, 0.25}},
    {"stacks", 0, {0, 0, -2}, {1, 0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {16, 16, 2}},
    {"stacks", 1, {-4.5, -4.5, 0.5}, {1, 0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0.5, 0.5, 0.5}},
    {"stacks", 51, {-1.5, -1.5, 0.5}, {1, 0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0.5, 0.5, 0.5}},
    {"stacks", 100, {-1.5, 1.5, 9.5}, {1, 0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0.5, 0.5, 0.5}},
    {"tumbler", 1, {-2.7, -2.7, -2.7}, {0.888723394, -0.448921538, -0.00836679693, -0.092575261}, {0, 0, 0}, {0, 0, 0}, {0.283591061, 0.461858434, 0.440943655}},
    {"tumbler", 51, {-2.7, -2.7, 0}, {0.944795852, -0.038891757, 0.284774096, 0.157327507}, {0, 0, 0}, {0, 0, 0}, {0.440398248, 0.446352989, 0.297475217}},
    {"tumbler", 100, {2.7, 2.7, 1.35}, {0.0514252667, 0.0298182593, -0.530457572, -0.845624667}, {0, 0, 0}, {0, 0, 0}, {0.401444781, 0.263318572, 0.367690967}},
    {"crowd", 2, {-4.2, -0.6, 1}, {0.982894605, 0, 0, 0.184168934}, {0, 0, 0}, {0, 0, 0}, {0.3, 0.3, 1}},
    {"crowd", 3, {-5.40555095, -5.42407696, 0.9}, {1, 0, 0, 0}, {1.4, 0, 0}, {0, 0, 0}, {0.3, 0.6, 0}},
    {"crowd", 53, {-4.25536084, 0.629701284, 0.9}, {1, 0, 0, 0}, {1.4, 0, 0}, {0, 0, 0}, {0.3, 0.6, 0}},
    {"crowd", 102, {-4.28190231, 6.61487125, 0.9}, {1, 0, 0, 0}, {1.4, 0, 0}, {0, 0, 0}, {0.3, 0.6, 0}},
    {"sparse", 0, {-11.3686888, -0.211884488, -2.3444171}, {0.659831518, -0.068119335, -0.722356018, 0.19540703}, {1.51592973, 2.88723351, -4.06140413}, {-0.943305047, 0.671530208, -0.134465864}, {0.283591061, 0.461858434, 0.440943655}},
    {"sparse", 50, {-3.73048069, 7.96710904, -17.7008551}, {0.874639398, 0.185353714, -0.432762431, -0.115614027}, {-2.34665709, -2.21246621, -0.202870607}, {0.586565669, 0.715695024, 0.57284728}, {0.49239981, 0.275792462, 0.388208465}},
    {"sparse", 99, {-22.594036, 2.44452391, 2.88820261}, {0.831383088, 0.135165819, -0.407701117, -0.352579299}, {2.42101844, -3.34601949, 0.886615021}, {-0.896834808, 0.451799353, 0.643216824}, {0.44877382, 0.390770113, 0.374293689}},
};
// clang-format on

void expect_near(const Vec3& found, const std::array<double, 3>& wanted)
{
    // Half a unit of the ninth digit, at worst.
    for (std::size_t i = 0; i < 3; ++i) {
        const double scale = std::max(1.0, std::abs(wanted[i]));
        EXPECT_NEAR(found[static_cast<Eigen::Index>(i)], wanted[i], 5e-9 * scale);
    }
}

TEST(Recipes, MatchTheIndependentProgram)
{
    for (const Known& known : kKnown) {
        SCOPED_TRACE(std::string(known.scene) + " body " + std::to_string(known.id));
        const Scene scene = make_scene(known.scene, 100, 1);
        ASSERT_LT(known.id, scene.body_count());
        const Body body = body_at(scene, known.id);
        const Quat& q = body.orientation;
        const std::array<double, 4>& wanted = known.orientation;
        expect_near(body.position, known.position);
        EXPECT_NEAR(q.w(), wanted[0], 1e-9);
        EXPECT_NEAR(q.x(), wanted[1], 1e-9);
        EXPECT_NEAR(q.y(), wanted[2], 1e-9);
        EXPECT_NEAR(q.z(), wanted[3], 1e-9);
        expect_near(body.velocity, known.velocity);
        expect_near(body.angular_velocity, known.angular_velocity);
        expect_near(body.size, known.size);
    }
}

TEST(Recipes, BodiesOfTheNineComparedScenesAreCounted)
{
    const std::pair<std::string_view, std::size_t> counts[] = {
        {"pile", 105},   {"spheres", 105}, {"hulls", 105}, {"pyramid", 92}, {"wall", 101},
        {"stacks", 101}, {"tumbler", 101}, {"crowd", 103}, {"sparse", 100}};
    for (const auto& [name, count] : counts)
        EXPECT_EQ(make_scene(name, 100).body_count(), count) << name;
}

TEST(Recipes, TumblerIsAClosedBoxThatTurns)
{
    const Scene scene = make_scene("tumbler", 100);
    const BodyDescription& drum = scene.bodies.at(0);
    EXPECT_EQ(drum.motion, Motion::kinematic);
    EXPECT_EQ(drum.angular_velocity, Vec3(0.3, 0, 0));
    EXPECT_EQ(std::get<CompoundShape>(scene.shapes[drum.shape].shape).parts.size(), 6U);
}

TEST(Recipes, CrowdWalksBothWaysUprightAndWeighs80Kilograms)
{
    const Scene scene = make_scene("crowd", 1000);
    int ahead = 0, people = 0;
    for (const BodyDescription& body : scene.bodies) {
        if (body.motion != Motion::dynamic) continue;
        ++people;
        ASSERT_EQ(body.mass, 80);
        ASSERT_TRUE(body.lock_rotation);
        ASSERT_EQ(body.drive_velocity[0], body.velocity.x());
        ASSERT_EQ(std::abs(body.velocity.x()), 1.4);
        ASSERT_EQ(body.drive_velocity[1], 0.0);
        ASSERT_FALSE(body.drive_velocity[2].has_value());
        if (body.velocity.x() > 0) ++ahead;
    }
    EXPECT_EQ(people, 1000);
    EXPECT_NEAR(ahead, 500, 80);
}

// The push turns the first piece about its far foot, which therefore stands still.
TEST(Recipes, DominoesBeginToTurnAboutTheFoot)
{
    const Scene scene = make_scene("dominoes", 15);
    const Body first = body_at(scene, 1);
    const Vec3 foot = Vec3(first.size.x(), 0, -first.size.z());
    EXPECT_LT((first.velocity + first.angular_velocity.cross(foot)).norm(), 1e-15);

    // Past the tipping point: the kinetic energy lifts the center over the foot (per kg).
    const double inertia = foot.squaredNorm() * 4 / 3;
    const double lift = 9.81 * (foot.norm() - first.size.z());
    EXPECT_GT(first.angular_velocity.squaredNorm() * inertia / 2, 2 * lift);
    EXPECT_LT(0.75 - 2 * first.size.x(), 2 * first.size.z()) << "out of reach of the next";
}

TEST(Recipes, CardHouseHasItsCardsAndRidgesTouch)
{
    for (const int levels : {1, 2, 5}) {
        const Scene scene = make_scene("card_house", levels);
        const auto cards = static_cast<std::size_t>((3 * levels * levels + levels) / 2);
        EXPECT_EQ(scene.body_count(), cards + 1);

        // The two cards of the first tent touch along the ridge and stand on the ground.
        const Box3 left = bounds_of(scene, 1), right = bounds_of(scene, 2);
        EXPECT_NEAR(left.upper.x(), right.lower.x(), 1e-15);
        EXPECT_NEAR(left.lower.z(), 0, 1e-15);
        EXPECT_NEAR(right.lower.z(), 0, 1e-15);
    }
}

TEST(Recipes, CardHouseFlatCardsRestOnTwoRidges)
{
    const Scene scene = make_scene("card_house", 3);
    // Level 1: cards 1 to 6 lean, 7 and 8 lie flat.
    const Box3 flat = bounds_of(scene, 7);
    const Box3 left = bounds_of(scene, 2), right = bounds_of(scene, 3);
    EXPECT_NEAR(flat.lower.z(), left.upper.z(), 1e-15);
    // The upper edge of a leaning card is its thickness, slanted, away from the ridge.
    const double edge = 2 * 0.001 * std::cos(25 * std::numbers::pi / 180);
    EXPECT_LT(flat.lower.x() + 0.001, left.lower.x() + edge);
    EXPECT_GT(flat.upper.x() - 0.001, right.upper.x() - edge);
}

// Twice the signed area of the triangle p q r in the plane of the arch.
double turned(const Vec3& p, const Vec3& q, const Vec3& r)
{
    return (q.z() - p.z()) * (r.x() - q.x()) - (q.x() - p.x()) * (r.z() - q.z());
}

TEST(Recipes, ArchStonesAreConvexAndShareTheirJoints)
{
    for (const int size : {7, 24, 25, 101}) {
        SCOPED_TRACE(size);
        const Scene scene = make_scene("arch", size);
        ASSERT_EQ(scene.bodies.size(), static_cast<std::size_t>(size) + 1);
        std::vector<std::array<Vec3, 4>> stones;
        for (std::size_t id = 1; id < scene.bodies.size(); ++id) {
            const BodyDescription& body = scene.bodies[id];
            const auto& points = std::get<HullShape>(scene.shapes[body.shape].shape).points;
            ASSERT_EQ(points.size(), 8U);
            // Inner and outer end of the left joint, then outer and inner end of the right one.
            std::array<Vec3, 4> face;
            for (std::size_t k = 0; k < 4; ++k) face[k] = points[2 * k] + body.position;
            for (std::size_t k = 0; k < 4; ++k)
                EXPECT_GT(turned(face[k], face[(k + 1) % 4], face[(k + 2) % 4]), 0);
            stones.push_back(face);
        }
        for (std::size_t i = 0; i + 1 < stones.size(); ++i) {
            EXPECT_LT((stones[i][3] - stones[i + 1][0]).norm(), 1e-13 * size);
            EXPECT_LT((stones[i][2] - stones[i + 1][1]).norm(), 1e-13 * size);
        }
        // Level feet, and the same on the left as on the right.
        EXPECT_NEAR(stones.front()[0].z(), 0, 1e-13 * size);
        EXPECT_NEAR(stones.front()[1].z(), 0, 1e-13 * size);
        EXPECT_NEAR(stones.front()[1].x(), -stones.back()[2].x(), 1e-12 * size);
    }
}

TEST(Recipes, CradleBallsTouchToTheLastBit)
{
    const Scene scene = make_scene("cradle", 5);
    EXPECT_EQ(scene.materials[0].restitution, 1);
    EXPECT_EQ(body_at(scene, 0).velocity, Vec3(1, 0, 0));
    for (std::size_t id = 2; id < 5; ++id)
        EXPECT_EQ(body_at(scene, id).position.x() - body_at(scene, id - 1).position.x(), 1);
}

TEST(Recipes, BulletsTouchThePlateAtTheKnownTime)
{
    const Scene scene = make_scene("bullet_plate", 10);
    EXPECT_TRUE(scene.instances.at(0).common.fast);
    for (std::size_t id = 1; id <= 10; ++id) {
        const Body bullet = body_at(scene, id);
        const double plate = body_at(scene, 0).size.x();
        const double way = -bullet.position.x() - bullet.size.x() - plate;
        EXPECT_NEAR(way / bullet.velocity.x(), 9.9945e-3, 1e-15);
    }
}

TEST(Recipes, BallsOnSpringsBeginAboutWhereTheyHangStill)
{
    const Scene scene = make_scene("spring", 7);
    ASSERT_EQ(scene.springs.size(), 7u);
    for (std::size_t id = 0; id < 7; ++id) {
        const Spring& spring = scene.springs[id];
        const Body ball = body_at(scene, id);
        const Vec3 still = spring.at_a - Vec3(0, 0, spring.length + 9.81 / spring.stiffness);
        EXPECT_LT((ball.position - still).norm(), 0.3);
        EXPECT_GT((ball.position - still).norm(), 0);
        EXPECT_EQ(spring.b, id);
        EXPECT_EQ(spring.damping, 0);
        EXPECT_NEAR(4.0 / 3 * M_PI * std::pow(ball.size.x(), 3) * 1000, 1, 1e-12) << "kg";
    }
}

TEST(Recipes, MixedHasBallsAndBoxesOfAllSizesFromOneToAThousand)
{
    const Scene scene = make_scene("mixed", 1000);
    ASSERT_EQ(scene.instances.size(), 2u);
    std::array<int, 10> of_size = {};
    for (const Instances& group : scene.instances) {
        EXPECT_EQ(group.count(), 500u);
        for (std::size_t i = 0; i < group.count(); ++i) {
            const double half = group.records.at(i * group.stride() + 13);
            const double halvings = std::log2(2.5 / half);
            ++of_size.at(static_cast<std::size_t>(halvings));
        }
    }
    for (const int count : of_size) EXPECT_EQ(count, 100);
}

TEST(Recipes, HillsHasAHundredTrianglesForEach)
{
    const Scene scene = make_scene("hills", 1000);
    const auto& terrain = std::get<MeshShape>(scene.shapes[scene.bodies.at(0).shape].shape);
    EXPECT_EQ(scene.bodies[0].motion, Motion::static_);
    EXPECT_GE(terrain.triangles.size(), 100'000u);
    EXPECT_LE(terrain.triangles.size(), 125'000u);
    EXPECT_EQ(scene.instances.size(), 5u);
}

TEST(Recipes, MeshesMixesSixKindsOnATerrain)
{
    const Scene scene = make_scene("meshes", 100);
    const auto& terrain = std::get<MeshShape>(scene.shapes[scene.bodies.at(0).shape].shape);
    EXPECT_EQ(scene.bodies[0].motion, Motion::static_);
    for (const auto& [a, b, c] : terrain.triangles) {
        const Vec3& p = terrain.vertices.at(a);
        const Vec3 normal = (terrain.vertices.at(b) - p).cross(terrain.vertices.at(c) - p);
        ASSERT_GT(normal.z(), 0) << "a triangle faces the ground";
    }
    std::array<std::size_t, 8> kinds = {};
    for (const Instances& group : scene.instances)
        kinds.at(scene.shapes[group.common.shape].shape.index()) += group.count();
    // Spheres, capsules, cylinders, boxes, hulls, planes, meshes, compounds.
    EXPECT_EQ(kinds, (std::array<std::size_t, 8>{17, 17, 17, 17, 16, 0, 0, 16}));
}

}  // namespace
}  // namespace throng
