// Step graph: who waits for whom, and the same bits whichever way the stages are run.
#include "pipeline/step/step_graph.hpp"

#include "pipeline/step/step_table.hpp"
#include "pipeline/world/world_state.hpp"
#include "tests/support/small_scenes.hpp"

#include <gtest/gtest.h>

#include <set>

namespace throng {
namespace {

// Effects that change what the step does; any subset makes a step of its own.
constexpr Effect kSwitched[] = {Effect::gravity,          Effect::drive,       Effect::rotation,
                                Effect::gyroscopic,       Effect::contact,     Effect::friction,
                                Effect::rolling_friction, Effect::restitution, Effect::mesh_contact,
                                Effect::sleeping};

Set<Effect> subset(unsigned bits)
{
    Set<Effect> on = {Effect::motion};
    for (unsigned i = 0; i < std::size(kSwitched); ++i)
        if ((bits >> i & 1u) != 0) on.add(kSwitched[i]);
    // What only contacts can have goes without them.
    if (!on.has(Effect::contact))
        for (const Effect effect : {Effect::friction, Effect::rolling_friction, Effect::restitution,
                                    Effect::mesh_contact, Effect::sleeping})
            on.remove(effect);
    return on;
}

// The mixed scene after some steps with a set of effects forced on it.
std::string run_with(Set<Effect> effects, bool in_order, int threads, const Settings& dials = {})
{
    Scene scene = given::mixed_scene();
    scene.settings.solver = dials.solver;
    scene.settings.response = dials.response;
    World world(scene, threads);
    world.run_in_order(in_order);
    static_cast<void>(world.effects());
    auto& state = state_of(world);
    state.get<StepContext>().effects = effects;
    auto& step = std::get<Step<float>>(state.step);
    state.pool.run([&](std::size_t, std::size_t, std::size_t) {
        step.graph = std::make_unique<StepGraph<float>>(stages_for<float>(effects, scene.settings),
                                                        step.data);
    });
    world.step(8);
    return world.state_hash();
}

TEST(StepGraph, MatchesRunInOrderForEverySolverAndResponse)
{
    std::set<std::string> seen;
    const auto check = [&](Solver solver, Response response) {
        Settings dials;
        dials.solver = solver;
        dials.response = response;
        const Set<Effect> effects = subset((1u << std::size(kSwitched)) - 1);
        const std::string wanted = run_with(effects, true, 1, dials);
        ASSERT_EQ(run_with(effects, false, 3, dials), wanted);
        seen.insert(wanted);
    };
    for (const Solver solver : {Solver::soft_step, Solver::pgs, Solver::direct})
        check(solver, Response::impulse);
    check(Solver::soft_step, Response::penalty);
    check(Solver::soft_step, Response::kinematic);
    EXPECT_EQ(seen.size(), 5u);
}

TEST(StepGraph, MatchesRunInOrderForEverySetOfEffects)
{
    std::set<std::string> seen;
    for (unsigned bits = 0; bits < 1u << std::size(kSwitched); ++bits) {
        // Sets that lost something without contact are there without it too.
        const Set<Effect> effects = subset(bits);
        if (!effects.has(Effect::contact) && bits >> 5 != 0) continue;
        const std::string wanted = run_with(effects, true, 1);
        ASSERT_EQ(run_with(effects, false, 3), wanted) << "effects " << bits;
        seen.insert(wanted);
    }
    EXPECT_GT(seen.size(), 30u);
}

TEST(StepGraph, WaitsAreTheLeastThatKeepTheOrder)
{
    const std::vector<Stage<float>> stages(step_table<float>().begin(), step_table<float>().end());
    const auto edges = waits(stages);
    const std::size_t count = stages.size();
    // What can be reached along edges, by brute force.
    const auto reaches = [&](const auto& list) {
        std::vector<std::vector<bool>> to(count, std::vector<bool>(count, false));
        for (const auto& [earlier, later] : list) to[earlier][later] = true;
        for (std::size_t via = 0; via < count; ++via)
            for (std::size_t a = 0; a < count; ++a)
                for (std::size_t b = 0; b < count; ++b)
                    if (to[a][via] && to[via][b]) to[a][b] = true;
        return to;
    };
    const auto reached = reaches(edges);
    for (std::size_t later = 0; later < count; ++later)
        for (std::size_t earlier = 0; earlier < later; ++earlier)
            if (stages[later].waits_for(stages[earlier])) {
                EXPECT_TRUE(reached[earlier][later])
                    << stages[later].name << " does not wait for " << stages[earlier].name;
            }
    for (std::size_t i = 0; i < edges.size(); ++i) {
        EXPECT_LT(edges[i].first, edges[i].second);
        auto fewer = edges;
        fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(i));
        EXPECT_FALSE(reaches(fewer)[edges[i].first][edges[i].second])
            << "edge " << i << " is implied";
    }
}

TEST(StepGraph, MeasuresEveryStage)
{
    World world(given::mixed_scene(), 2);
    world.step(2);
    ASSERT_FALSE(world.stages().empty());
    for (const StageReport& stage : world.stages()) EXPECT_GT(stage.time_ms, 0) << stage.name;
    const auto infos = world.step_stages();
    ASSERT_EQ(infos.size(), world.stages().size());
    for (std::size_t i = 0; i < infos.size(); ++i)
        for (const std::size_t earlier : infos[i].waits_for) EXPECT_LT(earlier, i);
}

}  // namespace
}  // namespace throng
