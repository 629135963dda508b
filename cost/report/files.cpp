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

std::string errors_json(const std::vector<Quantity>& quantities,
                        const Point& point,
                        double (Point::*error)(std::size_t) const)
{
    JsonMembers errors;
    for (std::size_t i = 0; i < quantities.size(); ++i)
        errors.add(quantities[i].name, (point.*error)(i));
    return errors.text();
}

// In one line.
template <class List, class Text>
std::string row_json(const List& list, const Text& text)
{
    std::string all;
    for (const auto& item : list) all += (all.empty() ? "" : ", ") + text(item);
    return '[' + all + ']';
}

std::string numbers_json(const std::vector<double>& numbers)
{
    return row_json(numbers, [](double number) { return json_text(number); });
}

// Of each trial, of each quantity: what averages are taken of.
std::string squares_json(const std::vector<Quantity>& quantities, const Point& point)
{
    return row_json(point.errors, [&](Errors trial) {
        trial.resize(quantities.size());  // what was never put in is 0
        return numbers_json(trial);
    });
}

std::string settings_json(const Changes& changes)
{
    JsonMembers settings;
    for (const Change& each : changes) settings.add(each.dial, json_dial_value(each.value));
    return settings.text();
}

std::string point_json(const std::vector<Quantity>& quantities, const Point& point)
{
    JsonMembers members;
    members.add("settings", settings_json(point.changes));
    if (!point.trouble.empty()) return members.add_text("trouble", point.trouble).text();
    return members.add("errors", errors_json(quantities, point, &Point::error))
        .add("errors_at_most", errors_json(quantities, point, &Point::error_at_most))
        .add("squares", squares_json(quantities, point))
        .add("times_ms", numbers_json(point.times_ms))
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
        .add_text("options", as_options(joined(report.given, advice.point->changes)))
        .add_text("command", command_of(report, *advice.point))
        .text();
}

std::string units_json(const std::vector<Quantity>& quantities)
{
    JsonMembers units;
    for (const Quantity& each : quantities) units.add_text(each.name, each.unit);
    return units.text();
}

// What is a word stands as it is; a case's quantities are sentences.
std::string head_in_csv(const std::string& head)
{
    return head.find_first_of(" ,\"") == std::string::npos ? head : in_csv(head);
}

std::string stages_json(const std::vector<StageTime>& stages)
{
    JsonMembers times;
    for (const StageTime& each : stages) times.add(each.name, each.time_ms);
    return times.text();
}

// What the report is of: a scene and its windows, or a case and its line.
void add_trials(const CostReport& report, JsonMembers& all)
{
    if (!report.of_case) {
        all.add("windows", static_cast<double>(report.windows))
            .add("windows_at_rest", static_cast<double>(report.at_rest))
            .add("window_s", report.window)
            .add("seconds", report.plan.seconds);
        return;
    }
    const CaseLine& line = *report.of_case;
    all.add_text("about", line.about)
        .add_text("line", line.setting)
        .add("runs", static_cast<double>(line.runs))
        .add("seconds", line.seconds);
}

}  // namespace

void write_cost_csv(const CostReport& report, std::ostream& out)
{
    out << "setting";
    for (const Quantity& told : report.quantities) {
        std::string unit = told.unit;
        std::replace(unit.begin(), unit.end(), ' ', '_');
        out << ',' << head_in_csv(told.name + '_' + unit) << ','
            << head_in_csv(told.name + "_at_most_" + unit);
    }
    out << ',' << (report.of_case ? "trials" : "windows")
        << ",time_ms,time_least_ms,time_most_ms,repeats,on_front,trouble\n";
    for (const Point& point : report.found.points) {
        out << in_csv(text_of(point.changes));
        for (std::size_t i = 0; i < report.quantities.size(); ++i)
            out << ',' << number_text(point.error(i)) << ',' << number_text(point.error_at_most(i));
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
    all.add_text(report.of_case ? "case" : "scene", report.scene);
    if (!report.of_case) all.add("seed", static_cast<double>(report.seed));
    all.add_text("command", report.command)
        .add("given", settings_json(report.given))
        .add("bodies", static_cast<double>(report.bodies))
        .add("machine",
             JsonMembers()
                 .add_text("processor", machine.processor)
                 .add("cores", machine.cores)
                 .add("threads", machine.threads)
                 .add("load", machine.load)
                 .add_text("throng", machine.version)
                 .text());
    add_trials(report, all);
    all.add_text("measure", report.told().name)
        .add("units", units_json(report.quantities))
        .add_text("state", report.state)
        .add("reference",
             JsonMembers()
                 .add_text("settings",
                           report.of_case ? reference_of(report) : report.reference.settings)
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
        .add("stages_ms", stages_json(report.stages))
        .add("advised_stages_ms", stages_json(report.advised_stages))
        .add("wish",
             JsonMembers()
                 .add("error", report.wish.error)
                 .add("time_ms", report.wish.time_ms)
                 .text())
        .add("advice", advice_json(report))
        .add("idle_dials",
             row_json(idle_dials(report.found.points, report.measure),
                      [](const std::string& dial) { return json_text(dial); }))
        .add("doubts",
             array(doubts_of(report), [](const std::string& doubt) { return json_text(doubt); }))
        .add("points", array(report.found.points, [&](const Point& point) {
                 return point_json(report.quantities, point);
             }));
    out << all.text() << '\n';
}

}  // namespace throng
