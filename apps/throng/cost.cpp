// Cost: what accuracy costs in time on a scene, and the setting for a wanted error or time.
#include "apps/throng/commands.hpp"
#include "apps/throng/interrupt.hpp"
#include "apps/throng/output_file.hpp"
#include "apps/throng/progress.hpp"
#include "apps/throng/scene_argument.hpp"
#include "apps/throng/this_machine.hpp"
#include "cost/report/cost_report.hpp"
#include "scene/names.hpp"
#include "throng/dials.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>

namespace throng {
namespace {

constexpr double kStandardMinutes = 4;

constexpr Option kOptions[] = {
    {"--error", "E",
     "names the cheapest setting whose error is at most that, in the measure's unit"},
    {"--within", "MS",
     "names the most exact setting that takes at most so long for each 1/60 s of the scene"},
    {"--measure", "M",
     "the error: drift, m; turn, rad; velocity, m/s; overlap, m; energy, J (default drift)"},
    {"--dials", "A,B",
     "tries values of these dials alone; none: measures the scene as it is (default: all that may "
     "matter here)"},
    {"--window", "S", "s that bodies may drift from the reference in (default 0.1)"},
    {"--windows", "N", "how many windows, 2 to 1000 (default 24)"},
    {"--seconds", "S", "s of the scene, from its beginning, that windows lie in (default 5)"},
    {"--minutes", "M", "of the clock, after which nothing new is begun (default 4)"},
    kThreadsOption,
    kDtOption,
    kSetOption,
    kSeedOption,
    kMeshOption,
    {"--out", "DIR",
     "folder of the report: cost.html, a page for a browser; cost.json, cost.csv and cost.svg "
     "(default: cost-SCENE)"},
    {"--resume", "", "takes what cost.json in that folder has of the same windows, and goes on"},
    {"--text", "", "draws the front in letters"},
    {"--quiet", "", "no progress and no warnings"},
};

// A number above 0, or the default where the option was not given.
double positive(const Options& options, std::string_view name, double standard)
{
    if (!options.has(name)) return standard;
    const double number = parse_number(options.text(name));
    if (!(number > 0))
        throw BadInput(std::string(name) + ": wanted a number above 0, not "
                       + in_quotes(options.text(name)));
    return number;
}

Measure measure_asked(const Options& options)
{
    if (!options.has("--measure")) return Measure::drift;
    try {
        return measure_named(options.text("--measure"));
    } catch (const std::invalid_argument& error) {
        throw BadInput(std::string("--measure: ") + error.what());
    }
}

std::vector<std::string> dials_asked(const Options& options)
{
    std::vector<std::string> dials;
    const std::vector<std::string_view> known = swept_dials();
    const std::string_view text = options.text("--dials");
    if (!options.has("--dials")) return dials;
    if (text == "none") return {std::string(text)};
    for (const std::string_view name : parts_of("--dials", text)) {
        if (std::find(known.begin(), known.end(), name) == known.end())
            throw BadInput("--dials: wanted none, " + either_of(known) + ", not "
                           + in_quotes(name));
        dials.emplace_back(name);
    }
    return dials;
}

struct Asked {
    WindowPlan windows;
    SweepPlan sweep;
    Wish wish;
};

Asked read_options(const Options& options)
{
    Asked asked;
    if (options.has("--error") && options.has("--within"))
        throw BadInput("--within: wanted either that or --error");
    asked.wish.error = positive(options, "--error", 0);
    asked.wish.time_ms = positive(options, "--within", 0);
    asked.windows.length = positive(options, "--window", asked.windows.length);
    asked.windows.seconds = positive(options, "--seconds", asked.windows.seconds);
    asked.windows.count = static_cast<std::size_t>(
        options.whole("--windows", static_cast<std::int64_t>(asked.windows.count), 2, 1000));
    asked.windows.threads = threads_asked(options);
    asked.sweep.measure = measure_asked(options);
    asked.sweep.dials = dials_asked(options);
    asked.sweep.patience = 60 * positive(options, "--minutes", kStandardMinutes);
    return asked;
}

std::filesystem::path folder_asked(const Options& options, const SceneArgument& argument)
{
    std::filesystem::path folder(options.text("--out"));
    if (folder.empty())
        folder = "cost-"
            + (argument.file.empty() ? argument.label
                                     : std::filesystem::path(argument.file).stem().string());
    std::error_code trouble;
    std::filesystem::create_directories(folder, trouble);
    if (!std::filesystem::is_directory(folder))
        throw BadInput("--out: " + in_quotes(folder.string())
                       + (trouble ? ": " + trouble.message() : " is no folder"));
    return folder;
}

std::string written_before(const std::filesystem::path& path)
{
    std::ifstream file(path, std::ios::binary);
    if (!file)
        throw BadInput("--resume: there is no " + in_quotes(path.string())
                       + " to go on from; leave the option out the first time");
    return {std::istreambuf_iterator<char>(file), {}};
}

// A third of the time is the reference's, by which all else is judged.
void measure(const SceneArgument& argument,
             const Asked& asked,
             const Effects& effects,
             const std::string& before,
             const Watch& watch,
             CostReport& report)
{
    const Scene& scene = argument.scene;
    const double patience = asked.sweep.patience;
    const double wanted =
        asked.sweep.measure == Measure::drift && asked.wish.error > 0 ? asked.wish.error : 0;
    const Windows windows(scene, asked.windows, wanted, patience / 3, watch);
    report.window = windows.length();
    report.windows = windows.size();
    report.at_rest = windows.at_rest();
    report.reference = windows.reference();
    report.state = windows.state_hash();
    SweepPlan plan = asked.sweep;
    if (!before.empty()) plan.known = read_points(before, "cost.json", report.state);
    plan.patience = patience / 2;
    report.found = sweep(scene, effects, windows, plan, watch);
    for (const std::string_view dial : {"dt", "substeps"})
        if (const auto fitted = fitted_order(scene, report.found, dial, report.measure,
                                             of(report.reference.remaining, report.measure)))
            report.orders.push_back(*fitted);
}

int run_cost(const Options& options)
{
    const Asked asked = read_options(options);
    const SceneArgument argument = read_scene_argument(options);
    const bool quiet = options.has("--quiet");
    const std::filesystem::path folder = folder_asked(options, argument);
    const std::string before =
        options.has("--resume") ? written_before(folder / "cost.json") : std::string();
    OutputFile json("--out", (folder / "cost.json").string());
    OutputFile csv("--out", (folder / "cost.csv").string());
    OutputFile page("--out", (folder / "cost.html").string());
    OutputFile svg("--out", (folder / "cost.svg").string());
    note_interrupts();

    CostReport report;
    Effects effects;
    {
        World world = make_world(argument, asked.windows.threads, quiet);
        effects = world.effects();
        report.bodies = world.body_count();
        report.machine = this_machine(world.threads());
    }
    report.scene = argument.label;
    report.seed = argument.seed;
    report.plan = asked.windows;
    report.measure = asked.sweep.measure;
    report.wish = asked.wish;
    {
        NoteLine line(!quiet);
        const Watch watch{[&](const std::string& note) { line.show(note); }, interrupted};
        try {
            measure(argument, asked, effects, before, watch, report);
        } catch (const Interrupted&) {
            return kInterrupted;
        }
    }
    write_cost_text(report, std::cout);
    if (options.has("--text")) draw_front(report, std::cout);
    write_cost_json(report, json.stream());
    json.keep();
    write_cost_csv(report, csv.stream());
    csv.keep();
    write_cost_svg(report, svg.stream());
    svg.keep();
    write_cost_page(report, page.stream());
    page.keep();
    std::cout << "report: " << page.path() << "; all points: " << json.path() << ", " << csv.path()
              << std::endl;
    return interrupted() ? kInterrupted : kDone;
}

}  // namespace

const Command kCost = {
    {"cost", "SCENE",
     "Measures error and time of a scene by many settings, and names the one to take.", 1, 1,
     kOptions},
    run_cost,
    nullptr,
};

}  // namespace throng
