// Text: the report on a terminal.
#include "cost/report/cost_report.hpp"
#include "scene/names.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>

namespace throng {

namespace {

std::vector<const Point*> front_of(const CostReport& report)
{
    std::vector<const Point*> front;
    for (const Point& point : report.found.points)
        if (point.on_front || (point.changes.empty() && point.had())) front.push_back(&point);
    std::sort(front.begin(), front.end(),
              [](const Point* a, const Point* b) { return a->time_ms.median < b->time_ms.median; });
    return front;
}

// A case tells the same in every run: there is no error at most.
void write_row(const CostReport& report, const Point& point, std::ostream& out)
{
    const double spread = point.time_ms.median > 0
        ? 100 * (point.time_ms.most - point.time_ms.least) / point.time_ms.median
        : 0;
    out << (point.on_front ? "  " : " -") << std::setw(9)
        << figure_text(point.error(report.measure)) << std::setw(10);
    if (!report.of_case) out << figure_text(point.error_at_most(report.measure)) << std::setw(10);
    out << figure_text(point.time_ms.median) << std::setw(7) << std::lround(spread) << " %  "
        << name_of(report, point) << '\n';
}

std::string promise_of(const CostReport& report, const Point& point)
{
    const double error = point.error(report.measure);
    const std::string name = report.told().name + ' ';
    if (report.of_case) return name + with_unit(number_text(error), report.told());
    return name + with_unit(figure_text(error), report.told())
        + ", in 19 of 20 runs like this at most "
        + with_unit(figure_text(point.error_at_most(report.measure)), report.told());
}

// As many as fit into lines of a screen.
void write_wrapped(const std::string& head,
                   const std::vector<std::string>& items,
                   std::ostream& out)
{
    constexpr std::size_t kWidth = 80;
    std::string line = head;
    for (std::size_t i = 0; i < items.size(); ++i) {
        const std::string item = items[i] + (i + 1 < items.size() ? "," : "");
        if (line.size() + 1 + item.size() > kWidth) {
            out << line << '\n';
            line = std::string(head.find_first_not_of(' ') + 2, ' ');
        }
        line += (line.back() == ' ' ? "" : " ") + item;
    }
    out << line << '\n';
}

void write_other_errors(const CostReport& report, const Point& point, std::ostream& out)
{
    std::vector<std::string> others;
    for (std::size_t i = 0; i < report.quantities.size(); ++i)
        if (i != report.measure)
            others.push_back(report.quantities[i].name + ' '
                             + with_unit(figure_text(point.error(i)), report.quantities[i]));
    if (!others.empty()) write_wrapped("  besides:", others, out);
}

}  // namespace

void write_front(const CostReport& report, std::ostream& out)
{
    out << "    error" << (report.of_case ? "" : "   at most") << "   time ms  spread  setting\n";
    for (const Point* const point : front_of(report)) write_row(report, *point, out);
}

void write_advice(const CostReport& report, std::ostream& out)
{
    const Advice advice = advice_of(report);
    if (advice.point == nullptr) {
        out << "no setting could be measured: see the troubles in the table of all points\n";
        return;
    }
    const Point& point = *advice.point;
    const Wish& wish = report.wish;
    if (wish.time_ms > 0)
        out << (advice.meets ? "the most exact within " : "nothing is within ") << wish.time_ms
            << " ms" << (advice.meets ? ":\n" : "; the cheapest that was found:\n");
    else if (wish.error > 0)
        out << (advice.meets ? "the cheapest within " : "nothing is within ")
            << with_unit(number_text(wish.error), report.told())
            << (advice.meets ? ":\n" : "; the most exact that was found:\n");
    else
        out << "the most exact that was found:\n";
    const Changes all = joined(report.given, point.changes);
    out << "  " << (all.empty() ? name_of_own(report) : as_options(all)) << '\n';
    if (!all.empty()) out << "  " << as_settings(all) << '\n';
    out << "  " << promise_of(report, point) << "; " << figure_text(point.time_ms.median)
        << " ms for each 1/60 s (" << figure_text(point.time_ms.least) << " to "
        << figure_text(point.time_ms.most) << " of " << point.time_ms.repeats << ") on "
        << report.machine.threads << " thread" << (report.machine.threads == 1 ? "" : "s") << '\n';
    write_other_errors(report, point, out);
    const std::vector<std::string> idle = idle_dials(report.found.points, report.measure);
    if (!idle.empty()) write_wrapped("did not matter here, errors alike:", idle, out);
}

void write_cost_text(const CostReport& report, std::ostream& out)
{
    const Quantity& told = report.told();
    out << report.scene << ", " << report.bodies << (report.bodies == 1 ? " body, " : " bodies, ")
        << trials_of(report) << '\n'
        << "reference: " << reference_of(report) << '\n'
        << "machine: " << report.machine.processor << ", " << report.machine.threads << " of "
        << report.machine.cores << " cores, load " << report.machine.load << "; throng "
        << report.machine.version << "\n\n"
        << told.name << ": " << told.about << (told.unit == "1" ? "" : ", " + told.unit)
        << "; time: ms for each 1/60 s of the scene\n";
    write_front(report, out);
    out << "settings on the front, of " << report.found.points.size()
        << " tried; with - one that others beat\n";
    for (const FittedOrder& fitted : report.orders)
        out << "order in " << fitted.dial << ": " << figure_text(fitted.order) << " ("
            << fitted.points << " values"
            << (fitted.helps.empty() ? "; none other helps"
                                     : ", the last that helps " + fitted.dial + '=' + fitted.helps)
            << ")\n";
    out << '\n';
    write_advice(report, out);
    for (const std::string& doubt : doubts_of(report)) out << "doubt: " << doubt << '\n';
}

void draw_front(const CostReport& report, std::ostream& out)
{
    constexpr int kWidth = 64, kHeight = 18;
    double low_time = INFINITY, high_time = 0, low = INFINITY, high = 0;
    std::vector<const Point*> drawn;
    for (const Point& point : report.found.points) {
        const double error = point.error(report.measure);
        if (!is_drawn(point, report.measure)) continue;
        drawn.push_back(&point);
        low_time = std::min(low_time, point.time_ms.median);
        high_time = std::max(high_time, point.time_ms.median);
        low = std::min(low, error);
        high = std::max(high, error);
    }
    if (drawn.empty()) return;
    const auto place = [](double value, double least, double most, int cells) {
        if (!(most > least)) return 0;
        return static_cast<int>(
            std::lround((cells - 1) * std::log(value / least) / std::log(most / least)));
    };
    std::vector<std::string> rows(kHeight, std::string(kWidth, ' '));
    const auto draw = [&](const Point& point, char letter) {
        const int x = place(point.time_ms.median, low_time, high_time, kWidth);
        const int y = place(point.error(report.measure), low, high, kHeight);
        rows[static_cast<std::size_t>(kHeight - 1 - y)][static_cast<std::size_t>(x)] = letter;
    };
    for (const Point* const point : drawn) draw(*point, '.');
    for (const Point* const point : drawn)
        if (point->on_front) draw(*point, 'o');
    draw(report.found.points[0], '@');
    out << '\n' << label_of(report.told()) << '\n';
    for (int row = 0; row < kHeight; ++row)
        out << std::setw(9)
            << (row == 0                 ? figure_text(high)
                    : row == kHeight - 1 ? figure_text(low)
                                         : "")
            << " |" << rows[static_cast<std::size_t>(row)] << '\n';
    out << std::string(10, ' ') << '+' << std::string(kWidth, '-') << '\n';
    const std::string left = figure_text(low_time), right = figure_text(high_time);
    out << std::string(11, ' ') << left
        << std::string(static_cast<std::size_t>(kWidth) - left.size() - right.size(), ' ') << right
        << "  ms\n"
        << std::string(11, ' ') << "o on the front   . beaten   @ " << name_of_own(report) << '\n';
    const std::string undrawn = undrawn_of(report);
    if (!undrawn.empty()) out << std::string(11, ' ') << undrawn << '\n';
}

}  // namespace throng
