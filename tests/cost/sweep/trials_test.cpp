// Trials: whatever settings are measured on, a sweep ends with a front.
#include "cost/sweep/sweep.hpp"
#include "throng/catalog.hpp"
#include "throng/world.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace throng {
namespace {

// One trial, whose error and time are made from the settings.
class MadeTrials : public Trials {
public:
    explicit MadeTrials(std::function<double(const Settings&)> error) : error_(std::move(error))
    {
        const ParsedScene parsed = parse_scene("stacks:10");
        scene_ = parsed.entry->make(parsed.size, 1);
    }
    const Scene& scene() const override { return scene_; }
    std::size_t size() const override { return 1; }
    double length() const override { return 1; }
    std::vector<Quantity> quantities() const override { return {{"off", "1", ""}}; }
    const Errors& reference_off() const override { return none_; }
    std::string state_hash() const override { return "0"; }
    bool holds_whole_steps(double dt) const override { return dt > 0; }
    Trial run(const Changes& changes, std::size_t /*trial*/, double patience) const override
    {
        const Settings settings = changed(scene_, changes).settings;
        if (takes_s(settings) > patience) throw TooSlow{};
        asked_.push_back(changes);
        const double error = error_(settings);
        return {{error * error}, time_ms(changes, 0)};
    }
    double time_ms(const Changes& changes, std::size_t /*trial*/) const override
    {
        return takes_s(changed(scene_, changes).settings) * 1e3 / 60;
    }

    // s of the clock for each substep a second.
    double second_each = 1e-9;
    const std::vector<Changes>& asked() const { return asked_; }

private:
    double takes_s(const Settings& settings) const
    {
        return second_each * settings.substeps / settings.dt;
    }

    Scene scene_;
    std::function<double(const Settings&)> error_;
    Errors none_;
    mutable std::vector<Changes> asked_;
};

SweepResult swept(const MadeTrials& trials, double patience)
{
    World world(trials.scene(), 1);
    SweepPlan plan;
    plan.dials = {"dt", "substeps"};
    plan.patience = patience;
    return sweep(trials, world.effects(), plan, {});
}

TEST(SweptTrials, OfNoErrorAtAllHaveTheCheapestOnTheFront)
{
    const MadeTrials trials([](const Settings&) { return 0.0; });
    const SweepResult found = swept(trials, 10);
    const Point* const best = cheapest_within(found.points, 0, 1e-3);
    ASSERT_NE(best, nullptr);
    EXPECT_EQ(best->error(0), 0);
    for (const Point& point : found.points) {
        if (!point.had()) continue;
        EXPECT_GE(point.time_ms.median, best->time_ms.median) << text_of(point.changes);
    }
    EXPECT_EQ(std::count_if(found.points.begin(), found.points.end(),
                            [](const Point& point) { return point.on_front; }),
              1);
}

TEST(SweptTrials, PromiseTheVeryErrorOfTheOnlyOne)
{
    const MadeTrials trials([](const Settings& by) { return by.dt / by.substeps / 3; });
    const SweepResult found = swept(trials, 10);
    const Point* const best = cheapest_within(found.points, 0, 1e-3);
    ASSERT_NE(best, nullptr);
    const Settings by = changed(trials.scene(), best->changes).settings;
    EXPECT_EQ(best->error(0), by.dt / by.substeps / 3);
    EXPECT_EQ(best->error_at_most(0), best->error(0));
    EXPECT_LE(best->error(0), 1e-3);
}

TEST(SweptTrials, ThatBlowUpAreOnNoFront)
{
    const MadeTrials trials([](const Settings&) { return INFINITY; });
    const SweepResult found = swept(trials, 10);
    EXPECT_EQ(most_exact_within(found.points, 0, 1), nullptr);
}

TEST(SweptTrials, AreCheapFirstSoThatTheDearestAreMissingWhereTimeIsUp)
{
    // As it is takes 2.4 s of a clock that stands still here, and so all but the cheapest too long.
    MadeTrials trials([](const Settings& by) { return by.dt / by.substeps; });
    trials.second_each = 0.01;
    const SweepResult found = swept(trials, 5);
    EXPECT_TRUE(found.cut_short);
    ASSERT_GT(trials.asked().size(), 2u);
    EXPECT_TRUE(trials.asked().front().empty());
    const auto substeps_of = [&](const Changes& changes) {
        const Settings by = changed(trials.scene(), changes).settings;
        return by.substeps / by.dt;
    };
    double dearest = 0;
    for (std::size_t k = 1; k < trials.asked().size(); ++k) {
        EXPECT_GE(substeps_of(trials.asked()[k]), substeps_of(trials.asked()[1]));
        dearest = std::max(dearest, substeps_of(trials.asked()[k]));
    }
    EXPECT_LE(dearest, 5 / trials.second_each);
    for (const Point& point : found.points) {
        if (!point.had()) {
            EXPECT_GE(substeps_of(point.changes), dearest) << text_of(point.changes);
        }
    }
    for (const Point& point : found.points)
        EXPECT_TRUE(point.trouble.empty()) << "that it had no time is not its own";
}

}  // namespace
}  // namespace throng
