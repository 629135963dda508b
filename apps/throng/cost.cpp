// Cost: what accuracy costs in time on a scene, and the setting for a wanted error or time.
#include "apps/throng/cost_options.hpp"
#include "apps/throng/interrupt.hpp"
#include "apps/throng/scene_argument.hpp"
#include "apps/throng/this_machine.hpp"
#include "scene/names.hpp"

#include <filesystem>
#include <iostream>

namespace throng {
namespace {

Measure measure_asked(const Options& options)
{
    if (!options.has("--measure")) return Measure::drift;
    try {
        return measure_named(options.text("--measure"));
    } catch (const std::invalid_argument& error) {
        throw BadInput(std::string("--measure: ") + error.what());
    }
}

// A third of the time is the reference's, by which all else is judged.
void measure(const Scene& scene,
             const CostOptions& asked,
             const Effects& effects,
             const CostFolder& folder,
             const Watch& watch,
             CostReport& report)
{
    const double patience = asked.sweep.patience;
    const double wanted = report.measure == place_of(Measure::drift) ? asked.wish.error : 0;
    const Windows windows(scene, asked.windows, wanted, patience / 3, watch);
    const WindowTrials trials(scene, windows);
    report.window = windows.length();
    report.windows = windows.size();
    report.at_rest = windows.at_rest();
    report.reference = windows.reference();
    report.state = trials.state_hash();
    SweepPlan plan = asked.sweep;
    folder.take_known(report, plan);
    plan.patience = patience / 2;
    sweep_into(report, trials, effects, plan, watch);
}

// Without the dials that were set: these are turned again, and others after them.
std::string command_for(const Options& options)
{
    std::string command = "throng run " + in_shell(options.words().front());
    for (const std::string_view option : {"--seed", "--mesh"})
        if (options.has(option))
            command += ' ' + std::string(option) + ' ' + in_shell(options.text(option));
    return command;
}

std::string report_text(std::string_view path)
{
    const std::optional<std::string> text = text_of_file(std::string(path));
    if (!text) throw BadInput("--compare: " + in_quotes(path) + " cannot be read");
    return *text;
}

int compare_reports(const Options& options)
{
    if (options.words().size() != 2)
        throw BadInput("--compare: wanted two reports, as in throng cost --compare A.json B.json");
    const std::string_view a = options.words()[0], b = options.words()[1];
    const CostReport first = read_report(report_text(a), std::string(a)),
                     second = read_report(report_text(b), std::string(b));
    std::cout << "A: " << a << "\nB: " << b << "\n\n";
    write_comparison(first, second, std::cout);
    return kDone;
}

int run_cost(const Options& options)
{
    if (options.has("--compare")) return compare_reports(options);
    word_measured(options);
    CostOptions asked = read_cost_options(options);
    asked.sweep.measure = place_of(measure_asked(options));
    const SceneArgument argument = read_scene_argument(options);
    // The label of a catalogue's scene says its mesh, too, after a space.
    CostFolder folder(options,
                      argument.file.empty() ? argument.label.substr(0, argument.label.find(' '))
                                            : std::filesystem::path(argument.file).stem().string());
    note_interrupts();

    CostReport report;
    Effects effects;
    {
        World world = make_world(argument, asked.windows.threads, options.has("--quiet"));
        effects = world.effects();
        report.bodies = world.body_count();
        report.machine = this_machine(world.threads());
    }
    report.scene = argument.label;
    report.command = command_for(options);
    report.given = changes_given(options);
    report.seed = argument.seed;
    report.plan = asked.windows;
    report.measure = asked.sweep.measure;
    report.wish = asked.wish;
    return report_cost(options, report, folder, [&](const Watch& watch) {
        measure(argument.scene, asked, effects, folder, watch, report);
    });
}

void tell_of_cases(std::ostream& out)
{
    out << "\nA CASE is a hard case by its name, as H3 is; `throng cases --help` lists them. Its "
           "error is\n"
           "the figure of its first line that comes from a run, against its exact answer. It has "
           "no\n"
           "windows, seed or mesh; --set and --dt are put upon all that it runs.\n";
}

}  // namespace

const Command kCost = {kCostUsage, run_cost, tell_of_cases, "throng_cases", asks_for_case};

}  // namespace throng
