#include "tests/support/small_scenes.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

using given::SceneOf;

// A pyramid on its tip, on a slab that stands still or is free to fall.
Scene on_tip(double aside, bool slab_falls)
{
    SceneOf made;
    made.box(Vec3(2, 2, 0.5), Vec3(0, 0, -0.5)).motion =
        slab_falls ? Motion::dynamic : Motion::static_;
    HullShape top;
    top.points = {Vec3(aside, 0, -1), Vec3(0.5, 0.5, 0), Vec3(-0.5, 0.5, 0), Vec3(-0.5, -0.5, 0),
                  Vec3(0.5, -0.5, 0)};
    made.body(made.shape(top), Vec3(0, 0, 1)).pivot = Vec3(0, 0, -1);
    return made.scene;
}

std::size_t contacts(const Scene& scene)
{
    World world(scene);
    world.step();
    return world.report().contacts;
}

}  // namespace

TEST(RemovePivotContacts, ATipOnItsPivotIsBorneByIt)
{
    EXPECT_EQ(contacts(on_tip(0, false)), 0u);
    EXPECT_EQ(contacts(on_tip(1e-4, false)), 0u);
    EXPECT_EQ(contacts(on_tip(0.1, false)), 1u);
    // What can give way is held by it.
    EXPECT_EQ(contacts(on_tip(0, true)), 1u);
}

TEST(RemovePivotContacts, AFootAboutItsPivotStands)
{
    SceneOf made;
    made.box(Vec3(2, 2, 0.5), Vec3(0, 0, -0.5)).motion = Motion::static_;
    made.box(Vec3(0.2, 0.2, 1), Vec3(0, 0, 1)).pivot = Vec3(0, 0, -1);
    EXPECT_EQ(contacts(made.scene), 4u);
    // Of a corner that it turns about, three are left.
    made.scene.bodies.back().pivot = Vec3(0.2, 0.2, -1);
    EXPECT_EQ(contacts(made.scene), 3u);
}

TEST(RemovePivotContacts, AFootThatIsStruckStaysAsItIs)
{
    // Friction next to a pivot has nothing to hold on to but rounding.
    SceneOf made;
    made.scene.gravity = Vec3(0, 0, -9.81);
    made.scene.materials[0] = {.name = "stuff",
                               .density = 3699.71621353925,
                               .friction = 0.5884009713917671,
                               .restitution = 1};
    made.body(made.shape(PlaneShape{}), Vec3::Zero()).motion = Motion::static_;
    const double half = 8.788709652210807;
    made.body(made.shape(CylinderShape{7.031211766535315, half}), Vec3(0, 0, half)).pivot =
        Vec3(0, 0, -half);
    const std::uint32_t drum = made.shape(CylinderShape{5.416779452305514, 4.3781654149839895});
    for (const double z : {197.60026247465038, 215.1129241345863, 223.86925496455427})
        made.body(drum, Vec3(0, 0, z));
    World world(made.scene);
    for (int i = 0; i < 400; ++i) {
        world.step();
        ASSERT_EQ(world.report().bodies_quarantined, 0u) << i;
    }
}

}  // namespace throng
