#include "apps/throng/cost_options.hpp"

#include "apps/throng/interrupt.hpp"
#include "apps/throng/progress.hpp"
#include "apps/throng/scene_argument.hpp"
#include "scene/names.hpp"
#include "throng/dials.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <sstream>

namespace throng {
namespace {

constexpr double kStandardMinutes = 4;

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

// A line of a file of settings: words such as solver=pgs, none turned twice.
Changes changes_in(const std::string& line, const std::string& place)
{
    Changes changes;
    Settings settings;
    std::istringstream words(line);
    for (std::string word; words >> word;) {
        const std::size_t equals = word.find('=');
        if (equals == std::string::npos)
            throw BadInput(place + "wanted DIAL=VALUE, not " + in_quotes(word));
        Change change{word.substr(0, equals), word.substr(equals + 1)};
        const std::string trouble = set_dial(settings, change.dial, change.value);
        if (!trouble.empty()) throw BadInput(place + trouble);
        const bool again = std::any_of(changes.begin(), changes.end(), [&](const Change& each) {
            return each.dial == change.dial;
        });
        if (again) throw BadInput(place + in_quotes(change.dial) + " is there twice");
        changes.push_back(std::move(change));
    }
    return changes;
}

// Empty lines are passed over, and so is what follows a #.
std::vector<Changes> settings_asked(const Options& options)
{
    std::vector<Changes> settings;
    if (!options.has("--settings")) return settings;
    if (options.has("--dials")) throw BadInput("--settings: wanted either that or --dials");
    const std::string path(options.text("--settings"));
    const std::optional<std::string> text = text_of_file(path);
    if (!text) throw BadInput("--settings: " + in_quotes(path) + " cannot be read");
    std::istringstream lines(*text);
    std::size_t number = 0;
    for (std::string line; std::getline(lines, line);) {
        const std::string place = path + ':' + std::to_string(++number) + ": ";
        Changes changes = changes_in(line.substr(0, line.find('#')), place);
        if (!changes.empty()) settings.push_back(std::move(changes));
    }
    if (settings.empty()) throw BadInput("--settings: there are none in " + in_quotes(path));
    return settings;
}

std::string folder_asked(const Options& options, const std::string& name)
{
    std::filesystem::path folder(options.text("--out"));
    if (folder.empty()) folder = "cost-" + name;
    std::error_code trouble;
    std::filesystem::create_directories(folder, trouble);
    if (!std::filesystem::is_directory(folder))
        throw BadInput("--out: " + in_quotes(folder.string())
                       + (trouble ? ": " + trouble.message() : " is no folder"));
    return folder.string();
}

std::string file_in(const std::string& folder, const char* name)
{
    return (std::filesystem::path(folder) / name).string();
}

std::string written_before(const Options& options, const std::string& path)
{
    if (!options.has("--resume")) return {};
    const std::optional<std::string> text = text_of_file(path);
    if (!text)
        throw BadInput("--resume: there is no " + in_quotes(path)
                       + " to go on from; leave the option out the first time");
    return *text;
}

}  // namespace

std::optional<std::string> text_of_file(const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    if (!file) return std::nullopt;
    return std::string{std::istreambuf_iterator<char>(file), {}};
}

CostOptions read_cost_options(const Options& options)
{
    CostOptions asked;
    if (options.has("--error") && options.has("--within"))
        throw BadInput("--within: wanted either that or --error");
    asked.wish.error = positive(options, "--error", 0);
    asked.wish.time_ms = positive(options, "--within", 0);
    asked.windows.length = positive(options, "--window", asked.windows.length);
    asked.windows.seconds = positive(options, "--seconds", asked.windows.seconds);
    asked.windows.count = static_cast<std::size_t>(
        options.whole("--windows", static_cast<std::int64_t>(asked.windows.count), 2, 1000));
    asked.windows.threads = threads_asked(options);
    asked.sweep.dials = dials_asked(options);
    asked.sweep.settings = settings_asked(options);
    asked.sweep.patience = 60 * positive(options, "--minutes", kStandardMinutes);
    return asked;
}

std::string_view word_measured(const Options& options)
{
    if (options.words().size() > 1)
        throw BadInput("cost: one word too many: " + in_quotes(options.words()[1])
                       + "; two reports are compared by --compare");
    return options.words().front();
}

Changes changes_given(const Options& options)
{
    // A scene without anything, for what dials take.
    Scene scene;
    set_dials_and_dt(scene, options);
    Changes given;
    for (const std::string& dial : scene.dials_set)
        given.push_back({dial, dial_value(scene.settings, dial)});
    return given;
}

std::string in_shell(std::string_view word)
{
    const auto is_plain = [](char letter) {
        return (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z')
            || (letter >= '0' && letter <= '9')
            || std::string_view("_./:=+,@%-").find(letter) != std::string_view::npos;
    };
    if (!word.empty() && std::all_of(word.begin(), word.end(), is_plain)) return std::string(word);
    std::string quoted = "'";
    for (const char letter : word) quoted += letter == '\'' ? "'\\''" : std::string(1, letter);
    return quoted + '\'';
}

CostFolder::CostFolder(const Options& options, const std::string& name)
    : folder_(folder_asked(options, name)),
      before_(written_before(options, file_in(folder_, "cost.json"))),
      json_("--out", file_in(folder_, "cost.json")), csv_("--out", file_in(folder_, "cost.csv")),
      page_("--out", file_in(folder_, "cost.html")), svg_("--out", file_in(folder_, "cost.svg"))
{ }

void CostFolder::take_known(const CostReport& report, SweepPlan& plan) const
{
    if (!before_.empty()) plan.known = read_points(before_, "cost.json", report);
}

void CostFolder::write(const CostReport& report)
{
    write_cost_json(report, json_.stream());
    write_cost_csv(report, csv_.stream());
    write_cost_page(report, page_.stream());
    write_cost_svg(report, svg_.stream());
    for (OutputFile* const file : {&json_, &csv_, &page_, &svg_}) file->keep();
}

std::string CostFolder::told() const
{
    return "report: " + page_.path() + "; all points: " + json_.path() + ", " + csv_.path();
}

void sweep_into(CostReport& report,
                const Trials& trials,
                const Effects& effects,
                const SweepPlan& plan,
                const Watch& watch)
{
    report.found = sweep(trials, effects, plan, watch);
    for (const std::string_view dial : {"dt", "substeps"})
        if (const auto fitted = fitted_order(trials.scene(), report.found, dial, report.measure,
                                             of(report.reference.remaining, report.measure)))
            report.orders.push_back(*fitted);
    if (report.found.interrupted) return;
    report.stages = trials.stage_times({});
    if (const Advice advice = advice_of(report); advice.point != nullptr)
        report.advised_stages = trials.stage_times(advice.point->changes);
}

int report_cost(const Options& options,
                CostReport& report,
                CostFolder& folder,
                const std::function<void(const Watch&)>& measure)
{
    {
        NoteLine line(!options.has("--quiet"));
        const Watch watch{[&](const std::string& note) { line.show(note); }, interrupted};
        try {
            measure(watch);
        } catch (const Interrupted&) {
            return kInterrupted;
        }
    }
    write_cost_text(report, std::cout);
    if (options.has("--text")) draw_front(report, std::cout);
    folder.write(report);
    std::cout << folder.told() << std::endl;
    return interrupted() ? kInterrupted : kDone;
}

}  // namespace throng
