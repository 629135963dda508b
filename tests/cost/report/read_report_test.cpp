// Read report: what was written is read again, and two of them are held side by side.
#include "cost/report/cost_report.hpp"
#include "scene/files/scene_error.hpp"
#include "tests/cost/sweep/made_points.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

namespace throng {
namespace {

CostReport of_scene()
{
    CostReport made;
    made.scene = "stacks:10";
    made.state = "0123456789abcdef";
    made.command = "throng run stacks:10 --seed 3";
    made.given = {{"dt", "1/120"}, {"substeps", "8"}};
    made.seed = 3;
    made.bodies = 11;
    made.machine = {"a processor", "0.1.0", 4, 2, 0.5};
    made.window = 0.1;
    made.windows = 4;
    made.at_rest = 1;
    made.reference.settings = "dt=1/960";
    made.reference.settles = true;
    of(made.reference.remaining, made.measure) = 1e-5;
    made.wish.error = 2e-3;
    made.found.points = {made_point(1, 1e-2, {}), made_point(2, 1e-3, {{"substeps", "16"}}),
                         made_point(9, INFINITY, {{"solver", "pgs"}})};
    made.found.points.emplace_back();
    made.found.points.back().changes = {{"dt", "1/30"}};
    made.found.points.back().trouble = "takes \"too\" long";
    for (Point& point : made.found.points) {
        point.reference_off = made.reference.remaining;
        for (Errors& errors : point.errors) errors.resize(kMeasures);
    }
    mark_front(made.found.points, made.measure);
    return made;
}

CostReport of_case()
{
    CostReport made = of_scene();
    made.scene = "H3";
    made.command = "throng cost H3 --dials none";
    made.given = {};
    made.seed = 0;
    made.window = 0;
    made.windows = made.at_rest = 0;
    made.of_case = CaseLine{"a heavy top nods", "by default, dt=1/60", 1, 2};
    made.quantities = {{"axis, \"from\" the answer", "1", "how far it is off"}};
    made.reference = {{}, {}, true};
    made.found.points = {made_point(1, 0, {}), made_point(2, 1e-3, {{"substeps", "16"}})};
    for (Point& point : made.found.points) {
        for (Errors& errors : point.errors) errors.resize(1);
        point.errors.resize(1);
        point.times_ms.resize(1);
    }
    mark_front(made.found.points, 0);
    return made;
}

template <class Write>
std::string text(const Write& write)
{
    std::ostringstream out;
    write(out);
    return out.str();
}
std::string json_of(const CostReport& report)
{
    return text([&](std::ostream& out) { write_cost_json(report, out); });
}

TEST(ReadReport, GivesWhatWasWrittenOfAScene)
{
    const CostReport report = of_scene(), again = read_report(json_of(report), "a.json");
    EXPECT_EQ(json_of(again), json_of(report));
    EXPECT_EQ(again.given, report.given);
    ASSERT_EQ(again.found.points.size(), report.found.points.size());
    for (std::size_t i = 0; i < report.found.points.size(); ++i)
        EXPECT_EQ(again.found.points[i].errors, report.found.points[i].errors) << i;
}

TEST(ReadReport, GivesWhatWasWrittenOfACase)
{
    const CostReport report = of_case(), again = read_report(json_of(report), "a.json");
    ASSERT_TRUE(again.of_case);
    EXPECT_EQ(again.told().name, report.told().name);
    EXPECT_EQ(again.found.points[1].errors, report.found.points[1].errors);
    EXPECT_EQ(json_of(again), json_of(report));
}

TEST(ReadReport, KnowsPointsOfTheSameStateAndDialsAlone)
{
    const CostReport report = of_scene();
    CostReport other = report;
    EXPECT_EQ(read_points(json_of(report), "a.json", other).size(), report.found.points.size());
    other.state = "0";
    EXPECT_TRUE(read_points(json_of(report), "a.json", other).empty());
    other = report;
    other.given = {};
    EXPECT_TRUE(read_points(json_of(report), "a.json", other).empty());
    other = report;
    other.quantities.pop_back();
    EXPECT_TRUE(read_points(json_of(report), "a.json", other).empty()) << "of fewer measures";
}

// As they were written before commands and given dials were told.
TEST(ReadReport, TakesReportsWithoutWhatOlderOnesDidNotTell)
{
    CostReport report = of_scene();
    report.given = {};
    std::string json = json_of(report);
    for (const std::string_view key :
         {R"("command": "throng run stacks:10 --seed 3", )", R"("given": {}, )"}) {
        const auto at = json.find(key);
        ASSERT_NE(at, std::string::npos) << key << " in " << json;
        json.erase(at, key.size());
    }
    EXPECT_EQ(read_report(json, "a.json").found.points.size(), report.found.points.size());
    EXPECT_EQ(read_points(json, "a.json", report).size(), report.found.points.size());
}

TEST(ReadReport, RefusesWhatIsNoneWithItsPlace)
{
    const std::string good = json_of(of_scene());
    const auto refusal = [](const std::string& json) -> std::string {
        try {
            read_report(json, "a.json");
        } catch (const SceneError& error) {
            return error.what();
        }
        return "none";
    };
    ASSERT_EQ(refusal(good), "none");
    EXPECT_EQ(refusal("[]").find("a.json:1:1: error: "), 0u) << refusal("[]");
    EXPECT_EQ(refusal("{").find("a.json:1:2: error: "), 0u) << refusal("{");
    const std::pair<std::string, std::string> wrongs[] = {
        {R"("measure": "drift")", R"("measure": "drft")"},
        {R"("windows": 4)", R"("windows": 4.5)"},
        {R"("bodies": 11)", R"("bodies": -1)"},
        {R"("processor": "a processor")", R"("processor": 3)"},
        {R"("on_front": true)", R"("on_front": 1)"},
        {R"("times_ms": [1, 1, 1, 1])", R"("times_ms": [1])"},
        {R"("squares": [[)", R"("squares": [[1, )"},
        {R"("state": ")", R"("stat": ")"},
    };
    for (const auto& [from, to] : wrongs) {
        std::string bad = good;
        const auto at = bad.find(from);
        ASSERT_NE(at, std::string::npos) << from << " in " << good;
        bad.replace(at, from.size(), to);
        EXPECT_EQ(refusal(bad).find("a.json:"), 0u) << to << ": " << refusal(bad);
    }
}

std::string compared(const CostReport& a, const CostReport& b)
{
    return text([&](std::ostream& out) { write_comparison(a, b, out); });
}

TEST(Comparison, HoldsTheSameSettingsSideBySide)
{
    const CostReport a = of_scene();
    CostReport b = a;
    b.given = {{"dt", "1/120"}};  // the same settings, said otherwise
    b.found.points[0] = made_point(2, 5e-3, {{"substeps", "8"}});
    b.found.points[1] = made_point(8, 2e-3, {{"substeps", "16"}});
    const std::string told = compared(a, b);
    EXPECT_EQ(told.find("not comparable"), std::string::npos) << told;
    EXPECT_NE(told.find("     0.01    0.005      0.5        1        2        2  dt=1/120 "
                        "substeps=8\n"),
              std::string::npos)
        << told;
    EXPECT_NE(told.find("    0.001    0.002        2        2        8        4  dt=1/120 "
                        "substeps=16\n"),
              std::string::npos)
        << told;
    EXPECT_NE(told.find("advice of A: the cheapest within 0.002 m:\n  --set dt=1/120 --set "
                        "substeps=16\n"),
              std::string::npos)
        << told;
    EXPECT_NE(told.find("advice of B: "), std::string::npos);
}

TEST(Comparison, SaysWhereThereIsNothingToCompare)
{
    const CostReport a = of_scene();
    CostReport other = a;
    other.scene = "pile:10";
    const std::string scenes = compared(a, other);
    EXPECT_NE(scenes.find("\nnot comparable: they are of other scenes\n"), std::string::npos);
    EXPECT_EQ(scenes.find("the same settings"), std::string::npos) << scenes;
    EXPECT_NE(compared(a, of_case()).find("not comparable: "), std::string::npos);

    CostReport state = a;
    state.state = "f";
    const std::string states = compared(a, state);
    EXPECT_NE(states.find("errors are not comparable: they are of another state"),
              std::string::npos)
        << states;
    EXPECT_NE(states.find("     0.01     0.01        -        1        1        1  "),
              std::string::npos)
        << "times are, errors are not: " << states;

    CostReport measure = a;
    measure.measure = place_of(Measure::turn);
    EXPECT_NE(compared(a, measure).find("errors are not comparable: they are of other measures"),
              std::string::npos);

    CostReport machine = a;
    machine.machine.threads = 1;
    EXPECT_NE(compared(a, machine).find("times are of other machines or numbers of threads"),
              std::string::npos);
}

TEST(CostOfACase, PromisesTheFigureAndTellsOfNoWindows)
{
    CostReport report = of_case();
    for (const std::string& told :
         {text([&](std::ostream& out) { write_cost_text(report, out); }),
          text([&](std::ostream& out) { write_cost_page(report, out); }), json_of(report),
          text([&](std::ostream& out) { write_cost_csv(report, out); }),
          text([&](std::ostream& out) { write_cost_svg(report, out); })}) {
        for (const char* const word : {"window", "seed", "19 of 20", "nan", "doubt:", "at rest"})
            EXPECT_EQ(told.find(word), std::string::npos) << word << " is in " << told;
    }
    const std::string said = text([&](std::ostream& out) { write_cost_text(report, out); });
    EXPECT_NE(said.find("reference: the case's own exact answer\n"), std::string::npos) << said;
    EXPECT_NE(said.find("  the case as it is\n  axis, \"from\" the answer 0; 1 ms"),
              std::string::npos)
        << said;
    const std::string csv = text([&](std::ostream& out) { write_cost_csv(report, out); });
    EXPECT_EQ(csv.find("setting,\"axis, \"\"from\"\" the answer_1\","), 0u) << csv;
    const std::string page = text([&](std::ostream& out) { write_cost_page(report, out); });
    EXPECT_NE(page.find("data-command=\"throng cost H3 --dials none --set substeps=16\""),
              std::string::npos)
        << page;
}

}  // namespace
}  // namespace throng
