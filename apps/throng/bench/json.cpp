// JSON: a benchmark's figures for programs, the time of every step included.
#include "scene/files/json.hpp"

#include "apps/throng/bench/budget.hpp"
#include "apps/throng/bench/report.hpp"
#include "apps/throng/json_lines.hpp"
#include "apps/throng/this_machine.hpp"
#include "cost/answers/answers.hpp"
#include "scene/files/json_writer.hpp"
#include "throng/version.hpp"

#include <thread>

namespace throng::bench {
namespace {

double number(std::size_t count) { return static_cast<double>(count); }

template <class List, class Text>
std::string array(const List& list, const Text& text, std::string_view between = ", ")
{
    return '[' + joined(list, between, text) + ']';
}

std::string numbers(const std::vector<double>& list)
{
    return array(list, [](double number) { return json_text(number); });
}

std::string json_of(const Spread& spread)
{
    return JsonMembers()
        .add("median", spread.median)
        .add("least", spread.least)
        .add("most", spread.most)
        .text();
}

std::string json_of(const Quality& quality)
{
    return JsonMembers()
        .add("mean_overlap_m", quality.mean_overlap)
        .add("max_overlap_m", quality.greatest_overlap)
        .add("overlapping_pairs", number(quality.overlapping_pairs))
        .add("kinetic_energy_j_per_body", quality.kinetic_energy)
        .add("mean_height_m", quality.mean_height)
        .add("shared_volume", quality.shared_volume)
        .text();
}

std::string json_of(const Comparison& other)
{
    return JsonMembers()
        .add_text("engine", other.engine)
        .add_text("setting", other.setting)
        .add("threads", other.threads)
        .add("steps", number(other.steps))
        .add("times_faster", json_of(other.times))
        .add("times_faster_cpu", json_of(other.cpu_times))
        .text();
}

std::string json_of(const Figure& figure)
{
    JsonMembers made;
    made.add_text("engine", figure.engine)
        .add_text("setting", figure.setting)
        .add_text("settings", figure.settings)
        .add("threads", figure.threads)
        .add("threads_used", figure.threads_met)
        .add("beside", figure.beside)
        .add("steps", number(figure.steps))
        .add("ms_mean", json_of(figure.ms_mean))
        .add("spread", figure.ms_mean.relative())
        .add("efficiency", json_of(figure.efficiency))
        .add("ms_median", figure.ms_median)
        .add("ms_p99", figure.ms_p99)
        .add("cpu_ms_mean", figure.cpu_ms)
        .add("make_ms", figure.make_ms)
        .add("ns_per_body", figure.ns_a_body)
        .add("ns_per_contact", figure.ns_a_contact)
        .add("contacts", figure.contacts)
        .add("state_bytes_per_body", figure.state_bytes)
        .add("heap_bytes_per_body", figure.heap_bytes)
        .add("resident_bytes_per_body", figure.resident_bytes)
        .add("quality", json_of(figure.quality))
        .add("error", figure.error)
        .add_text("state_hash", figure.state_hash)
        .add("against", array(figure.against, [](const Comparison& c) { return json_of(c); }));
    if (!figure.stages.empty())
        made.add("stages", array(figure.stages, [](const StageFigure& stage) {
                     return JsonMembers()
                         .add_text("name", stage.name)
                         .add_text("part",
                                   perf::kBudgetPartNames[static_cast<std::size_t>(
                                       perf::part_of_stage(stage.name))])
                         .add("ms_mean", stage.ms_mean)
                         .add("ms_p99", stage.ms_p99)
                         .text();
                 }));
    return made.text();
}

std::string json_of(const Run& run)
{
    JsonMembers made;
    made.add_text("engine", run.engine)
        .add_text("setting", run.setting)
        .add("threads", run.threads)
        .add("beside", run.beside)
        .add("repeat", run.repeat)
        .add_text("state_hash", run.state_hash)
        .add("ms", numbers(run.ms))
        .add("cpu_ms", numbers(run.cpu_ms))
        .add("contacts",
             array(run.contacts, [](std::size_t count) { return std::to_string(count); }));
    return made.text();
}

std::string json_of(const Case& made)
{
    JsonMembers all;
    all.add_text("scene", made.scene->name)
        .add("size", made.size)
        .add("dt", made.dt)
        .add("bodies", number(made.bodies))
        .add("bodies_dynamic", number(made.bodies_dynamic))
        .add("complete", std::string(made.complete ? "true" : "false"))
        .add("hashes_agree", std::string(hashes_agree(made) ? "true" : "false"));
    if (const SceneAnswer* const answer = find_answer(made.scene->name))
        all.add_text("error_of", answer->quantity).add_text("error_unit", answer->unit);
    const perf::Budget* const budget = perf::find_budget(made.scene->name);
    if (budget != nullptr && made.size == perf::kBudgetSize) {
        JsonMembers parts;
        for (std::size_t i = 0; i < budget->ms.size(); ++i)
            parts.add(perf::kBudgetPartNames[i], budget->ms[i]);
        all.add("budget_ms", parts.add("sum", budget->sum_ms).text());
    }
    all.add("figures",
            array(
                figures_of(made), [](const Figure& figure) { return json_of(figure); }, ",\n    "))
        .add("runs",
             array(
                 made.runs, [](const Run& run) { return json_of(run); }, ",\n    "));
    return all.text();
}

std::string json_of(const Growth& growth)
{
    return JsonMembers()
        .add_text("scene", growth.scene)
        .add_text("setting", growth.setting)
        .add("dt", growth.dt)
        .add("threads", growth.threads)
        .add("steps", number(growth.steps))
        .add("bodies", array(growth.bodies, [](std::size_t n) { return std::to_string(n); }))
        .add("ms_mean", numbers(growth.ms))
        .add("exponent", growth.exponent)
        .add("equal_state",
             array(growth.steps_up,
                   [](const Growth::EqualState& step) {
                       return JsonMembers()
                           .add("bodies_from", number(step.small))
                           .add("bodies_to", number(step.large))
                           .add_text("per", step.by_contact ? "contact" : "body")
                           .add("ns_from", step.ns_small)
                           .add("ns_to", step.ns_large)
                           .add("ratio", step.ratio())
                           .add("contacts_per_body_from", step.contacts_small)
                           .add("contacts_per_body_to", step.contacts_large)
                           .text();
                   }))
        .text();
}

}  // namespace

void write_json(const Plan& plan, const std::vector<Case>& cases, bool complete, std::ostream& out)
{
    JsonLines json(out);
    json.add("throng", json_string(version()));
    json.add("machine",
             JsonMembers()
                 .add_text("processor", this_machine(0).processor)
                 .add("cores", number(std::thread::hardware_concurrency()))
                 .add_text("lanes", lane_width())
                 .text());
    json.add("sleep", json_string("off"));
    if (plan.steps > 0) json.add("steps", static_cast<std::uint64_t>(plan.steps));
    json.add("repeats", static_cast<std::uint64_t>(plan.repeats));
    json.add("max_seconds", plan.max_seconds);
    json.add("seed", plan.seed);
    if (!plan.mesh.empty()) json.add("mesh", json_string(plan.mesh));
    json.add("complete", std::string(complete ? "true" : "false"));
    json.add("cases",
             array(
                 cases, [](const Case& made) { return "\n  " + json_of(made); }, ","));
    json.add(
        "growth",
        array(
            growth_of(cases), [](const Growth& growth) { return "\n  " + json_of(growth); }, ","));
    json.end();
}

}  // namespace throng::bench
