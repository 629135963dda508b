// Run: what a run of the command writes, and what it leaves behind when it cannot.
#include "scene/catalog/closed_meshes.hpp"
#include "scene/files/json.hpp"
#include "scene/files/mesh_file.hpp"
#include "tests/apps/throng/command.hpp"
#include "throng/catalog.hpp"
#include "throng/dials.hpp"
#include "throng/world.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <sys/mount.h>
#include <thread>

namespace throng {
namespace {

using Names = std::vector<std::string>;

constexpr const char* kBall = R"({
  "throng": 1,
  "shapes": {"ball": {"sphere": {"radius": 0.5}}},
  "bodies": [{"name": "a, \"b\"", "shape": "ball"}]
})";

void write_ring(const TestFolder& folder)
{
    const TriangleSoup ring = torus_mesh(2, 0.5, 16, 8);
    folder.write("ring.obj", mesh_text({ring.vertices, ring.triangles}));
}

TEST(RunStats, HoldTheFieldsOfTheContract)
{
    const TestFolder folder;
    const Outcome done = run_throng({"run", "pile:50", "--steps", "20", "--threads", "2", "--set",
                                     "substeps=6", "--stats", folder / "s.json"});
    ASSERT_EQ(done.code, 0) << done.err;
    const JsonDocument stats(folder.read("s.json"), "s.json");
    const auto at = [&](const char* key) {
        const JsonDocument::Node node = stats.find(JsonDocument::kRoot, key);
        EXPECT_NE(node, JsonDocument::kRoot) << key;
        return node;
    };
    for (const char* key : {"realtime_factor", "pairs", "contacts", "islands", "colors",
                            "max_overlap_m", "mean_overlap_m", "kinetic_energy_j",
                            "potential_energy_j", "energy_gained_j", "energy_net_j", "bodies_awake",
                            "bodies_quarantined", "contacts_dropped", "fallbacks", "peak_rss_mb"})
        EXPECT_EQ(stats.kind(at(key)), JsonKind::number) << key;
    EXPECT_EQ(stats.text(at("scene")), "pile:50");
    EXPECT_EQ(stats.number(at("bodies")), 55);
    EXPECT_EQ(stats.number(at("steps")), 20);
    EXPECT_EQ(stats.number(at("dt")), 1.0 / 60);
    EXPECT_EQ(stats.number(at("threads")), 2);
    EXPECT_GE(stats.number(at("threads_used")), 1);
    EXPECT_LE(stats.number(at("threads_used")), 2);
    EXPECT_EQ(stats.size(at("energy_gained_steps")), 2u);
    EXPECT_EQ(stats.size(at("momentum")), 3u);
    EXPECT_EQ(stats.size(at("angular_momentum")), 3u);
    EXPECT_EQ(stats.size(at("step_error_m")), 5u);
    for (const char* key : {"rms", "last", "greatest"})
        EXPECT_GT(stats.number(stats.find(at("step_error_m"), key)), 0) << key;
    EXPECT_EQ(stats.size(at("ms_per_step")), 4u);
    for (const char* key : {"mean", "median", "p99", "greatest"})
        EXPECT_GT(stats.number(stats.find(at("ms_per_step"), key)), 0) << key;
    EXPECT_EQ(stats.text(at("state_hash")).size(), 16u);

    EXPECT_EQ(stats.size(at("dials")), dials().size());
    EXPECT_EQ(stats.number(stats.find(at("dials"), "substeps")), 6);
    EXPECT_EQ(stats.text(stats.find(at("dials"), "dt")), "1/60");

    Names effects;
    for (auto node = stats.first(at("effects")); effects.size() < stats.size(at("effects"));
         node = stats.next(node))
        effects.emplace_back(stats.text(node));
    EXPECT_EQ(effects,
              (Names{"motion", "gravity", "rotation", "gyroscopic", "contact", "friction", "seams",
                     "sleeping"}));
    const auto entry = stats.first(at("effect_ledger"));
    EXPECT_EQ(stats.size(at("effect_ledger")), static_cast<std::size_t>(kEffects));
    EXPECT_EQ(stats.text(stats.find(entry, "effect")), "motion");
    for (const char* key : {"callers", "ms", "rows", "bytes"})
        EXPECT_EQ(stats.kind(stats.find(entry, key)), JsonKind::number) << key;
    EXPECT_EQ(stats.kind(stats.find(entry, "stages")), JsonKind::array);
    const auto stage = stats.first(at("stages"));
    EXPECT_EQ(stats.text(stats.find(stage, "name")), "sleep_pairs");
    EXPECT_EQ(stats.kind(stats.find(stage, "ms_mean")), JsonKind::number);
    EXPECT_EQ(stats.kind(stats.find(stage, "ms_p99")), JsonKind::number);
}

// The numbers of a line of the final CSV, after id and name.
std::vector<double> numbers_of(const std::string& line)
{
    std::vector<double> numbers;
    std::istringstream cells(line);
    std::string cell;
    for (int i = 0; std::getline(cells, cell, ','); ++i) {
        if (i < 2) continue;
        numbers.push_back(0);
        std::from_chars(cell.data(), cell.data() + cell.size(), numbers.back());
    }
    return numbers;
}

TEST(RunStats, CountTheThreadsThatWorked)
{
    const auto used = [](const char* scene, const char* steps) {
        const Outcome outcome = run_throng(
            {"run", scene, "--threads", "3", "--steps", steps, "--quiet", "--stats", "-"});
        const JsonDocument stats(outcome.out, "stats");
        return stats.number(stats.find(JsonDocument::kRoot, "threads_used"));
    };
    EXPECT_EQ(used("pile:20", "0"), 0);
    EXPECT_EQ(used("pile:3000", "100"), 3);
}

TEST(Run, StatsGoToStandardOutputByADash)
{
    const Outcome outcome =
        run_throng({"run", "pile:20", "--steps", "2", "--quiet", "--stats", "-"});
    EXPECT_EQ(outcome.code, 0);
    const JsonDocument stats(outcome.out, "stats");
    EXPECT_EQ(stats.number(stats.find(JsonDocument::kRoot, "steps")), 2);
}

// A spring that the step cannot follow, by a textbook method that gains.
TEST(Run, WarnsOfEnergyWithoutStatsAndTellsItInQuietOnes)
{
    const TestFolder folder;
    const std::string scene =
        folder.write("spring.json",
                     R"({"throng": 1, "gravity": [0, 0, 0], "settings": {"integrator": "euler"},
            "bodies": [{"name": "a", "shape": null, "mass": 1, "inertia": [1, 1, 1, 0, 0, 0],
                        "position": [1, 0, 0]}],
            "springs": [{"a": "a", "b": null, "stiffness": 400}]})");
    const Names words = {"run", scene, "--steps", "200"};
    EXPECT_NE(run_throng(words).err.find("warning: energy grew by"), std::string::npos);
    Names quiet = words;
    for (const char* word : {"--quiet", "--stats", "-"}) quiet.emplace_back(word);
    const Outcome outcome = run_throng(quiet);
    EXPECT_EQ(outcome.err.find("energy"), std::string::npos);
    const JsonDocument stats(outcome.out, "stats");
    const auto warnings = stats.find(JsonDocument::kRoot, "warnings");
    ASSERT_EQ(stats.size(warnings), 2u);  // the other one is of the spring
    const auto last = stats.next(stats.first(warnings));
    EXPECT_EQ(stats.text(last).find("energy grew by"), 0u);
}

TEST(RunFinal, ReadsBackToTheSameBits)
{
    const TestFolder folder;
    ASSERT_EQ(run_throng({"run", "pile:30", "--steps", "40", "--final", folder / "f.csv"}).code, 0);
    World world(make_scene("pile", 30));
    world.step(40);

    std::istringstream file(folder.read("f.csv"));
    std::string line;
    std::getline(file, line);
    EXPECT_EQ(line, "id,name,px,py,pz,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz");
    for (const BodyId body : world.bodies()) {
        ASSERT_TRUE(std::getline(file, line));
        EXPECT_EQ(line.find(std::to_string(body.index) + ',' + world.name(body) + ','), 0u);
        const Pose pose = world.pose(body);
        const Quat& q = pose.orientation;
        const Vec3 p = pose.position, v = world.velocity(body), w = world.angular_velocity(body);
        const std::vector<double> wanted = {p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z(),
                                            v.x(), v.y(), v.z(), w.x(), w.y(), w.z()};
        const std::vector<double> read = numbers_of(line);
        ASSERT_EQ(read.size(), wanted.size());
        EXPECT_EQ(std::memcmp(read.data(), wanted.data(), wanted.size() * sizeof(double)), 0)
            << line;
    }
    EXPECT_FALSE(std::getline(file, line));
}

TEST(RunFinal, QuotesNames)
{
    const TestFolder folder;
    const std::string scene = folder.write("ball.json", kBall);
    ASSERT_EQ(run_throng({"run", scene, "--steps", "0", "--final", folder / "f.csv"}).code, 0);
    EXPECT_NE(folder.read("f.csv").find("\n0,\"a, \"\"b\"\"\",0,0,0,1,0,0,0,0,0,0,0,0,0\n"),
              std::string::npos);
}

TEST(Run, IsTheSameOnAnyNumberOfThreads)
{
    Names hashes;
    for (const char* threads : {"1", "2", "5"}) {
        const std::string out =
            run_throng({"run", "pile:200", "--steps", "60", "--threads", threads}).out;
        EXPECT_NE(out.find(std::string("\nthreads: ") + threads + '\n'), std::string::npos);
        hashes.push_back(out.substr(out.find("state_hash")));
    }
    EXPECT_EQ(hashes[0], hashes[1]);
    EXPECT_EQ(hashes[0], hashes[2]);
}

TEST(Run, BadScenesAreRefusedWithTheirPlaceAndNothingIsWritten)
{
    const TestFolder folder;
    const Names outputs = {"--stats",        folder / "s.json", "--final",
                           folder / "f.csv", "--out",           folder / "r.h5"};
    const std::vector<std::pair<std::string, std::string>> scenes = {
        {"syntax.json", "{\n  \"throng\": 1,\n}"},
        {"meaning.json",
         "{\"throng\": 1, \"shapes\": {\"ball\": {\"sphere\": {\"radius\": -1}}}, \"bodies\": []}"},
        {"empty.json", ""},
    };
    for (const auto& [name, text] : scenes) {
        Names words = {"run", folder.write(name, text)};
        words.insert(words.end(), outputs.begin(), outputs.end());
        const Outcome refused = run_throng(words);
        EXPECT_EQ(refused.code, 2);
        EXPECT_EQ(refused.out, "");
        EXPECT_NE(refused.err.find(name + ':'), std::string::npos) << refused.err;
        EXPECT_NE(refused.err.find(": error: "), std::string::npos) << refused.err;
    }
    EXPECT_EQ(folder.files(), (Names{"empty.json", "meaning.json", "syntax.json"}));
}

// What only shows once a shape is made: no voxel of this size fits into any memory.
TEST(Run, MeshesRefusedAtBuildingAreToldWithTheirPlace)
{
    const TestFolder folder;
    write_ring(folder);
    const std::string scene = folder.write("s.json", R"({"throng": 1,
  "shapes": {
    "ring": {"mesh": {"file": "ring.obj", "voxel_size": 1e-5}}},
  "bodies": [{"shape": "ring"}]})");
    const Outcome refused = run_throng({"run", scene, "--steps", "0"});
    EXPECT_EQ(refused.code, 2);
    EXPECT_NE(
        refused.err.find("s.json:3:31: error: shapes.ring.mesh.file: wanted a mesh that can "),
        std::string::npos)
        << refused.err;
    EXPECT_NE(refused.err.find("at voxel size 1e-05"), std::string::npos) << refused.err;
}

TEST(Run, OutputsThatCannotBeWrittenAreRefusedBeforeTheRun)
{
    const TestFolder folder;
    const std::string scene = folder.write("ball.json", kBall);
    for (const Names& outputs :
         {Names{"--stats", folder / "no/s.json"},
          Names{"--final", folder / "s.json", "--out", folder / "no/r.h5"},
          Names{"--stats", folder / "."}, Names{"--stats", folder / "x", "--final", folder / "x"},
          Names{"--stats", scene}}) {
        Names words = {"run", scene, "--steps", "1000000000"};
        words.insert(words.end(), outputs.begin(), outputs.end());
        const Outcome refused = run_throng(words);
        EXPECT_EQ(refused.code, 2);
        EXPECT_EQ(refused.err.find("error: "), 0u) << refused.err;
        EXPECT_EQ(folder.files(), Names{"ball.json"});
    }
    EXPECT_EQ(folder.read("ball.json"), kBall);
}

TEST(Run, AnEarlierFileIsReplaced)
{
    const TestFolder folder;
    const std::string scene = folder.write("ball.json", kBall);
    folder.write("s.json", "old");
    ASSERT_EQ(run_throng({"run", scene, "--steps", "1", "--stats", folder / "s.json"}).code, 0);
    EXPECT_EQ(folder.read("s.json").find("{\n"), 0u);
    EXPECT_EQ(folder.files(), (Names{"ball.json", "s.json"}));
}

TEST(Run, StandardOutputCanBeAFileOfTheRun)
{
    const Outcome done = run_throng({"run", "cradle", "--steps", "1", "--stats", "/dev/stdout"});
    EXPECT_EQ(done.code, 0);
    EXPECT_NO_THROW(JsonDocument(done.out, "standard output"));
}

TEST(Run, AFullDiskIsSaid)
{
    for (const char* option : {"--stats", "--final", "--out"}) {
        const Outcome refused =
            run_throng({"run", "pile:300", "--steps", "1", option, "/dev/full"});
        EXPECT_EQ(refused.code, 2) << option;
        EXPECT_EQ(refused.err.find(std::string("error: ") + option + ": /dev/full: "), 0u)
            << refused.err;
        EXPECT_EQ(count_of(refused.err, "\n"), 1u) << refused.err;
    }
}

// A small disk of its own, where this may be had.
class SmallDisk {
public:
    SmallDisk(std::string folder, const char* size) : folder_(std::move(folder))
    {
        std::filesystem::create_directory(folder_);
        mounted_ = ::mount("tmpfs", folder_.c_str(), "tmpfs", 0, size) == 0;
    }
    ~SmallDisk()
    {
        if (mounted_) ::umount(folder_.c_str());
    }
    bool is_there() const { return mounted_; }

private:
    std::string folder_;
    bool mounted_ = false;
};

TEST(Run, AFullDiskKeepsItsFramesAndTheOtherOutputs)
{
    const TestFolder folder;
    const SmallDisk disk(folder / "disk", "size=4m");
    if (!disk.is_there()) GTEST_SKIP() << "no disk can be mounted here";
    const Outcome done = run_throng({"run", "pile:1000", "--steps", "150", "--every", "1", "--out",
                                     folder / "disk/r.h5", "--final", folder / "f.csv", "--stats",
                                     folder / "s.json", "--quiet"});
    EXPECT_EQ(done.code, 2);
    EXPECT_EQ(count_of(done.err, "\n"), 1u) << done.err;
    EXPECT_NE(done.err.find("No space left on device; its first "), std::string::npos) << done.err;
    EXPECT_GT(std::filesystem::file_size(folder / "disk/r.h5"), 1'000'000u);
    EXPECT_EQ(count_of(folder.read("f.csv"), "\n"), 1006u);
    const JsonDocument stats(folder.read("s.json"), "s.json");
    EXPECT_EQ(stats.number(stats.find(JsonDocument::kRoot, "steps")), 150);
    const auto warnings = stats.find(JsonDocument::kRoot, "warnings");
    ASSERT_EQ(stats.size(warnings), 1u);
    EXPECT_EQ(stats.text(stats.first(warnings)).find("--out: "), 0u);
}

TEST(Run, OneOutputThatFailsLeavesTheOthers)
{
    const TestFolder folder;
    for (const char* option : {"--final", "--stats", "--trace"}) {
        Names words = {"run", "pile:300", "--steps", "1", "--quiet", option, "/dev/full"};
        std::vector<std::string> others;
        for (const char* other : {"--final", "--stats", "--trace"}) {
            if (std::string_view(other) == option) continue;
            others.push_back(folder / (std::string(option) + other));
            words.insert(words.end(), {other, others.back()});
        }
        const Outcome done = run_throng(words);
        EXPECT_EQ(done.code, 2) << option;
        EXPECT_EQ(done.err.find(std::string("error: ") + option + ": /dev/full: cannot be written"),
                  0u)
            << done.err;
        for (const std::string& other : others)
            EXPECT_GT(std::filesystem::file_size(other), 100u) << other;
    }
}

TEST(Run, AnInterruptEndsTheStepAndKeepsTheFiles)
{
    for (const int signal : {SIGINT, SIGTERM}) {
        const TestFolder folder;
        const Outcome ended =
            run_throng({"run", "pile:100", "--steps", "1000000000", "--stats", folder / "s.json",
                        "--final", folder / "f.csv", "--out", folder / "r.h5"},
                       [&](pid_t process) {
                           // Files appear once interrupts are noted.
                           while (folder.files().size() < 3)
                               std::this_thread::sleep_for(std::chrono::milliseconds(10));
                           std::this_thread::sleep_for(std::chrono::milliseconds(500));
                           ::kill(process, signal);
                       });
        EXPECT_EQ(ended.code, 130) << ended.err;
        EXPECT_EQ(folder.files(), (Names{"f.csv", "r.h5", "s.json"}));
        const JsonDocument stats(folder.read("s.json"), "s.json");
        const double steps = stats.number(stats.find(JsonDocument::kRoot, "steps"));
        EXPECT_GT(steps, 0);
        EXPECT_LT(steps, 1e9);
    }
}

// Steps of this scene take longer than anybody waits.
TEST(Run, AnInterruptWithinALongStepKeepsTheFrames)
{
    const TestFolder folder;
    const Outcome ended =
        run_throng({"run", "pile:200", "--set", "overlap=subdivide", "--set", "dt=1", "--stats",
                    folder / "s.json", "--final", folder / "f.csv", "--trace", folder / "t.json",
                    "--out", folder / "r.h5"},
                   [&](pid_t process) {
                       while (folder.files().size() < 4)
                           std::this_thread::sleep_for(std::chrono::milliseconds(10));
                       std::this_thread::sleep_for(std::chrono::milliseconds(500));
                       ::kill(process, SIGINT);
                   });
    EXPECT_EQ(ended.code, 130) << ended.err;
    EXPECT_NE(ended.err.find("interrupted within a step"), std::string::npos) << ended.err;
    EXPECT_EQ(folder.files(), Names{"r.h5"});
    EXPECT_GT(std::filesystem::file_size(folder / "r.h5"), 10'000u);
}

TEST(Run, AQuarantinedBodyIsNamedAndOutputsAreWritten)
{
    const TestFolder folder;
    // Spun beyond what the explicit update can follow.
    const std::string scene = folder.write("fast.json", R"({
      "throng": 1, "gravity": [0, 0, 0], "settings": {"gyroscopic": "explicit"},
      "shapes": {"plank": {"box": {"half_extents": [1, 0.3, 0.1]}}},
      "bodies": [
        {"name": "bolt", "shape": "plank", "angular_velocity": [1e14, 2e14, 3e14]},
        {"name": "calm", "shape": "plank", "position": [0, 9, 0], "mask": 0}
      ]
    })");
    const Outcome ended = run_throng(
        {"run", scene, "--steps", "20", "--stats", folder / "s.json", "--final", folder / "f.csv"});
    EXPECT_EQ(ended.code, 1) << ended.err;
    EXPECT_NE(ended.err.find("1 body was"), std::string::npos) << ended.err;
    EXPECT_NE(ended.err.find("0 bolt"), std::string::npos) << ended.err;
    EXPECT_EQ(folder.files(), (Names{"f.csv", "fast.json", "s.json"}));
    const JsonDocument stats(folder.read("s.json"), "s.json");
    EXPECT_EQ(stats.number(stats.find(JsonDocument::kRoot, "bodies_quarantined")), 1);
}

TEST(Run, WarningsGoToStandardErrorUnlessQuiet)
{
    const Names words = {"run",   "pile:10",    "--steps", "1",
                         "--set", "solver=pgs", "--set",   "contact_rate=0.2"};
    const Outcome warned = run_throng(words);
    EXPECT_EQ(warned.code, 0);
    EXPECT_NE(warned.err.find("warning: contact_rate: unused"), std::string::npos) << warned.err;
    Names quiet = words;
    quiet.push_back("--quiet");
    const Outcome silent = run_throng(quiet);
    EXPECT_EQ(silent.code, 0);
    EXPECT_EQ(silent.err + silent.out, "");
}

TEST(Run, WarnsOfWhatAMeshLosesAndTellsItInQuietStats)
{
    const TestFolder folder;
    write_ring(folder);
    const std::string scene = folder.write("ring.json", R"({"throng": 1,
        "shapes": {"ring": {"mesh": {"file": "ring.obj", "nonconvex": "hull"}}},
        "bodies": [{"shape": "ring"}, {"shape": "ring", "position": [9, 0, 0]}]})");
    const Outcome warned = run_throng({"run", scene, "--steps", "0"});
    EXPECT_EQ(warned.code, 0);
    EXPECT_EQ(count_of(warned.err, "warning: shape ring: taken as one hull: "), 1u) << warned.err;
    const Outcome quiet = run_throng({"run", scene, "--steps", "0", "--quiet", "--stats", "-"});
    EXPECT_EQ(quiet.err, "");
    EXPECT_NE(quiet.out.find("\"shape ring: taken as one hull: "), std::string::npos) << quiet.out;
}

TEST(Run, ProgressIsForTerminalsAlone)
{
    const Names words = {"run", "pile:100", "--steps", "1500", "--set", "sleep=off"};
    const Outcome piped = run_throng(words);
    EXPECT_EQ(piped.code, 0);
    EXPECT_EQ(piped.err, "");
    const Outcome shown = run_throng_on_terminal(words);
    EXPECT_EQ(shown.code, 0);
    EXPECT_NE(shown.err.find("/1500 steps"), std::string::npos);
    EXPECT_EQ(shown.out.substr(shown.out.find("state_hash")),
              piped.out.substr(piped.out.find("state_hash")));
}

TEST(RunEvents, AreALineEach)
{
    const TestFolder folder;
    const Outcome done = run_throng({"run", "bouncing:4", "--steps", "120", "--quiet", "--events",
                                     folder / "e.csv", "--hit-speed", "5"});
    ASSERT_EQ(done.code, 0) << done.err;
    std::istringstream lines(folder.read("e.csv"));
    std::string line;
    std::getline(lines, line);
    EXPECT_EQ(line, "step,event,a,b,part_a,part_b,speed,px,py,pz,nx,ny,nz");
    int begun = 0, ended = 0, hits = 0;
    while (std::getline(lines, line)) {
        EXPECT_EQ(std::count(line.begin(), line.end(), ','), 12) << line;
        begun += line.find(",begin,") != std::string::npos ? 1 : 0;
        ended += line.find(",end,") != std::string::npos ? 1 : 0;
        hits += line.find(",hit,") != std::string::npos ? 1 : 0;
    }
    // Each of four balls bounces once in two seconds.
    EXPECT_EQ(begun, 4);
    EXPECT_EQ(ended, 4);
    EXPECT_EQ(hits, 4);
}

TEST(RunEvents, ASpeedThatNobodyAskedForOrThatIsNoneIsRefused)
{
    const TestFolder folder;
    const Outcome alone = run_throng({"run", "bouncing:4", "--hit-speed", "5"});
    EXPECT_EQ(alone.code, 2);
    EXPECT_NE(alone.err.find("give --events as well"), std::string::npos) << alone.err;
    for (const char* speed : {"0", "-1", "fast", "inf"}) {
        const Outcome done =
            run_throng({"run", "bouncing:4", "--events", folder / "e.csv", "--hit-speed", speed});
        EXPECT_EQ(done.code, 2) << speed;
        EXPECT_NE(done.err.find("--hit-speed: wanted a speed above 0"), std::string::npos);
    }
    const Outcome same = run_throng(
        {"run", "bouncing:4", "--events", folder / "e.csv", "--final", folder / "e.csv"});
    EXPECT_EQ(same.code, 2);
}

}  // namespace
}  // namespace throng
