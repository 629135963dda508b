// Cost report: what a sweep of a scene has to say, for people and for programs.
#pragma once

#include "cost/sweep/orders.hpp"

#include <cstdint>
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

/// What was measured, and on what.
///
///   state  fingerprint of the scene as it begins and of where the reference has the windows end:
///          points of another are none of this report
struct CostReport {
    std::string scene, state;
    std::uint64_t seed = 0;
    std::size_t bodies = 0;
    Machine machine;
    WindowPlan plan;
    double window = 0;  // s
    std::size_t windows = 0, at_rest = 0;
    Measure measure = Measure::drift;
    ReferenceInfo reference;
    Wish wish;
    SweepResult found;
    std::vector<FittedOrder> orders;
};

/// A figure with two digits, which is what errors are known to.
std::string figure_text(double figure);

/// Whether it has a place among logarithms.
bool is_drawn(const Point& point, Measure measure);
/// Its changes, or that it is the scene as it is.
std::string name_of(const Point& point);
/// The same with its error and time, a line long.
std::string words_of(const CostReport& report, const Point& point);

/// What is advised, and whether it is what was wished for: of no wish the most exact point.
struct Advice {
    const Point* point = nullptr;
    bool meets = false;
};
Advice advice_of(const CostReport& report);

/// Sentences that a reader should know before trusting the figures: a reference that does not
/// settle, windows in which nothing moves, a sweep cut short.
std::vector<std::string> doubts_of(const CostReport& report);

/// What is advised, ready to paste, and what it promises.
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

/// The points of a report that was written before, if they are of that state; else none.
/// Throws SceneError, with line and column, where the text is no such report.
std::vector<Point>
read_points(const std::string& text, const std::string& file, const std::string& state);

}  // namespace throng
