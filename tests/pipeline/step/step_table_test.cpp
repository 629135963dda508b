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
void fourth(const Pairs&, const StageData<const Poses, Velocities, const Masses>& data)
{
    data.get<Velocities>().linear = data.get<const Poses>().position;
}
template <class Real>
void fifth(const ConvexContacts<Real>&, Poses&)
{ }

TEST(Stage, ReadsItsConstParametersAndWritesTheOthers)
{
    constexpr Stage<float> row = stage<float, second>({Effect::contact});
    EXPECT_EQ(row.reads.bits, (data_set<float, Velocities> | data_set<float, Masses>).bits);
    EXPECT_EQ(row.writes.bits, (data_set<float, Bounds>).bits);
    EXPECT_TRUE(row.called_for_by.has(Effect::contact));
}

TEST(Stage, ReadsAndWritesWhatAParameterOfSeveralHolds)
{
    constexpr Stage<float> row = stage<float, fourth>({Effect::contact});
    EXPECT_EQ(row.reads.bits,
              (data_set<float, Pairs> | data_set<float, Poses> | data_set<float, Masses>).bits);
    EXPECT_EQ(row.writes.bits, (data_set<float, Velocities>).bits);
    StepData<float> data;
    std::get<Poses>(data).position = {Vec3(1, 2, 3)};
    row.run(data);
    EXPECT_EQ(std::get<Velocities>(data).linear, std::get<Poses>(data).position);
}

TEST(Stage, IsCalledWhatItsFunctionIsCalled)
{
    EXPECT_EQ((stage<float, first>({}).name), "first");
    EXPECT_EQ((stage<double, fifth<double>>({}).name), "fifth");
    EXPECT_EQ((function_name<&StageData<Poses, const Pairs>::get<Poses>>()), "get");
}

TEST(Stage, WaitsForWhoeverTouchesItsData)
{
    constexpr auto a = stage<float, first>({});
    constexpr auto b = stage<float, second>({});
    constexpr auto c = stage<float, third>({});
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
    stage<double, prescribe_velocities>({}).run(data);
    EXPECT_EQ(std::get<Velocities>(data).linear[0], Vec3(5, 5, 5));
    EXPECT_EQ(std::get<Velocities>(data).linear[1], Vec3(2, 5, -1));
}

TEST(StepTable, HoldsTheRowsThatAnEffectCallsForAndNoOther)
{
    EXPECT_TRUE(stages_for<float>({}, {}).empty());
    EXPECT_EQ(names_of(stages_for<float>({Effect::motion}, {})),
              (std::vector<std::string>{"integrate_poses", "quarantine_bodies"}));
    EXPECT_EQ(names_of(stages_for<float>({Effect::drive}, {})),
              (std::vector<std::string>{"prescribe_velocities"}));
    for (const auto& row : stages_for<float>({Effect::motion, Effect::contact}, {}))
        EXPECT_TRUE(row.called_for_by.has(Effect::motion)
                    || row.called_for_by.has(Effect::contact));
}

TEST(StepTable, ContactIsSolvedByTheSolverAndResponseThatAreChosenAlone)
{
    const std::vector<std::string> solvers = {"solve_soft_step", "solve_pgs", "solve_direct",
                                              "solve_penalty", "solve_kinematic"};
    const auto check = [&](const std::string& wanted, Solver solver, Response response) {
        Settings settings;
        settings.solver = solver;
        settings.response = response;
        for (const std::string& name : names_of(stages_for<float>({Effect::contact}, settings))) {
            const bool solves = std::count(solvers.begin(), solvers.end(), name) > 0;
            EXPECT_TRUE(!solves || name == wanted) << name;
        }
        const auto rows = stages_for<float>({Effect::contact}, settings);
        const auto row = std::find_if(rows.begin(), rows.end(),
                                      [&](const auto& stage) { return stage.name == wanted; });
        ASSERT_NE(row, rows.end()) << wanted;
        ASSERT_NE(row->passes, nullptr) << wanted;
        EXPECT_FALSE(row->passes().empty()) << wanted;
    };
    check("solve_soft_step", Solver::soft_step, Response::impulse);
    check("solve_pgs", Solver::pgs, Response::impulse);
    check("solve_direct", Solver::direct, Response::impulse);
    check("solve_penalty", Solver::direct, Response::penalty);
    check("solve_kinematic", Solver::pgs, Response::kinematic);
}

TEST(StepTable, StrainIsMeasuredWhereItMayEscalate)
{
    const auto measures = [](const Settings& settings) {
        const std::vector<std::string> names =
            names_of(stages_for<float>({Effect::contact}, settings));
        return std::count(names.begin(), names.end(), "measure_strain") == 1;
    };
    Settings off, direct;
    off.escalation = Escalation::off;
    direct.solver = Solver::direct;
    EXPECT_TRUE(measures({}));
    EXPECT_FALSE(measures(off));
    EXPECT_FALSE(measures(direct));
}

TEST(StepTable, PassesOfEachStageAreNamedOnce)
{
    for (const auto& row : step_table<float>()) {
        if (row.passes == nullptr) continue;
        std::vector<std::string_view> names;
        for (const PassRow& pass : row.passes()) {
            EXPECT_EQ(std::count(names.begin(), names.end(), pass.name), 0) << pass.name;
            EXPECT_FALSE(pass.when.empty()) << pass.name;
            EXPECT_FALSE(pass.called_for_by.empty()) << pass.name;
            names.push_back(pass.name);
        }
    }
}

TEST(StepTable, SolidsAreCollidedWhereAWayOfTakingThemIsCalledForAndNowhereElse)
{
    const auto has_solids = [](Set<Effect> effects) {
        const std::vector<std::string> names = names_of(stages_for<float>(effects, {}));
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
