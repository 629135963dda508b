// Explain: what is said of scenes whose effects are known.
#include "scene/files/json.hpp"
#include "tests/apps/throng/command.hpp"
#include "throng/catalog.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

// The lines under a heading.
std::string part_of(const std::string& text, const std::string& heading)
{
    const auto begin = text.find("\n" + heading + "\n");
    if (begin == std::string::npos) return {};
    return text.substr(begin, text.find("\n\n", begin + 1) - begin);
}

std::string effect_line(const std::string& text, const std::string& effect)
{
    const std::string part = part_of(text, "effects");
    const auto begin = part.find("\n  " + effect + "  ");
    if (begin == std::string::npos) return {};
    return part.substr(begin + 1, part.find('\n', begin + 1) - begin - 1);
}

bool is_on(const std::string& text, const std::string& effect)
{
    return effect_line(text, effect).find("  on ") != std::string::npos;
}

constexpr const char* kIce = R"({
  "throng": 1, "gravity": [0, 0, 0],
  "materials": {"ice": {"friction": 0}},
  "shapes": {"ball": {"sphere": {"radius": 0.5}}},
  "bodies": [
    {"name": "left", "shape": "ball", "material": "ice", "position": [0, 0, 0],
     "velocity": [1, 0, 0]},
    {"name": "right", "shape": "ball", "material": "ice", "position": [3, 0, 0]}
  ]
})";

TEST(Explain, SmoothBallsInSpaceHaveNoFrictionRotationOrGravity)
{
    const TestFolder folder;
    const Outcome said = run_throng({"explain", folder.write("ice.json", kIce)});
    ASSERT_EQ(said.code, 0) << said.err;
    EXPECT_TRUE(is_on(said.out, "contact"));
    for (const char* effect : {"gravity", "rotation", "friction", "gyroscopic", "restitution"})
        EXPECT_NE(effect_line(said.out, effect).find("  off"), std::string::npos) << effect;
    const std::string stages = part_of(said.out, "stages");
    EXPECT_NE(stages.find("solve_velocities"), std::string::npos);
    for (const char* word : {"friction", "turn", "gravity", "restitution", "roll"})
        EXPECT_EQ(stages.find(word), std::string::npos) << word << " is in " << stages;
}

TEST(Explain, APileHasWhatAPileNeeds)
{
    const Outcome said = run_throng({"explain", "pile:20"});
    ASSERT_EQ(said.code, 0) << said.err;
    for (const char* effect :
         {"gravity", "rotation", "gyroscopic", "contact", "friction", "sleeping"})
        EXPECT_TRUE(is_on(said.out, effect)) << effect;
    const std::string stages = part_of(said.out, "stages");
    for (const char* word :
         {"\n  find_pairs ", "waits for sleep_pairs, update_bounds", "\n  solve_soft_step ",
          "\n      integrate_velocities ", "each iteration of a substep"})
        EXPECT_NE(stages.find(word), std::string::npos) << word;
}

TEST(Explain, TheSubstepIsThatOfTheResponseAndTheSolver)
{
    const auto inner_of = [](const std::string& dial) {
        const Outcome said = run_throng({"explain", "pile:20", "--set", dial});
        EXPECT_EQ(said.code, 0) << said.err;
        return part_of(said.out, "stages");
    };
    const std::vector<std::pair<std::string, std::string>> wanted = {
        {"solver=soft_step", "relax "},
        {"solver=pgs", "solve_pgs"},
        {"solver=direct", "hold_contacts"},
        {"response=penalty", "apply_penalty_forces"},
        {"response=kinematic", "stop_approaches"}};
    for (const auto& [dial, row] : wanted) {
        const std::string inner = inner_of(dial);
        for (const auto& [other, others] : wanted)
            EXPECT_EQ(inner.find(others) != std::string::npos, row == others) << dial << inner;
    }
}

TEST(Explain, WritesForProgramsWhatItPrints)
{
    const TestFolder folder;
    const std::string file = folder / "explained.json";
    const Outcome said = run_throng({"explain", "pile:20", "--steps", "3", "--json", file});
    ASSERT_EQ(said.code, 0) << said.err;
    const JsonDocument json(folder.read("explained.json"), "explained.json");
    const auto at = [&](std::string_view key) { return json.find(JsonDocument::kRoot, key); };
    EXPECT_EQ(json.text(at("scene")), "pile:20");
    EXPECT_EQ(json.number(at("steps")), 3);
    double told = 0, all = 0;
    const auto entries = at("effect_ledger"), stages = at("stages");
    for (auto entry = json.first(entries); entry != json.next(entries); entry = json.next(entry)) {
        const std::string name(json.text(json.find(entry, "effect")));
        EXPECT_EQ(json.kind(json.find(entry, "on")), JsonKind::boolean);
        EXPECT_EQ(is_on(said.out, name), json.number(json.find(entry, "callers")) > 0) << name;
        told += json.number(json.find(entry, "ms"));
    }
    for (auto stage = json.first(stages); stage != json.next(stages); stage = json.next(stage))
        all += json.number(json.find(stage, "ms"));
    EXPECT_GT(all, 0);
    EXPECT_NEAR(told, all, 1e-9 * all);
}

TEST(Explain, ATopOnAPivotFalls)
{
    const TestFolder folder;
    const Outcome said = run_throng(
        {"explain",
         folder.write("top.json",
                      R"({"throng": 1, "shapes": {"top": {"box": {"half_extents": [1, 1, 2]}}},
                                      "bodies": [{"shape": "top", "pivot": [0, 0, -2]}]})")});
    ASSERT_EQ(said.code, 0) << said.err;
    for (const char* effect : {"gravity", "pivot", "rotation", "gyroscopic"})
        EXPECT_TRUE(is_on(said.out, effect)) << effect;
}

TEST(Explain, ALoneBallOnlyFalls)
{
    const TestFolder folder;
    const Outcome said = run_throng(
        {"explain",
         folder.write("lone.json", R"({"throng": 1, "shapes": {"ball": {"sphere": {"radius": 1}}},
                                       "bodies": [{"name": "lone", "shape": "ball"}]})")});
    ASSERT_EQ(said.code, 0) << said.err;
    EXPECT_NE(effect_line(said.out, "motion").find("lone"), std::string::npos);
    EXPECT_TRUE(is_on(said.out, "gravity"));
    EXPECT_FALSE(is_on(said.out, "contact"));
    EXPECT_EQ(part_of(said.out, "stages").find("find_pairs"), std::string::npos);
}

TEST(Explain, StepsGiveTheStagesTheirTimes)
{
    const Outcome said = run_throng({"explain", "pile:20", "--steps", "5", "--threads", "1"});
    ASSERT_EQ(said.code, 0) << said.err;
    EXPECT_NE(said.out.find("\nsteps: 5\n"), std::string::npos);
    EXPECT_NE(part_of(said.out, "stages").find("ms/step"), std::string::npos);
}

TEST(Explain, TheGraphHasEveryStage)
{
    const TestFolder folder;
    ASSERT_EQ(run_throng({"explain", "pile:20", "--dot", folder / "step.dot"}).code, 0);
    const std::string dot = folder.read("step.dot");
    EXPECT_EQ(dot.find("digraph"), 0u);
    EXPECT_NE(dot.find("find_pairs -> collide_convex;"), std::string::npos);
    EXPECT_NE(dot.find("integrate_velocities"), std::string::npos);
    EXPECT_EQ(folder.files(), std::vector<std::string>{"step.dot"});
}

TEST(Explain, WithoutAnEffectSaysWhatThatSavesAndGetsWrong)
{
    const TestFolder folder;
    const auto without = [&](const std::string& effect, const std::string& scene) {
        const Outcome said = run_throng({"explain", scene, "--steps", "12", "--without", effect,
                                         "--json", folder / "without.json"});
        EXPECT_EQ(said.code, 0) << said.err;
        EXPECT_NE(said.out.find("\nwithout "), std::string::npos) << said.out;
        const JsonDocument json(folder.read("without.json"), "without.json");
        const auto report = json.find(JsonDocument::kRoot, "without");
        EXPECT_EQ(json.number(json.find(report, "windows")), 2);
        EXPECT_NEAR(json.number(json.find(report, "window_s")), 0.1, 1e-9);
        EXPECT_GT(json.number(json.find(report, "ms_per_step_without")), 0);
        return json.number(json.find(report, "drift_m"));
    };
    // In a tenth of a second what falls and what does not part by g t2 / 2, and a little more by
    // steps that are not short.
    EXPECT_NEAR(without("gravity", "pile:20"), 0.049, 0.01);
    EXPECT_EQ(without("springs", "pile:20"), 0);  // there are none
    EXPECT_GT(without("rotation", "pile:20"), 1e-4);
    EXPECT_GT(without("rolling_friction", "rolling:4") + without("friction", "rolling:4"), 1e-4);
    const Outcome wrong = run_throng({"explain", "pile:20", "--without", "frictio"});
    EXPECT_EQ(wrong.code, 2);
    EXPECT_NE(wrong.err.find("did you mean"), std::string::npos) << wrong.err;
    EXPECT_EQ(run_throng({"explain", "pile:20", "--without", "motion"}).code, 2);
}

// Of each scene of the catalogue, as small as it is made.
TEST(Explain, EffectsAutoKeepsItsPromise)
{
    const TestFolder folder;
    std::size_t neglected = 0;
    for (const CatalogEntry& entry : catalog()) {
        const int size = std::min(entry.default_size, std::max(14, entry.least));
        const std::string scene = std::string(entry.name) + ':' + std::to_string(size);
        const Outcome said = run_throng({"explain", scene, "--steps", "18", "--set", "effects=auto",
                                         "--json", folder / "auto.json"});
        ASSERT_EQ(said.code, 0) << said.err;
        EXPECT_NE(said.out.find("\nneglected by effects=auto"), std::string::npos) << said.out;
        const JsonDocument json(folder.read("auto.json"), "auto.json");
        const auto report = json.find(JsonDocument::kRoot, "neglected");
        EXPECT_TRUE(json.boolean(json.find(report, "kept"))) << said.out;
        EXPECT_EQ(json.number(json.find(report, "promised_rad")), 0.02);
        const auto ledger = json.find(JsonDocument::kRoot, "effect_ledger");
        for (auto entry = json.first(ledger); entry != json.next(ledger); entry = json.next(entry))
            neglected += json.number(json.find(entry, "neglected")) > 0 ? 1 : 0;
    }
    EXPECT_GT(neglected, 5u);
}

TEST(Explain, DrawsTheStep)
{
    const TestFolder folder;
    const Outcome said =
        run_throng({"explain", "pile:20", "--steps", "2", "--svg", folder / "step.svg"});
    ASSERT_EQ(said.code, 0) << said.err;
    const std::string drawn = folder.read("step.svg");
    for (const char* word : {"<svg ", ">sort_islands<", " ms<", ">make_constraints, ", "</svg>"})
        EXPECT_NE(drawn.find(word), std::string::npos) << word;
    EXPECT_EQ(run_throng({"explain", "pile:20", "--svg", "a", "--dot", "a"}).code, 2);
}

}  // namespace
}  // namespace throng
