// Case trials: the error is the very figure of a case's line, by whatever dials are forced on it.
#include "cost/hard_cases/case_trials.hpp"

#include "throng/world.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace throng {
namespace {

HardCase case_that(void (*runs)(CaseBench&)) { return {"H0", "", runs, Fault::none}; }

Scene falling_ball(const CaseBench& bench, double gravity = -9.81)
{
    Scene scene = bench.scene();
    scene.gravity = Vec3(0, 0, gravity);
    scene.shapes.push_back({"ball", SphereShape{1}});
    scene.bodies.emplace_back().shape = 0;
    scene.settings.dt = 1.0 / 50;
    scene.settings.substeps = 1;
    scene.settings.precision = Precision::double_;
    scene.settings.integrator = Integrator::semi_implicit;
    return scene;
}

// Falls for a second: how far it is from the parabola, m. Semi-implicit steps are off by g h t / 2.
double falls(CaseBench& bench, double gravity = -9.81)
{
    double off = 0;
    bench.run(falling_ball(bench, gravity), 1, [&](World& world, double now) {
        off = std::abs(world.pose(world.bodies()[0]).position.z() - gravity * now * now / 2);
        return true;
    });
    return off;
}

void fall_and_tell(CaseBench& bench)
{
    bench.report("before any run", "nothing", 7, 0, "1");
    bench.report("falls", "off its parabola", falls(bench), 0, "m");
    bench.report("falls", "less than it may be off", -1, 0, "m");
    bench.report("falls again", "off its parabola", falls(bench) + 1, 0, "m");
}

double error_of(const Trial& trial) { return rms(std::span(&trial.errors, 1), 0); }

TEST(CaseTrials, TellTheFigureOfTheFirstLineThatComesFromARun)
{
    const HardCase which = case_that(fall_and_tell);
    const CaseTrials trials(which, {}, {});
    EXPECT_EQ(trials.line().setting, "falls");
    EXPECT_EQ(trials.quantities().front().name, "off its parabola");
    EXPECT_EQ(trials.quantities().front().unit, "m");
    EXPECT_EQ(trials.size(), 1u);
    EXPECT_EQ(trials.runs(), 1u);
    EXPECT_NEAR(trials.length(), 1, 1e-12);
    const Trial own = trials.run({}, 0, 10);
    EXPECT_EQ(error_of(own), trials.line().figure) << "to the last bit";
    EXPECT_NEAR(error_of(own), 9.81 / 50 / 2, 1e-9);
    EXPECT_GT(own.time_ms, 0);
    EXPECT_GT(trials.time_ms({}, 0), 0);
}

TEST(CaseTrials, ForceDialsThatTheCaseHadSetItself)
{
    const HardCase which = case_that(fall_and_tell);
    const CaseTrials trials(which, {}, {});
    EXPECT_NEAR(error_of(trials.run({{"dt", "1/100"}}, 0, 10)), 9.81 / 100 / 2, 1e-9);
    EXPECT_NEAR(error_of(trials.run({{"substeps", "5"}}, 0, 10)), 9.81 / 250 / 2, 1e-9);
    EXPECT_NEAR(error_of(trials.run({{"dt", "1/10"}, {"substeps", "5"}}, 0, 10)), 9.81 / 50 / 2,
                1e-9);
    EXPECT_THROW(trials.run({{"solver", "pigs"}}, 0, 10), std::invalid_argument);
    EXPECT_TRUE(trials.holds_whole_steps(1.0 / 25));
    EXPECT_FALSE(trials.holds_whole_steps(1.0 / 12.5)) << "twelve and a half of them";

    CasePlan plan;
    plan.given = {{"dt", "1/100"}};
    const CaseTrials given(which, plan, {});
    EXPECT_NEAR(given.line().figure, 9.81 / 100 / 2, 1e-9);
    EXPECT_EQ(given.scene().settings.dt, 1.0 / 100);
    EXPECT_NE(given.state_hash(), trials.state_hash());
    EXPECT_EQ(CaseTrials(which, {}, {}).state_hash(), trials.state_hash());
}

TEST(CaseTrials, AFigureBelowZeroIsNoErrorAndALostBodyAnInfiniteOne)
{
    CasePlan plan;
    plan.quantity = "less than it may be off";
    const HardCase less = case_that(fall_and_tell);
    const CaseTrials trials(less, plan, {});
    EXPECT_EQ(trials.line().figure, -1);
    EXPECT_EQ(trials.runs(), 1u) << "those that the line before was of";
    EXPECT_EQ(error_of(trials.run({}, 0, 10)), 0);

    const HardCase loses = case_that([](CaseBench& bench) {
        bench.run(falling_ball(bench, 1e15), 20, [](World&, double) { return true; });
        bench.report("falls for ever", "error", 0, 1, "1");
    });
    EXPECT_TRUE(std::isinf(error_of(CaseTrials(loses, {}, {}).run({}, 0, 10))));

    const HardCase blind = case_that([](CaseBench& bench) {
        falls(bench);
        bench.report("sees nothing", "error", NAN, 1, "1");
    });
    EXPECT_TRUE(std::isinf(error_of(CaseTrials(blind, {}, {}).run({}, 0, 10))));
}

// What is thrown, as text.
std::string refusal_of(const HardCase& which, const std::string& quantity)
{
    CasePlan plan;
    plan.quantity = quantity;
    try {
        const CaseTrials trials(which, plan, {});
    } catch (const std::invalid_argument& refused) {
        return refused.what();
    }
    return "none";
}

TEST(CaseTrials, RefuseWhatIsNoLineOfARun)
{
    const HardCase which = case_that(fall_and_tell);
    EXPECT_EQ(refusal_of(which, "nothing"),
              "H0 has no line of \"nothing\" that comes from runs; there are off its parabola; "
              "less than it may be off");
    const HardCase skips = case_that([](CaseBench& bench) { bench.skip("all", "it", "no data"); });
    EXPECT_EQ(refusal_of(skips, ""), "H0 has no line that comes from runs: no data");
    const HardCase* const asks = find_case("H29");
    EXPECT_EQ(refusal_of(*asks, "").find("H29 asks methods about shapes and steps no world"), 0u);
}

TEST(CaseTrials, GiveUpWhatTakesTooLongAndEndWhereSomebodyWantsThemTo)
{
    const HardCase which = case_that(fall_and_tell);
    const CaseTrials trials(which, {}, {});
    EXPECT_THROW(trials.run({{"dt", "1/100"}}, 0, 0), TooSlow);
    const Watch ended{{}, [] { return true; }};
    EXPECT_THROW(CaseTrials(which, {}, ended), Interrupted);
}

TEST(CaseTrials, AreRunInBriefWhereThatTellsTheSame)
{
    // Whole it runs long before the line, which is the same in brief.
    static int runs = 0;
    const HardCase which = case_that([](CaseBench& bench) {
        for (int k = bench.brief() ? 1 : 4; k > 0; --k, ++runs) falls(bench);
        bench.report("before", "another", 0, 0, "m");
        bench.report("falls", "off its parabola", falls(bench), 0, "m");
    });
    CasePlan plan;
    plan.quantity = "off its parabola";
    const CaseTrials trials(which, plan, {});
    runs = 0;
    trials.run({{"substeps", "2"}}, 0, 10);
    EXPECT_EQ(runs, 1);
}

TEST(CaseTrials, AreTheSameBitsOnAnyNumberOfThreads)
{
    const HardCase& stack = *find_case("H9");
    CasePlan plan;
    plan.threads = 1;
    const CaseTrials one(stack, plan, {});
    plan.threads = 3;
    const CaseTrials three(stack, plan, {});
    EXPECT_EQ(one.line().figure, three.line().figure);
    EXPECT_EQ(one.state_hash(), three.state_hash());
    const Changes changes = {{"substeps", "2"}};
    EXPECT_EQ(one.run(changes, 0, 60).errors, three.run(changes, 0, 60).errors);
}

}  // namespace
}  // namespace throng
