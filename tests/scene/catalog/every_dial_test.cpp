// Every dial: each scene of the catalogue takes some steps with each value of each dial, and no
// body is lost. Worth most where checks and sanitizers look on.
#include "scene/rules/scene_check.hpp"
#include "throng/catalog.hpp"
#include "throng/dials.hpp"
#include "throng/world.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>

namespace throng {
namespace {

constexpr int kSteps = 3;

// Of dials that take numbers: the ends of their ranges, as far as a few bodies can be run there,
// and something between.
const std::map<std::string_view, std::vector<std::string_view>>& numbers()
{
    static const std::map<std::string_view, std::vector<std::string_view>> kNumbers = {
        {"dt", {"1e-6", "1/240", "1/30", "1"}},
        {"substeps", {"1", "3", "50"}},
        {"iterations", {"1", "7", "100"}},
        {"relax_iterations", {"1", "3", "100"}},
        {"contact_rate", {"0.01", "1", "fixed:30"}},
        {"push_limit", {"0", "0.1", "1000"}},
        {"direct_limit", {"1", "3", "1000"}},
        {"penalty_stiffness", {"1", "1e5", "1e12"}},
        {"penalty_damping", {"0", "10", "1e9"}},
        {"voxel_size", {"0.2"}},
        {"image_resolution", {"4", "64"}},
        {"sphere_levels", {"1", "3"}},
        {"max_parts", {"1", "4"}},
        {"halvings", {"1", "8"}},
        {"toi_tolerance", {"1.2e-7", "0.02"}},
        {"effects_error", {"0", "1"}},
        {"rest_force", {"1e-6", "1"}},
    };
    return kNumbers;
}

std::vector<std::string> values_of(const Dial& dial)
{
    std::vector<std::string> values;
    for (const Choice& choice : dial.choices)
        if (choice.available) values.emplace_back(choice.text);
    if (const auto some = numbers().find(dial.name); some != numbers().end())
        for (const std::string_view value : some->second) values.emplace_back(value);
    return values;
}

bool is_finite(const World& world, BodyId body)
{
    const Pose pose = world.pose(body);
    return pose.position.allFinite() && pose.orientation.coeffs().allFinite()
        && world.velocity(body).allFinite() && world.angular_velocity(body).allFinite();
}

bool has_moving_meshes(const Scene& scene) { return !World(scene).solids().empty(); }

bool is_of_meshes(std::string_view dial)
{
    constexpr std::string_view kOfMeshes[] = {"nonconvex", "voxel_size", "image_resolution",
                                              "sphere_levels", "max_parts"};
    return std::find(std::begin(kOfMeshes), std::end(kOfMeshes), dial) != std::end(kOfMeshes);
}

void expect_sound(Scene scene, std::string_view dial, const std::string& value)
{
    const std::string what = std::string(dial) + '=' + value;
    ASSERT_EQ(set_dial(scene.settings, dial, value), "") << what;
    std::optional<World> made;
    try {
        made.emplace(scene);
    } catch (const SceneRefused& refused) {
        // A mesh may be too thin, or too large, for what is asked.
        EXPECT_TRUE(is_of_meshes(dial)) << what << ": " << refused.what();
        return;
    }
    World& world = *made;
    world.step(kSteps);
    EXPECT_EQ(world.report().bodies_quarantined, 0u) << what;
    for (const BodyId body : world.bodies())
        ASSERT_TRUE(is_finite(world, body)) << what << ", body " << body.index;
    EXPECT_EQ(world.state_hash().size(), 16u);
}

// The way that a dial of meshes is for.
void take_way_of(std::string_view dial, Settings& settings)
{
    if (dial == "image_resolution") settings.nonconvex = NonConvex::depth_image;
    if (dial == "sphere_levels") settings.nonconvex = NonConvex::spheres;
    if (dial == "max_parts") settings.nonconvex = NonConvex::parts;
}

void run_all_values(Scene scene)
{
    // What a mesh becomes is made once for all values.
    scene.cache_folder = (std::filesystem::path(testing::TempDir()) / "throng_every_dial").string();
    const bool meshes = has_moving_meshes(scene);
    // By the scene's own values once, and not by each of its dials.
    expect_sound(scene, "dt", dial_value(scene.settings, "dt"));
    for (const Dial& dial : dials()) {
        if (is_of_meshes(dial.name) && !meshes) continue;
        Scene given = scene;
        take_way_of(dial.name, given.settings);
        const std::string own = dial_value(given.settings, dial.name);
        for (const std::string& value : values_of(dial))
            if (value != own) expect_sound(given, dial.name, value);
    }
}

TEST(EveryDial, HasValuesToTry)
{
    for (const Dial& dial : dials())
        EXPECT_GE(values_of(dial).size(), dial.available ? 1u : 0u) << dial.name;
}

TEST(EveryDial, LeavesAHeapSound) { run_all_values(make_scene("pile", 2)); }

class EverySceneAndDial : public testing::TestWithParam<CatalogEntry> { };

// A few bodies of each; what is made of meshes or of many cards takes a second a value as it is.
int size_of(const CatalogEntry& entry)
{
    constexpr std::string_view kSlow[] = {"knots",   "chain",      "peg",   "bolt",
                                          "terrain", "card_house", "meshes"};
    const bool slow = std::find(std::begin(kSlow), std::end(kSlow), entry.name) != std::end(kSlow);
    return std::max(entry.least, slow ? 1 : 5);
}

TEST_P(EverySceneAndDial, LeavesTheSceneSound)
{
    run_all_values(GetParam().make(size_of(GetParam()), kDefaultSeed));
}

INSTANTIATE_TEST_SUITE_P(Slow,
                         EverySceneAndDial,
                         testing::ValuesIn(catalog().begin(), catalog().end()),
                         [](const auto& entry) { return std::string(entry.param.name); });

}  // namespace
}  // namespace throng
