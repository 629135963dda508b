// Effect pairs: the stages that run are those that explain tells, for every scene of the catalogue
// and every two effects together; and what nobody calls for holds no memory.
#include "pipeline/records/trace.hpp"
#include "scene/files/json.hpp"
#include "tests/support/solid_scenes.hpp"
#include "throng/catalog.hpp"
#include "throng/effect_ledger.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

namespace throng {
namespace {

using given::SceneOf;

std::set<std::string> told_stages(World& world)
{
    std::set<std::string> names;
    for (const World::StageInfo& stage : world.step_stages()) names.emplace(stage.name);
    return names;
}

// Of one step.
std::set<std::string> stages_that_run(World& world)
{
    Trace trace(1);
    trace.watch(world);
    trace.begin_step(1);
    world.step();
    trace.end_step();
    Trace::leave(world);
    std::ostringstream out;
    trace.write("pairs", {}, out);
    const JsonDocument json(out.str(), "trace.json");
    const auto events = json.find(JsonDocument::kRoot, "traceEvents");
    std::set<std::string> names;
    auto event = json.first(events);
    for (std::size_t i = 0; i < json.size(events); ++i, event = json.next(event)) {
        if (json.text(json.find(event, "ph")) != "X") continue;
        if (json.text(json.find(event, "cat")) == "stage")
            names.emplace(json.text(json.find(event, "name")));
    }
    return names;
}

void check(World& world)
{
    for (int step = 0; step < 3; ++step) {
        const std::set<std::string> told = told_stages(world);
        ASSERT_EQ(stages_that_run(world), told) << "step " << step;
    }
    for (const EffectEntry& entry : effect_ledger(world, world.stages())) {
        if (entry.on) continue;
        EXPECT_EQ(entry.bytes, 0u) << name_of(entry.effect);
        EXPECT_EQ(entry.stages.size(), 0u) << name_of(entry.effect);
    }
}

TEST(EffectPairs, StagesOfTheCatalogueAreThoseThatRun)
{
    for (const CatalogEntry& entry : catalog()) {
        SCOPED_TRACE(std::string(entry.name));
        World world(
            make_scene(entry.name, std::min(entry.default_size, std::max(12, entry.least))));
        check(world);
    }
}

// What calls for an effect, put at a place of its own.
struct Caller {
    Effect effect;
    void (*call)(SceneOf&, const Vec3& at);
};

BodyDescription& on_shelf(SceneOf& made, const Vec3& at)
{
    made.box(Vec3(2, 2, 0.1), at - Vec3(0, 0, 0.3)).motion = Motion::static_;
    return made.box(Vec3(0.2, 0.2, 0.2), at);
}

BodyDescription& alone(SceneOf& made, const Vec3& at)
{
    BodyDescription& body = made.box(Vec3(0.2, 0.2, 0.2), at);
    body.mask = 0;
    body.lock_rotation = true;
    return body;
}

void roll(SceneOf& made, const Vec3& at, double Material::*number)
{
    const auto material = static_cast<std::uint32_t>(made.scene.materials.size());
    made.scene.materials.push_back({"material " + std::to_string(material), 1000, 0, 0, 0});
    made.scene.materials.back().*number = 0.3;
    made.box(Vec3(2, 2, 0.1), at - Vec3(0, 0, 0.3)).motion = Motion::static_;
    made.scene.bodies.back().material = material;
    made.ball(0.2, at).material = material;
}

void solid(SceneOf& made, const Vec3& at, const char* way)
{
    MeshShape ring = given::mesh_of(torus_mesh(0.3, 0.12, 12, 6));
    ring.nonconvex = way;
    ring.voxel_size = 0.08;
    made.body(made.shape(ring), at);
    made.box(Vec3(2, 2, 0.1), at - Vec3(0, 0, 0.5)).motion = Motion::static_;
}

const Caller kCallers[] = {
    {Effect::forces, [](SceneOf& made, const Vec3& at) { alone(made, at).force = Vec3(1, 0, 0); }},
    {Effect::drive, [](SceneOf& made, const Vec3& at) { alone(made, at).drive_velocity[0] = 1; }},
    {Effect::rotation,
     [](SceneOf& made, const Vec3& at) {
         BodyDescription& ball = made.ball(0.2, at);
         ball.mask = 0;
         ball.angular_velocity = Vec3(1, 0, 0);
     }},
    {Effect::gyroscopic,
     [](SceneOf& made, const Vec3& at) {
         BodyDescription& body = made.box(Vec3(0.1, 0.2, 0.3), at);
         body.mask = 0;
         body.angular_velocity = Vec3(1, 2, 0);
     }},
    {Effect::contact, [](SceneOf& made, const Vec3& at) { on_shelf(made, at); }},
    {Effect::friction, [](SceneOf& made, const Vec3& at) { roll(made, at, &Material::friction); }},
    {Effect::rolling_friction,
     [](SceneOf& made, const Vec3& at) { roll(made, at, &Material::rolling_friction); }},
    {Effect::restitution,
     [](SceneOf& made, const Vec3& at) { roll(made, at, &Material::restitution); }},
    {Effect::fast_motion,
     [](SceneOf& made, const Vec3& at) { on_shelf(made, at).velocity = Vec3(0, 0, 300); }},
    {Effect::mesh_contact,
     [](SceneOf& made, const Vec3& at) {
         MeshShape tile;
         tile.vertices = {Vec3(-1, -1, 0), Vec3(1, -1, 0), Vec3(1, 1, 0), Vec3(-1, 1, 0)};
         tile.triangles = {{0, 1, 2}, {0, 2, 3}};
         made.body(made.shape(tile), at).motion = Motion::static_;
         made.ball(0.2, at + Vec3(0, 0, 0.25));
     }},
    {Effect::voxel_contact, [](SceneOf& made, const Vec3& at) { solid(made, at, "voxels"); }},
    {Effect::sphere_contact, [](SceneOf& made, const Vec3& at) { solid(made, at, "spheres"); }},
    {Effect::image_contact, [](SceneOf& made, const Vec3& at) { solid(made, at, "depth_image"); }},
    {Effect::seams,
     [](SceneOf& made, const Vec3& at) {
         on_shelf(made, at);
         on_shelf(made, at + Vec3(4, 0, 0));
     }},
    {Effect::springs,
     [](SceneOf& made, const Vec3& at) {
         alone(made, at);
         Spring spring;
         spring.a = static_cast<std::uint32_t>(made.scene.bodies.size()) - 1;
         spring.at_b = at + Vec3(0, 0, 1);
         spring.stiffness = 10;
         made.scene.springs.push_back(spring);
     }},
    {Effect::attractors,
     [](SceneOf& made, const Vec3& at) {
         alone(made, at);
         made.scene.attractors.push_back({at + Vec3(0, 0, 5), 1});
     }},
    {Effect::wind,
     [](SceneOf& made, const Vec3& at) {
         alone(made, at).linear_drag = 0.1;
         made.scene.wind = Vec3(1, 0, 0);
     }},
    {Effect::drag, [](SceneOf& made, const Vec3& at) { alone(made, at).linear_drag = 0.1; }},
    {Effect::pivot,
     [](SceneOf& made, const Vec3& at) {
         BodyDescription& body = made.ball(0.2, at);
         body.mask = 0;
         body.pivot = Vec3(0, 0, 0.2);
     }},
};

TEST(EffectPairs, EveryTwoEffectsTogether)
{
    for (const Caller& one : kCallers)
        for (const Caller& other : kCallers) {
            if (other.effect < one.effect) continue;
            SCOPED_TRACE(std::string(name_of(one.effect)) + " and "
                         + std::string(name_of(other.effect)));
            SceneOf made;
            made.scene.materials[0].friction = 0;
            one.call(made, Vec3(0, 0, 5));
            other.call(made, Vec3(40, 0, 5));
            World world(made.scene);
            EXPECT_TRUE(world.effects().on.has(one.effect));
            EXPECT_TRUE(world.effects().on.has(other.effect));
            check(world);
        }
}

// Alone each calls for itself and for what it cannot be without.
TEST(EffectPairs, OneCallsForNoOther)
{
    for (const Caller& caller : kCallers) {
        SCOPED_TRACE(std::string(name_of(caller.effect)));
        SceneOf made;
        made.scene.materials[0].friction = 0;
        caller.call(made, Vec3(0, 0, 5));
        World world(made.scene);
        const Set<Effect> on = world.effects().on;
        for (const Caller& other : kCallers) {
            if (other.effect == caller.effect || !on.has(other.effect)) continue;
            // Wind blows on who is dragged; what is not a ball turns by any touch, by which boxes
            // and rings have moments that differ; solids are meshes.
            const Set<Effect> wide = {Effect::rotation, Effect::gyroscopic, Effect::contact,
                                      Effect::drag, Effect::seams};
            EXPECT_TRUE(wide.has(other.effect)) << name_of(other.effect);
        }
    }
}

}  // namespace
}  // namespace throng
