// Usage: what the command answers to words, right and wrong.
#include "tests/apps/throng/command.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <sys/stat.h>

namespace throng {
namespace {

using Names = std::vector<std::string>;

TEST(Usage, HelpAndVersionGoToStandardOutput)
{
    const Outcome help = run_throng({"--help"});
    EXPECT_EQ(help.code, 0);
    EXPECT_EQ(help.err, "");
    for (const char* name : {"run", "explain", "scene", "bench"}) {
        EXPECT_NE(help.out.find(std::string("\n  ") + name + ' '), std::string::npos) << name;
        const Outcome more = run_throng({name, "--help"});
        EXPECT_EQ(more.code, 0);
        EXPECT_EQ(more.out.find(std::string("usage: throng ") + name), 0u);
    }
    EXPECT_EQ(run_throng({"--version"}).out.find("throng "), 0u);
}

TEST(Usage, RunHelpListsTheDials)
{
    const Outcome help = run_throng({"run", "--help"});
    for (const char* name : {"--steps", "--set", "substeps", "contact_rate", "toi_tolerance"})
        EXPECT_NE(help.out.find(name), std::string::npos) << name;
}

TEST(Usage, SceneTellsItsFormat)
{
    const Outcome schema = run_throng({"scene", "--schema"});
    EXPECT_EQ(schema.code, 0);
    EXPECT_EQ(schema.out.find("{\n  \"$schema\""), 0u);
    EXPECT_NE(schema.out.find("\"drive_velocity\""), std::string::npos);
}

TEST(Usage, HelpIsACommandToo)
{
    EXPECT_EQ(run_throng({"help"}).out, run_throng({"--help"}).out);
    for (const char* name : {"run", "cases", "scene"}) {
        const Outcome help = run_throng({"help", name});
        EXPECT_EQ(help.code, 0);
        EXPECT_EQ(help.out, run_throng({name, "--help"}).out);
    }
    EXPECT_EQ(run_throng({"help", "runn"}).code, 2);
}

TEST(Usage, HelpForgivesTheRest)
{
    EXPECT_EQ(run_throng({"run", "--steps", "x", "--help"}).code, 0);
}

TEST(Usage, NoWordsAreBadUsage)
{
    const Outcome outcome = run_throng({});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(outcome.err.find("usage:"), 0u);
}

constexpr const char* kTetrahedron =
    "v 10 10 10\nv 12 10 10\nv 10 12 10\nv 10 10 12\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

/// Words that are refused, and what the answer has to say.
struct Refusal {
    Names words;
    std::string said;
};

TEST(Usage, WrongWordsAreRefusedWithWhatWasWanted)
{
    const TestFolder folder;
    const std::string ball = folder.write("ball.obj", kTetrahedron);
    const std::string empty = folder.write("empty.obj", "v 0 0 0\n");
    const std::string point = folder.write("point.obj", "v 3 3 3\nf 1 1 1\n");
    const std::string broken = folder.write("broken.obj", "v 0 0 x\n");
    const std::string scene = folder.write("s.json", "{\"throng\": 1}");
    const std::vector<Refusal> refusals = {
        {{"rum"}, "did you mean run?"},
        {{"explian", "pile"}, "did you mean explain?"},
        {{"zzzzzz"}, "there are: run, explain"},
        {{"run"}, "wanted SCENE"},
        {{"run", "pile", "spheres"}, "one word too many"},
        {{"run", "pile:10", "--stepz", "3"}, "did you mean --steps?"},
        {{"run", "pile:10", "-s", "3"}, "there is no option \"-s\""},
        {{"run", "pile:10", "--steps"}, "--steps: wanted a value"},
        {{"run", "pile:10", "--steps="}, "--steps: wanted a value"},
        {{"run", "pile:10", "--steps", "--quiet"}, "--steps: wanted a value"},
        {{"run", "pile:10", "--steps", "-3"}, "wanted a whole number from 0 to"},
        {{"run", "pile:10", "--steps", "1.5"}, "wanted a whole number"},
        {{"run", "pile:10", "--steps", "99999999999999999999"}, "wanted a whole number"},
        {{"run", "pile:10", "--steps", "1", "--steps", "2"}, "--steps: given twice"},
        {{"run", "pile:10", "--threads", "0"}, "from 1 to 1024"},
        {{"run", "pile:10", "--quiet=1"}, "--quiet: takes no value"},
        {{"run", "pile:10", "--dt", "fast"}, "--dt: dt: wanted a time"},
        {{"run", "pile:10", "--set", "substeps"}, "--set: wanted DIAL=VALUE"},
        {{"run", "pile:10", "--set", "substep=3"}, "perhaps substeps"},
        {{"run", "pile:10", "--set", "substeps=0"}, "from 1 to 1000"},
        {{"run", "pile:10", "--every", "3"}, "give --out as well"},
        {{"run", "pile:-1"}, "give a whole number from 1"},
        {{"run", "pilr:10"}, "did you mean \"pile\"?"},
        {{"run", folder / "none.json"}, "error:"},
        {{"run", "pile:10", "--trace-steps", "3"}, "give --trace as well"},
        {{"run", "pile:10", "--trace", folder / "no/t.json"}, "--trace: "},
        {{"run", "pile:10", "--trace", folder / "t", "--trace-steps", "0"}, "from 1 to 1000"},
        {{"run", "pile:10", "--trace", folder / "t", "--stats", folder / "t"}, "--trace: "},
        {{"bench", "pile"}, "one word too many"},
        {{"bench", "--scenes", "pilr"}, "did you mean \"pile\"?"},
        {{"bench", "--scenes", "pile,,wall"}, "no empty part"},
        {{"bench", "--scenes", "pile,pile"}, "given twice"},
        {{"bench", "--scenes", "pile:10"}, "sizes go to --sizes"},
        {{"bench", "--sizes", "many"}, "--sizes: wanted a whole number"},
        {{"bench", "--scenes", "stacks", "--sizes", "5"}, "stacks has sizes from 10 to"},
        {{"bench", "--threads", "1,0"}, "--threads: wanted a whole number from 1 to 1024"},
        {{"bench", "--vary", "substeps"}, "--vary: wanted DIAL=VALUE,VALUE"},
        {{"bench", "--vary", "substeps=4,many"}, "--vary: substeps: wanted a whole number"},
        {{"bench", "--vary", "substeps=4,4"}, "given twice"},
        {{"bench", "--lanes", "sse"}, "--lanes: wanted scalar, avx2 or avx512"},
        {{"bench", "--lanes", "scalar,scalar"}, "given twice"},
        {{"bench", "--dt", "soon"}, "--dt: dt: wanted a time"},
        {{"bench", "--dt", "0.01,1/100"}, "given twice"},
        {{"bench", "--error", "--scenes", "rolling,pile"}, "pile has no answer"},
        {{"bench", "--error", "--scenes", "kapla"}, "rolling, bouncing, ball_cube"},
        {{"bench", "--error=1"}, "--error: takes no value"},
        {{"bench", "--error", "--vary", "dt=0.01,0.02"}, "with --error give --dt"},
        {{"bench", "--steps", "0"}, "wanted a whole number from 1 to"},
        {{"bench", "--repeat", "0"}, "wanted a whole number from 1 to"},
        {{"bench", "--max-seconds", "soon"}, "--max-seconds: wanted a time above 0"},
        {{"bench", "--peers", "havok"}, "wanted bullet or ode"},
        {{"bench", "--set", "substeps=0"}, "from 1 to 1000"},
        {{"bench", "--json", folder / "no/b.json"}, "--json: "},
        {{"bench", "--trace", folder / "t.json"}, "--trace: is of one run"},
        {{"scene", "pile", "many"}, "give a whole number"},
        {{"scene", "--seed", "3"}, "wanted the name of a scene"},
        {{"scene", "pile:3", "4"}, "given twice"},
        {{"scene", "pile", "--schema"}, "--schema: wanted nothing beside it"},
        {{"scene", "--mesh", ball}, "wanted the name of a scene"},
        {{"scene", "pile", "--mesh", ball}, "--mesh: pile has no mesh that another could replace"},
        {{"scene", "chain", "--mesh", ball}, "these have: knots, terrain"},
        {{"scene", "knots", "--mesh", folder / "no.obj"}, "--mesh: "},
        {{"scene", "knots", "--mesh", empty}, "has no faces"},
        {{"scene", "knots", "--mesh", point}, "wanted a mesh of some size"},
        {{"scene", "knots", "--mesh", broken}, "broken.obj:1:7: error: v: wanted three finite"},
        {{"scene", "knots", "--mesh", ball, "--out", ball}, "--out: "},
        {{"run", "wall:10", "--mesh", ball}, "--mesh: wall has no mesh"},
        {{"explain", "wall:10", "--mesh", ball}, "--mesh: wall has no mesh"},
        {{"run", scene, "--mesh", ball}, "--mesh: only a scene of the catalogue takes one"},
        {{"bench", "--scenes", "knots,pile", "--mesh", ball}, "--mesh: pile has no mesh"},
    };
    for (const Refusal& refusal : refusals) {
        const Outcome outcome = run_throng(refusal.words);
        EXPECT_EQ(outcome.code, 2) << refusal.said;
        EXPECT_EQ(outcome.out, "") << refusal.said;
        EXPECT_NE(outcome.err.find(refusal.said), std::string::npos)
            << refusal.said << " is not in " << outcome.err;
    }
}

TEST(Usage, BothSpellingsOfAnOptionMeanTheSame)
{
    const Outcome apart = run_throng({"run", "cradle", "--steps", "2", "--threads", "1"});
    const Outcome joined = run_throng({"run", "--threads=1", "--steps=2", "--", "cradle"});
    EXPECT_EQ(apart.code, 0);
    EXPECT_NE(apart.out.find("steps: 2\n"), std::string::npos);
    EXPECT_EQ(apart.out.substr(apart.out.find("state_hash")),
              joined.out.substr(joined.out.find("state_hash")));
}

TEST(Scenes, AreListed)
{
    const Outcome list = run_throng({"scene"});
    EXPECT_EQ(list.code, 0);
    EXPECT_EQ(list.err, "");
    EXPECT_NE(list.out.find("\npile "), std::string::npos);
    EXPECT_NE(list.out.find("\nbullet_plate "), std::string::npos);
}

TEST(Scenes, SmallOnesAreWrittenToStandardOutput)
{
    const TestFolder folder;
    const Outcome text = run_throng({"scene", "wall", "12", "--seed", "7"});
    ASSERT_EQ(text.code, 0) << text.err;
    const std::string file = folder.write("wall.json", text.out);
    const auto hash = [](const Names& words) {
        const std::string out = run_throng(words).out;
        return out.substr(std::min(out.find("state_hash"), out.size()));
    };
    EXPECT_EQ(hash({"run", file, "--steps", "20"}),
              hash({"run", "wall:12", "--seed", "7", "--steps", "20"}));
}

TEST(Scenes, BigOnesNeedAFileAndKeepTheirState)
{
    const TestFolder folder;
    const Outcome refused = run_throng({"scene", "pile", "2000"});
    EXPECT_EQ(refused.code, 2);
    EXPECT_EQ(refused.out, "");
    EXPECT_NE(refused.err.find("--out"), std::string::npos);

    ASSERT_EQ(run_throng({"scene", "pile", "2000", "--out", folder / "p.json"}).code, 0);
    EXPECT_EQ(folder.files(), (Names{"p.0.bin", "p.json"}));
    const auto tail = [](const std::string& out) { return out.substr(out.find("state_hash")); };
    EXPECT_EQ(tail(run_throng({"run", folder / "p.json", "--steps", "3"}).out),
              tail(run_throng({"run", "pile:2000", "--steps", "3"}).out));
}

TEST(Scenes, TakeAnotherMeshInPlaceOfTheirOwn)
{
    const TestFolder folder;
    const std::string mesh = folder.write("mine.obj", kTetrahedron);
    const Outcome made =
        run_throng({"scene", "knots", "6", "--mesh", mesh, "--out", folder / "k.json"});
    ASSERT_EQ(made.code, 0) << made.err;
    EXPECT_EQ(folder.files(), (Names{"k.5.obj", "k.json", "mine.obj"}));
    // Its own four triangles, about the middle of its bounds and 0.5 m from there at most.
    EXPECT_EQ(count_of(folder.read("k.5.obj"), "\nf "), 4u);
    EXPECT_EQ(count_of(folder.read("k.5.obj"), "0.28867513459481"), 12u) << "not 0.5 / sqrt(3)";
    EXPECT_EQ(count_of(folder.read("k.json"), "\"solid\""), 7u) << "a shape and six bodies";

    const Outcome plain = run_throng({"scene", "knots", "6", "--out", folder / "p.json"});
    ASSERT_EQ(plain.code, 0) << plain.err;
    EXPECT_EQ(folder.read("p.json").find("\"solid\""), std::string::npos);
    EXPECT_NE(folder.read("p.json").find("\"trefoil\""), std::string::npos);
}

TEST(Scenes, TakeTheNameOfNoDevice)
{
    const TestFolder folder;
    const std::string pipe = folder / "pipe";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    const Outcome refused = run_throng({"scene", "cradle", "5", "--out", pipe});
    EXPECT_EQ(refused.code, 2);
    EXPECT_NE(refused.err.find("plain file"), std::string::npos) << refused.err;
    EXPECT_TRUE(std::filesystem::is_fifo(pipe));
}

TEST(Usage, WrongLanesAreNoFaultOfThrong)
{
    ASSERT_EQ(::setenv("THRONG_LANES", "wide", 1), 0);
    const Outcome refused = run_throng({"run", "cradle", "--steps", "1"});
    ::unsetenv("THRONG_LANES");
    EXPECT_EQ(refused.code, 2);
    EXPECT_NE(refused.err.find("THRONG_LANES: wanted"), std::string::npos) << refused.err;
}

}  // namespace
}  // namespace throng
