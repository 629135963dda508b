// Step table: what each row reads and writes, as its signature says, and who calls for it.
#include "pipeline/step/step_table.hpp"

#include "pipeline/step/effects.hpp"
#include "pipeline/step/stages.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

std::vector<std::string> names_of(const std::vector<Stage<float>>& stages)
{
    std::vector<std::string> names;
    for (const auto& stage : stages) names.emplace_back(stage.name);
    return names;
}

void first(const Poses&, Velocities&) { }
void second(const Velocities&, const Masses&, Bounds&) { }
void third(const Poses&, Pairs&) { }

TEST(Stage, ReadsItsConstParametersAndWritesTheOthers)
{
    constexpr Stage<float> row = stage<float, second>("second", {Effect::contact});
    EXPECT_EQ(row.reads.bits, (data_set<float, Velocities> | data_set<float, Masses>).bits);
    EXPECT_EQ(row.writes.bits, (data_set<float, Bounds>).bits);
    EXPECT_TRUE(row.called_for_by.has(Effect::contact));
}

TEST(Stage, WaitsForWhoeverTouchesItsData)
{
    constexpr auto a = stage<float, first>("first", {});
    constexpr auto b = stage<float, second>("second", {});
    constexpr auto c = stage<float, third>("third", {});
    EXPECT_TRUE(b.waits_for(a));   // reads what a writes
    EXPECT_TRUE(a.waits_for(b));   // writes what b reads
    EXPECT_TRUE(a.waits_for(a));   // writes what it writes
    EXPECT_FALSE(c.waits_for(a));  // both only read poses
    EXPECT_FALSE(c.waits_for(b));
}

TEST(Stage, RunsItsFunctionOnTheDataOfTheStep)
{
    StepData<double> data;
    std::get<PrescribedVelocities>(data).body = {1};
    std::get<PrescribedVelocities>(data).velocity = {{2.0, std::nan(""), -1.0}};
    std::get<BodyStates>(data).awake = {1, 1};
    std::get<Velocities>(data).linear = {Vec3(5, 5, 5), Vec3(5, 5, 5)};
    stage<double, prescribe_velocities>("prescribe_velocities", {}).run(data);
    EXPECT_EQ(std::get<Velocities>(data).linear[0], Vec3(5, 5, 5));
    EXPECT_EQ(std::get<Velocities>(data).linear[1], Vec3(2, 5, -1));
}

TEST(StepTable, HoldsTheRowsThatAnEffectCallsForAndNoOther)
{
    EXPECT_TRUE(stages_for<float>({}).empty());
    EXPECT_EQ(names_of(stages_for<float>({Effect::motion})),
              (std::vector<std::string>{"integrate_poses", "quarantine_bodies"}));
    EXPECT_EQ(names_of(stages_for<float>({Effect::drive})),
              (std::vector<std::string>{"prescribe_velocities"}));
    for (const auto& row : stages_for<float>({Effect::motion, Effect::contact}))
        EXPECT_TRUE(row.called_for_by.has(Effect::motion)
                    || row.called_for_by.has(Effect::contact));
}

TEST(StepTable, SolidsAreCollidedWhereAWayOfTakingThemIsCalledForAndNowhereElse)
{
    const auto has_solids = [](Set<Effect> effects) {
        const std::vector<std::string> names = names_of(stages_for<float>(effects));
        return std::count(names.begin(), names.end(), "collide_solids") == 1;
    };
    EXPECT_FALSE(has_solids({Effect::motion, Effect::contact, Effect::mesh_contact}));
    for (const Effect way : {Effect::voxel_contact, Effect::sphere_contact, Effect::image_contact})
        EXPECT_TRUE(has_solids({Effect::motion, Effect::contact, way})) << name_of(way);
}

TEST(StepTable, IsOneTextForFloatAndDouble)
{
    const auto in_float = step_table<float>();
    const auto in_double = step_table<double>();
    ASSERT_EQ(in_float.size(), in_double.size());
    for (std::size_t i = 0; i < in_float.size(); ++i) {
        EXPECT_EQ(in_float[i].name, in_double[i].name);
        EXPECT_EQ(in_float[i].reads.bits, in_double[i].reads.bits);
        EXPECT_EQ(in_float[i].writes.bits, in_double[i].writes.bits);
    }
}

TEST(StepTable, NamesEachRowOnce)
{
    std::vector<std::string_view> names;
    for (const auto& row : step_table<float>()) {
        EXPECT_EQ(std::count(names.begin(), names.end(), row.name), 0) << row.name;
        EXPECT_FALSE(row.called_for_by.empty()) << row.name;
        names.push_back(row.name);
    }
}

}  // namespace
}  // namespace throng
