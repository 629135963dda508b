// Effects: what a scene calls for, what it does not, and who called.
#include "pipeline/step/effects.hpp"

#include "tests/support/small_scenes.hpp"
#include "throng/effect_ledger.hpp"
#include "throng/world.hpp"

#include <gtest/gtest.h>

#include <set>

namespace throng {
namespace {

using given::SceneOf;

std::string causes_of(World& world, Effect effect) { return world.effects().cause_of(effect); }

std::vector<std::string> stages_of(World& world)
{
    std::vector<std::string> names;
    for (const auto& stage : world.step_stages()) names.emplace_back(stage.name);
    return names;
}

SceneOf equal_balls()
{
    SceneOf made;
    made.scene.gravity.setZero();
    made.scene.materials[0].friction = 0;
    const std::uint32_t ball = made.shape(SphereShape{0.5});
    for (int i = 0; i < 10; ++i) made.body(ball, Vec3(2.0 * i, 0, 0)).velocity = Vec3(1 - i, 0, 0);
    return made;
}

TEST(Effects, EqualBallsWithoutFrictionOrGravityCallForContactAlone)
{
    World world(equal_balls().scene);
    Set<Effect> wanted = {Effect::motion, Effect::contact, Effect::sleeping};
    EXPECT_EQ(world.effects().on, wanted);
}

TEST(Effects, EachIsCalledForByTheFirstWhoNeedsIt)
{
    SceneOf made = equal_balls();
    made.scene.gravity = Vec3(0, 0, -1);
    made.scene.materials.push_back(
        {.name = "rubber", .friction = 0.5, .restitution = 0.5, .rolling_friction = 0.1});
    made.scene.materials[0].friction = 0.1;
    made.scene.bodies[3].material = 1;
    made.scene.bodies[4].name = "walker";
    made.scene.bodies[4].drive_velocity[0] = 1.0;
    made.scene.bodies[5].angular_velocity = Vec3(0, 0, 1);
    made.box(Vec3(1, 2, 3), Vec3(0, 50, 0)).name = "slab";
    made.ball(0.1, Vec3(0, 70, 0)).velocity = Vec3(100, 0, 0);
    World world(made.scene);
    EXPECT_EQ(causes_of(world, Effect::motion), "body 0");
    EXPECT_EQ(causes_of(world, Effect::gravity), "gravity of the scene");
    EXPECT_EQ(causes_of(world, Effect::drive), "body 4 walker");
    EXPECT_EQ(causes_of(world, Effect::contact), "body 0 may touch body 1");
    EXPECT_EQ(causes_of(world, Effect::friction), "materials stuff and stuff");
    EXPECT_EQ(causes_of(world, Effect::rolling_friction), "materials stuff and rubber");
    EXPECT_EQ(causes_of(world, Effect::restitution), "materials stuff and rubber");
    EXPECT_EQ(causes_of(world, Effect::rotation), "body 0");
    EXPECT_EQ(causes_of(world, Effect::gyroscopic), "body 10 slab");
    EXPECT_EQ(causes_of(world, Effect::fast_motion), "body 11");
    EXPECT_EQ(causes_of(world, Effect::sleeping), "body 0");
    EXPECT_FALSE(world.effects().on.has(Effect::mesh_contact));
}

TEST(Effects, WhoHangsOnAPivotFallsAboutIt)
{
    const auto effects_at = [](const Vec3& pivot, bool locked) {
        SceneOf made;
        BodyDescription& top = made.box(Vec3(0.1, 0.1, 0.5), Vec3::Zero());
        top.pivot = pivot;
        top.lock_rotation = locked;
        return World(made.scene).effects().on;
    };
    const Set<Effect> hanging = effects_at({0, 0, -0.5}, false);
    for (const Effect effect :
         {Effect::gravity, Effect::pivot, Effect::rotation, Effect::gyroscopic})
        EXPECT_TRUE(hanging.has(effect)) << name_of(effect);
    // Held by its center, or fast, it does not fall.
    EXPECT_FALSE(effects_at(Vec3::Zero(), false).has(Effect::gravity));
    EXPECT_FALSE(effects_at({0, 0, -0.5}, true).has(Effect::gravity));
}

TEST(Effects, MasksThatNeverMeetCallForNoContact)
{
    SceneOf made = equal_balls();
    for (BodyDescription& body : made.scene.bodies) {
        body.group = 1;
        body.mask = 2;
        body.fast = true;  // and is held nowhere
    }
    World world(made.scene);
    EXPECT_FALSE(world.effects().on.has(Effect::contact));
    EXPECT_EQ(stages_of(world), (std::vector<std::string>{"integrate_poses", "quarantine_bodies"}));
    made.scene.bodies[0].group = 2;
    made.scene.bodies[0].mask = 1;
    World met(made.scene);
    EXPECT_TRUE(met.effects().on.has(Effect::contact));
}

TEST(Effects, OneBodyAloneTouchesNothing)
{
    SceneOf made;
    made.box(Vec3(1, 1, 1), Vec3::Zero());
    World world(made.scene);
    EXPECT_FALSE(world.effects().on.has(Effect::contact));
    EXPECT_FALSE(world.effects().on.has(Effect::rotation));
    EXPECT_TRUE(world.effects().on.has(Effect::gravity));
}

TEST(Effects, ComeAndGoWithBodiesAndSettings)
{
    SceneOf made;
    made.floor();
    made.box(Vec3(1, 2, 3), Vec3(0, 0, 3));
    World world(made.scene);
    EXPECT_TRUE(world.effects().on.has(Effect::contact));
    EXPECT_TRUE(world.effects().on.has(Effect::gyroscopic));
    Settings settings = world.settings();
    settings.gyroscopic = Gyroscopic::off;
    settings.sleep = false;
    world.set_settings(settings);
    EXPECT_FALSE(world.effects().on.has(Effect::gyroscopic));
    EXPECT_FALSE(world.effects().on.has(Effect::sleeping));
    world.set_gravity(Vec3::Zero());
    EXPECT_FALSE(world.effects().on.has(Effect::gravity));
    const BodyId box = world.bodies()[1];
    world.remove(std::vector{world.bodies()[0]});
    EXPECT_FALSE(world.effects().on.has(Effect::contact));
    EXPECT_FALSE(world.effects().on.has(Effect::rotation));
    world.set_velocity(box, Vec3::Zero(), Vec3(0, 0, 1));
    EXPECT_TRUE(world.effects().on.has(Effect::rotation));
    world.remove(std::vector{box});
    EXPECT_TRUE(world.effects().on.empty());
}

TEST(Effects, AGoneBodyDoesNotFall)
{
    SceneOf made;
    made.box(Vec3(1, 1, 1), Vec3::Zero()).motion = Motion::kinematic;
    made.box(Vec3(1, 1, 1), Vec3(5, 0, 0));
    World world(made.scene);
    EXPECT_TRUE(world.effects().on.has(Effect::gravity));
    world.remove(std::vector{world.bodies()[1]});
    EXPECT_FALSE(world.effects().on.has(Effect::gravity));
}

TEST(Effects, AllHaveNamesOfTheirOwn)
{
    std::vector<std::string_view> names;
    for (int i = 0; i < kEffects; ++i) {
        const std::string_view name = name_of(static_cast<Effect>(i));
        EXPECT_FALSE(name.empty());
        EXPECT_EQ(std::count(names.begin(), names.end(), name), 0);
        names.push_back(name);
    }
    EXPECT_EQ(name_of(Effect::motion), "motion");
    EXPECT_EQ(name_of(Effect::mesh_contact), "mesh contact");
    EXPECT_EQ(name_of(Effect::voxel_contact), "voxel contact");
    EXPECT_EQ(name_of(Effect::sleeping), "sleeping");
    EXPECT_EQ(name_of(Effect::springs), "springs");
}

TEST(EffectLedger, SharesAllTimeAmongThoseWhoCall)
{
    SceneOf made;
    made.scene.materials[0].restitution = 0.3;
    made.floor();
    made.box(Vec3(1, 1, 0.1), Vec3(0, 0, 0.1)).motion = Motion::static_;
    for (int i = 0; i < 3; ++i) made.box(Vec3(0.2, 0.2, 0.2), Vec3(0.5 * i - 0.5, 0, 0.4));
    made.ball(0.2, Vec3(3, 0, 0.2));
    World world(made.scene);
    world.step(5);
    const std::vector<StageReport> stages = world.stages();
    const std::vector<EffectEntry> entries = effect_ledger(world, stages);
    ASSERT_EQ(entries.size(), static_cast<std::size_t>(kEffects));
    double all = 0, told = 0;
    for (const StageReport& stage : stages) all += stage.time_ms;
    std::set<std::string_view> named;
    for (const EffectEntry& entry : entries) {
        EXPECT_EQ(entry.on, world.effects().on.has(entry.effect));
        EXPECT_EQ(entry.first, world.effects().cause_of(entry.effect));
        told += entry.ms;
        named.insert(entry.stages.begin(), entry.stages.end());
        if (entry.on) {
            EXPECT_GT(entry.callers, 0u) << name_of(entry.effect);
        } else {
            EXPECT_EQ(entry.callers + entry.stages.size() + entry.rows + entry.bytes, 0u);
        }
    }
    EXPECT_NEAR(told, all, 1e-9 * all);
    EXPECT_EQ(named.size(), stages.size());
    const auto of = [&](Effect effect) { return entries[static_cast<std::size_t>(effect)]; };
    EXPECT_EQ(of(Effect::motion).callers, 4u);
    EXPECT_EQ(of(Effect::friction).callers, 1u);
    EXPECT_EQ(of(Effect::seams).callers, 1u);  // the plane has no rim
    EXPECT_EQ(of(Effect::contact).rows, 13u);  // three boxes on four points, a ball on one
    EXPECT_EQ(of(Effect::restitution).rows, 13u);
    EXPECT_EQ(of(Effect::friction).rows, 12u);  // of four manifolds
    EXPECT_GT(of(Effect::contact).bytes, 0u);
}

}  // namespace
}  // namespace throng
