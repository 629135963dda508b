// Trace: what it holds, and that it changes nothing.
#include "pipeline/records/trace.hpp"

#include "pipeline/world/world_state.hpp"
#include "scene/files/json.hpp"
#include "throng/catalog.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <sstream>

namespace throng {
namespace {

std::string traced(Trace& trace, int steps, int threads)
{
    World world(make_scene("pile", 200), threads);
    trace.watch(world);
    for (int i = 0; i < steps; ++i) {
        trace.begin_step(static_cast<std::uint64_t>(i) + 1);
        world.step();
        trace.end_step();
    }
    Trace::leave(world);
    return world.state_hash();
}

struct Bar {
    std::string name, kind;
    double row = 0, begin = 0, end = 0;
};

std::vector<Bar> bars_of(const Trace& trace, const std::vector<Trace::Wait>& waits = {})
{
    std::ostringstream out;
    trace.write("a \"pile\"", waits, out);
    const JsonDocument json(out.str(), "trace.json");
    const auto events = json.find(JsonDocument::kRoot, "traceEvents");
    std::vector<Bar> bars;
    auto event = json.first(events);
    for (std::size_t i = 0; i < json.size(events); ++i, event = json.next(event)) {
        const std::string_view phase = json.text(json.find(event, "ph"));
        if (phase != "X" && phase != "s" && phase != "f") continue;
        Bar& bar = bars.emplace_back();
        bar.name = json.text(json.find(event, "name"));
        bar.kind = phase == "X" ? json.text(json.find(event, "cat")) : phase;
        bar.row = json.number(json.find(event, "tid"));
        bar.begin = bar.end = json.number(json.find(event, "ts"));
        if (phase == "X") bar.end += json.number(json.find(event, "dur"));
    }
    return bars;
}

TEST(Trace, LeavesTheSameBits)
{
    for (const int threads : {1, 3}) {
        World world(make_scene("pile", 200), threads);
        world.step(30);
        Trace trace(4);
        EXPECT_EQ(traced(trace, 30, threads), world.state_hash());
    }
}

TEST(Trace, KeepsTheLastStepsAndEveryStageOfThem)
{
    Trace trace(3);
    traced(trace, 10, 2);
    EXPECT_EQ(trace.steps(), 3u);
    EXPECT_EQ(trace.left_out(), 0u);
    std::map<std::string, int> stages;
    std::vector<std::string> steps;
    for (const Bar& bar : bars_of(trace)) {
        if (bar.kind == "stage") ++stages[bar.name];
        if (bar.kind == "step") steps.push_back(bar.name);
    }
    EXPECT_EQ(steps, (std::vector<std::string>{"step 8", "step 9", "step 10"}));
    World world(make_scene("pile", 200));
    for (const World::StageInfo& stage : world.step_stages())
        EXPECT_EQ(stages[std::string(stage.name)], 3) << stage.name;
}

TEST(Trace, StagesLieWithinTheirStepAndBlocksWithinTheirStage)
{
    Trace trace(2);
    traced(trace, 5, 2);
    const std::vector<Bar> bars = bars_of(trace);
    const auto within = [&](const Bar& inner, const char* kind, const std::string& name) {
        constexpr double kRounded = 0.002;  // us
        return std::any_of(bars.begin(), bars.end(), [&](const Bar& bar) {
            return bar.kind == kind && (name.empty() || bar.name == name)
                && bar.begin <= inner.begin + kRounded && inner.end <= bar.end + kRounded;
        });
    };
    int blocks = 0;
    for (const Bar& bar : bars) {
        if (bar.kind == "stage") {
            EXPECT_TRUE(within(bar, "step", "")) << bar.name;
        }
        if (bar.kind != "block") continue;
        ++blocks;
        EXPECT_TRUE(within(bar, "stage", bar.name)) << bar.name;
    }
    EXPECT_GT(blocks, 0);
}

TEST(Trace, WaitsAreArrowsForward)
{
    Trace trace(2);
    traced(trace, 5, 2);
    const std::vector<Bar> bars =
        bars_of(trace, {{"find_pairs", "collide_convex"}, {"nobody", "find_pairs"}});
    std::vector<Bar> from, to;
    for (const Bar& bar : bars) {
        if (bar.kind == "s") from.push_back(bar);
        if (bar.kind == "f") to.push_back(bar);
    }
    ASSERT_EQ(from.size(), 2u);  // one a step
    ASSERT_EQ(to.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) EXPECT_LE(from[i].begin, to[i].begin);
}

TEST(Trace, OfNoStepsIsStillReadable)
{
    const Trace trace(5);
    EXPECT_TRUE(bars_of(trace).empty());
}

}  // namespace
}  // namespace throng
