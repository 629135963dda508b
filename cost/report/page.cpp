// Page: the report as one HTML page, from page.html.
#include "cost/report/cost_report.hpp"
#include "cost/report/markup.hpp"
#include "cost/report/page_template.hpp"
#include "scene/names.hpp"

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace throng {

namespace {

std::string element(std::string_view name, std::string_view text)
{
    const std::string tag(name);
    return '<' + tag + '>' + in_markup(text) + "</" + tag + ">\n";
}

// A cell that sorts by the whole number and shows two digits of it; empty where there is none.
std::string cell(double figure)
{
    if (std::isnan(figure)) return "<td></td>";
    return "<td data-value=\"" + number_text(figure) + "\">" + figure_text(figure) + "</td>";
}

std::string about(const CostReport& report)
{
    std::ostringstream text;
    if (report.of_case) text << report.of_case->about << "; ";
    text << report.bodies << (report.bodies == 1 ? " body" : " bodies");
    if (!report.of_case) text << ", seed " << report.seed;
    text << "; " << trials_of(report) << "; " << report.found.points.size() << " settings";
    return in_markup(text.str());
}

std::string advice(const CostReport& report)
{
    std::ostringstream text;
    write_advice(report, text);
    return "<pre class=\"advice\">" + in_markup(text.str()) + "</pre>";
}

std::string doubts(const CostReport& report)
{
    std::string list;
    for (const std::string& doubt : doubts_of(report)) list += element("li", doubt);
    return list.empty() ? "" : "<p>To be known before it is trusted:</p>\n<ul>\n" + list + "</ul>";
}

std::string chart(const CostReport& report)
{
    std::ostringstream text;
    write_cost_svg(report, text);
    const std::string undrawn = undrawn_of(report);
    if (!undrawn.empty())
        text << "<figcaption class=\"soft\">" << in_markup(undrawn) << "</figcaption>\n";
    return text.str();
}

// What is bounded by what other runs may come to.
std::string bars(const CostReport& report)
{
    return report.of_case
        ? ""
        : "; the\nthin bar of a dot on the front reaches to the error that 19 of 20 "
          "runs like this stay within";
}

std::string heads(const CostReport& report)
{
    std::vector<std::string> names = {"setting", label_of(report.told())};
    if (!report.of_case) names.emplace_back("at most");
    names.insert(names.end(), {"time, ms", "from", "to"});
    for (std::size_t i = 0; i < report.quantities.size(); ++i)
        if (i != report.measure) names.push_back(label_of(report.quantities[i]));
    names.emplace_back("front");
    std::string row;
    for (const std::string& name : names)
        row += "<th scope=\"col\" aria-sort=\"none\"><button type=\"button\">" + in_markup(name)
            + "</button></th>";
    return row;
}

std::string row(const CostReport& report, std::size_t at)
{
    const Point& point = report.found.points[at];
    std::string text = "<tr data-point=\"" + std::to_string(at) + "\" data-command=\""
        + in_markup(command_of(report, point)) + '"' + (point.on_front ? " class=\"front\"" : "")
        + "><td>" + in_markup(name_of(report, point))
        + (point.trouble.empty() ? "" : ": " + in_markup(point.trouble)) + "</td>";
    const auto figure = [&](double number) { text += cell(point.had() ? number : NAN); };
    figure(point.error(report.measure));
    if (!report.of_case) figure(point.error_at_most(report.measure));
    figure(point.time_ms.median);
    figure(point.time_ms.least);
    figure(point.time_ms.most);
    for (std::size_t i = 0; i < report.quantities.size(); ++i)
        if (i != report.measure) figure(point.error(i));
    return text + "<td>" + (point.on_front ? "yes" : "") + "</td></tr>\n";
}

std::string rows(const CostReport& report)
{
    std::string text;
    for (std::size_t at = 0; at < report.found.points.size(); ++at) text += row(report, at);
    return text;
}

std::string how(const CostReport& report)
{
    const Machine& machine = report.machine;
    std::ostringstream times;
    times << "Times: the median of repeats, settings in turn, on " << machine.threads << " of "
          << machine.cores << " cores of " << machine.processor << ", load " << machine.load
          << ", throng " << machine.version << '.';
    std::string text = element("p", "Reference: " + reference_of(report) + '.')
        + element("p", times.str()) + "<dl>\n";
    for (const Quantity& each : report.quantities)
        text += element("dt", label_of(each)) + element("dd", each.about);
    text += "</dl>\n";
    for (const FittedOrder& fitted : report.orders)
        text += element("p",
                        "Order in " + fitted.dial + ": " + figure_text(fitted.order) + ", of "
                            + std::to_string(fitted.points) + " values.");
    return text;
}

double time_of(const std::vector<StageTime>& stages, std::string_view name)
{
    for (const StageTime& each : stages)
        if (each.name == name) return each.time_ms;
    return NAN;
}

// In the order of the step, what the advice alone has at the end; nothing where nobody timed them.
std::string stages(const CostReport& report)
{
    if (report.stages.empty()) return "";
    std::vector<std::string_view> names;
    for (const StageTime& each : report.stages) names.push_back(each.name);
    for (const StageTime& each : report.advised_stages)
        if (std::isnan(time_of(report.stages, each.name))) names.push_back(each.name);
    std::string text =
        "<section aria-labelledby=\"stages\"><h2 id=\"stages\">Time by stage</h2>\n"
        "<p class=\"soft\">ms for each 1/60 s; where the step runs on several threads, of all of "
        "them.</p>\n<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"table of "
        "stages\">\n<table class=\"stages\">\n<thead><tr><th scope=\"col\">stage</th>"
        "<th scope=\"col\">as it is</th><th scope=\"col\">advised</th></tr></thead>\n<tbody>\n";
    for (const std::string_view name : names)
        text += "<tr><td>" + in_markup(name) + "</td>" + cell(time_of(report.stages, name))
            + cell(time_of(report.advised_stages, name)) + "</tr>\n";
    return text + "</tbody>\n</table>\n</div>\n</section>";
}

std::string word_for(std::string_view place, const CostReport& report)
{
    if (place == "scene") return in_markup(report.scene);
    if (place == "about") return about(report);
    if (place == "advice") return advice(report);
    if (place == "doubts") return doubts(report);
    if (place == "chart") return chart(report);
    if (place == "bars") return bars(report);
    if (place == "heads") return heads(report);
    if (place == "rows") return rows(report);
    if (place == "stages") return stages(report);
    if (place == "how") return how(report);
    throw std::logic_error("page.html: nothing is called " + std::string(place));
}

}  // namespace

void write_cost_page(const CostReport& report, std::ostream& out)
{
    std::string_view left = kPageTemplate;
    for (;;) {
        const std::size_t begin = left.find("{{"), end = left.find("}}");
        if (begin == std::string_view::npos) break;
        out << left.substr(0, begin) << word_for(left.substr(begin + 2, end - begin - 2), report);
        left.remove_prefix(end + 2);
    }
    out << left;
}

}  // namespace throng
