#include "cost/report/cost_report.hpp"

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

bool is_drawn(const Point& point, Measure measure)
{
    const double error = point.error(measure);
    return point.had() && std::isfinite(error) && error > 0 && point.time_ms.median > 0;
}

std::string name_of(const Point& point)
{
    return point.changes.empty() ? "the scene as it is" : text_of(point.changes);
}

std::string words_of(const CostReport& report, const Point& point)
{
    const MeasureInfo& told = info(report.measure);
    return name_of(point) + ": " + std::string(told.name) + ' '
        + figure_text(point.error(report.measure)) + ' ' + std::string(told.unit) + ", "
        + figure_text(point.time_ms.median) + " ms" + (point.on_front ? ", on the front" : "");
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
    const MeasureInfo& told = info(report.measure);
    const double remaining = of(report.reference.remaining, report.measure);
    const std::string off = figure_text(remaining) + ' ' + std::string(told.unit);
    if (!report.reference.settles)
        doubts.push_back("the reference does not settle: halving its step moved it by " + off
                         + ", no less than the time before; errors of that size cannot be told "
                           "apart. A shorter --window lets bodies part less");
    else if (report.wish.error > 0 && remaining > report.wish.error / 3)
        doubts.push_back("the reference is itself off by about " + off
                         + ", which is too near to the error that is wanted; --minutes gives it "
                           "more time");
    if (report.at_rest == report.windows)
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
