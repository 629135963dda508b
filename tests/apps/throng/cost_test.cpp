// Cost: what the command answers, writes and refuses.
#include "tests/apps/throng/command.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
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
        {{"--measure", "drft"}, "--measure: wanted drift, turn, velocity, overlap or energy"},
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
