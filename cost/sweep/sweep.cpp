#include "cost/sweep/sweep.hpp"

#include "cost/clock.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace throng {

namespace {

// Trials of each round; what is left is measured on all.
constexpr std::size_t kFirstTrials = 4, kMoreTrials = 10;
// Of the patience that the first look at all of them may take: what did well has to be joined, too.
constexpr double kFirstShare = 0.6;
// Another has to be so much better in both time and error for a point to be left, round by round.
constexpr double kBeatenBy[] = {0.6, 0.75, 0.9};
// Values that change the error by less, and make it no faster, do nothing here.
constexpr double kChanges = 0.02, kFaster = 0.95;
// A trial that takes so many times as long as with no change is given up.
constexpr double kTooSlow = 300;
constexpr double kLeast = 1;            // s of the clock
constexpr std::size_t kMostJoined = 8;  // others that are tried with steps, and steps with others
// Of the patience, after which nothing new is tried: the rest is for a nearer look.
constexpr double kTriesShare = 0.75;
// A point from which others are looked for has no other so much better in both.
constexpr double kAtFront = 0.97;
// Trials that a time is taken over, and the share of the patience that times may take.
constexpr std::size_t kTimedTrials = 8;
constexpr double kTimesShare = 0.25;

class Sweeper {
public:
    Sweeper(const Trials& trials, const SweepPlan& plan, const Watch& watch)
        : trials_(trials), plan_(plan), watch_(watch), begin_(WallClock::now())
    { }

    SweepResult run(const Candidates& candidates)
    {
        try {
            if (plan_.settings.empty())
                search(candidates);
            else
                measure_whole();
        } catch (const Interrupted&) {
            found_.interrupted = true;
        }
        mark_front(found_.points, plan_.measure);
        return std::move(found_);
    }

private:
    void search(const Candidates& candidates)
    {
        add({});
        for (const Changes& each : candidates.steps) add(each);
        steps_end_ = found_.points.size();
        for (const Changes& each : candidates.others) add(each);
        measure_all(kFirstTrials, kFirstShare);
        join();
        measure_all(kFirstTrials, kTriesShare);
        move_on();
        leave_beaten(kBeatenBy[0]);
        measure_left(kMoreTrials);
        leave_beaten(kBeatenBy[1]);
        measure_left(trials_.size());
        leave_beaten(kBeatenBy[2]);
        take_times();
    }
    // Without a choice among them, and of each that cannot be had, why.
    void measure_whole()
    {
        add({});
        for (const Changes& each : plan_.settings)
            if (const std::string trouble = trouble_of(each); trouble.empty()) {
                add(each);
            } else {
                found_.points.push_back({});
                found_.points.back().changes = each;
                found_.points.back().trouble = trouble;
            }
        measure_all(trials_.size(), 1);
        std::erase_if(left_, [&](std::size_t at) {
            return !point(at).had() || point(at).errors.size() < trials_.size();
        });
        take_times();
    }
    double time_left(double share = 1) const
    {
        return share * plan_.patience - seconds_since(begin_);
    }
    // Why it cannot be tried; empty where it can. Trials have to hold a whole number of steps.
    std::string trouble_of(const Changes& changes) const
    {
        const bool turns_dt = std::any_of(changes.begin(), changes.end(),
                                          [](const Change& each) { return each.dial == "dt"; });
        try {
            const double dt = changed(trials_.scene(), changes).settings.dt;
            if (turns_dt && !trials_.holds_whole_steps(dt))
                return "what is measured holds no whole number of its steps";
        } catch (const std::invalid_argument& wrong) {
            return wrong.what();
        }
        return {};
    }
    void add(const Changes& changes)
    {
        if (!trouble_of(changes).empty()) return;
        const bool known =
            std::any_of(found_.points.begin(), found_.points.end(),
                        [&](const Point& point) { return point.changes == changes; });
        if (known) return;
        const auto before =
            std::find_if(plan_.known.begin(), plan_.known.end(),
                         [&](const Point& point) { return point.changes == changes; });
        found_.points.push_back(before == plan_.known.end() ? Point{} : *before);
        found_.points.back().changes = changes;
        found_.points.back().reference_off = trials_.reference_off();
        average_time(found_.points.back());
        left_.push_back(found_.points.size() - 1);
    }
    Point& point(std::size_t at) { return found_.points[at]; }

    void show(std::size_t done, std::size_t of, const Point& point, const char* what)
    {
        if (watch_.show)
            watch_.show(std::string(what) + ' ' + std::to_string(done) + " of " + std::to_string(of)
                        + ": " + (point.changes.empty() ? "as it is" : text_of(point.changes)));
    }

    // That of no change first, by whose time the others are too slow.
    void measure(Point& point, std::size_t trials, double share = 1)
    {
        trials = std::min(trials, trials_.size());
        if (!point.trouble.empty()) return;
        const double too_slow = most_seconds(point);
        double left = 0;
        try {
            while (point.errors.size() < trials) {
                left = point.changes.empty() ? too_slow : std::max(kLeast, time_left(share));
                const Trial run =
                    trials_.run(point.changes, point.errors.size(), std::min(too_slow, left));
                point.errors.push_back(run.errors);
                point.times_ms.push_back(run.time_ms);
                average_time(point);
            }
        } catch (const TooSlow&) {
            if (left < too_slow)
                found_.cut_short = true;
            else
                point.trouble = "takes more than 300 times as long as with no change";
        } catch (const std::invalid_argument& wrong) {
            point.trouble = wrong.what();
        }
    }
    // Of the clock, that a trial may take; never less than what a clock tells well.
    double most_seconds(const Point& point) const
    {
        if (point.changes.empty()) return std::numeric_limits<double>::infinity();
        return std::max(kLeast, kTooSlow * seconds_of(found_.points[0]));
    }
    // Of the clock, that a trial takes.
    double seconds_of(const Point& point) const
    {
        return 1e-3 * point.time_ms.median * trials_.length() / kFrame;
    }
    static void average_time(Point& point)
    {
        if (point.times_ms.empty()) return;
        const double mean = mean_of(point.times_ms, point.times_ms.size());
        point.time_ms = {mean, mean, mean, 1};
    }
    static double mean_of(const std::vector<double>& list, std::size_t count)
    {
        double sum = 0;
        for (std::size_t k = 0; k < count; ++k) sum += list[k];
        return sum / static_cast<double>(count);
    }

    // Substeps that a second takes: what the work goes by most of all.
    double substeps_of(const Point& point) const
    {
        const Settings settings = changed(trials_.scene(), point.changes).settings;
        return settings.substeps / settings.dt;
    }
    // After that of no change the cheap ones come first: where time is up, it is the dearest that
    // are missing.
    void measure_all(std::size_t trials, double share)
    {
        std::vector<std::pair<double, std::size_t>> turns;
        for (std::size_t at = 0; at < found_.points.size(); ++at)
            if (point(at).trouble.empty())
                turns.emplace_back(at == 0 ? 0 : substeps_of(point(at)), at);
        std::sort(turns.begin(), turns.end());
        for (std::size_t k = 0; k < turns.size(); ++k) {
            if (k > 0 && time_left(share) < 0) {
                found_.cut_short = true;
                break;
            }
            show(k + 1, turns.size(), point(turns[k].second), "setting");
            measure(point(turns[k].second), trials, share);
        }
    }
    void measure_left(std::size_t trials)
    {
        for (std::size_t k = 0; k < left_.size(); ++k) {
            if (time_left() < 0) {
                found_.cut_short = true;
                return;
            }
            show(k + 1, left_.size(), point(left_[k]), "nearer look, setting");
            measure(point(left_[k]), trials);
        }
    }

    // By another, on the trials that both were measured on.
    bool beaten(const Point& point, double by) const
    {
        return std::any_of(found_.points.begin(), found_.points.end(), [&](const Point& other) {
            if (!other.had()) return false;
            const std::size_t both = std::min(point.errors.size(), other.errors.size());
            const auto error = [&](const Point& of) {
                return rms(std::span(of.errors).first(both), plan_.measure);
            };
            return mean_of(other.times_ms, both) <= by * mean_of(point.times_ms, both)
                && error(other) <= by * error(point);
        });
    }
    // That of no change stays, beaten or not.
    void leave_beaten(double by)
    {
        std::erase_if(left_, [&](std::size_t at) {
            return !point(at).had() || (at > 0 && beaten(point(at), by));
        });
    }

    // Whether a value by itself does any good, or no more harm than it saves.
    bool is_worth_more(const Point& point) const
    {
        const Point& own = found_.points[0];
        const double error = point.error(plan_.measure), own_error = own.error(plan_.measure);
        const bool faster = point.time_ms.median < kFaster * own.time_ms.median;
        return point.had() && !beaten(point, kBeatenBy[1])
            && (faster || error < (1 - kChanges) * own_error);
    }
    void join()
    {
        std::vector<std::size_t> steps, others;
        for (std::size_t at = 1; at < found_.points.size(); ++at) {
            const bool is_step = at < steps_end_;
            if (is_step && point(at).had() && !beaten(point(at), kBeatenBy[1])) steps.push_back(at);
            if (!is_step && is_worth_more(point(at))) others.push_back(at);
        }
        std::stable_sort(others.begin(), others.end(), [&](std::size_t a, std::size_t b) {
            return worth(point(a)) < worth(point(b));
        });
        if (others.size() > kMostJoined) others.resize(kMostJoined);
        spread(steps);
        std::vector<Changes> joint;
        for (const std::size_t step : steps)
            for (const std::size_t other : others)
                joint.push_back(joined(point(step).changes, point(other).changes));
        for (std::size_t a = 0; a < others.size(); ++a)
            for (std::size_t b = a + 1; b < others.size(); ++b)
                joint.push_back(joined(point(others[a]).changes, point(others[b]).changes));
        for (const Changes& each : joint) add(each);
    }
    // From the cheapest to the dearest, so that no part of the front is without.
    void spread(std::vector<std::size_t>& steps)
    {
        std::stable_sort(steps.begin(), steps.end(), [&](std::size_t a, std::size_t b) {
            return point(a).time_ms.median < point(b).time_ms.median;
        });
        if (steps.size() <= kMostJoined) return;
        std::vector<std::size_t> some;
        for (std::size_t k = 0; k < kMostJoined; ++k)
            some.push_back(steps[k * (steps.size() - 1) / (kMostJoined - 1)]);
        steps = std::move(some);
    }
    // From the front to its neighbors, as long as that leads to settings that are new and time is
    // left: what joins two good values need not be at the best of steps for both.
    void move_on()
    {
        for (bool moved = true; moved && time_left(kTriesShare) > 0;) {
            const std::size_t before = found_.points.size();
            std::vector<std::size_t> front;
            for (std::size_t at = 0; at < before; ++at)
                if (point(at).had() && !beaten(point(at), kAtFront)) front.push_back(at);
            for (const std::size_t at : front)
                for (const Changes& each :
                     neighbors_of(trials_.scene(), point(at).changes, plan_.dials))
                    add(each);
            measure_all(kFirstTrials, kTriesShare);
            moved = found_.points.size() > before;
        }
    }
    // The less the better: time times error, as on a front of order 1.
    double worth(const Point& point) const
    {
        return point.time_ms.median * point.error(plan_.measure);
    }

    // In turn, so that a busy machine is busy for all of them; in whole rounds.
    void take_times()
    {
        const WallClock::time_point begin = WallClock::now();
        std::vector<std::vector<double>> times(left_.size());
        for (int repeat = 0; repeat < plan_.repeats; ++repeat) {
            double takes = 0;
            for (const std::size_t at : left_)
                takes += seconds_of(point(at)) * static_cast<double>(timed());
            if (seconds_since(begin) + takes > kTimesShare * plan_.patience) {
                found_.cut_short = found_.cut_short || repeat == 0;
                break;
            }
            for (std::size_t k = 0; k < left_.size(); ++k) {
                show(k + 1, left_.size(), point(left_[k]), "time of setting");
                times[k].push_back(time_of(point(left_[k])));
            }
        }
        for (std::size_t k = 0; k < left_.size(); ++k) {
            std::vector<double>& of = times[k];
            if (of.empty()) continue;
            std::sort(of.begin(), of.end());
            point(left_[k]).time_ms = {of[of.size() / 2], of.front(), of.back(), of.size()};
        }
    }
    std::size_t timed() const { return std::min(kTimedTrials, trials_.size()); }
    double time_of(const Point& point) const
    {
        double sum = 0;
        for (std::size_t k = 0; k < timed(); ++k)
            sum += trials_.time_ms(point.changes, k * trials_.size() / timed());
        return sum / static_cast<double>(timed());
    }

    const Trials& trials_;
    const SweepPlan& plan_;
    const Watch& watch_;
    WallClock::time_point begin_;
    SweepResult found_;
    std::size_t steps_end_ = 0;      // of the points of steps, from the second on
    std::vector<std::size_t> left_;  // points that nothing beats by far
};

}  // namespace

SweepResult
sweep(const Trials& trials, const Effects& effects, const SweepPlan& plan, const Watch& watch)
{
    const Candidates candidates = candidates_for(trials.scene(), effects, plan.dials);
    return Sweeper(trials, plan, watch).run(candidates);
}

void mark_front(std::span<Point> points, std::size_t measure)
{
    const auto how_well = [](const Point& point) {
        return std::pair(point.errors.size(), point.time_ms.repeats);
    };
    std::pair<std::size_t, std::size_t> best;
    for (const Point& point : points)
        if (point.had()) best = std::max(best, how_well(point));
    std::vector<Point*> by_time;
    for (Point& point : points) {
        point.on_front = false;
        if (point.had() && how_well(point) == best && std::isfinite(point.error(measure)))
            by_time.push_back(&point);
    }
    std::stable_sort(by_time.begin(), by_time.end(), [&](const Point* a, const Point* b) {
        return a->time_ms.median != b->time_ms.median
            ? a->time_ms.median < b->time_ms.median
            : a->error_at_most(measure) < b->error_at_most(measure);
    });
    double least = std::numeric_limits<double>::infinity();
    for (Point* const point : by_time) {
        const double error = point->error_at_most(measure);
        if (!(error < least)) continue;
        least = error;
        point->on_front = true;
    }
}

namespace {

// Of the front the one with the least `cost` among those whose `held` stays within a limit; where
// there is none, that with the least of what is held.
template <class Held, class Cost>
const Point*
best_within(std::span<const Point> points, double limit, const Held& held, const Cost& cost)
{
    const auto key = [&](const Point& point) {
        const bool meets = held(point) <= limit;
        return std::pair(!meets, meets ? cost(point) : held(point));
    };
    const Point* best = nullptr;
    for (const Point& point : points)
        if (point.on_front && (best == nullptr || key(point) < key(*best))) best = &point;
    return best;
}

}  // namespace

const Point* cheapest_within(std::span<const Point> points, std::size_t measure, double error)
{
    return best_within(
        points, error, [&](const Point& point) { return point.error_at_most(measure); },
        [](const Point& point) { return point.time_ms.median; });
}

const Point* most_exact_within(std::span<const Point> points, std::size_t measure, double time_ms)
{
    return best_within(
        points, time_ms, [](const Point& point) { return point.time_ms.median; },
        [&](const Point& point) { return point.error_at_most(measure); });
}

}  // namespace throng
