#include "cost/report/cost_report.hpp"
#include "scene/names.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace throng {

std::string figure_text(double figure)
{
    std::ostringstream text;
    text << std::setprecision(2) << figure;
    return text.str();
}

bool is_drawn(const Point& point, std::size_t measure)
{
    const double error = point.error(measure);
    return point.had() && std::isfinite(error) && error > 0 && point.time_ms.median > 0;
}

std::string undrawn_of(const CostReport& report)
{
    const std::span<const Point> points = report.found.points;
    const auto count = std::count_if(points.begin(), points.end(), [&](const Point& point) {
        return point.had() && !is_drawn(point, report.measure);
    });
    if (count == 0) return {};
    return std::to_string(count) + (count == 1 ? " setting" : " settings")
        + " whose error is 0 or beyond all bounds, not drawn for want of a logarithm";
}

std::string name_of_own(const CostReport& report)
{
    return report.of_case ? "the case as it is" : "the scene as it is";
}

std::string name_of(const CostReport& report, const Point& point)
{
    return point.changes.empty() ? name_of_own(report) : text_of(point.changes);
}

std::string words_of(const CostReport& report, const Point& point)
{
    return name_of(report, point) + ": " + report.told().name + ' '
        + with_unit(figure_text(point.error(report.measure)), report.told()) + ", "
        + figure_text(point.time_ms.median) + " ms" + (point.on_front ? ", on the front" : "");
}

std::string command_of(const CostReport& report, const Point& point)
{
    const Changes all = joined(report.given, point.changes);
    return report.command + (all.empty() ? "" : ' ' + as_options(all));
}

std::string trials_of(const CostReport& report)
{
    if (!report.of_case)
        return std::to_string(report.windows) + " windows of " + number_text(report.window)
            + " s from the first " + number_text(report.plan.seconds) + " s of the scene";
    const CaseLine& line = *report.of_case;
    return "the line \"" + line.setting + ": " + report.told().name + "\", of "
        + std::to_string(line.runs) + (line.runs == 1 ? " run, " : " runs, ")
        + number_text(std::round(1e6 * line.seconds) / 1e6) + " s";
}

std::string reference_of(const CostReport& report)
{
    if (report.of_case) return "the case's own exact answer";
    return report.reference.settings + "; still off by "
        + with_unit(figure_text(of(report.reference.remaining, report.measure)), report.told());
}

Advice advice_of(const CostReport& report)
{
    const std::span<const Point> points = report.found.points;
    if (report.wish.time_ms > 0) {
        const Point* const best = most_exact_within(points, report.measure, report.wish.time_ms);
        return {best, best != nullptr && best->time_ms.median <= report.wish.time_ms};
    }
    const Point* const best = cheapest_within(points, report.measure, report.wish.error);
    const bool meets = best != nullptr
        && (report.wish.error == 0 || best->error_at_most(report.measure) <= report.wish.error);
    return {best, meets};
}

std::vector<std::string> doubts_of(const CostReport& report)
{
    std::vector<std::string> doubts;
    const double remaining = of(report.reference.remaining, report.measure);
    const std::string off = with_unit(figure_text(remaining), report.told());
    const bool none_errs = std::all_of(
        report.found.points.begin(), report.found.points.end(),
        [&](const Point& point) { return !point.had() || point.error(report.measure) == 0; });
    if (none_errs && advice_of(report).point != nullptr && report.found.points.size() > 1)
        doubts.push_back("no setting has any error: nothing that " + report.told().name
                         + " is of happens here, or all of them get it right");
    // What no reference is asked for is not off by it.
    if (!report.of_case && !report.reference.settles && remaining > 0)
        doubts.push_back("the reference does not settle: halving its step moved it by " + off
                         + ", no less than the time before; errors of that size cannot be told "
                           "apart. A shorter --window lets bodies part less");
    else if (report.wish.error > 0 && remaining > report.wish.error / 3)
        doubts.push_back("the reference is itself off by about " + off
                         + ", which is too near to the error that is wanted; --minutes gives it "
                           "more time");
    if (!report.of_case && report.at_rest == report.windows)
        doubts.push_back("nothing moves in any of the " + std::to_string(report.windows)
                         + " windows: these figures are of bodies at rest");
    if (report.found.interrupted)
        doubts.emplace_back("interrupted: this is what was found until then; --resume goes on");
    if (report.found.cut_short)
        doubts.emplace_back(
            "time was up before all settings were looked at as closely as they should "
            "be; --minutes gives more");
    return doubts;
}

}  // namespace throng
