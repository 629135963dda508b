// Comparison: two reports side by side.
#include "cost/report/cost_report.hpp"
#include "scene/names.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>

namespace throng {

namespace {

constexpr std::size_t kWidest = 48;  // of what stands in a column

std::string cut(const std::string& text)
{
    return text.size() > kWidest ? text.substr(0, kWidest - 3) + "..." : text;
}

// What a report is of and on, a line each; a star marks what the two have different.
class HeadTable {
public:
    void add(const std::string& name, const std::string& a, const std::string& b)
    {
        rows_.push_back({name, a, b});
        widest_ = std::max(widest_, cut(a).size());
    }
    void write(std::ostream& out) const
    {
        for (const Row& row : rows_)
            out << (row.a == row.b ? "  " : "* ") << std::left << std::setw(11) << row.name
                << std::setw(static_cast<int>(widest_) + 2) << cut(row.a) << cut(row.b) << '\n'
                << std::right;
    }

private:
    struct Row {
        std::string name, a, b;
    };
    std::vector<Row> rows_;
    std::size_t widest_ = 1;
};

std::string cores_of(const Machine& machine)
{
    return std::to_string(machine.threads) + " of " + std::to_string(machine.cores)
        + " cores, load " + number_text(machine.load);
}

void write_head(const CostReport& a, const CostReport& b, std::ostream& out)
{
    HeadTable table;
    const auto row = [&](const std::string& name, const auto& text) {
        table.add(name, text(a), text(b));
    };
    table.add("", "A", "B");
    row("of", [](const CostReport& r) { return (r.of_case ? "case " : "scene ") + r.scene; });
    row("seed", [](const CostReport& r) {
        return r.of_case ? std::string("none") : std::to_string(r.seed);
    });
    row("dials set", [](const CostReport& r) {
        return r.given.empty() ? std::string("none") : text_of(r.given);
    });
    row("bodies", [](const CostReport& r) { return std::to_string(r.bodies); });
    row("measure", [](const CostReport& r) { return label_of(r.told()); });
    row("on", trials_of);
    row("reference", reference_of);
    row("state", [](const CostReport& r) { return r.state; });
    row("throng", [](const CostReport& r) { return r.machine.version; });
    row("processor", [](const CostReport& r) { return r.machine.processor; });
    row("threads", [](const CostReport& r) { return cores_of(r.machine); });
    table.write(out);
}

// What of the two can be held side by side.
struct Comparable {
    bool errors = true, times = true;
    std::vector<std::string> why_not;
};

Comparable comparable(const CostReport& a, const CostReport& b)
{
    Comparable answer;
    const auto doubt = [&](const char* why, bool times) {
        answer.errors = false;
        answer.times = answer.times && times;
        answer.why_not.emplace_back(why);
    };
    if (a.scene != b.scene || a.of_case.has_value() != b.of_case.has_value())
        doubt("not comparable: they are of other scenes", false);
    else if (a.state != b.state)
        doubt(a.of_case ? "errors are not comparable: the case's line, or what it tells by its own "
                          "settings, is another"
                        : "errors are not comparable: they are of another state, for the windows "
                          "begin or end elsewhere (seed, window or version)",
              true);
    if (label_of(a.told()) != label_of(b.told()))
        doubt("errors are not comparable: they are of other measures", true);
    if (a.machine.processor != b.machine.processor || a.machine.threads != b.machine.threads)
        answer.why_not.emplace_back("times are of other machines or numbers of threads: their "
                                    "ratios tell of these as well");
    return answer;
}

// Whole settings, whatever part of them was set for all of a report.
Changes whole(const CostReport& report, const Point& point)
{
    Changes all = joined(report.given, point.changes);
    std::sort(all.begin(), all.end(),
              [](const Change& x, const Change& y) { return x.dial < y.dial; });
    return all;
}

std::string ratio(double a, double b)
{
    if (a == b) return "1";
    if (!(a > 0) || !std::isfinite(a) || !std::isfinite(b)) return "-";
    return figure_text(b / a);
}

void write_same(const CostReport& a, const CostReport& b, const Comparable& can, std::ostream& out)
{
    struct Both {
        const Point *a, *b;
        std::string name;
    };
    std::vector<Both> same;
    for (const Point& of_a : a.found.points)
        for (const Point& of_b : b.found.points) {
            const Changes all = whole(a, of_a);
            if (of_a.had() && of_b.had() && all == whole(b, of_b))
                same.push_back({&of_a, &of_b, all.empty() ? name_of_own(a) : text_of(all)});
        }
    if (same.empty()) {
        out << "\nno setting was measured in both\n";
        return;
    }
    std::stable_sort(same.begin(), same.end(), [](const Both& x, const Both& y) {
        return x.a->time_ms.median < y.a->time_ms.median;
    });
    out << "\nthe same settings, with o that are on the front of A and of B\n"
           "      error A  error B      B/A     ms A     ms B      B/A  setting\n";
    for (const Both& each : same) {
        const double error_a = each.a->error(a.measure), error_b = each.b->error(b.measure);
        const double time_a = each.a->time_ms.median, time_b = each.b->time_ms.median;
        out << "  " << (each.a->on_front ? 'o' : '.') << (each.b->on_front ? 'o' : '.');
        for (const std::string& text :
             {figure_text(error_a), figure_text(error_b),
              can.errors ? ratio(error_a, error_b) : std::string("-"), figure_text(time_a),
              figure_text(time_b), ratio(time_a, time_b)})
            out << std::setw(9) << text;
        out << "  " << each.name << '\n';
    }
}

}  // namespace

void write_comparison(const CostReport& a, const CostReport& b, std::ostream& out)
{
    write_head(a, b, out);
    const Comparable can = comparable(a, b);
    if (!can.why_not.empty()) out << '\n';
    for (const std::string& why : can.why_not) out << why << '\n';
    for (const auto& [name, report] : {std::pair("A", &a), std::pair("B", &b)}) {
        out << "\nfront of " << name << '\n';
        write_front(*report, out);
    }
    if (can.times) write_same(a, b, can, out);
    for (const auto& [name, report] : {std::pair("A", &a), std::pair("B", &b)}) {
        out << "\nadvice of " << name << ": ";
        write_advice(*report, out);
    }
}

}  // namespace throng
