// Cost: what the command answers, writes and refuses.
#include "scene/catalog/closed_meshes.hpp"
#include "scene/files/mesh_file.hpp"
#include "tests/apps/throng/command.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <sstream>
#include <thread>

namespace throng {
namespace {

std::vector<std::string> quick(const TestFolder& folder, std::vector<std::string> more)
{
    std::vector<std::string> words = {"cost",      "stacks:10", "--windows", "2",
                                      "--seconds", "0.5",       "--threads", "1",
                                      "--dials",   "dt",        "--out",     folder / "found"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

TEST(Cost, NamesASettingReadyToPaste)
{
    const TestFolder folder;
    const Outcome said = run_throng(quick(folder, {"--error", "1", "--text"}));
    ASSERT_EQ(said.code, 0) << said.err;
    EXPECT_NE(said.out.find("the cheapest within 1 m:\n"), std::string::npos) << said.out;
    EXPECT_NE(said.out.find("in 19 of 20 runs like this at most"), std::string::npos);
    EXPECT_NE(said.out.find("o on the front"), std::string::npos);
    const std::string json = folder.read("found/cost.json");
    for (const char* key : {"\"points\": ", "\"advice\": {\"point\": ", "\"meets\": true",
                            "\"measure\": \"drift\"", "\"processor\": "})
        EXPECT_NE(json.find(key), std::string::npos) << key << " is not in " << json;
    const std::string csv = folder.read("found/cost.csv");
    EXPECT_EQ(csv.find("setting,drift_m,"), 0u) << csv;
    EXPECT_NE(csv.find("\"dt=1/30\","), std::string::npos) << csv;
}

TEST(Cost, AsksForEachMeasure)
{
    const std::pair<const char*, const char*> measures[] = {
        {"momentum", "momentum: what bodies that nothing holds were given from nothing, N s;"},
        {"complementarity", " m/s, in 19 of 20 runs like this at most "},
        {"friction_cone", " m/s, in 19 of 20 runs like this at most "},
        {"missed_contacts", "doubt: no setting has any error: "},
        {"force_error", "force_error: what is left of the forces on what rests, over its weight;"},
    };
    for (const auto& [measure, told] : measures) {
        const TestFolder folder;
        const Outcome said = run_throng(quick(folder, {"--measure", measure}));
        ASSERT_EQ(said.code, 0) << said.err;
        EXPECT_NE(said.out.find(told), std::string::npos) << measure << ": " << said.out;
        EXPECT_NE(folder.read("found/cost.json").find("\"measure\": \"" + std::string(measure)),
                  std::string::npos);
    }
}

TEST(Cost, MarksWhatOnlyComesNear)
{
    const TestFolder folder;
    const Outcome said = run_throng(quick(folder, {"--error", "1e-30"}));
    EXPECT_EQ(said.code, 0) << said.err;
    EXPECT_NE(said.out.find("nothing is within 1e-30 m; the most exact that was found:"),
              std::string::npos)
        << said.out;
    EXPECT_NE(folder.read("found/cost.json").find("\"meets\": false"), std::string::npos);
}

TEST(Cost, ResumesWhatItHasMeasured)
{
    const TestFolder folder;
    ASSERT_EQ(run_throng(quick(folder, {})).code, 0);
    const std::string first = folder.read("found/cost.json");
    const Outcome again = run_throng(quick(folder, {"--resume"}));
    ASSERT_EQ(again.code, 0) << again.err;
    const auto squares = [](const std::string& json) {
        const auto at = json.find("\"squares\": ");
        return json.substr(at, json.find("]]", at) - at);
    };
    EXPECT_EQ(squares(first), squares(folder.read("found/cost.json")));

    folder.write("found/cost.json", "{\"points\": 3}");
    const Outcome broken = run_throng(quick(folder, {"--resume"}));
    EXPECT_EQ(broken.code, 2);
    EXPECT_NE(broken.err.find("cost.json:1:1: error: scene: wanted the key state"),
              std::string::npos)
        << broken.err;
    const TestFolder empty;
    const Outcome none = run_throng(quick(empty, {"--resume"}));
    EXPECT_EQ(none.code, 2);
    EXPECT_NE(none.err.find("--resume: there is no "), std::string::npos) << none.err;
}

// Of the page, the command of the last setting.
std::string last_command(const std::string& page)
{
    const std::string key = "data-command=\"";
    const auto at = page.rfind(key) + key.size();
    return page.substr(at, page.find('"', at) - at);
}

TEST(Cost, PrintsCommandsThatRunWhatWasMeasured)
{
    const TestFolder folder;
    const TriangleSoup ring = torus_mesh(2, 0.5, 16, 8);
    const std::string file = folder.write("a ring.obj", mesh_text({ring.vertices, ring.triangles}));
    const Outcome said =
        run_throng({"cost",       "knots:2",   "--seed",     "5",     "--mesh",
                    file,         "--set",     "substeps=2", "--dt",  "1/120",
                    "--windows",  "2",         "--seconds",  "0.1",   "--dials",
                    "iterations", "--minutes", "0.2",        "--out", folder / "found"});
    ASSERT_EQ(said.code, 0) << said.err;
    EXPECT_EQ(last_command(folder.read("found/cost.html"))
                  .find("throng run knots:2 --seed 5 --mesh '" + file
                        + "' --set substeps=2 --set dt=1/120 --set iterations="),
              0u)
        << folder.read("found/cost.html");
}

TEST(Cost, OfACaseIsItsOwnError)
{
    const TestFolder folder;
    const std::vector<std::string> words = {"cost",    "h3",          "--error", "1e-3",
                                            "--dials", "dt,substeps", "--out",   folder / "found"};
    const Outcome said = run_throng(words);
    ASSERT_EQ(said.code, 0) << said.err;
    EXPECT_EQ(said.out.find("H3, 1 body, the line \"by default, dt=1/60: axis from the answer\""),
              0u)
        << said.out;
    const auto at = said.out.find("the cheapest within 0.001:\n  --set ");
    ASSERT_NE(at, std::string::npos) << said.out;
    // The setting that is named has the figure that is promised, wherever it is set.
    const std::string json = folder.read("found/cost.json"), key = "\"command\": \"";
    const auto begin = json.rfind(key) + key.size();
    std::istringstream command(json.substr(begin, json.find('"', begin) - begin));
    std::vector<std::string> again;
    for (std::string word; command >> word;) again.push_back(word);
    ASSERT_EQ(again.front(), "throng") << json;
    again.erase(again.begin());
    again.insert(again.end(), {"--out", folder / "again"});
    const Outcome once_more = run_throng(again);
    ASSERT_EQ(once_more.code, 0) << once_more.err;
    const auto promise = [](const std::string& text) {
        const auto figure = text.find("  axis from the answer ");
        return text.substr(figure, text.find(';', figure) - figure);
    };
    EXPECT_EQ(promise(said.out), promise(once_more.out));

    std::vector<std::string> resumed = words;
    resumed.emplace_back("--resume");
    EXPECT_EQ(run_throng(resumed).code, 0);
}

TEST(Cost, OfACaseRefusesWhatItHasNot)
{
    const TestFolder folder;
    const std::pair<std::vector<std::string>, const char*> wrongs[] = {
        {{"cost", "H3", "--seed", "2"}, "--seed: a case has none; it is for scenes"},
        {{"cost", "H3", "--window", "1"}, "--window: a case has none; it is for scenes"},
        {{"cost", "H3", "--measure", "drift"},
         "H3 has no line of \"drift\" that comes from runs; there are axis from the answer; "},
        {{"cost", "H29"}, "H29 asks methods about shapes and steps no world"},
        {{"cost", "H0"}, "there is no case \"H0\"; there are: H1, H2"},
        {{"cost", "H3", "H4"}, "cost: one word too many: \"H4\""},
    };
    for (auto [words, wanted] : wrongs) {
        words.insert(words.end(), {"--out", folder / "found"});
        const Outcome said = run_throng(words);
        EXPECT_EQ(said.code, 2) << wanted;
        EXPECT_NE(said.err.find(wanted), std::string::npos) << said.err;
    }
}

TEST(Cost, ComparesTwoReports)
{
    const TestFolder folder;
    ASSERT_EQ(run_throng(quick(folder, {"--error", "1"})).code, 0);
    const std::string report = folder / "found/cost.json";
    const Outcome same = run_throng({"cost", "--compare", report, report});
    EXPECT_EQ(same.code, 0) << same.err;
    EXPECT_EQ(same.out.find("A: " + report + "\nB: " + report + "\n"), 0u) << same.out;
    EXPECT_EQ(same.out.find("comparable"), std::string::npos) << same.out;
    EXPECT_NE(same.out.find("the same settings, with o"), std::string::npos);

    const std::string bad = folder.write("bad.json", "{\n \"state\": 3}");
    const Outcome refused = run_throng({"cost", "--compare", report, bad});
    EXPECT_EQ(refused.code, 2);
    EXPECT_NE(refused.err.find("bad.json:2:11: error: state: wanted a text"), std::string::npos)
        << refused.err;
    EXPECT_EQ(run_throng({"cost", "--compare", report}).code, 2);
    EXPECT_EQ(run_throng({"cost", "--compare", report, folder / "none.json"}).code, 2);
}

TEST(Cost, TriesTheSettingsOfAFile)
{
    const TestFolder folder;
    const auto by = [&](const std::string& text) {
        return run_throng({"cost", "stacks:10", "--windows", "2", "--seconds", "0.5", "--settings",
                           folder.write("some.txt", text), "--out", folder / "found"});
    };
    const Outcome said = by("# two\nsubsteps=16   contact_rate=0.4\n\nsolver=pgs # by sweeps\n");
    ASSERT_EQ(said.code, 0) << said.err;
    EXPECT_NE(said.out.find("settings on the front, of 3 tried"), std::string::npos) << said.out;
    const std::string csv = folder.read("found/cost.csv");
    EXPECT_NE(csv.find("\n\"substeps=16 contact_rate=0.4\","), std::string::npos) << csv;
    EXPECT_NE(csv.find("\n\"solver=pgs\","), std::string::npos) << csv;

    const std::pair<const char*, const char*> wrongs[] = {
        {"substeps=16\nsolver pgs\n", "some.txt:2: wanted DIAL=VALUE, not \"solver\""},
        {"solver=pigs\n", "some.txt:1: "},
        {"substeps=1 substeps=2\n", "some.txt:1: \"substeps\" is there twice"},
        {"# none\n", "--settings: there are none in "},
    };
    for (const auto& [text, wanted] : wrongs) {
        const Outcome refused = by(text);
        EXPECT_EQ(refused.code, 2) << wanted;
        EXPECT_NE(refused.err.find(wanted), std::string::npos) << refused.err;
    }
    const Outcome both = run_throng(quick(folder, {"--settings", folder / "some.txt"}));
    EXPECT_NE(both.err.find("--settings: wanted either that or --dials"), std::string::npos);
    const Outcome none =
        run_throng({"cost", "stacks:10", "--settings", folder / "no.txt", "--out", folder / "a"});
    EXPECT_NE(none.err.find("no.txt\" cannot be read"), std::string::npos) << none.err;
}

TEST(Cost, AnInterruptKeepsWhatWasFound)
{
    const TestFolder folder;
    const Outcome said = run_throng(
        {"cost", "stacks:20", "--windows", "24", "--out", folder / "found"}, [](pid_t process) {
            std::this_thread::sleep_for(std::chrono::seconds(2));
            ::kill(process, SIGINT);
        });
    EXPECT_EQ(said.code, 130);
    if (said.out.empty()) return;  // the reference was not there yet
    EXPECT_NE(said.out.find("doubt: interrupted"), std::string::npos) << said.out;
    EXPECT_NE(folder.read("found/cost.json").find("\"points\": "), std::string::npos);
}

TEST(Cost, RefusesWithWhatWasWanted)
{
    const TestFolder folder;
    const std::pair<std::vector<std::string>, const char*> wrongs[] = {
        {{"--measure", "drft"},
         "--measure: wanted drift, turn, velocity, overlap, energy, momentum, complementarity, "
         "friction_cone, missed_contacts or force_error, not "},
        {{"--error", "-1"}, "--error: wanted a number above 0"},
        {{"--error", "1", "--within", "1"}, "--within: wanted either that or --error"},
        {{"--window", "x"}, "--window: wanted a number above 0"},
        {{"--minutes", "0"}, "--minutes: wanted a number above 0"},
    };
    for (const auto& [more, wanted] : wrongs) {
        const Outcome said = run_throng(quick(folder, more));
        EXPECT_EQ(said.code, 2) << wanted;
        EXPECT_NE(said.err.find(wanted), std::string::npos) << said.err;
    }
    const Outcome dials = run_throng({"cost", "stacks:10", "--dials", "dts"});
    EXPECT_EQ(dials.code, 2);
    EXPECT_NE(dials.err.find("--dials: wanted none, dt, substeps, "), std::string::npos)
        << dials.err;
}

}  // namespace
}  // namespace throng
