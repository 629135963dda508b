#include "tests/support/small_scenes.hpp"
#include "throng/rotation.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

using given::SceneOf;

constexpr double kGravity = 9.81, kMass = 3;

// Two slabs side by side, and a box or a table that lies across.
Scene across_two(double restitution, bool table)
{
    SceneOf made;
    made.scene.materials[0].restitution = restitution;
    made.scene.gravity = Vec3(0, 0, -kGravity);
    made.scene.settings.sleep = false;
    for (const double x : {-2.0, 2.0})
        made.box(Vec3(2, 2, 0.5), Vec3(x, 0, -0.5)).motion = Motion::static_;
    if (!table) {
        made.box(Vec3(0.5, 0.4, 0.2), Vec3(0.1, 0.05, 0.2)).mass = kMass;
        return made.scene;
    }
    const std::uint32_t leg = made.shape(BoxShape{Vec3(0.05, 0.05, 0.2)});
    CompoundShape legs;
    for (const double x : {-0.5, 0.5})
        for (const double y : {-0.4, 0.4})
            legs.parts.push_back({leg, {Vec3(x, y, 0), Quat::Identity()}});
    made.body(made.shape(legs), Vec3(0.1, 0.05, 0.2)).mass = kMass;
    return made.scene;
}

}  // namespace

TEST(JoinContacts, WhatMayBounceOrHasPartsIsSolvedAsOneOnOnePlane)
{
    for (const bool table : {false, true}) {
        World bouncing(across_two(0.5, table)), resting(across_two(0, table));
        bouncing.step();
        resting.step();
        EXPECT_EQ(bouncing.report().manifolds, 1u) << table;
        EXPECT_EQ(bouncing.report().contacts, 4u) << table;
        EXPECT_EQ(resting.report().manifolds, table ? 1u : 2u) << table;
    }
}

TEST(JoinContacts, EachThatItLiesOnIsToldItsOwnLoad)
{
    // Its four corners, or its legs, bear a quarter each, and two of them are on either slab.
    for (const double restitution : {0.5, 0.0})
        for (const bool table : {false, true}) {
            // Two contacts of four points share a load as they come to.
            if (restitution == 0 && !table) continue;
            SCOPED_TRACE(testing::Message() << restitution << ' ' << table);
            World world(across_two(restitution, table));
            for (int i = 0; i < 240; ++i) world.step();
            for (const std::size_t slab : {0u, 1u})
                EXPECT_NEAR(-world.contact_force(world.bodies()[slab]).z(), kMass * kGravity / 2,
                            1e-3 * kMass * kGravity)
                    << slab;
            EXPECT_NEAR(world.contact_force(world.bodies()[2]).z(), kMass * kGravity,
                        1e-3 * kMass * kGravity);
        }
}

TEST(JoinContacts, OtherNormalsAndMaterialsStayApart)
{
    Scene scene = across_two(0.5, false);
    scene.materials.push_back(scene.materials[0]);
    scene.materials.back().name = "other";
    scene.materials.back().restitution = 0.6;
    scene.bodies[1].material = 1;
    World unlike(scene);
    unlike.step();
    EXPECT_EQ(unlike.report().manifolds, 2u);

    Scene corner = across_two(0.5, false);
    corner.bodies[1].position = Vec3(2.601, 0.05, 0.5);  // a wall at the box's side
    World in_corner(corner);
    in_corner.step();
    EXPECT_EQ(in_corner.report().manifolds, 2u);
}

TEST(JoinContacts, WhatEndsWithinAnotherPartIsNotOfItsPlane)
{
    // A table upside down: its legs end within the board that it lies on, 10 mm above the floor.
    for (const double restitution : {0.5, 0.0}) {
        SceneOf made;
        made.scene.materials[0].restitution = restitution;
        made.scene.gravity = Vec3(0, 0, -kGravity);
        made.box(Vec3(2, 2, 0.5), Vec3(0, 0, -0.5)).motion = Motion::static_;
        const std::uint32_t board = made.shape(BoxShape{Vec3(0.8, 0.6, 0.05)});
        const std::uint32_t leg = made.shape(BoxShape{Vec3(0.06, 0.06, 0.2)});
        CompoundShape table;
        table.parts.push_back({board, {Vec3(0, 0, 0.05), Quat::Identity()}});
        for (const double x : {-0.7, 0.7})
            for (const double y : {-0.5, 0.5})
                table.parts.push_back({leg, {Vec3(x, y, 0.21), Quat::Identity()}});
        BodyDescription& body = made.body(made.shape(table), Vec3::Zero());
        body.mass = kMass;
        body.velocity = Vec3(0, 0, -2);  // its legs may come as far within the step
        World world(made.scene);
        world.step();
        // The board, and the legs as one.
        EXPECT_EQ(world.report().manifolds, 2u) << restitution;
    }
}

TEST(JoinContacts, WhatLeansByAHairBouncesFlat)
{
    Scene scene = across_two(0.5, false);
    BodyDescription& box = scene.bodies.back();
    box.position.z() += 1;
    box.orientation = exponential(Vec3(0.0048, 0.0015, 0));
    World world(scene);
    for (int i = 0; i < 35; ++i) world.step();
    EXPECT_GT(world.velocity(world.bodies()[2]).z(), 0.1);
    EXPECT_LT(world.angular_velocity(world.bodies()[2]).norm(), 0.2);
}

TEST(JoinContacts, BySubstepsOfAnotherLengthNothingIsLost)
{
    // Escalated islands are solved by finer substeps, with impulses of theirs.
    Scene scene = across_two(0.5, true);
    for (int i = 1; i < 12; ++i) {
        BodyDescription above = scene.bodies.back();
        above.position.z() = 0.2 + 0.4 * i;
        above.mass = i == 11 ? 1000 * kMass : kMass;
        scene.bodies.push_back(above);
    }
    World world(scene);
    for (int i = 0; i < 300; ++i) world.step();
    EXPECT_LT(given::greatest_speed(world), 0.01);
    EXPECT_GT(world.pose(world.bodies().back()).position.z(), 0.2 + 0.4 * 11 - 0.05);
}

}  // namespace throng
