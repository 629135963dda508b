// Bench: what a benchmark prints and writes.
#include "scene/files/json.hpp"
#include "tests/apps/throng/command.hpp"
#include "throng/version.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <sstream>
#include <thread>

namespace throng {
namespace {

using Names = std::vector<std::string>;
using Node = JsonDocument::Node;

/// A JSON document with short ways in.
struct Json {
    JsonDocument document;
    explicit Json(const std::string& text) : document(text, "bench.json") { }
    Node at(Node node, const char* key) const
    {
        const Node found = document.find(node, key);
        EXPECT_NE(found, JsonDocument::kRoot) << key;
        return found;
    }
    Node at(const char* key) const { return at(JsonDocument::kRoot, key); }
    std::vector<Node> items(Node list) const
    {
        std::vector<Node> nodes;
        Node node = document.first(list);
        for (std::size_t i = 0; i < document.size(list); ++i, node = document.next(node))
            nodes.push_back(node);
        return nodes;
    }
    double number(Node node, const char* key) const { return document.number(at(node, key)); }
    std::string text(Node node, const char* key) const
    {
        return std::string(document.text(at(node, key)));
    }
};

TEST(Bench, TellsOfEveryEngineAndStage)
{
    const TestFolder folder;
    const Outcome done =
        run_throng({"bench", "--scenes", "pile,sparse", "--sizes", "20,40", "--threads", "1,2",
                    "--steps", "25", "--peers", "none", "--json", folder / "b.json"});
    ASSERT_EQ(done.code, 0) << done.err;
    EXPECT_EQ(done.err, "");
    for (const char* word : {"\npile:20 ", "\nsparse:40 ", "ms/step", "speedup", "solve_soft_step",
                             "state_hash", "exponent"})
        EXPECT_NE(done.out.find(word), std::string::npos) << word << " is not in " << done.out;

    const Json json(folder.read("b.json"));
    EXPECT_EQ(json.document.text(json.at("sleep")), "off");
    EXPECT_TRUE(json.document.boolean(json.at("complete")));
    const std::vector<Node> cases = json.items(json.at("cases"));
    ASSERT_EQ(cases.size(), 4u);
    EXPECT_EQ(json.text(cases[1], "scene"), "pile");
    EXPECT_EQ(json.number(cases[1], "size"), 40);
    EXPECT_EQ(json.number(cases[1], "bodies_dynamic"), 40);
    EXPECT_TRUE(json.document.boolean(json.at(cases[1], "hashes_agree")));
    const std::vector<Node> figures = json.items(json.at(cases[1], "figures"));
    ASSERT_EQ(figures.size(), 2u);
    for (const char* key : {"ms_median", "ms_p99", "cpu_ms_mean", "ns_per_body", "ns_per_contact",
                            "contacts", "state_bytes_per_body"})
        EXPECT_GT(json.number(figures[1], key), 0) << key;
    EXPECT_EQ(json.number(figures[1], "threads_used"), 2);
    EXPECT_EQ(json.number(figures[1], "steps"), 25);
    EXPECT_EQ(json.text(figures[0], "state_hash"), json.text(figures[1], "state_hash"));
    EXPECT_EQ(json.items(json.at(figures[1], "against")).size(), 1u);
    EXPECT_FALSE(json.items(json.at(figures[0], "stages")).empty());
    const std::vector<Node> runs = json.items(json.at(cases[1], "runs"));
    ASSERT_EQ(runs.size(), 4u);  // two repeats of two
    EXPECT_EQ(json.items(json.at(runs[0], "ms")).size(), 25u);
    EXPECT_EQ(json.items(json.at("growth")).size(), 4u);
}

TEST(Bench, OneRunEndsAsTheCommandRunsIt)
{
    const std::string bench =
        run_throng({"bench", "--scenes", "stacks", "--sizes", "20", "--threads", "1", "--steps",
                    "30", "--repeat", "1", "--peers", "none"})
            .out;
    const std::string run =
        run_throng({"run", "stacks:20", "--steps", "30", "--set", "sleep=off"}).out;
    const std::string hash = run.substr(run.find("state_hash: ") + 12, 16);
    EXPECT_NE(bench.find(hash), std::string::npos) << bench;
}

// Runs peers beside throng, who have to fall as it does, and no overlap of theirs goes unseen; how
// many there were.
std::size_t peers_that_fall(const std::string& scenes, std::vector<std::string> more)
{
    const TestFolder folder;
    std::vector<std::string> words = {"bench",          "--scenes", scenes,     "--sizes", "30",
                                      "--steps",        "15",       "--repeat", "1",       "--json",
                                      folder / "b.json"};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome done = run_throng(words);
    EXPECT_EQ(done.code, 0) << done.err;
    if (done.code != 0) return 0;
    const Json json(folder.read("b.json"));
    std::size_t peers = 0;
    for (const Node one : json.items(json.at("cases"))) {
        const std::vector<Node> figures = json.items(json.at(one, "figures"));
        const double height = json.number(json.at(figures[0], "quality"), "mean_height_m");
        for (const Node figure : figures) {
            if (json.text(figure, "engine") == "throng") continue;
            ++peers;
            const Node quality = json.at(figure, "quality");
            EXPECT_NEAR(json.number(quality, "mean_height_m"), height, 0.03)
                << json.text(one, "scene") << ' ' << json.text(figure, "engine");
            EXPECT_LT(json.number(quality, "max_overlap_m"), 0.2);
            EXPECT_EQ(json.number(figure, "steps"), 15);
            EXPECT_FALSE(json.text(figure, "settings").empty());
        }
    }
    return peers;
}

constexpr const char* kPeerScenes = "pile,spheres,hulls,wall,pyramid,stacks,tumbler,crowd,sparse";

TEST(Bench, PeersFallAsThrongDoes)
{
    if (peers_that_fall(kPeerScenes, {"--threads", "1"}) == 0)
        GTEST_SKIP() << "no other engine was there when this was built";
}

TEST(Bench, PeersThatUsersBuildAreSoughtWhereTheyAre)
{
    const TestFolder folder;
    const auto trouble = [](const std::string& at) {
        const Outcome done = run_throng({"bench", "--scenes", "pile", "--sizes", "20", "--threads",
                                         "1", "--steps", "1", "--peer-at", at});
        EXPECT_EQ(done.code, 2) << at;
        return done.err;
    };
    EXPECT_NE(trouble("bullet=" + folder / "").find("wanted NAME=DIR"), std::string::npos);
    EXPECT_NE(trouble("box3d=" + folder / "none").find("there is no folder"), std::string::npos);
    EXPECT_NE(trouble("box3d=" + folder / "").find("no box3d/box3d.h in "), std::string::npos);
    EXPECT_NE(trouble("jolt=" + folder / "").find("no JoltConfig.cmake in "), std::string::npos);
    EXPECT_NE(trouble("physx=" + folder / "").find("no PxPhysicsAPI.h in "), std::string::npos);
}

// Where THRONG_TEST_PEERS has some, as `box3d=DIR jolt=DIR`.
TEST(Bench, PeersThatUsersBuildFallAsThrongDoes)
{
    const char* const given = std::getenv("THRONG_TEST_PEERS");  // NOLINT(concurrency-mt-unsafe)
    if (given == nullptr) GTEST_SKIP() << "THRONG_TEST_PEERS names no engine and its folder";
    std::istringstream engines(given);
    for (std::string engine; engines >> engine;)
        EXPECT_EQ(peers_that_fall(kPeerScenes,
                                  {"--threads", "1,2", "--peers", "none", "--peer-at", engine}),
                  18u)
            << engine;
}

TEST(Bench, ErrorsAreToldBesideTimes)
{
    const TestFolder folder;
    const Outcome done = run_throng({"bench",     "--error",
                                     "--scenes",  "rolling",
                                     "--threads", "1",
                                     "--dt",      "1e-2,1/500",
                                     "--steps",   "50",
                                     "--repeat",  "1",
                                     "--set",     "solver=direct",
                                     "--set",     "precision=double",
                                     "--set",     "substeps=1",
                                     "--set",     "integrator=semi_implicit",
                                     "--json",    folder / "b.json"});
    ASSERT_EQ(done.code, 0) << done.err;
    for (const char* words : {"\nrolling:25, dt 0.01 s ", "\nrolling:25, dt 0.002 s ", "cpu_s",
                              "error_m2/s2", "squared error of the velocities"})
        EXPECT_NE(done.out.find(words), std::string::npos) << words << " is not in " << done.out;
    const Json json(folder.read("b.json"));
    const std::vector<Node> cases = json.items(json.at("cases"));
    ASSERT_EQ(cases.size(), 2u);
    EXPECT_EQ(json.number(cases[0], "dt"), 0.01);
    EXPECT_EQ(json.text(cases[0], "error_unit"), "m2/s2");
    for (const Node one : cases)
        for (const Node figure : json.items(json.at(one, "figures"))) {
            const double error = json.number(figure, "error");
            const std::string engine = json.text(figure, "engine");
            EXPECT_GE(error, 0) << engine;
            // A box that nobody pulls would be 0.046 m2/s2 off in half a second.
            EXPECT_LT(error, engine == "throng" ? 1e-18 : 0.2) << engine;
        }
}

// Of every scene, for as long as its answer is followed unless told otherwise.
TEST(Bench, ErrorsAreOfAllScenesThatHaveAnAnswer)
{
    const TestFolder folder;
    const Outcome done =
        run_throng({"bench", "--error", "--sizes", "8", "--threads", "1", "--dt", "0.1", "--repeat",
                    "1", "--peers", "none", "--json", folder / "b.json"});
    ASSERT_EQ(done.code, 0) << done.err;
    const Json json(folder.read("b.json"));
    const double steps[] = {40, 200, 100, 100};
    const std::vector<Node> cases = json.items(json.at("cases"));
    ASSERT_EQ(cases.size(), 4u);
    for (std::size_t i = 0; i < cases.size(); ++i)
        for (const Node figure : json.items(json.at(cases[i], "figures"))) {
            EXPECT_EQ(json.number(figure, "steps"), steps[i]);
            EXPECT_GE(json.number(figure, "error"), 0);
        }
}

std::vector<Node> figures_of_first(const Json& json)
{
    return json.items(json.at(json.items(json.at("cases")).at(0), "figures"));
}

// Both ends are judged by the same geometry.
TEST(Bench, ValuesOfADialRunSideBySide)
{
    const TestFolder folder;
    const Outcome done = run_throng({"bench", "--scenes", "knots", "--sizes", "4", "--threads", "1",
                                     "--steps", "10", "--repeat", "1", "--peers", "none", "--vary",
                                     "nonconvex=voxels,hull", "--json", folder / "b.json"});
    ASSERT_EQ(done.code, 0) << done.err;
    EXPECT_NE(done.out.find("throng nonconvex=hull"), std::string::npos) << done.out;
    const Json json(folder.read("b.json"));
    const std::vector<Node> figures = figures_of_first(json);
    ASSERT_GE(figures.size(), 2u);
    const Outcome alone = run_throng({"run", "knots:4", "--steps", "10", "--set", "sleep=off"});
    EXPECT_NE(alone.out.find(json.text(figures[0], "state_hash")), std::string::npos);
    EXPECT_EQ(json.text(figures[1], "setting"), "nonconvex=hull");
    EXPECT_NE(json.text(figures[0], "state_hash"), json.text(figures[1], "state_hash"));
    for (const Node figure : figures)
        EXPECT_GE(json.number(json.at(figure, "quality"), "shared_volume"), 0);
}

TEST(Bench, WidthsRunSideBySideAndComeToTheSameState)
{
    const TestFolder folder;
    const bool wide = machine_has_lanes("avx2");
    const Outcome done = run_throng({"bench", "--scenes", "stacks", "--sizes", "30", "--threads",
                                     "1", "--steps", "5", "--repeat", "1", "--peers", "none",
                                     "--lanes", wide ? "avx2,scalar" : "scalar", "--vary",
                                     "substeps=4,5", "--json", folder / "b.json"});
    ASSERT_EQ(done.code, 0) << done.err;
    EXPECT_NE(done.out.find("throng lanes=scalar substeps=5"), std::string::npos) << done.out;
    const Json json(folder.read("b.json"));
    const std::vector<Node> figures = figures_of_first(json);
    ASSERT_EQ(figures.size(), wide ? 4u : 2u);
    if (wide) {
        EXPECT_EQ(json.text(figures[0], "state_hash"), json.text(figures[2], "state_hash"));
        EXPECT_EQ(json.text(figures[1], "setting"), "lanes=avx2 substeps=5");
    }
    EXPECT_NE(json.text(figures[0], "state_hash"), json.text(figures[1], "state_hash"));
}

TEST(Bench, TellsWhatThreadsDoTogetherOfWhatRunsDoBesideOneAnother)
{
    const TestFolder folder;
    const Outcome done = run_throng({"bench", "--scenes", "stacks", "--sizes", "30", "--threads",
                                     "1,2", "--steps", "25", "--repeat", "1", "--peers", "none",
                                     "--efficiency", "--json", folder / "b.json"});
    ASSERT_EQ(done.code, 0) << done.err;
    EXPECT_NE(done.out.find("throng beside 1"), std::string::npos) << done.out;
    const Json json(folder.read("b.json"));
    const std::vector<Node> figures = figures_of_first(json);
    ASSERT_EQ(figures.size(), 3u);
    const auto mean_ms = [&](const Node& figure) {
        return json.number(json.at(figure, "ms_mean"), "median");
    };
    EXPECT_EQ(json.number(figures[2], "beside"), 1);
    EXPECT_NEAR(json.number(json.at(figures[1], "efficiency"), "median"),
                mean_ms(figures[2]) / (2 * mean_ms(figures[1])), 1e-9);
    EXPECT_EQ(json.number(json.at(figures[0], "efficiency"), "median"), 0);
    EXPECT_EQ(json.text(figures[0], "state_hash"), json.text(figures[2], "state_hash"));
    EXPECT_EQ(run_throng({"bench", "--threads", "1", "--efficiency"}).code, 2);
}

TEST(Bench, TimeThatIsUpEndsARunEarly)
{
    const TestFolder folder;
    const Outcome done = run_throng({"bench", "--scenes", "pile", "--sizes", "300", "--threads",
                                     "1", "--steps", "100000", "--repeat", "1", "--peers", "none",
                                     "--max-seconds", "0.05", "--json", folder / "b.json"});
    ASSERT_EQ(done.code, 0) << done.err;
    const Json json(folder.read("b.json"));
    const Node one = json.items(json.at("cases")).at(0);
    const Node figure = json.items(json.at(one, "figures")).at(0);
    EXPECT_GT(json.number(figure, "steps"), 0);
    EXPECT_LT(json.number(figure, "steps"), 100000);
}

TEST(Bench, AnInterruptLeavesWhatThereIs)
{
    const TestFolder folder;
    const Outcome ended =
        run_throng({"bench", "--scenes", "pile", "--sizes", "200", "--steps", "100000", "--peers",
                    "none", "--max-seconds", "600", "--json", folder / "b.json"},
                   [](pid_t process) {
                       std::this_thread::sleep_for(std::chrono::milliseconds(600));
                       ::kill(process, SIGINT);
                   });
    EXPECT_EQ(ended.code, 130) << ended.err;
    EXPECT_EQ(folder.files(), Names{"b.json"});
    const Json json(folder.read("b.json"));
    EXPECT_FALSE(json.document.boolean(json.at("complete")));
    EXPECT_EQ(json.items(json.at("cases")).size(), 1u);
}

TEST(Bench, JsonOnStandardOutputIsAllThatIsThere)
{
    const Outcome done =
        run_throng({"bench", "--scenes", "cradle", "--sizes", "5", "--threads", "1", "--steps", "3",
                    "--peers", "none", "--json", "/dev/stdout"});
    ASSERT_EQ(done.code, 0) << done.err;
    const Json json(done.out);
    EXPECT_EQ(json.items(json.at("cases")).size(), 1u);
}

TEST(Bench, ProgressIsForTerminalsAlone)
{
    const Names words = {"bench",   "--scenes", "pile",     "--sizes", "300",     "--threads", "1",
                         "--steps", "700",      "--repeat", "1",       "--peers", "none"};
    EXPECT_EQ(run_throng(words).err, "");
    EXPECT_NE(run_throng_on_terminal(words).err.find("pile:300 throng on 1"), std::string::npos);
}

TEST(RunTrace, HoldsTheLastSteps)
{
    const TestFolder folder;
    const Outcome done = run_throng(
        {"run", "pile:50", "--steps", "20", "--trace", folder / "t.json", "--trace-steps", "4"});
    ASSERT_EQ(done.code, 0) << done.err;
    EXPECT_EQ(folder.files(), Names{"t.json"});
    const std::string text = folder.read("t.json");
    const Json json(text);
    EXPECT_EQ(json.number(json.at("otherData"), "steps"), 4);
    EXPECT_EQ(count_of(text, "\"name\": \"step "), 4u);
    EXPECT_NE(text.find("\"step 20\""), std::string::npos);
    EXPECT_GE(count_of(text, "\"name\": \"find_pairs\", \"cat\": \"stage\""), 4u);
}

TEST(RunTrace, ChangesNothing)
{
    const TestFolder folder;
    const auto hash = [](const Outcome& done) {
        return done.out.substr(done.out.find("state_hash"));
    };
    EXPECT_EQ(hash(run_throng({"run", "pile:50", "--steps", "40"})),
              hash(run_throng({"run", "pile:50", "--steps", "40", "--trace", folder / "t.json"})));
}

}  // namespace
}  // namespace throng
