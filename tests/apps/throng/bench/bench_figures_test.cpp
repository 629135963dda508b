// Bench figures: what runs come to, on runs whose figures are known.
#include "apps/throng/bench/figures.hpp"

#include <gtest/gtest.h>

namespace throng::bench {
namespace {

const CatalogEntry& pile() { return *find_scene("pile"); }

Run run_of(const char* engine, int threads, int repeat, std::vector<double> ms)
{
    Run run;
    run.engine = engine;
    run.threads = run.threads_met = threads;
    run.repeat = repeat;
    run.contacts.assign(ms.size(), 10);
    run.cpu_ms = run.ms = std::move(ms);
    return run;
}

Case case_of(std::size_t bodies, std::vector<Run> runs)
{
    Case made;
    made.scene = &pile();
    made.size = static_cast<int>(bodies);
    made.bodies = made.bodies_dynamic = bodies;
    made.runs = std::move(runs);
    return made;
}

TEST(BenchFigures, AreMediansOverRepeats)
{
    const Case made = case_of(100,
                              {run_of("throng", 1, 0, {1, 1, 4}), run_of("throng", 1, 1, {3, 3, 3}),
                               run_of("throng", 1, 2, {9, 9, 9})});
    const std::vector<Figure> figures = figures_of(made);
    ASSERT_EQ(figures.size(), 1u);
    EXPECT_DOUBLE_EQ(figures[0].ms_mean.median, 3);
    EXPECT_DOUBLE_EQ(figures[0].ms_mean.least, 2);
    EXPECT_DOUBLE_EQ(figures[0].ms_mean.most, 9);
    EXPECT_DOUBLE_EQ(figures[0].ms_median, 3);
    EXPECT_DOUBLE_EQ(figures[0].ms_p99, 4);  // of 4, 3 and 9
    EXPECT_DOUBLE_EQ(figures[0].ns_a_body, 3e4);
    EXPECT_DOUBLE_EQ(figures[0].ns_a_contact, 4e5);  // of 4e5, 3e5 and 9e5
}

TEST(BenchFigures, CompareTheStepsThatBothHaveDone)
{
    const Case made =
        case_of(100, {run_of("throng", 1, 0, {1, 1, 100, 100}), run_of("bullet", 1, 0, {4, 6})});
    const std::vector<Figure> figures = figures_of(made);
    ASSERT_EQ(figures.size(), 2u);
    ASSERT_EQ(figures[0].against.size(), 1u);
    EXPECT_EQ(figures[0].against[0].engine, "bullet");
    EXPECT_EQ(figures[0].against[0].steps, 2u);
    EXPECT_DOUBLE_EQ(figures[0].against[0].times.median, 5);
    EXPECT_TRUE(figures[1].against.empty());
}

TEST(BenchFigures, SpeedUpIsOverOneThread)
{
    const Case made =
        case_of(100, {run_of("throng", 1, 0, {8, 8}), run_of("throng", 2, 0, {4, 4})});
    const std::vector<Figure> figures = figures_of(made);
    EXPECT_TRUE(figures[0].against.empty());
    ASSERT_EQ(figures[1].against.size(), 1u);
    EXPECT_DOUBLE_EQ(figures[1].against[0].times.median, 2);
}

TEST(BenchFigures, PeersAreComparedOnAsManyThreads)
{
    const Case made = case_of(100,
                              {run_of("throng", 1, 0, {2, 2}), run_of("throng", 2, 0, {1, 1}),
                               run_of("bullet", 1, 0, {8, 8}), run_of("box3d", 1, 0, {6, 6}),
                               run_of("box3d", 2, 0, {4, 4})});
    const std::vector<Figure> figures = figures_of(made);
    ASSERT_EQ(figures[0].against.size(), 2u);
    EXPECT_DOUBLE_EQ(figures[0].against[0].times.median, 4);
    EXPECT_DOUBLE_EQ(figures[0].against[1].times.median, 3);
    ASSERT_EQ(figures[1].against.size(), 3u);  // itself on one, bullet on one, box3d on two
    EXPECT_DOUBLE_EQ(figures[1].against[1].times.median, 8);
    EXPECT_EQ(figures[1].against[2].threads, 2);
    EXPECT_DOUBLE_EQ(figures[1].against[2].times.median, 4);
}

TEST(BenchFigures, RunsWithoutAStepAreLeftOut)
{
    EXPECT_TRUE(figures_of(case_of(100, {run_of("throng", 1, 0, {})})).empty());
    EXPECT_TRUE(growth_of({case_of(100, {run_of("throng", 1, 0, {})})}).empty());
}

TEST(BenchFigures, HashesOfEqualStepsHaveToAgree)
{
    Case made = case_of(100,
                        {run_of("throng", 1, 0, {1, 1}), run_of("throng", 2, 0, {1}),
                         run_of("throng", 1, 1, {1, 1})});
    made.runs[0].state_hash = made.runs[2].state_hash = "a";
    made.runs[1].state_hash = "b";  // of another step
    EXPECT_TRUE(hashes_agree(made));
    made.runs[2].state_hash = "c";
    EXPECT_FALSE(hashes_agree(made));
    made.runs[2].alike = "substeps=8";  // comes to what it may
    EXPECT_TRUE(hashes_agree(made));
}

TEST(BenchFigures, SettingsAreAsEnginesOfTheirOwn)
{
    Case made = case_of(100,
                        {run_of("throng", 1, 0, {1, 1}), run_of("throng", 1, 0, {4, 4}),
                         run_of("throng", 2, 0, {2, 2}), run_of("bullet", 1, 0, {8, 8})});
    made.runs[0].setting = "substeps=2";
    made.runs[1].setting = made.runs[2].setting = "substeps=8";
    const std::vector<Figure> figures = figures_of(made);
    ASSERT_EQ(figures.size(), 4u);
    ASSERT_EQ(figures[2].against.size(), 2u);
    EXPECT_DOUBLE_EQ(figures[2].against[0].times.median,
                     2);  // on one thread, with the same setting
    EXPECT_EQ(figures[2].against[1].engine, "bullet");
    EXPECT_DOUBLE_EQ(figures[0].against[0].times.median, 8);
}

TEST(BenchFigures, GrowthFindsThePower)
{
    std::vector<Case> cases;
    for (const std::size_t bodies : {100u, 1000u, 10000u}) {
        const double ms =
            2 * static_cast<double>(bodies) * 1e-2 * std::sqrt(static_cast<double>(bodies));
        cases.push_back(case_of(bodies, {run_of("throng", 1, 0, {ms, ms})}));
    }
    const std::vector<Growth> growth = growth_of(cases);
    ASSERT_EQ(growth.size(), 1u);
    EXPECT_NEAR(growth[0].exponent, 1.5, 1e-9);
    EXPECT_EQ(growth[0].steps_up.size(), 2u);
}

TEST(BenchFigures, EqualStatesHaveTheSameContactsABody)
{
    // The small one is through with falling when the large one still is on its way.
    std::vector<double> small_ms, large_ms;
    std::vector<std::size_t> small_contacts, large_contacts;
    for (std::size_t i = 0; i < 100; ++i) {
        small_contacts.push_back(4 * (i + 1));
        small_ms.push_back(static_cast<double>(4 * (i + 1)) * 1e-3);  // 1 us a contact
        large_contacts.push_back(20 * (i + 1));
        large_ms.push_back(static_cast<double>(20 * (i + 1)) * 1.1e-3);
    }
    bench::Run small = run_of("throng", 1, 0, small_ms), large = run_of("throng", 1, 0, large_ms);
    small.contacts = small_contacts;
    large.contacts = large_contacts;
    const std::vector<Growth> growth = growth_of({case_of(100, {small}), case_of(1000, {large})});
    ASSERT_EQ(growth.size(), 1u);
    const Growth::EqualState& step = growth[0].steps_up.at(0);
    EXPECT_TRUE(step.by_contact);
    EXPECT_NEAR(step.contacts_small, step.contacts_large, 0.03);
    EXPECT_NEAR(step.ns_small, 1000, 1e-6);
    EXPECT_NEAR(step.ratio(), 1.1, 1e-9);
}

}  // namespace
}  // namespace throng::bench
