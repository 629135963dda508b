// Files: the report for programs, as JSON and as CSV.
#include "cost/report/cost_report.hpp"
#include "scene/files/json_writer.hpp"
#include "scene/names.hpp"

#include <algorithm>

namespace throng {

namespace {

std::string in_csv(std::string_view text)
{
    std::string quoted = "\"";
    for (const char letter : text) quoted += letter == '"' ? "\"\"" : std::string(1, letter);
    return quoted + '"';
}

std::string errors_json(const Point& point, double (Point::*error)(Measure) const)
{
    JsonMembers errors;
    for (std::size_t i = 0; i < kMeasures; ++i) {
        const auto measure = static_cast<Measure>(i);
        errors.add(info(measure).name, (point.*error)(measure));
    }
    return errors.text();
}

// Of each window, of each measure: what averages are taken of.
std::string squares_json(const Point& point)
{
    std::string windows;
    for (const WindowErrors& window : point.errors) {
        std::string squares;
        for (const double square : window)
            squares += (squares.empty() ? "" : ", ") + json_text(square);
        windows += (windows.empty() ? "[" : ", [") + squares + ']';
    }
    return '[' + windows + ']';
}

std::string times_json(const Point& point)
{
    std::string times;
    for (const double time : point.times_ms) times += (times.empty() ? "" : ", ") + json_text(time);
    return '[' + times + ']';
}

std::string settings_json(const Changes& changes)
{
    JsonMembers settings;
    for (const Change& each : changes) settings.add(each.dial, json_dial_value(each.value));
    return settings.text();
}

std::string point_json(const Point& point)
{
    JsonMembers members;
    members.add("settings", settings_json(point.changes));
    if (!point.trouble.empty()) return members.add_text("trouble", point.trouble).text();
    return members.add("errors", errors_json(point, &Point::error))
        .add("errors_at_most", errors_json(point, &Point::error_at_most))
        .add("squares", squares_json(point))
        .add("times_ms", times_json(point))
        .add("time_ms",
             JsonMembers()
                 .add("median", point.time_ms.median)
                 .add("least", point.time_ms.least)
                 .add("most", point.time_ms.most)
                 .add("repeats", static_cast<double>(point.time_ms.repeats))
                 .text())
        .add("on_front", json_text(point.on_front))
        .text();
}

template <class List, class Text>
std::string array(const List& list, const Text& text)
{
    std::string all;
    for (const auto& item : list) all += (all.empty() ? "" : ",\n  ") + text(item);
    return "[\n  " + all + ']';
}

std::string advice_json(const CostReport& report)
{
    const Advice advice = advice_of(report);
    if (advice.point == nullptr) return "null";
    const auto place = static_cast<double>(advice.point - report.found.points.data());
    return JsonMembers()
        .add("point", place)
        .add("meets", json_text(advice.meets))
        .add_text("options", as_options(advice.point->changes))
        .text();
}

std::string units_json()
{
    JsonMembers units;
    for (std::size_t i = 0; i < kMeasures; ++i) {
        const MeasureInfo& told = info(static_cast<Measure>(i));
        units.add_text(told.name, told.unit);
    }
    return units.text();
}

}  // namespace

void write_cost_csv(const CostReport& report, std::ostream& out)
{
    out << "setting";
    for (std::size_t i = 0; i < kMeasures; ++i) {
        const MeasureInfo& told = info(static_cast<Measure>(i));
        out << ',' << told.name << '_' << told.unit << ',' << told.name << "_at_most_" << told.unit;
    }
    out << ",windows,time_ms,time_least_ms,time_most_ms,repeats,on_front,trouble\n";
    for (const Point& point : report.found.points) {
        out << in_csv(text_of(point.changes));
        for (std::size_t i = 0; i < kMeasures; ++i) {
            const auto measure = static_cast<Measure>(i);
            out << ',' << number_text(point.error(measure)) << ','
                << number_text(point.error_at_most(measure));
        }
        const Point::Time& time = point.time_ms;
        out << ',' << point.errors.size() << ',' << number_text(time.median) << ','
            << number_text(time.least) << ',' << number_text(time.most) << ',' << time.repeats
            << ',' << (point.on_front ? 1 : 0) << ',' << in_csv(point.trouble) << '\n';
    }
}

void write_cost_json(const CostReport& report, std::ostream& out)
{
    const Machine& machine = report.machine;
    JsonMembers all;
    all.add_text("scene", report.scene)
        .add("seed", static_cast<double>(report.seed))
        .add("bodies", static_cast<double>(report.bodies))
        .add("machine",
             JsonMembers()
                 .add_text("processor", machine.processor)
                 .add("cores", machine.cores)
                 .add("threads", machine.threads)
                 .add("load", machine.load)
                 .add_text("throng", machine.version)
                 .text())
        .add("windows", static_cast<double>(report.windows))
        .add("windows_at_rest", static_cast<double>(report.at_rest))
        .add("window_s", report.window)
        .add("seconds", report.plan.seconds)
        .add_text("measure", info(report.measure).name)
        .add("units", units_json())
        .add_text("state", report.state)
        .add("reference",
             JsonMembers()
                 .add_text("settings", report.reference.settings)
                 .add("remaining", of(report.reference.remaining, report.measure))
                 .add("settles", json_text(report.reference.settles))
                 .text())
        .add("orders",
             array(report.orders,
                   [](const FittedOrder& fitted) {
                       return JsonMembers()
                           .add_text("dial", fitted.dial)
                           .add("order", fitted.order)
                           .add("values", static_cast<double>(fitted.points))
                           .add_text("last_that_helps", fitted.helps)
                           .text();
                   }))
        .add("wish",
             JsonMembers()
                 .add("error", report.wish.error)
                 .add("time_ms", report.wish.time_ms)
                 .text())
        .add("advice", advice_json(report))
        .add("doubts",
             array(doubts_of(report), [](const std::string& doubt) { return json_text(doubt); }))
        .add("points", array(report.found.points, point_json));
    out << all.text() << '\n';
}

}  // namespace throng
