// Figures: what the runs of a benchmark come to.
#include "apps/throng/bench/figures.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <tuple>

namespace throng::bench {
namespace {

double mean(const std::vector<double>& list, std::size_t begin, std::size_t end)
{
    const auto at = [&](std::size_t i) { return list.begin() + static_cast<std::ptrdiff_t>(i); };
    return end <= begin
        ? 0
        : std::accumulate(at(begin), at(end), 0.0) / static_cast<double>(end - begin);
}

double percentile(std::vector<double> list, double part)
{
    if (list.empty()) return 0;
    const double rank = std::ceil(part * static_cast<double>(list.size()));
    const auto place = static_cast<std::ptrdiff_t>(std::max(1.0, rank)) - 1;
    std::nth_element(list.begin(), list.begin() + place, list.end());
    return list[static_cast<std::size_t>(place)];
}

Spread spread_of(std::vector<double> list)
{
    if (list.empty()) return {};
    std::sort(list.begin(), list.end());
    const std::size_t middle = list.size() / 2;
    const double median =
        list.size() % 2 == 1 ? list[middle] : (list[middle - 1] + list[middle]) / 2;
    return {median, list.front(), list.back()};
}

template <class Value>
Spread over(const std::vector<const Run*>& runs, const Value& value)
{
    std::vector<double> list(runs.size());
    std::transform(runs.begin(), runs.end(), list.begin(),
                   [&](const Run* run) { return value(*run); });
    return spread_of(std::move(list));
}

// The repeats of each engine, engines in their order.
std::vector<std::vector<const Run*>> by_engine(const Case& made)
{
    std::vector<std::vector<const Run*>> engines;
    for (const Run& run : made.runs) {
        if (run.steps() == 0) continue;
        const auto same = [&](const std::vector<const Run*>& runs) {
            const Run& first = *runs.front();
            return first.engine == run.engine && first.setting == run.setting
                && first.threads == run.threads && first.beside == run.beside;
        };
        const auto found = std::find_if(engines.begin(), engines.end(), same);
        if (found == engines.end())
            engines.push_back({&run});
        else
            found->push_back(&run);
    }
    return engines;
}

std::size_t common_steps(const std::vector<const Run*>& runs)
{
    std::size_t least = runs.front()->steps();
    for (const Run* run : runs) least = std::min(least, run->steps());
    return least;
}

Comparison compare(const std::vector<const Run*>& ours, const std::vector<const Run*>& theirs)
{
    Comparison made;
    made.engine = theirs.front()->engine;
    made.setting = theirs.front()->setting;
    made.threads = theirs.front()->threads;
    made.steps = std::min(common_steps(ours), common_steps(theirs));
    std::vector<double> times, cpu_times;
    const auto ratio = [&](const std::vector<double>& a, const std::vector<double>& b) {
        return mean(a, 0, made.steps) / mean(b, 0, made.steps);
    };
    for (std::size_t i = 0; i < std::min(ours.size(), theirs.size()); ++i) {
        times.push_back(ratio(theirs[i]->ms, ours[i]->ms));
        cpu_times.push_back(ratio(theirs[i]->cpu_ms, ours[i]->cpu_ms));
    }
    made.times = spread_of(std::move(times));
    made.cpu_times = spread_of(std::move(cpu_times));
    return made;
}

// Whether an engine has been run on so many threads.
bool runs_on(const std::vector<std::vector<const Run*>>& engines,
             const std::string& engine,
             int threads)
{
    return std::any_of(engines.begin(), engines.end(), [&](const std::vector<const Run*>& runs) {
        return runs.front()->engine == engine && runs.front()->threads == threads;
    });
}

Spread efficiency_of(const std::vector<const Run*>& ours, const std::vector<const Run*>& alone)
{
    const std::size_t steps = std::min(common_steps(ours), common_steps(alone));
    std::vector<double> shares;
    for (std::size_t i = 0; i < std::min(ours.size(), alone.size()); ++i)
        shares.push_back(mean(alone[i]->ms, 0, steps)
                         / (ours[i]->threads * mean(ours[i]->ms, 0, steps)));
    return spread_of(std::move(shares));
}

std::vector<StageFigure> stages_of(const std::vector<const Run*>& runs)
{
    std::vector<StageFigure> stages;
    for (const StageRun& stage : runs.front()->stages) {
        std::vector<double> all;
        for (const Run* run : runs)
            for (const StageRun& same : run->stages)
                if (same.name == stage.name) all.insert(all.end(), same.ms.begin(), same.ms.end());
        stages.push_back({stage.name, mean(all, 0, all.size()), percentile(all, 0.99)});
    }
    return stages;
}

// What steps took: of one thread by the processor's time, which others disturb less.
const std::vector<double>& steady_ms(const Run& run)
{
    return run.threads == 1 ? run.cpu_ms : run.ms;
}

// Time of a contact, ns, over steps [begin, end) of those times; 0 where there is none.
double contact_ns(const Run& run, const std::vector<double>& ms, std::size_t begin, std::size_t end)
{
    double contacts = 0;
    for (std::size_t i = begin; i < end; ++i) contacts += static_cast<double>(run.contacts[i]);
    const double taken = mean(ms, begin, end) * static_cast<double>(end - begin);
    return contacts > 0 ? taken * 1e6 / contacts : 0;
}

Figure figure_of(const Case& made, const std::vector<const Run*>& runs)
{
    const Run& first = *runs.front();
    const auto bodies = static_cast<double>(std::max<std::size_t>(1, made.bodies_dynamic));
    Figure figure;
    figure.engine = first.engine;
    figure.setting = first.setting;
    figure.settings = first.settings;
    figure.threads = first.threads;
    figure.threads_met = first.threads_met;
    figure.beside = first.beside;
    figure.steps = common_steps(runs);
    figure.ms_mean = over(runs, [&](const Run& run) { return mean(run.ms, 0, figure.steps); });
    figure.ms_median = over(runs, [](const Run& run) { return percentile(run.ms, 0.5); }).median;
    figure.ms_p99 = over(runs, [](const Run& run) { return percentile(run.ms, 0.99); }).median;
    figure.cpu_ms =
        over(runs, [&](const Run& run) { return mean(run.cpu_ms, 0, figure.steps); }).median;
    figure.make_ms = over(runs, [](const Run& run) { return run.make_ms; }).median;
    figure.ns_a_body = figure.ms_mean.median * 1e6 / bodies;
    figure.ns_a_contact =
        over(runs, [&](const Run& run) {
            return contact_ns(run, run.ms, figure.steps - (figure.steps + 3) / 4, figure.steps);
        }).median;
    figure.contacts = static_cast<double>(first.contacts[figure.steps - 1]);
    // What an earlier repeat gave back may be taken again unseen: the greatest is the true one.
    figure.state_bytes = over(runs, [](const Run& run) { return run.state_bytes; }).most / bodies;
    figure.heap_bytes = over(runs, [](const Run& run) { return run.heap_bytes; }).most / bodies;
    figure.resident_bytes =
        over(runs, [](const Run& run) { return run.resident_bytes; }).most / bodies;
    figure.stages = stages_of(runs);
    figure.quality = first.quality;
    figure.error = first.error;
    figure.state_hash = first.state_hash;
    return figure;
}

// Exponent of the power law that is nearest, by least squares of logarithms.
double fitted_exponent(const std::vector<std::size_t>& bodies, const std::vector<double>& ms)
{
    double n = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        if (!(ms[i] > 0) || bodies[i] == 0) continue;
        const double a = std::log(static_cast<double>(bodies[i])), b = std::log(ms[i]);
        n += 1, x += a, y += b, xx += a * a, xy += a * b;
    }
    const double spread = n * xx - x * x;
    return spread > 0 ? (n * xy - x * y) / spread : 0;
}

// Contacts a body over some steps.
double contacts_a_body(const Case& made, const Run& run, std::size_t begin, std::size_t end)
{
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) sum += static_cast<double>(run.contacts[i]);
    return sum / static_cast<double>((end - begin) * std::max<std::size_t>(1, made.bodies_dynamic));
}

Growth::EqualState
equal_state(const Case& small, const Run& of_small, const Case& large, const Run& of_large)
{
    // A window of steps: the last one at the greater size, and where the smaller is most like it.
    const std::size_t steps = std::min(of_small.steps(), of_large.steps());
    const std::size_t window = std::max<std::size_t>(1, std::min<std::size_t>(20, steps / 4));
    Growth::EqualState made;
    made.small = small.bodies_dynamic;
    made.large = large.bodies_dynamic;
    const std::size_t end = of_large.steps();
    made.contacts_large = contacts_a_body(large, of_large, end - window, end);
    std::size_t best = of_small.steps() - window;
    double off =
        std::abs(contacts_a_body(small, of_small, best, best + window) - made.contacts_large);
    for (std::size_t at = best; at-- > 0;) {
        const double here =
            std::abs(contacts_a_body(small, of_small, at, at + window) - made.contacts_large);
        if (here < off) off = here, best = at;
    }
    made.contacts_small = contacts_a_body(small, of_small, best, best + window);
    made.by_contact = made.contacts_large > 0.1;
    const auto cost = [&](const Case& of, const Run& run, std::size_t begin) {
        return made.by_contact ? contact_ns(run, steady_ms(run), begin, begin + window)
                               : mean(steady_ms(run), begin, begin + window) * 1e6
                / static_cast<double>(std::max<std::size_t>(1, of.bodies_dynamic));
    };
    made.ns_small = cost(small, of_small, best);
    made.ns_large = cost(large, of_large, end - window);
    return made;
}

// The repeat of throng whose mean time is least: the one that others disturbed least.
const Run* calmest(const Case& made, const std::string& setting, int threads)
{
    const Run* found = nullptr;
    const auto cost = [](const Run& run) { return mean(steady_ms(run), 0, run.steps()); };
    for (const Run& run : made.runs) {
        if (run.engine != "throng" || run.setting != setting || run.threads != threads
            || run.beside > 0 || run.steps() == 0)
            continue;
        if (found == nullptr || cost(run) < cost(*found)) found = &run;
    }
    return found;
}

Growth
growth_of_scene(const std::vector<const Case*>& cases, const std::string& setting, int threads)
{
    Growth made;
    made.scene = cases.front()->scene->name;
    made.dt = cases.front()->dt;
    made.setting = setting;
    made.threads = threads;
    std::vector<const Run*> runs(cases.size());
    std::transform(cases.begin(), cases.end(), runs.begin(),
                   [&](const Case* one) { return calmest(*one, setting, threads); });
    made.steps = common_steps(runs);
    for (std::size_t i = 0; i < cases.size(); ++i) {
        made.bodies.push_back(cases[i]->bodies_dynamic);
        made.ms.push_back(mean(steady_ms(*runs[i]), 0, made.steps));
        if (i > 0)
            made.steps_up.push_back(equal_state(*cases[i - 1], *runs[i - 1], *cases[i], *runs[i]));
    }
    made.exponent = fitted_exponent(made.bodies, made.ms);
    return made;
}

}  // namespace

std::vector<Figure> figures_of(const Case& made)
{
    const std::vector<std::vector<const Run*>> engines = by_engine(made);
    std::vector<Figure> figures;
    for (const std::vector<const Run*>& runs : engines) {
        figures.push_back(figure_of(made, runs));
        if (runs.front()->engine != "throng") continue;
        for (const std::vector<const Run*>& others : engines) {
            const Run& other = *others.front();
            const Run& run = *runs.front();
            const bool serial = other.engine == "throng" && other.threads == 1
                && other.setting == run.setting && run.threads > 1;
            const bool peer = other.engine != "throng"
                && (other.threads == run.threads
                    || (other.threads == 1 && !runs_on(engines, other.engine, run.threads)));
            if (peer || (serial && other.beside == 0))
                figures.back().against.push_back(compare(runs, others));
            else if (serial && other.beside + 1 == run.threads)
                figures.back().efficiency = efficiency_of(runs, others);
        }
    }
    return figures;
}

bool hashes_agree(const Case& made)
{
    std::map<std::pair<std::string, std::size_t>, std::string> seen;  // by kind and steps
    for (const Run& run : made.runs) {
        if (run.state_hash.empty()) continue;
        const auto [known, first] = seen.try_emplace({run.alike, run.steps()}, run.state_hash);
        if (!first && known->second != run.state_hash) return false;
    }
    return true;
}

std::vector<Growth> growth_of(const std::vector<Case>& cases)
{
    std::vector<Growth> all;
    // Scene, dt, setting, threads.
    std::set<std::tuple<const CatalogEntry*, double, std::string, int>> done;
    for (const Case& one : cases)
        for (const Run& run : one.runs) {
            if (run.engine != "throng" || run.beside > 0) continue;
            if (!done.emplace(one.scene, one.dt, run.setting, run.threads).second) continue;
            std::vector<const Case*> sizes;
            for (const Case& other : cases)
                if (other.scene == one.scene && other.dt == one.dt
                    && calmest(other, run.setting, run.threads) != nullptr)
                    sizes.push_back(&other);
            if (sizes.size() > 1) all.push_back(growth_of_scene(sizes, run.setting, run.threads));
        }
    return all;
}

}  // namespace throng::bench
