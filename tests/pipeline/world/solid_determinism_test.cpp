// Solid determinism: bodies that are not convex leave the same bits whichever way they are taken,
// on any number of threads, in order or by the graph, made anew or kept from an earlier run.
#include "pipeline/world/world_state.hpp"
#include "tests/support/solid_scenes.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <random>
#include <set>

namespace throng {
namespace {

constexpr int kSteps = 40;  // all have fallen on something by then

struct How {
    int threads = 1;
    bool in_order = false;
    std::string cache{};  // folder; empty: none
};

std::string hash_after(Scene scene, const How& how)
{
    scene.cache_folder = how.cache;
    World world(scene, how.threads);
    world.run_in_order(how.in_order);
    world.step(kSteps);
    EXPECT_GT(world.report().contacts, 5u);
    EXPECT_EQ(world.report().bodies_quarantined, 0u);
    return world.state_hash();
}

class SolidBits : public ::testing::TestWithParam<NonConvex> {
protected:
    Scene scene(Precision precision) const
    {
        Scene made = given::solids_on_voxels(GetParam());
        made.settings.precision = precision;
        return made;
    }
};

TEST_P(SolidBits, NeitherThreadsNorTheGraphChangeABit)
{
    std::set<std::string> seen;
    for (const Precision precision : {Precision::float_, Precision::double_}) {
        const Scene made = scene(precision);
        const std::string wanted = hash_after(made, {.in_order = true});
        seen.insert(wanted);
        for (const int threads : {1, 2, 5})
            EXPECT_EQ(hash_after(made, {.threads = threads}), wanted) << threads;
        EXPECT_EQ(hash_after(made, {.threads = 5, .in_order = true}), wanted);
    }
    EXPECT_EQ(seen.size(), 2u);
}

TEST_P(SolidBits, AColdCacheAndAWarmOneChangeNoBit)
{
    const auto folder = std::filesystem::temp_directory_path()
        / ("throng_bits_" + std::to_string(std::random_device{}()));
    const Scene made = scene(Precision::float_);
    const std::string wanted = hash_after(made, {});
    EXPECT_EQ(hash_after(made, {.threads = 2, .cache = folder.string()}), wanted) << "cold";
    const bool keeps = GetParam() == NonConvex::voxels || GetParam() == NonConvex::parts
        || GetParam() == NonConvex::spheres;
    EXPECT_EQ(std::filesystem::exists(folder) && !std::filesystem::is_empty(folder), keeps);
    EXPECT_EQ(hash_after(made, {.threads = 2, .cache = folder.string()}), wanted) << "warm";
    std::filesystem::remove_all(folder);
}

std::string name_of_way(const ::testing::TestParamInfo<NonConvex>& way)
{
    constexpr const char* kNames[] = {"voxels", "parts", "spheres", "depth_image", "hull"};
    return kNames[static_cast<std::size_t>(way.param)];
}

INSTANTIATE_TEST_SUITE_P(Ways,
                         SolidBits,
                         ::testing::Values(NonConvex::voxels,
                                           NonConvex::parts,
                                           NonConvex::spheres,
                                           NonConvex::depth_image,
                                           NonConvex::hull),
                         name_of_way);

TEST(SolidWays, EachLeadsItsOwnWay)
{
    std::set<std::string> seen;
    for (const NonConvex way : {NonConvex::voxels, NonConvex::parts, NonConvex::spheres,
                                NonConvex::depth_image, NonConvex::hull})
        seen.insert(hash_after(given::solids_on_voxels(way), {}));
    EXPECT_EQ(seen.size(), 5u);
}

}  // namespace
}  // namespace throng
