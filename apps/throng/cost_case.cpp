// Cost of a case: what accuracy costs in time on a hard case, by its own error.
#include "apps/throng/cost_options.hpp"
#include "apps/throng/interrupt.hpp"
#include "apps/throng/scene_argument.hpp"
#include "apps/throng/this_machine.hpp"
#include "cost/hard_cases/case_trials.hpp"
#include "scene/names.hpp"

#include <chrono>

namespace throng {
namespace {

// What a case is not cut into, and has no choice of.
constexpr std::string_view kOfScenes[] = {"--window", "--windows", "--seconds", "--seed", "--mesh"};

// Of the patience that the case as it is may take, and of what that leaves for the sweep: times in
// turn come after it.
constexpr double kOwnShare = 0.35, kSweepShare = 0.8;

const HardCase& case_asked(const Options& options)
{
    const std::string_view word = word_measured(options);
    const HardCase* const found = find_case(word);
    if (found != nullptr) return *found;
    std::vector<std::string_view> names;
    for (const HardCase& one : hard_cases()) names.push_back(one.name);
    throw BadInput("there is no case " + in_quotes(word) + "; there are: " + either_of(names));
}

void measure(const HardCase& which,
             const CostOptions& asked,
             const CostFolder& folder,
             CasePlan plan,
             const Watch& watch,
             CostReport& report)
{
    using Clock = std::chrono::steady_clock;
    const Clock::time_point begin = Clock::now();
    const double patience = asked.sweep.patience;
    plan.patience = kOwnShare * patience;
    if (watch.show) watch.show("the case as it is");
    const CaseTrials trials(which, plan, watch);
    report.of_case =
        CaseLine{std::string(which.about), trials.line().setting, trials.runs(), trials.seconds()};
    report.quantities = trials.quantities();
    report.reference.settles = true;
    report.state = trials.state_hash();
    World world(trials.scene(), plan.threads);
    report.bodies = world.body_count();
    report.machine = this_machine(world.threads());
    SweepPlan swept = asked.sweep;
    folder.take_known(report, swept);
    const double taken = std::chrono::duration<double>(Clock::now() - begin).count();
    swept.patience = kSweepShare * (patience - taken);
    sweep_into(report, trials, world.effects(), swept, watch);
}

int run_cost_of_case(const Options& options)
{
    const HardCase& which = case_asked(options);
    for (const std::string_view option : kOfScenes)
        if (options.has(option))
            throw BadInput(std::string(option) + ": a case has none; it is for scenes");
    const CostOptions asked = read_cost_options(options);
    CasePlan plan;
    plan.quantity = options.text("--measure");
    plan.given = changes_given(options);
    plan.threads = threads_asked(options);
    CostFolder folder(options, std::string(which.name));
    note_interrupts();

    CostReport report;
    report.scene = which.name;
    report.command = "throng cost " + report.scene + " --dials none"
        + (plan.quantity.empty() ? "" : " --measure " + in_shell(plan.quantity));
    report.given = plan.given;
    report.wish = asked.wish;
    try {
        return report_cost(options, report, folder, [&](const Watch& watch) {
            measure(which, asked, folder, plan, watch, report);
        });
    } catch (const TooSlow&) {
        throw BadInput(report.scene
                       + ": its line does not come in this time; --minutes gives it more");
    } catch (const std::invalid_argument& wrong) {
        throw BadInput(wrong.what());
    }
}

}  // namespace

const Command kCostOfCase = {kCostUsage, run_cost_of_case};

}  // namespace throng
