// Case bench: what a run that lost a body proves, and who hears of its lines when.
#include "cost/hard_cases/cases.hpp"
#include "throng/world.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

Scene falling_ball(const CaseBench& bench, double gravity)
{
    Scene scene = bench.scene();
    scene.gravity = Vec3(0, 0, gravity);
    scene.shapes.push_back({"ball", SphereShape{1}});
    BodyDescription& ball = scene.bodies.emplace_back();
    ball.shape = 0;
    return scene;
}

HardCase case_that(void (*runs)(CaseBench&)) { return {"H0", "", runs, Fault::none}; }

TEST(CaseBench, NoLinePassesThatARunWithAQuarantinedBodyIsIn)
{
    const auto results = run_case(case_that([](CaseBench& bench) {
        bench.run(falling_ball(bench, 1e15), 20, [](World&, double) { return true; });
        bench.report("falls for ever", "error", 0, 1, "1");
        bench.report("the next line", "error", 0, 1, "1");
    }));
    ASSERT_EQ(results.size(), 2U);
    EXPECT_EQ(results[0].verdict, Verdict::fail);
    EXPECT_EQ(results[0].why, "bodies quarantined: 1");
    EXPECT_EQ(results[1].verdict, Verdict::pass);
}

TEST(CaseBench, WhatTheDefaultMissesIsNoFailureWhereASettingMeetsIt)
{
    const auto results = run_case(case_that([](CaseBench& bench) {
        bench.report_default("default", "error", 2, 1, "1", "solver=direct");
        bench.report_default("default", "error", 1, 1, "1", "solver=direct");
        bench.run(falling_ball(bench, 1e15), 20, [](World&, double) { return true; });
        bench.report_default("loses a body", "error", 2, 1, "1", "solver=direct");
    }));
    ASSERT_EQ(results.size(), 3U);
    EXPECT_EQ(results[0].verdict, Verdict::missed);
    EXPECT_EQ(results[0].why, "met by solver=direct");
    EXPECT_EQ(results[1].verdict, Verdict::pass);
    EXPECT_EQ(results[2].verdict, Verdict::fail);
}

TEST(CaseBench, WhatIsHeldToNothingIsNoPass)
{
    const auto results = run_case(case_that([](CaseBench& bench) {
        bench.show("default", "way", 2, "m");
        bench.report_time("default", "time a step", 3);
    }));
    ASSERT_EQ(results.size(), 2U);
    EXPECT_EQ(results[0].verdict, Verdict::shown);
    EXPECT_EQ(results[0].figure, 2);
    EXPECT_EQ(results[1].verdict, Verdict::shown);
    EXPECT_EQ(results[1].unit, "ns");
}

TEST(CaseBench, ALedgerIsKeptOfRunsByDefaultWhereItIsWanted)
{
    const HardCase falls = case_that([](CaseBench& bench) {
        Scene scene = falling_ball(bench, -9.81);
        bench.run(scene, 0.5, [](World&, double) { return true; });
        bench.report("falls", "error", 0, 1, "1");
        scene.settings.substeps += 1;
        bench.run(scene, 0.5, [](World&, double) { return true; });
        bench.report("falls finely", "error", 0, 1, "1");
    });
    CaseListener listener;
    listener.energy = true;
    const auto kept = run_case(falls, {}, Fault::none, 1, Extent::whole, listener);
    ASSERT_EQ(kept.size(), 3U);
    EXPECT_EQ(kept[2].setting.find("1 runs by default"), 0U) << kept[2].setting;
    EXPECT_EQ(kept[2].verdict, Verdict::pass);

    const auto hastened = run_case(falls, {}, Fault::haste, 1, Extent::whole, listener);
    ASSERT_EQ(hastened.size(), 3U);
    EXPECT_NE(hastened[2].setting.find("worst: falls,"), std::string::npos) << hastened[2].setting;
    EXPECT_EQ(hastened[2].verdict, Verdict::fail);

    EXPECT_EQ(run_case(falls).size(), 2U);
}

TEST(CaseBench, ForcedDialsReachEveryRunForAsLongAsTheCaseWanted)
{
    const HardCase falls = case_that([](CaseBench& bench) {
        Scene scene = falling_ball(bench, -9.81);
        for (const double dt : {0.1, 0.05}) {
            scene.settings.dt = dt;
            bench.inspect(scene, [](const World& world) { EXPECT_EQ(world.settings().dt, 0.025); });
            bench.run(scene, 1, [](World&, double) { return true; });
        }
    });
    std::vector<double> steps, times;
    CaseListener listener;
    listener.ran = [&](const CaseRun& run) {
        EXPECT_EQ(run.scene.settings.substeps, 7);
        steps.push_back(run.scene.settings.dt);
        times.push_back(run.simulated);
        EXPECT_EQ(run.duration, 1);
        EXPECT_GT(run.steps_ms, 0);
    };
    CaseBench bench({}, Fault::none, 1, Extent::whole, listener);
    bench.force({{"dt", "0.025"}, {"substeps", "7"}});
    bench.run(falls);
    EXPECT_EQ(steps, (std::vector<double>{0.025, 0.025}));
    EXPECT_EQ(times, (std::vector<double>{1, 1}));
}

// Ten steps, of which a line each is told.
void tell_ten_steps(CaseBench& bench)
{
    for (int step = 1; step <= 10; ++step) {
        bench.run(falling_ball(bench, -9.81), bench.settings().dt,
                  [](World&, double) { return true; });
        bench.report("step " + std::to_string(step), "error", 0, 1, "1");
    }
}

TEST(CaseBench, EachLineIsHeardAtOnceAndUnderTheNameOfItsCase)
{
    std::vector<std::string> heard;
    CaseListener listener;
    listener.line = [&](const CaseResult& line) {
        heard.push_back(line.name + " " + line.setting);
    };
    // Nothing more is asked for: what was heard until then was heard while the case ran.
    listener.enough = [&] { return heard.size() == 3; };
    const auto results =
        run_case(case_that(tell_ten_steps), {}, Fault::none, 1, Extent::whole, listener);
    EXPECT_EQ(heard, (std::vector<std::string>{"H0 step 1", "H0 step 2", "H0 step 3"}));
    EXPECT_EQ(results.size(), 3U);
}

}  // namespace
}  // namespace throng
