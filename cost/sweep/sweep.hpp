// Sweep: what error and what time the settings have that a scene or a case may be stepped by, found
// without trying all of them.
#pragma once

#include "cost/sweep/candidates.hpp"
#include "cost/sweep/trials.hpp"

#include <span>
#include <string>
#include <vector>

namespace throng {

/// One setting, measured. What is measured of it is named by its place among the trials'
/// quantities.
///
///   errors    of the trials it was measured on, the first of all
///   times_ms  of the same trials, for each 1/60 s of simulated time
///   time_ms   the average over trials: as it was measured first, or once it was timed in turn the
///             median of some repeats and what they lie between
///   reference_off  what the reference is itself off by: the true error may be as much more than
///             the measured one
///   on_front  no other setting is as fast and more exact
///   trouble   why it was given up; empty where it was not
struct Point {
    Changes changes;
    std::vector<Errors> errors;
    std::vector<double> times_ms;
    struct Time {
        double median = 0, least = 0, most = 0;
        std::size_t repeats = 0;
    } time_ms;
    Errors reference_off;
    bool on_front = false;
    std::string trouble;

    double error(std::size_t measure) const { return rms(errors, measure); }
    double error_at_most(std::size_t measure) const
    {
        return rms_at_most(errors, measure) + of(reference_off, measure);
    }
    bool had() const { return trouble.empty() && !errors.empty(); }
};

/// How it is swept.
///
///   dials     alone; empty: all that can matter
///   settings  tried alone, each on all trials and none left; empty: those that are worth a try
///   measure   by which the front is: a place among the quantities
///   patience  s of the clock after which nothing new is begun
///   repeats   of the times of what is on the front
///   known     points that were measured before, on the same trials: not measured again
struct SweepPlan {
    std::vector<std::string> dials;
    std::vector<Changes> settings;
    std::size_t measure = 0;
    double patience = 180;
    int repeats = 7;
    std::vector<Point> known;
};

/// What was found; the first point is of no change.
///
///   cut_short    patience ended before all was tried that should have been
///   interrupted  somebody ended it: what was found until then is kept
struct SweepResult {
    std::vector<Point> points;
    bool cut_short = false, interrupted = false;
};

/// Steps and substeps together and every other value by itself are measured on a few trials; what
/// another beats by far is left (successive halving); values that did well by themselves are tried
/// with the steps that did; from the front others are looked for, a dial at a time, until that
/// leads to nothing new; and what is near the front is measured on more trials, at last on all, and
/// timed in turn. effects: of the trials' scene. Settings that the plan names are measured whole
/// instead, without a choice among them: what those are held against that were found so.
///
/// Source: Jamieson and Talwalkar, Non-stochastic best arm identification and hyperparameter
///         optimization (2016).
SweepResult
sweep(const Trials& trials, const Effects& effects, const SweepPlan& plan, const Watch& watch);

/// Marks those of which no other is as fast and more exact, among those that were measured on the
/// most trials and timed the most often: a time taken alone is no match for times taken in turn.
void mark_front(std::span<Point> points, std::size_t measure);

/// The cheapest point whose error stays within what is wanted; where there is none the most exact.
/// Null where none was measured.
const Point* cheapest_within(std::span<const Point> points, std::size_t measure, double error);
/// The most exact point within a time; where there is none the cheapest.
const Point* most_exact_within(std::span<const Point> points, std::size_t measure, double time_ms);

}  // namespace throng
