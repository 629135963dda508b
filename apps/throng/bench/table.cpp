// Table: a benchmark's figures for people, in columns that programs can read, too.
#include "apps/throng/bench/budget.hpp"
#include "apps/throng/bench/report.hpp"
#include "cost/answers/answers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>

namespace throng::bench {
namespace {

using Row = std::vector<std::string>;

std::string text_of(double number, const char* format = "%.4g")
{
    char text[40];
    std::snprintf(text, sizeof text, format, number);
    return text;
}

/// Rows in columns, the first to the left and the others to the right.
void print_rows(const std::vector<Row>& rows, std::ostream& out)
{
    std::vector<std::size_t> widths;
    for (const Row& row : rows) {
        widths.resize(std::max(widths.size(), row.size()), 0);
        for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
    }
    for (const Row& row : rows) {
        out << "  ";
        for (std::size_t i = 0; i < row.size(); ++i) {
            const std::string pad(widths[i] - row[i].size(), ' ');
            out << (i == 0 ? row[i] + pad : "  " + pad + row[i]);
        }
        out << '\n';
    }
}

std::string times_of(const Figure& figure,
                     const std::string& engine,
                     Spread Comparison::*of = &Comparison::times)
{
    for (const Comparison& other : figure.against)
        if (other.engine == engine) return text_of((other.*of).median, "%.2f");
    return "-";
}

// What an engine took and how it compares.
void print_times(const Plan& plan,
                 const Case& made,
                 const std::vector<Figure>& figures,
                 std::ostream& out)
{
    Row head = {"engine", "threads", "steps",   "ms/step",    "median",   "p99",
                "cpu_ms", "spread",  "ns/body", "ns/contact", "contacts", "speedup"};
    constexpr std::ptrdiff_t kErrorAt = 4;
    if (plan.errors)
        head.insert(head.begin() + kErrorAt,
                    {"cpu_s", "error_" + std::string(find_answer(made.scene->name)->unit)});
    if (plan.efficiency) head.emplace_back("efficiency");
    for (const std::string& peer : plan.peers)
        head.insert(head.end(), {"x_" + peer, "cpu_x_" + peer});
    std::vector<Row> rows = {head};
    for (const Figure& figure : figures) {
        Row row = {name_of(figure.engine, figure.setting, figure.beside),
                   std::to_string(figure.threads_met),
                   std::to_string(figure.steps),
                   text_of(figure.ms_mean.median),
                   text_of(figure.ms_median),
                   text_of(figure.ms_p99),
                   text_of(figure.cpu_ms),
                   plan.repeats > 1 ? text_of(figure.ms_mean.relative() * 100, "%.1f%%") : "-",
                   text_of(figure.ns_a_body),
                   figure.ns_a_contact > 0 ? text_of(figure.ns_a_contact) : "-",
                   text_of(figure.contacts, "%.0f"),
                   times_of(figure, "throng")};
        if (plan.errors)
            row.insert(row.begin() + kErrorAt,
                       {text_of(figure.cpu_ms * static_cast<double>(figure.steps) / 1e3),
                        std::isnan(figure.error) ? "-" : text_of(figure.error, "%.3g")});
        if (plan.efficiency)
            row.push_back(figure.efficiency.median > 0 ? text_of(figure.efficiency.median, "%.3f")
                                                       : "-");
        for (const std::string& peer : plan.peers) {
            row.push_back(times_of(figure, peer));
            row.push_back(times_of(figure, peer, &Comparison::cpu_times));
        }
        rows.push_back(std::move(row));
    }
    print_rows(rows, out);
}

// What the state of each is worth, and what it holds.
void print_states(const std::vector<Figure>& figures, std::ostream& out)
{
    std::vector<Row> rows = {{"engine", "threads", "mean_overlap_mm", "max_overlap_mm", "overlaps",
                              "shared_volume", "J/body", "height_m", "state_B/body", "heap_B/body",
                              "rss_B/body", "state_hash"}};
    for (const Figure& figure : figures) {
        if (figure.beside > 0) continue;  // as by itself, and the memory of all of them
        const Quality& quality = figure.quality;
        rows.push_back({name_of(figure.engine, figure.setting), std::to_string(figure.threads_met),
                        text_of(quality.mean_overlap * 1e3),
                        text_of(quality.greatest_overlap * 1e3),
                        std::to_string(quality.overlapping_pairs),
                        std::isnan(quality.shared_volume) ? "-" : text_of(quality.shared_volume),
                        text_of(quality.kinetic_energy), text_of(quality.mean_height),
                        figure.state_bytes > 0 ? text_of(figure.state_bytes, "%.0f") : "-",
                        text_of(figure.heap_bytes, "%.0f"), text_of(figure.resident_bytes, "%.0f"),
                        figure.state_hash.empty() ? "-" : figure.state_hash});
    }
    print_rows(rows, out);
}

// Stages of throng side by side for each number of threads, and their parts beside the budget.
void print_stages(const Case& made, const std::vector<const Figure*>& ours, std::ostream& out)
{
    if (ours.front()->stages.empty()) return;
    out << '\n';
    Row head = {ours.front()->setting.empty() ? "stage" : "stage, " + ours.front()->setting};
    for (const Figure* figure : ours)
        head.insert(head.end(), {"ms(" + std::to_string(figure->threads_met) + ")", "share"});
    std::vector<Row> rows = {head};
    std::array<double, perf::kBudgetParts> parts = {};
    for (std::size_t i = 0; i < ours.front()->stages.size(); ++i) {
        const StageFigure& stage = ours.front()->stages[i];
        parts[static_cast<std::size_t>(perf::part_of_stage(stage.name))] += stage.ms_mean;
        Row row = {stage.name};
        for (const Figure* figure : ours) {
            const double ms = i < figure->stages.size() ? figure->stages[i].ms_mean : 0;
            row.push_back(text_of(ms));
            row.push_back(text_of(100 * ms / figure->ms_mean.median, "%.1f%%"));
        }
        rows.push_back(std::move(row));
    }
    print_rows(rows, out);

    const perf::Budget* const budget = perf::find_budget(made.scene->name);
    if (budget == nullptr || made.size != perf::kBudgetSize || ours.front()->threads != 1) return;
    out << '\n';
    rows = {{"part", "ms", "budget_ms", "of_budget"}};
    for (std::size_t i = 0; i < parts.size(); ++i)
        rows.push_back({std::string(perf::kBudgetPartNames[i]), text_of(parts[i]),
                        text_of(budget->ms[i]),
                        budget->ms[i] > 0 ? text_of(parts[i] / budget->ms[i], "%.2f") : "-"});
    const double sum = ours.front()->ms_mean.median;
    rows.push_back(
        {"step", text_of(sum), text_of(budget->sum_ms), text_of(sum / budget->sum_ms, "%.2f")});
    print_rows(rows, out);
}

void print_all_stages(const Case& made, const std::vector<Figure>& figures, std::ostream& out)
{
    std::map<std::string, std::vector<const Figure*>> by_setting;
    for (const Figure& figure : figures)
        if (figure.engine == "throng" && figure.beside == 0)
            by_setting[figure.setting].push_back(&figure);
    for (const auto& [setting, ours] : by_setting) print_stages(made, ours, out);
}

}  // namespace

void print_heading(const Plan& plan, std::ostream& out)
{
    out << "Times are of the clock, ms a step, over the same first steps for all; nobody sleeps. "
           "Engines\ntake turns of some steps; "
        << plan.repeats << (plan.repeats == 1 ? " run" : " runs")
        << " of each, of which the median is told. x_NAME: how many times\nfaster than that "
           "engine over the steps that both have done, cpu_x_NAME by processor time,\nwhich a "
           "busy machine disturbs less. Overlap, energy and height are of the last poses, by the "
           "same\ngeometry for all; shared_volume is that of pairs, of the volume of the bodies "
           "that "
           "are meshes.\n";
    if (plan.efficiency)
        out << "efficiency: the work that the threads do together, of what as many runs of one "
               "thread do beside\none another in the same minutes (the rows `beside`).\n";
    if (!plan.errors) return;
    out << "\nError: mean over the steps, from the end of each, of\n";
    for (const SceneAnswer& answer : scene_answers())
        out << "  " << answer.scene << ": " << answer.quantity << ", " << answer.unit << ", for "
            << answer.time << " s\n";
    out << "An engine whose time is up before (--max-seconds) is told of the steps that it did.\n";
}

void print_case(const Plan& plan, const Case& made, std::ostream& out)
{
    const std::vector<Figure> figures = figures_of(made);
    out << '\n'
        << made.scene->name << ':' << made.size
        << (plan.dts.empty() ? std::string() : ", dt " + text_of(made.dt) + " s") << "  "
        << made.bodies_dynamic << " dynamic bodies" << (made.complete ? "" : ", interrupted")
        << '\n';
    print_times(plan, made, figures, out);
    out << '\n';
    print_states(figures, out);
    print_all_stages(made, figures, out);
    out.flush();
}

void print_growth(const std::vector<Growth>& all, std::ostream& out)
{
    if (all.empty()) return;
    out << "\nHow cost grows: exponent of the number of bodies over all sizes; and the cost of a "
           "contact (of a\nbody, where little touches) from one size to the next, each while a "
           "body "
           "has as many contacts.\n";
    std::vector<Row> rows = {{"scene", "dt", "threads", "steps", "exponent", "from", "to", "per",
                              "ns_from", "ns_to", "ratio", "contacts_from", "contacts_to"}};
    for (const Growth& growth : all)
        for (const Growth::EqualState& step : growth.steps_up)
            rows.push_back({name_of(growth.scene, growth.setting), text_of(growth.dt),
                            std::to_string(growth.threads), std::to_string(growth.steps),
                            text_of(growth.exponent, "%.3f"), std::to_string(step.small),
                            std::to_string(step.large), step.by_contact ? "contact" : "body",
                            text_of(step.ns_small), text_of(step.ns_large),
                            text_of(step.ratio(), "%.3f"), text_of(step.contacts_small, "%.2f"),
                            text_of(step.contacts_large, "%.2f")});
    print_rows(rows, out);
}

}  // namespace throng::bench
