// Determinism: the same bits on any number of threads, in any order the graph takes, with any
// finder of pairs and any width of lanes, on every run.
#include "pipeline/world/world_state.hpp"
#include "throng/catalog.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <string>

namespace throng {
namespace {

struct CatalogScene {
    const char* name;
    int size;
};
constexpr CatalogScene kScenes[] = {{"pile", 300},   {"spheres", 300}, {"hulls", 200},
                                    {"stacks", 100}, {"tumbler", 200}, {"crowd", 200},
                                    {"meshes", 100}};

std::ostream& operator<<(std::ostream& out, const CatalogScene& scene)
{
    return out << scene.name << "_" << scene.size;
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr int kSteps = 40;
constexpr int kThreads[] = {3};
#else
constexpr int kSteps = 120;
constexpr int kThreads[] = {2, 3, 8};
#endif

struct How {
    int threads = 1;
    bool in_order = false;
    bool measured = false;
    BroadPhase finder = BroadPhase::auto_;
    Precision precision = Precision::float_;
};

std::string hash_after(const CatalogScene& of, const How& how, int steps = kSteps)
{
    Scene scene = make_scene(of.name, of.size);
    scene.settings.broadphase = how.finder;
    scene.settings.precision = how.precision;
    World world(scene, how.threads);
    world.run_in_order(how.in_order);
    for (int i = 0; i < steps; i += 20) {
        world.step(20);
        if (how.measured) static_cast<void>(world.measure());
    }
    return world.state_hash();
}

class SameBits : public ::testing::TestWithParam<CatalogScene> { };

TEST_P(SameBits, NeitherThreadsNorTheGraphChangeABit)
{
    const std::string wanted = hash_after(GetParam(), {.in_order = true});
    EXPECT_EQ(hash_after(GetParam(), {.threads = 1}), wanted);
    EXPECT_EQ(hash_after(GetParam(), {.threads = 2, .measured = true}), wanted);
    EXPECT_EQ(hash_after(GetParam(), {.threads = 3}), wanted);
    EXPECT_EQ(hash_after(GetParam(), {.threads = 8}), wanted);
    EXPECT_EQ(hash_after(GetParam(), {.threads = 8, .in_order = true}), wanted);
}

TEST_P(SameBits, NoFinderOfPairsChangesABit)
{
    const std::string wanted = hash_after(GetParam(), {.finder = BroadPhase::all_pairs});
    for (const BroadPhase finder :
         {BroadPhase::auto_, BroadPhase::grid, BroadPhase::embree, BroadPhase::sweep})
        EXPECT_EQ(hash_after(GetParam(), {.threads = 2, .finder = finder}), wanted)
            << static_cast<int>(finder);
}

INSTANTIATE_TEST_SUITE_P(Catalogue, SameBits, ::testing::ValuesIn(kScenes), [](const auto& test) {
    return std::string(test.param.name);
});

// As islands of some thousand bodies are: cut into slices, with passes one behind the other.
std::string hash_when_cut(const char* name, int size, int threads, Precision precision)
{
    Scene scene = make_scene(name, size);
    scene.settings.precision = precision;
    scene.settings.sleep = false;
    World world(scene, threads);
    state_of(world).get<ConstraintGraph>().split_rule = {.from = 550, .slice = 60};
    world.step(kSteps);
    std::size_t most = 0;
    for (const Batch& batch : state_of(world).get<Layout>().batches)
        most = std::max<std::size_t>(most, batch.slices);
    EXPECT_GT(most, 3u) << name;
    return world.state_hash();
}

TEST(Determinism, HoldsForIslandsThatAreCut)
{
    for (const auto& [name, size] : {std::pair("wall", 400), std::pair("spheres", 800)})
        for (const Precision precision : {Precision::float_, Precision::double_}) {
            const std::string wanted = hash_when_cut(name, size, 1, precision);
            for (const int threads : kThreads)
                EXPECT_EQ(hash_when_cut(name, size, threads, precision), wanted) << name;
        }
}

TEST(Determinism, HoldsInDoubleToo)
{
    const How in_double{.in_order = true, .precision = Precision::double_};
    const std::string wanted = hash_after({"pile", 200}, in_double, 60);
    EXPECT_EQ(hash_after({"pile", 200}, {.threads = 3, .precision = Precision::double_}, 60),
              wanted);
    EXPECT_NE(hash_after({"pile", 200}, {}, 60), wanted);
}

TEST(Determinism, TheHashFeelsOneBitOfOneBody)
{
    World a(make_scene("stacks", 20)), b(make_scene("stacks", 20));
    EXPECT_EQ(a.state_hash(), b.state_hash());
    const BodyId body = b.bodies()[7];
    Pose pose = b.pose(body);
    pose.position.x() = std::nextafter(pose.position.x(), 1e9);
    b.set_pose(body, pose);
    EXPECT_NE(a.state_hash(), b.state_hash());
}

// Run by the test below in a process of its own: the width is chosen once, when a program starts.
TEST(Lanes, DISABLED_PrintHashes)
{
    for (const Precision precision : {Precision::float_, Precision::double_})
        for (const CatalogScene& scene : {kScenes[0], kScenes[2], kScenes[4], kScenes[6]})
            std::printf("hash %s\n", hash_after(scene, {.precision = precision}, 60).c_str());
}

std::string hashes_with(const std::string& lanes)
{
    const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
    const std::string command = "THRONG_LANES=" + lanes + " '" + self
        + "' --gtest_also_run_disabled_tests --gtest_filter=Lanes.DISABLED_PrintHashes 2>&1";
    std::string hashes;
    FILE* const pipe = popen(command.c_str(), "r");
    if (pipe == nullptr) return {};
    std::array<char, 256> line{};
    while (std::fgets(line.data(), line.size(), pipe) != nullptr)
        if (const std::string text = line.data(); text.starts_with("hash ")) hashes += text;
    return pclose(pipe) == 0 ? hashes : std::string();
}

TEST(Lanes, LeaveTheSameBitsInWholeScenes)
{
    const std::string wanted = hashes_with("scalar");
    ASSERT_FALSE(wanted.empty());
    for (const char* const lanes : {"avx2", "avx512"}) {
        const bool here = lanes == std::string("avx2") ? __builtin_cpu_supports("avx2") != 0
                                                       : __builtin_cpu_supports("avx512f") != 0;
        EXPECT_EQ(here ? hashes_with(lanes) : wanted, wanted) << lanes;
    }
    EXPECT_EQ(hashes_with("abacus"), "");
}

}  // namespace
}  // namespace throng
