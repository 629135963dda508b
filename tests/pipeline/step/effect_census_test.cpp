// Effect census: kept up to date, it counts what a look at everybody counts.
#include "pipeline/step/effect_census.hpp"

#include "pipeline/world/world_state.hpp"
#include "tests/support/small_scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace throng {
namespace {

using given::SceneOf;

// A body of any kind, which calls for something or other.
Scene any_body(std::mt19937& random, double x)
{
    SceneOf made;
    const auto chance = [&](unsigned one_in) { return random() % one_in == 0; };
    made.scene.materials[0].friction = chance(3) ? 0.5 : 0;
    made.scene.materials[0].restitution = chance(6) ? 0.5 : 0;
    made.scene.materials[0].rolling_friction = chance(6) ? 0.01 : 0;
    if (chance(8)) made.floor();
    BodyDescription& body =
        chance(2) ? made.ball(0.3, Vec3(x, 0, 5)) : made.box(Vec3(0.2, 0.3, 0.4), Vec3(x, 0, 5));
    if (chance(8)) body.motion = Motion::static_;
    if (chance(8)) body.motion = Motion::kinematic;
    if (body.motion != Motion::dynamic) return made.scene;
    if (chance(8)) body.angular_velocity = Vec3(0, 0, 2);
    if (chance(8)) body.force = Vec3(1, 0, 0);
    if (chance(8)) body.linear_drag = 0.1;
    if (chance(8)) body.pivot = Vec3(0, 0, 0.5);
    if (!body.pivot && chance(8)) body.drive_velocity[0] = 1.0;
    body.lock_rotation = body.angular_velocity.isZero(0) && chance(8);
    if (chance(8)) body.group = body.mask = 2;
    if (chance(8)) {
        Spring spring;
        spring.a = static_cast<std::uint32_t>(made.scene.bodies.size() - 1);
        spring.at_a = Vec3(0, 0, chance(2) ? 0.1 : 0);
        spring.stiffness = 10;
        made.scene.springs.push_back(spring);
    }
    return made.scene;
}

TEST(EffectCensus, IsThatOfALookAtEverybody)
{
    for (unsigned seed = 0; seed < 60; ++seed) {
        std::mt19937 random(seed);
        Settings settings;
        settings.sleep = seed % 2 == 0;
        World world(settings);
        world.set_gravity(seed % 3 == 0 ? Vec3(Vec3::Zero()) : Vec3(0, 0, -10));
        WorldState& state = state_of(world);
        std::vector<BodyId> bodies;
        for (int edit = 0; edit < 60; ++edit) {
            const std::size_t at = bodies.empty() ? 0 : random() % bodies.size();
            switch (bodies.empty() ? 0 : random() % 4) {
            case 0:
            case 1:
                for (const BodyId id : world.add(any_body(random, 3.0 * edit)))
                    bodies.push_back(id);
                break;
            case 2:
                world.remove(std::span(&bodies[at], 1));
                bodies.erase(bodies.begin() + static_cast<std::ptrdiff_t>(at));
                break;
            default:
                world.set_velocity(bodies[at], Vec3(random() % 2 == 0 ? 0 : 100, 0, 0),
                                   Vec3(0, 0, random() % 2 == 0 ? 0 : 1));
            }
            if (random() % 2 == 0) continue;
            const Effects effects = world.effects();
            EffectCensus fresh;
            const EffectFacts facts = state.effect_facts();
            fresh.count_all(facts.bodies);
            for (std::size_t i = 0; i < kCalls; ++i)
                ASSERT_EQ(state.get<EffectCensus>().count(static_cast<Call>(i)),
                          fresh.count(static_cast<Call>(i)))
                    << "call " << i << ", edit " << edit << ", seed " << seed;
            const Effects wanted = find_effects(facts, fresh);
            ASSERT_EQ(effects.on, wanted.on) << "edit " << edit << ", seed " << seed;
            ASSERT_EQ(state.get<StepContext>().effects, wanted.on);
            for (int i = 0; i < kEffects; ++i)
                ASSERT_EQ(effects.cause_of(static_cast<Effect>(i)),
                          wanted.cause_of(static_cast<Effect>(i)));
        }
    }
}

World boxes_after_a_step(int count)
{
    SceneOf made;
    made.floor();
    for (int i = 0; i < count; ++i) made.box(Vec3(0.3, 0.3, 0.3), Vec3(2.0 * i, 0, 0.3));
    World world(made.scene);
    world.step();
    return world;
}

// What is asked of the world each time is only what was done to it.
TEST(EffectCensus, LooksAtWhoChangedAlone)
{
    World world = boxes_after_a_step(50);
    WorldState& state = state_of(world);
    const std::size_t changes = state.get<EffectCensus>().changes();
    for (int i = 0; i < 20; ++i) {
        world.set_velocity(world.bodies()[7], Vec3(0.1, 0, 0), Vec3::Zero());
        EXPECT_EQ(state.changed.size(), 1u);
        EXPECT_FALSE(state.census_stale || state.effects_stale || state.active_bodies_stale);
        world.step();
    }
    EXPECT_EQ(state.get<EffectCensus>().changes(), changes);
}

TEST(EffectCensus, OtherSettingsTakeEffectThoughSomebodyGoesBeforeTheStep)
{
    World world = boxes_after_a_step(3);
    Settings settings = world.settings();
    settings.solver = Solver::pgs;
    world.set_settings(settings);
    const BodyId last = world.bodies()[3];
    world.remove({&last, 1});
    world.step();
    const std::vector<StageReport> stages = world.stages();
    const auto is_pgs = [](const StageReport& stage) { return stage.name == "solve_pgs"; };
    EXPECT_TRUE(std::any_of(stages.begin(), stages.end(), is_pgs));
}

}  // namespace
}  // namespace throng
