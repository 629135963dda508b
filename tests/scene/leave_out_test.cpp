// Leave out: what is taken out of a scene is what called for the effect, and nothing else.
#include "throng/leave_out.hpp"

#include "throng/catalog.hpp"
#include "throng/world.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace throng {
namespace {

// Effects of a world of it, with what a world leaves out itself.
Set<Effect> effects_without(const Scene& scene, Effect effect)
{
    World world(leave_out(scene, effect));
    if (kLeftOutByWorld.has(effect)) world.leave_out({effect});
    return world.effects().on;
}

Scene everything()
{
    Scene scene = make_scene("meshes", 12);
    scene.materials.push_back({"rubber", 1000, 0.5, 0.5, 0.01});
    scene.pairs.push_back({0, static_cast<std::uint32_t>(scene.materials.size()) - 1, 0.9, 0.4});
    BodyDescription& body = scene.bodies.emplace_back(scene.bodies.back());
    body.name.clear();
    body.motion = Motion::dynamic;
    body.shape = 1;
    body.position = Vec3(0, 0, 50);
    body.force = Vec3(1, 0, 0);
    body.linear_drag = 0.1;
    body.drive_velocity[1] = 1;
    body.velocity = Vec3(0, 0, -1000);
    body.material = static_cast<std::uint32_t>(scene.materials.size()) - 1;
    BodyDescription& swings = scene.bodies.emplace_back(scene.bodies.back());
    swings.position = Vec3(50, 0, 50);
    swings.velocity = Vec3::Zero();
    swings.drive_velocity = {};
    swings.pivot = Vec3(0, 0, 0.1);
    scene.wind = Vec3(1, 0, 0);
    scene.attractors.push_back({Vec3(0, 0, 100), 1});
    Spring spring;
    spring.a = static_cast<std::uint32_t>(scene.bodies.size()) - 2;
    spring.stiffness = 1;
    scene.springs.push_back(spring);
    return scene;
}

TEST(LeaveOut, TakesOutWhatIsNamed)
{
    const Scene scene = everything();
    const Set<Effect> all = World(scene).effects().on;
    int left_out = 0;
    for (int i = 0; i < kEffects; ++i) {
        const auto effect = static_cast<Effect>(i);
        if (effect == Effect::motion || !all.has(effect)) continue;
        ++left_out;
        const Set<Effect> on = effects_without(scene, effect);
        EXPECT_FALSE(on.has(effect)) << name_of(effect);
        // All others stay but where they need it.
        const Set<Effect> contact = {Effect::contact};
        if (Set<Effect>{effect}.meets(contact | Set<Effect>{Effect::rotation})) continue;
        EXPECT_EQ(on | Set<Effect>{effect}, all) << name_of(effect);
    }
    EXPECT_GE(left_out, 16);
}

TEST(LeaveOut, RefusesWhatCannotBe)
{
    EXPECT_THROW(static_cast<void>(leave_out(everything(), Effect::motion)), std::invalid_argument);
    World world(everything());
    EXPECT_THROW(world.leave_out({Effect::friction}), std::invalid_argument);
}

TEST(LeaveOut, OfTheWorldComesBack)
{
    World world(make_scene("pile", 20));
    world.leave_out({Effect::sleeping, Effect::gyroscopic});
    world.step(200);
    EXPECT_EQ(world.report().bodies_awake, 20u);
    EXPECT_FALSE(world.effects().on.has(Effect::gyroscopic));
    world.leave_out({});
    world.step(600);
    EXPECT_TRUE(world.effects().on.has(Effect::gyroscopic));
    EXPECT_EQ(world.report().bodies_awake, 0u);
}

}  // namespace
}  // namespace throng
