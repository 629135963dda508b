// Golden: small scenes against what they did when their files were written.
//
// A change that means to move one runs tools/update_golden.sh and says why in the same commit.
#include "throng/catalog.hpp"
#include "throng/world.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace throng {
namespace {

struct GoldenScene {
    const char* name;
    int size;
};
constexpr GoldenScene kGolden[] = {{"pile", 100},  {"stacks", 50}, {"tumbler", 60}, {"hulls", 60},
                                   {"meshes", 40}, {"crowd", 60},  {"cradle", 5},   {"arch", 9}};
constexpr int kEvery = 60, kTimes = 4;

// A line every 60 steps: step, fingerprint, energy.
std::string told(const GoldenScene& of, int threads)
{
    World world(make_scene(of.name, of.size), threads);
    std::string text;
    for (int i = 0; i <= kTimes; ++i) {
        if (i > 0) world.step(kEvery);
        const Measures measures = world.measure();
        std::array<char, 128> line{};
        std::snprintf(line.data(), line.size(), "%d %s %.9e\n", i * kEvery,
                      world.state_hash().c_str(),
                      measures.kinetic_energy + measures.potential_energy);
        text += line.data();
    }
    return text;
}

class Golden : public ::testing::TestWithParam<GoldenScene> { };

TEST_P(Golden, SceneDoesWhatItDid)
{
    const auto file =
        std::filesystem::path(THRONG_GOLDEN) / (std::string(GetParam().name) + ".txt");
    const std::string now = told(GetParam(), 2);
    // Tests change no environment.
    if (std::getenv("THRONG_UPDATE_GOLDEN") != nullptr) {  // NOLINT(concurrency-mt-unsafe)
        std::filesystem::create_directories(file.parent_path());
        std::ofstream(file) << now;
        return;
    }
    std::ifstream in(file);
    ASSERT_TRUE(in) << "no golden file " << file << "; tools/update_golden.sh writes it";
    std::stringstream before;
    before << in.rdbuf();
    EXPECT_EQ(now, before.str()) << "tools/update_golden.sh takes this for the new truth";
}

INSTANTIATE_TEST_SUITE_P(Scenes, Golden, ::testing::ValuesIn(kGolden), [](const auto& test) {
    return std::string(test.param.name);
});

}  // namespace
}  // namespace throng
