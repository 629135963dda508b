// Cost report: what a sweep of a scene or of a hard case has to say, for people and for programs.
#pragma once

#include "cost/sweep/idle_dials.hpp"
#include "cost/sweep/orders.hpp"

#include <cstdint>
#include <optional>
#include <ostream>

namespace throng {

/// What was wished for: an error, in the measure's unit, or a time, in ms for each 1/60 s of the
/// scene's time; neither: 0.
struct Wish {
    double error = 0, time_ms = 0;
    bool any() const { return error > 0 || time_ms > 0; }
};

/// What the times were measured on.
///
///   load  of the last minute as the sweep began: processes that wanted a core
struct Machine {
    std::string processor, version;
    unsigned cores = 0;
    int threads = 0;
    double load = 0;
};

/// The line of a hard case whose figure is the error.
///
///   about    what the case shows
///   setting  of the line, as the case calls it
///   runs     that lead to it, of so many seconds of simulated time
struct CaseLine {
    std::string about, setting;
    std::size_t runs = 0;
    double seconds = 0;
};

/// What was measured, and on what.
///
///   scene     its name, or that of the case
///   state     fingerprint of the scene as it begins and of where the reference has the windows
///             end, or of the case's line: points of another are none of this report
///   command   that runs it as it was measured, but for `given`
///   given     the dials that were set for all of it
///   of_case   of a case; seed, plan, window, windows and at_rest are of a scene alone
///   stages, advised_stages  time by stage with no change, and by the advice; none of a case
struct CostReport {
    std::string scene, state, command;
    Changes given;
    std::uint64_t seed = 0;
    std::size_t bodies = 0;
    Machine machine;
    std::optional<CaseLine> of_case;
    WindowPlan plan;
    double window = 0;  // s
    std::size_t windows = 0, at_rest = 0;
    std::vector<Quantity> quantities = WindowTrials::of_windows();
    std::size_t measure = 0;
    ReferenceInfo reference;
    Wish wish;
    SweepResult found;
    std::vector<FittedOrder> orders;
    std::vector<StageTime> stages, advised_stages;

    /// What the error is of.
    const Quantity& told() const { return quantities[measure]; }
};

/// A figure with two digits, which is what errors are known to.
std::string figure_text(double figure);

/// Whether it has a place among logarithms.
bool is_drawn(const Point& point, std::size_t measure);
/// How many were measured and have none, in a sentence; empty where all have one.
std::string undrawn_of(const CostReport& report);
/// Of no change: the scene, or the case, as it is.
std::string name_of_own(const CostReport& report);
/// Its changes, or that there are none.
std::string name_of(const CostReport& report, const Point& point);
/// The same with its error and time, a line long.
std::string words_of(const CostReport& report, const Point& point);
/// What runs it: a command, ready to paste.
std::string command_of(const CostReport& report, const Point& point);
/// What it was measured on, and against what.
std::string trials_of(const CostReport& report);
std::string reference_of(const CostReport& report);

/// What is advised, and whether it is what was wished for: of no wish the most exact point.
struct Advice {
    const Point* point = nullptr;
    bool meets = false;
};
Advice advice_of(const CostReport& report);

/// Sentences that a reader should know before trusting the figures: a reference that does not
/// settle, windows in which nothing moves, a sweep cut short.
std::vector<std::string> doubts_of(const CostReport& report);

/// The front and what it began from, a row a setting.
void write_front(const CostReport& report, std::ostream& out);
/// What is advised, ready to paste, what it promises, its other errors, and which dials made no
/// difference.
void write_advice(const CostReport& report, std::ostream& out);
/// The front, the advice and the doubts, a screen wide.
void write_cost_text(const CostReport& report, std::ostream& out);
/// The front drawn in letters: error against time, both by their logarithms.
void draw_front(const CostReport& report, std::ostream& out);
/// Error against time as SVG: the front, the advice and a line a dial, each point with its words.
void write_cost_svg(const CostReport& report, std::ostream& out);
/// All of it as one HTML page that loads nothing: the advice, the chart, a table that sorts.
void write_cost_page(const CostReport& report, std::ostream& out);
/// A row a point, the names and units of the columns in the first.
void write_cost_csv(const CostReport& report, std::ostream& out);
void write_cost_json(const CostReport& report, std::ostream& out);

/// A report that was written before, but for its orders.
/// Throws SceneError, with line and column, where the text is no such report.
CostReport read_report(const std::string& text, const std::string& file);
/// Its points, if they are of the state of this one, and of the dials given here; else none.
std::vector<Point>
read_points(const std::string& text, const std::string& file, const CostReport& report);

/// Two reports side by side: what they are of and on, the front and the advice of each, and what
/// error and time of the same settings come to in the second beside the first. Says where they are
/// of different things, so that their figures cannot be compared.
void write_comparison(const CostReport& a, const CostReport& b, std::ostream& out);

}  // namespace throng
