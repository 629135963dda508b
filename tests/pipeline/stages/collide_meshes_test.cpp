// Collide meshes: what has hardly moved on one is told from where it is, and by nothing else.
#include "pipeline/world/world_state.hpp"
#include "scene/catalog/parts.hpp"
#include "scene/catalog/sheets.hpp"
#include "tests/support/small_scenes.hpp"
#include "throng/world.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace throng {
namespace {

using given::SceneOf;

// Bumps of a meter, and what lies on them.
SceneOf bumps()
{
    SceneOf made;
    made.scene.settings.sleep = false;
    const MeshShape ground = mesh_shape(sheet_mesh(24, [](int i, int k) {
        return Vec3(0.5 * i, 0.5 * k, 0.1 * std::sin(2.1 * i + 1.3 * k));
    }));
    made.body(made.shape(ground), Vec3::Zero()).motion = Motion::static_;
    for (int i = 0; i < 4; ++i) made.box({0.4, 0.3, 0.2}, Vec3(2 + 2.0 * i, 3, 0.6));
    for (int i = 0; i < 4; ++i) made.ball(0.3, Vec3(2 + 2.0 * i, 7, 0.6));
    return made;
}

const MeshContacts<float>& contacts_of(World& world)
{
    return std::get<MeshContacts<float>>(std::get<Step<float>>(state_of(world).step).data);
}

TEST(CollideMeshes, BoxesAtRestAreNotLookedAtAnew)
{
    World world(bumps().scene);
    world.step(240);
    const auto found = contacts_of(world).found;
    ASSERT_EQ(found.pairs.size(), 4U);  // balls are found anew
    world.step(5);
    const auto& now = contacts_of(world).found;
    ASSERT_EQ(now.pairs.size(), 4U);
    for (std::size_t k = 0; k < 4; ++k) {
        EXPECT_EQ(now.pairs[k].b_in_a.position, found.pairs[k].b_in_a.position);
        EXPECT_EQ(now.pairs[k].count, found.pairs[k].count);
    }
}

TEST(CollideMeshes, WhatIsPushedIsLookedAtAnew)
{
    World world(bumps().scene);
    world.step(240);
    const Vec3 before = contacts_of(world).found.pairs[0].b_in_a.position;
    world.set_velocity(world.bodies()[1], Vec3(1, 0, 0), Vec3::Zero());
    world.step(3);
    EXPECT_NE(contacts_of(world).found.pairs[0].b_in_a.position, before);
}

}  // namespace
}  // namespace throng
