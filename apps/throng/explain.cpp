// Explain: which effects a scene calls for, and the step that follows from them.
#include "apps/throng/commands.hpp"
#include "apps/throng/effect_json.hpp"
#include "apps/throng/instructions.hpp"
#include "apps/throng/interrupt.hpp"
#include "apps/throng/json_lines.hpp"
#include "apps/throng/neglected.hpp"
#include "apps/throng/output_file.hpp"
#include "apps/throng/progress.hpp"
#include "apps/throng/scene_argument.hpp"
#include "apps/throng/step_picture.hpp"
#include "apps/throng/step_times.hpp"
#include "apps/throng/without.hpp"
#include "scene/files/json.hpp"
#include "scene/files/json_writer.hpp"
#include "scene/names.hpp"
#include "throng/dials.hpp"
#include "throng/effect_ledger.hpp"
#include "throng/version.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <map>
#include <optional>

namespace throng {
namespace {

constexpr Option kOptions[] = {
    {"--steps", "N",
     "runs so many steps, from 0, and says what each stage took; by effects=auto also what that "
     "left out, saves and gets wrong (default 0)"},
    {"--without", "EFFECT",
     "runs the scene with one effect off as well, and says what time that saves and what error it "
     "makes in 0.1 s (without --steps, of 120)"},
    {"--json", "FILE", "effects and stages, for programs"},
    {"--dot", "FILE", "the step as a graph, for graphviz"},
    {"--svg", "FILE", "the same, drawn; with --steps, with what each stage took"},
    kDtOption,
    kThreadsOption,
    kSetOption,
    kSeedOption,
    kMeshOption,
};

constexpr std::int64_t kStepsWithout = 120;

using Stages = std::vector<World::StageInfo>;

std::string padded(std::string_view text, std::size_t width)
{
    std::string all(text);
    all.resize(std::max(width, all.size()), ' ');
    return all;
}

/// Who calls for what, and once steps were run what that cost.
void print_effects(const std::vector<EffectEntry>& entries, bool costs)
{
    std::cout << "\neffects\n";
    if (costs)
        std::cout << "  " << padded("", 18) << "    callers    ms/step      rows      kB  first\n";
    for (const EffectEntry& entry : entries) {
        std::cout << "  " << padded(name_of(entry.effect), 18);
        if (!entry.on) {
            std::cout << "off\n";
            continue;
        }
        char text[80];
        if (costs)
            std::snprintf(text, sizeof text, "on %8zu %10.4f %9zu %7.1f  ", entry.callers, entry.ms,
                          entry.rows, static_cast<double>(entry.bytes) / 1e3);
        else
            std::snprintf(text, sizeof text, "on %8zu  ", entry.callers);
        std::cout << text << entry.first << '\n';
    }
}

/// What each stage took, by name; empty where no step was run.
using StageMs = std::map<std::string_view, double>;

std::string stage_json(const Stages& stages, const World::StageInfo& stage, const StageMs& times)
{
    const auto earlier = [&](std::size_t at) { return json_string(stages[at].name); };
    const auto pass = [](const World::PassInfo& of) {
        return JsonMembers().add_text("name", of.name).add_text("when", of.when).text();
    };
    const auto found = times.find(stage.name);
    return "\n    "
        + JsonMembers()
              .add_text("name", stage.name)
              .add("waits_for", '[' + joined(stage.waits_for, ", ", earlier) + ']')
              .add("passes", '[' + joined(stage.passes, ", ", pass) + ']')
              .add("ms", found == times.end() ? 0.0 : found->second)
              .text();
}

void write_json(const SceneArgument& argument,
                const StepTimes& times,
                std::optional<double> instructions,
                const std::vector<EffectEntry>& entries,
                const Stages& stages,
                const StageMs& stage_ms,
                const std::optional<WithoutReport>& without,
                const std::optional<NeglectReport>& neglected,
                std::ostream& out)
{
    JsonLines json(out);
    json.add("throng", json_string(version()));
    json.add("scene", json_string(argument.label));
    json.add("steps", times.steps().count());
    json.add("ms_per_step", times.steps().mean());
    if (instructions) json.add("instructions_per_step", *instructions);
    json.add("effect_ledger", effect_ledger_json(entries));
    if (without) json.add("without", without_json(*without));
    if (neglected) json.add("neglected", neglected_json(*neglected));
    json.add("stages",
             '[' + joined(stages, ",", [&](const World::StageInfo& stage) {
                 return stage_json(stages, stage, stage_ms);
             }) + ']');
    json.end();
}

std::string time_column(const StageMs& times, std::string_view stage)
{
    if (times.empty()) return {};
    const auto found = times.find(stage);
    char text[32];
    std::snprintf(text, sizeof text, "%10.4f  ", found == times.end() ? 0.0 : found->second);
    return text;
}

void print_stages(const Stages& stages, const StageMs& times)
{
    std::size_t width = 24;
    for (const World::StageInfo& stage : stages) {
        width = std::max(width, stage.name.size() + 2);
        for (const World::PassInfo& pass : stage.passes)
            width = std::max(width, pass.name.size() + 6);
    }
    std::cout << "\nstages\n";
    if (stages.empty()) std::cout << "  none: nothing in this scene can move\n";
    if (!times.empty()) std::cout << "  " << padded("", width) << "   ms/step  waits for\n";
    for (const World::StageInfo& stage : stages) {
        std::string waits = times.empty() ? "waits for " : "";
        for (const std::size_t earlier : stage.waits_for)
            waits += (earlier == stage.waits_for.front() ? "" : ", ")
                + std::string(stages[earlier].name);
        if (stage.waits_for.empty()) waits += "nothing";
        std::cout << "  " << padded(stage.name, width) << time_column(times, stage.name) << waits
                  << '\n';
        for (const World::PassInfo& pass : stage.passes)
            std::cout << "  " << padded("    " + std::string(pass.name), width)
                      << (times.empty() ? "" : padded("", 12)) << pass.when << '\n';
    }
}

void print_solids(const std::vector<std::string>& solids)
{
    if (solids.empty()) return;
    std::cout << "\nmoving meshes and level sets\n";
    for (const std::string& solid : solids) std::cout << "  " << solid << '\n';
}

void write_dot(const Stages& stages, std::ostream& out)
{
    out << "digraph step {\n  rankdir=LR;\n  node [shape=box, fontname=\"sans-serif\"];\n";
    for (const World::StageInfo& stage : stages) {
        out << "  " << stage.name;
        if (!stage.passes.empty()) {
            out << " [label=\"" << stage.name << "\\n";
            for (const World::PassInfo& pass : stage.passes)
                out << "  " << pass.name << " (" << pass.when << ")\\l";
            out << "\"]";
        }
        out << ";\n";
    }
    for (const World::StageInfo& stage : stages)
        for (const std::size_t earlier : stage.waits_for)
            out << "  " << stages[earlier].name << " -> " << stage.name << ";\n";
    out << "}\n";
}

/// None where they were not counted, or no step was run.
std::optional<double> instructions_per_step(std::optional<std::uint64_t> before,
                                            std::optional<std::uint64_t> after,
                                            std::size_t steps)
{
    if (!before || !after || steps == 0) return std::nullopt;
    return static_cast<double>(*after - *before) / static_cast<double>(steps);
}

StepTimes run_steps(World& world, std::int64_t steps)
{
    using Clock = std::chrono::steady_clock;
    StepTimes times;
    Progress progress(steps, true);
    StepGuard guard([] {});
    for (std::int64_t done = 0; done < steps && !interrupted();) {
        guard.begin_step();
        const auto begin = Clock::now();
        world.step();
        const std::chrono::duration<double, std::milli> taken = Clock::now() - begin;
        guard.end_step();
        times.add(taken.count(), world.stages());
        progress.show(++done, world.report().bodies_awake);
    }
    return times;
}

int explain(const Options& options)
{
    const std::int64_t steps = options.whole("--steps", 0, 0, kMostSteps);
    std::optional<Effect> left_out;
    if (options.has("--without")) left_out = effect_asked("--without", options.text("--without"));
    const int threads = threads_asked(options);
    const InstructionCounter instructions;  // before the threads that it counts
    const SceneArgument argument = read_scene_argument(options);
    World world = make_world(argument, threads);
    note_interrupts();
    OutputFile dot("--dot", options.text("--dot")), json("--json", options.text("--json")),
        svg("--svg", options.text("--svg"));
    refuse_same_file(dot, json.path(), "--json");
    refuse_same_file(svg, json.path(), "--json");
    refuse_same_file(svg, dot.path(), "--dot");
    for (const OutputFile* file : {&dot, &json, &svg}) {
        refuse_same_file(*file, argument.file, "the scene");
        refuse_same_file(*file, argument.mesh, "--mesh");
    }

    // The stages that are printed are those of the step as it begins; bodies that fail on the way
    // may change it. Effects are told as they are at the end, with what they cost.
    const Stages stages = world.step_stages();
    if (dot.asked_for()) write_dot(stages, dot.stream());
    dot.keep();

    const std::optional<std::uint64_t> before = instructions.count();
    const StepTimes times = run_steps(world, steps);
    const std::optional<double> taken =
        instructions_per_step(before, instructions.count(), times.steps().count());
    StageMs stage_ms;
    for (const StageReport& stage : times.mean_stages()) stage_ms[stage.name] = stage.time_ms;
    const std::vector<EffectEntry> entries = effect_ledger(world, times.mean_stages());
    std::optional<WithoutReport> without;
    if (left_out)
        without = run_without(argument, *left_out, steps > 0 ? steps : kStepsWithout, threads);
    std::optional<NeglectReport> neglected;
    if (steps > 0 && argument.scene.settings.effects == EffectChoice::auto_)
        neglected = run_neglected(argument, steps, threads);
    if (json.asked_for())
        write_json(argument, times, taken, entries, stages, stage_ms, without, neglected,
                   json.stream());
    json.keep();
    if (svg.asked_for()) draw_step(stages, stage_ms, svg.stream());
    svg.keep();
    if (dot.is_stdout() || json.is_stdout() || svg.is_stdout())
        return interrupted() ? kInterrupted : kDone;
    std::cout << "scene: " << argument.label << "\nbodies: " << world.body_count() << '\n';
    if (steps > 0) {
        char text[32];
        std::snprintf(text, sizeof text, "%.4g", times.steps().mean());
        std::cout << "steps: " << times.steps().count() << "\nthreads: " << world.threads_met()
                  << "\nms_per_step: " << text << '\n';
        if (taken) {
            std::snprintf(text, sizeof text, "%.4g", *taken);
            std::cout << "instructions_per_step: " << text << '\n';
        } else {
            std::cout << "instructions_per_step: left out, " << instructions.trouble() << '\n';
        }
        if (const double iterations = world.report().relax_iterations; iterations > 0) {
            std::snprintf(text, sizeof text, "%.3g", iterations);
            std::cout << "relax_visits: " << text
                      << " a contact and substep (dial relax_iterations)\n";
        }
    }
    if (const Settings& settings = argument.scene.settings; settings.partial_rest)
        std::cout << "rest_force: " << dial_value(settings, "rest_force")
                  << " of what a body bears: a change by which it wakes (dial partial_rest)\n";
    print_effects(entries, times.steps().count() > 0);
    print_stages(stages, stage_ms);
    print_solids(world.solids());
    if (without) print_without(*without);
    if (neglected) print_neglected(*neglected, entries);
    for (const std::string& sentence : unused_dials(argument.scene))
        std::cerr << "warning: " << sentence << '\n';
    return interrupted() ? kInterrupted : kDone;
}

}  // namespace

const Command kExplain = {
    {"explain", "SCENE",
     "Says which effects a scene calls for and why, and shows the step that follows.", 1, 1,
     kOptions},
    explain,
    nullptr,
};

}  // namespace throng
