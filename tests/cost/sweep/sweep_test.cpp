// Sweeps: the front, what is advised, the orders, and what is tried at all.
#include "cost/sweep/idle_dials.hpp"
#include "cost/sweep/orders.hpp"
#include "tests/cost/sweep/made_points.hpp"
#include "throng/catalog.hpp"
#include "throng/dials.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace throng {
namespace {

Scene scene_of(std::string_view word)
{
    const ParsedScene parsed = parse_scene(word);
    return parsed.entry->make(parsed.size, 1);
}

TEST(Front, HoldsWhatNothingBeats)
{
    std::vector<Point> points = {made_point(1, 1e-2), made_point(2, 1e-3), made_point(2, 5e-3),
                                 made_point(3, 1e-3), made_point(4, 1e-4)};
    mark_front(points, kDrift);
    const bool wanted[] = {true, true, false, false, true};
    for (std::size_t i = 0; i < points.size(); ++i) EXPECT_EQ(points[i].on_front, wanted[i]) << i;
}

TEST(Front, HasNoPlaceForWhatBlewUpOrWasLookedAtLess)
{
    std::vector<Point> points = {made_point(1, INFINITY), made_point(2, 1e-3),
                                 made_point(0.5, 1e-4)};
    points[2].errors.resize(2);
    points[2].times_ms.resize(2);
    mark_front(points, kDrift);
    EXPECT_FALSE(points[0].on_front);
    EXPECT_TRUE(points[1].on_front);
    EXPECT_FALSE(points[2].on_front);
}

TEST(Front, HasNoPlaceForATimeThatWasNotTakenInTurn)
{
    std::vector<Point> points = {made_point(1, 1e-2), made_point(0.9, 2e-2), made_point(2, 1e-3)};
    points[1].time_ms.repeats = 1;
    mark_front(points, kDrift);
    EXPECT_TRUE(points[0].on_front);
    EXPECT_FALSE(points[1].on_front);
    EXPECT_TRUE(points[2].on_front);
}

TEST(Front, AdvisesTheCheapestWithinAnErrorAndTheMostExactWithinATime)
{
    std::vector<Point> points = {made_point(1, 1e-2), made_point(2, 1e-3), made_point(4, 1e-4)};
    mark_front(points, kDrift);
    EXPECT_EQ(cheapest_within(points, kDrift, 2e-3), &points[1]);
    EXPECT_EQ(cheapest_within(points, kDrift, 1e-6), &points[2]);
    EXPECT_EQ(most_exact_within(points, kDrift, 3), &points[1]);
    EXPECT_EQ(most_exact_within(points, kDrift, 0.5), &points[0]);
    EXPECT_EQ(cheapest_within({}, kDrift, 1), nullptr);
}

TEST(Orders, AreTheSlopesOfErrors)
{
    Scene scene;
    SweepResult found;
    found.points = {made_point(1, 1e-2, {}), made_point(2, 2.5e-3, {{"dt", "1/120"}}),
                    made_point(4, 6.25e-4, {{"dt", "1/240"}}),
                    made_point(8, 3e-5, {{"dt", "1/480"}})};
    const auto fitted = fitted_order(scene, found, "dt", kDrift, 2e-5);
    ASSERT_TRUE(fitted);
    EXPECT_NEAR(fitted->order, 2, 1e-9);
    EXPECT_EQ(fitted->points, 3u) << "what is near the reference's own error tells none";
    EXPECT_EQ(fitted->helps, "1/480");
    EXPECT_FALSE(fitted_order(scene, found, "substeps", kDrift, 0));
}

TEST(Changes, AreWrittenAsTheyAreRead)
{
    const Changes changes = {{"dt", "1/120"}, {"solver", "pgs"}};
    EXPECT_EQ(as_options(changes), "--set dt=1/120 --set solver=pgs");
    EXPECT_EQ(as_settings(changes), R"("settings": {"dt": "1/120", "solver": "pgs"})");
    EXPECT_EQ(joined(changes, {{"solver", "direct"}, {"substeps", "2"}}),
              (Changes{{"dt", "1/120"}, {"solver", "direct"}, {"substeps", "2"}}));
    EXPECT_THROW(changed(Scene{}, {{"solver", "pigs"}}), std::invalid_argument);
}

TEST(Candidates, AreOfDialsThatDoSomething)
{
    const Scene scene = scene_of("spheres:20");
    World world(scene, 1);
    const Candidates all = candidates_for(scene, world.effects(), {});
    EXPECT_FALSE(all.steps.empty());
    for (const Changes& each : all.others) {
        Scene by = changed(scene, each);
        EXPECT_TRUE(unused_dials(by).empty()) << text_of(each);
        for (const Change& change : each) {
            EXPECT_NE(change.dial, "nonconvex") << "no mesh moves";
            EXPECT_NE(change.dial, "mesh_tree") << "no mesh stands still";
        }
    }
    const std::vector<std::string> dials = {"dt"};
    const Candidates few = candidates_for(scene, world.effects(), dials);
    EXPECT_TRUE(few.others.empty());
    EXPECT_EQ(few.steps.size(), 5u) << "all but the scene's own";
}

TEST(IdleDials, AreThoseThatChangeNoErrorWhereverTheyAreTurned)
{
    std::vector<Point> points = {
        made_point(1, 2, {}),
        made_point(2, 2, {{"broadphase", "grid"}}),
        made_point(3, 2, {{"broadphase", "sweep"}}),
        made_point(2, 1, {{"substeps", "8"}}),
        made_point(2, 1, {{"substeps", "8"}, {"broadphase", "grid"}}),
        made_point(2, 2, {{"iterations", "2"}}),
        made_point(2, 3, {{"solver", "pgs"}}),
        made_point(2, 2.5, {{"solver", "pgs"}, {"iterations", "60"}}),
    };
    points.emplace_back();
    points.back().changes = {{"broadphase", "embree"}};
    points.back().trouble = "cannot be had";
    EXPECT_EQ(idle_dials(points, kDrift), std::vector<std::string>{"broadphase"})
        << "iterations alone do nothing, with pgs they do";
    of(points[2].errors[3], kDrift) += 1e-9;
    EXPECT_TRUE(idle_dials(points, kDrift).empty()) << "in one window of four";
    for (Point& point : points)
        for (Errors& errors : point.errors) of(errors, kDrift) = 0;
    EXPECT_TRUE(idle_dials(points, kDrift).empty()) << "nothing errs at all";
}

TEST(Candidates, HaveNeighborsAMoveAway)
{
    const Scene scene = scene_of("spheres:20");
    const auto texts_of = [&](const Changes& changes, std::vector<std::string> dials) {
        std::vector<std::string> texts;
        for (const Changes& each : neighbors_of(scene, changes, dials))
            texts.push_back(text_of(each));
        return texts;
    };
    using Texts = std::vector<std::string>;
    EXPECT_EQ(texts_of({{"dt", "1/120"}, {"solver", "pgs"}, {"iterations", "60"}}, {"dt"}),
              (Texts{"solver=pgs iterations=60", "dt=1/240 solver=pgs iterations=60",
                     "dt=1/120 iterations=60", "dt=1/120 solver=pgs",
                     "dt=1/120 solver=pgs iterations=30"}));
    EXPECT_EQ(texts_of({{"solver", "pgs"}}, {"iterations"}), (Texts{"solver=pgs iterations=10"}));
    EXPECT_EQ(texts_of({{"iterations", "4"}}, {"iterations"}),
              (Texts{"iterations=8", "iterations=2"}));
    EXPECT_EQ(texts_of({{"dt", "1/30"}}, {}),
              (Texts{"dt=1/30 substeps=8", "dt=1/30 substeps=2", "substeps=8", "substeps=2"}))
        << "1/15 s is none of the steps, and the scene as it is none of its neighbors";
    EXPECT_EQ(texts_of({{"substeps", "32"}}, {"substeps"}), (Texts{"substeps=16"}));
    EXPECT_EQ(texts_of({{"substeps", "3"}}, {"substeps"}), (Texts{}));
}

TEST(Candidates, KnowTheirDials)
{
    for (const std::string_view name : swept_dials()) EXPECT_NE(find_dial(name), nullptr) << name;
}

TEST(SettingsSweep, MeasuresTheFrontOnAllWindowsAndItsTimesInTurn)
{
    const Scene scene = scene_of("stacks:10");
    World world(scene, 1);
    const Windows windows(scene, {1, 0.1, 5, 1}, 0, 20, {});
    SweepPlan plan;
    plan.dials = {"substeps", "contact_rate"};
    plan.repeats = 3;
    const SweepResult found = sweep(WindowTrials(scene, windows), world.effects(), plan, {});
    EXPECT_FALSE(found.cut_short);
    EXPECT_TRUE(found.points.front().changes.empty());
    std::size_t front = 0;
    for (const Point& each : found.points) {
        if (!each.on_front) continue;
        ++front;
        EXPECT_EQ(each.errors.size(), windows.size());
        EXPECT_EQ(each.time_ms.repeats, 3u);
    }
    EXPECT_GE(front, 2u);
    // What more substeps buy.
    const auto error_of = [&](const Changes& changes) {
        const auto at = std::find_if(found.points.begin(), found.points.end(),
                                     [&](const Point& p) { return p.changes == changes; });
        return at == found.points.end() ? NAN : at->error(kDrift);
    };
    EXPECT_LT(error_of({{"substeps", "32"}}), 0.1 * error_of({}));
}

// A made-up world, whose errors and times are plain laws of its dials.
class MadeTrials : public Trials {
public:
    explicit MadeTrials(Scene scene) : scene_(std::move(scene)) { }

    const Scene& scene() const override { return scene_; }
    std::size_t size() const override { return 5; }
    double length() const override { return 0.1; }
    std::vector<Quantity> quantities() const override { return WindowTrials::of_windows(); }
    const Errors& reference_off() const override { return exact_; }
    std::string state_hash() const override { return "0"; }
    bool holds_whole_steps(double dt) const override
    {
        return std::abs(length() / dt - std::round(length() / dt)) < 1e-9;
    }
    Trial run(const Changes& changes, std::size_t trial, double /*patience*/) const override
    {
        const Settings settings = changed(scene_, changes).settings;
        const double substep = settings.dt / settings.substeps;
        // Of the fourth order, of the second, and the worse the later in the list; steps cost, and
        // their substeps less.
        const bool is_rk4 = settings.integrator == Integrator::rk4;
        const double worse = 1 + static_cast<double>(settings.integrator);
        const double drift =
            is_rk4 ? std::pow(20 * substep, 4) : 0.1 * worse * std::pow(20 * substep, 2);
        Errors errors{};
        of(errors, kDrift) = drift * drift * (1 + 0.01 * static_cast<double>(trial));
        return {errors, time_ms(changes, trial)};
    }
    double time_ms(const Changes& changes, std::size_t /*trial*/) const override
    {
        const Settings settings = changed(scene_, changes).settings;
        const double substep = settings.integrator == Integrator::rk4 ? 4 : 1;
        return 1e-3 / settings.dt * (3 + substep * settings.substeps);
    }

private:
    Scene scene_;
    Errors exact_{};
};

// What was chosen among, beside all there is to choose among.
TEST(SettingsSweep, RecommendsWhatIsAsCheapAsTheBestOfAProduct)
{
    const Scene scene = scene_of("spring:1");
    World world(scene, 1);
    const MadeTrials trials(scene);
    SweepPlan plan;
    plan.dials = {"dt", "substeps", "integrator"};
    plan.repeats = 1;
    const SweepResult found = sweep(trials, world.effects(), plan, {});
    for (const char* dt : {"1/30", "1/60", "1/120", "1/240", "1/480", "1/960"})
        for (const char* substeps : {"1", "2", "4", "8", "16", "32"})
            for (const char* integrator : {"auto", "semi_implicit", "midpoint", "splitting", "rk4"})
                plan.settings.push_back(
                    {{"dt", dt}, {"substeps", substeps}, {"integrator", integrator}});
    const SweepResult all = sweep(trials, world.effects(), plan, {});
    ASSERT_EQ(all.points.size(), 181u);
    EXPECT_LT(found.points.size(), 100u);
    for (double error = 1e-9; error < 1e-2; error *= 2) {
        const Point* const chosen = cheapest_within(found.points, kDrift, error);
        const Point* const best = cheapest_within(all.points, kDrift, error);
        ASSERT_NE(chosen, nullptr);
        EXPECT_LE(chosen->error(kDrift), std::max(error, best->error(kDrift))) << error;
        EXPECT_LE(chosen->time_ms.median, 1.3 * best->time_ms.median)
            << error << ": " << text_of(chosen->changes) << ", but " << text_of(best->changes);
    }
}

// Beside what each window says of a setting when it is asked by itself.
TEST(SettingsSweep, MeasuresWholeWhatIsNamed)
{
    const Scene scene = scene_of("stacks:10");
    World world(scene, 1);
    const Windows windows(scene, {1, 0.1, 5, 1}, 0, 20, {});
    const WindowTrials trials(scene, windows);
    SweepPlan plan;
    plan.repeats = 3;
    plan.settings = {{{"substeps", "16"}},
                     {{"dt", "1/7"}},
                     {{"solver", "pgs"}, {"iterations", "1"}},
                     {{"toi_tolerance", "1e-9"}}};
    const SweepResult found = sweep(trials, world.effects(), plan, {});
    EXPECT_FALSE(found.cut_short);
    ASSERT_EQ(found.points.size(), 5u) << "none but these, and the scene as it is";
    for (const std::size_t at : {0, 1, 3}) {
        const Point& point = found.points[at];
        ASSERT_EQ(point.errors.size(), windows.size()) << text_of(point.changes);
        EXPECT_EQ(point.time_ms.repeats, 3u) << text_of(point.changes);
        for (std::size_t k = 0; k < windows.size(); ++k)
            EXPECT_EQ(point.errors[k], trials.run(point.changes, k, 10).errors) << k;
    }
    EXPECT_EQ(found.points[2].trouble, "what is measured holds no whole number of its steps");
    EXPECT_FALSE(found.points[4].trouble.empty()) << "float does not resolve it";
}

TEST(SettingsSweep, SaysWhereItHadNoTime)
{
    const Scene scene = scene_of("stacks:10");
    World world(scene, 1);
    const Windows windows(scene, {1, 0.1, 2, 1}, 0, 5, {});
    SweepPlan plan;
    plan.patience = 0;
    const SweepResult found = sweep(WindowTrials(scene, windows), world.effects(), plan, {});
    EXPECT_TRUE(found.cut_short);
    EXPECT_TRUE(found.points.front().had());
}

}  // namespace
}  // namespace throng
