// Step errors: H103, what each step is told to be off by, beside what it is off by.
//
// Answer: from the state that a step began with, solver direct goes to its end in 32 parts, in
// double, without pushing apart what overlaps. Where that puts each center of mass is the truth.
#include "cost/changes.hpp"
#include "cost/hard_cases/hard_cases.hpp"
#include "cost/windows/errors.hpp"
#include "throng/catalog.hpp"
#include "throng/error_estimate.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <string>

namespace throng {

namespace {

constexpr double kTime = 3;        // s
constexpr int kParts = 32;         // of a step
constexpr double kTruth = 1e-9;    // m, below which an end is exact
constexpr double kTooSmall = 0.5;  // of the truth

struct Swept {
    const char* scene;
    int size;
};
constexpr Swept kScenes[] = {{"pile", 15},      {"spring", 1},   {"dominoes", 12}, {"tumbler", 15},
                             {"stacks", 20},    {"spheres", 20}, {"hulls", 12},    {"crowd", 20},
                             {"card_house", 2}, {"arch", 13},    {"pyramid", 14}};

const Changes kSettings[] = {{},
                             {{"dt", "1/240"}},
                             {{"substeps", "1"}},
                             {{"dt", "1/30"}},
                             {{"dt", "1/120"}},
                             {{"dt", "1/960"}},
                             {{"dt", "1/240"}, {"substeps", "1"}},
                             {{"substeps", "16"}},
                             {{"iterations", "4"}},
                             {{"solver", "pgs"}},
                             {{"solver", "direct"}, {"substeps", "1"}}};

struct Pair {
    double truth = 0, told = 0;  // m, rms over bodies
};

BodyStates exact_end(const CaseBench& bench, const Scene& scene, const BodyStates& begin, double dt)
{
    Scene by = scene;
    by.settings = {};
    by.settings.dt = dt / kParts;
    by.settings.substeps = 1;
    by.settings.solver = Solver::direct;
    by.settings.precision = Precision::double_;
    by.settings.push_limit = 0;
    by.settings.sleep = false;
    by.settings.escalation = Escalation::off;
    World world(by, bench.threads());
    put_states(world, begin);
    world.step(kParts);
    return states_of(world);
}

void sample_steps(CaseBench& bench,
                  const Scene& scene,
                  const Changes& changes,
                  int samples,
                  std::vector<Pair>& pairs)
{
    Scene by = changed(scene, changes);
    // Of who sleeps no step is taken, nor is anything told.
    by.settings.sleep = false;
    const double dt = by.settings.dt;
    const int steps = static_cast<int>(std::lround(kTime / dt)), every = steps / samples;
    ErrorEstimate estimate;
    BodyStates begin;
    int step = 0;
    const auto prepare = [&](const World& world) {
        if (step % every != every / 2) return;
        begin = states_of(world);
        estimate.before_step(world);
    };
    bench.inspect(by, prepare);
    bench.run(by, kTime, [&](World& world, double) {
        if (step++ % every == every / 2) {
            estimate.after_step(world);
            Errors errors;
            compare(states_of(world), exact_end(bench, scene, begin, dt), errors);
            pairs.push_back(
                {std::sqrt(of(errors, Measure::drift)), bench.estimated(estimate.last().rms)});
        }
        prepare(world);
        return step < steps;
    });
}

std::vector<double> ranks_of(const std::vector<Pair>& pairs, double Pair::*which)
{
    std::vector<std::size_t> order(pairs.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return pairs[a].*which < pairs[b].*which; });
    std::vector<double> ranks(pairs.size());
    for (std::size_t first = 0, last = 0; first < order.size(); first = last) {
        while (last < order.size() && pairs[order[last]].*which == pairs[order[first]].*which)
            ++last;
        const double mean = (static_cast<double>(first) + static_cast<double>(last - 1)) / 2;
        for (std::size_t i = first; i < last; ++i) ranks[order[i]] = mean;
    }
    return ranks;
}

// Spearman's: that of their ranks.
double rank_correlation(const std::vector<Pair>& pairs)
{
    const std::vector<double> a = ranks_of(pairs, &Pair::truth), b = ranks_of(pairs, &Pair::told);
    const double mean = (static_cast<double>(pairs.size()) - 1) / 2;
    double both = 0, of_a = 0, of_b = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        both += (a[i] - mean) * (b[i] - mean);
        of_a += (a[i] - mean) * (a[i] - mean);
        of_b += (b[i] - mean) * (b[i] - mean);
    }
    return both / std::sqrt(of_a * of_b);
}

// What telling it takes, beside the steps: of a heap that falls, on one thread.
void time_it(CaseBench& bench)
{
    using Clock = std::chrono::steady_clock;
    const Scene scene = make_scene("pile", 1000);
    ErrorEstimate estimate;
    Clock::duration spent{};
    double steps_ms = 0;
    const auto timed = [&](auto&& look) {
        const Clock::time_point begin = Clock::now();
        look();
        spent += Clock::now() - begin;
    };
    bench.run(scene, kTime, [&](World& world, double) {
        timed([&] { estimate.after_step(world); });
        steps_ms += world.report().time_ms;
        timed([&] { estimate.before_step(world); });
        return true;
    });
    const double spent_ms = std::chrono::duration<double, std::milli>(spent).count();
    bench.show("pile:1000", "time that telling it takes over that of the steps",
               spent_ms / steps_ms, "1");
}

}  // namespace

void case_step_errors(CaseBench& bench)
{
    const std::size_t scenes = bench.brief() ? 4 : std::size(kScenes);
    const std::size_t settings = bench.brief() ? 4 : std::size(kSettings);
    std::vector<Pair> pairs;
    for (std::size_t i = 0; i < scenes; ++i) {
        const Scene scene = make_scene(
            kScenes[i].scene, bench.brief() ? 1 + 2 * kScenes[i].size / 3 : kScenes[i].size);
        for (std::size_t k = 0; k < settings; ++k)
            sample_steps(bench, scene, kSettings[k], 6, pairs);
    }
    std::vector<double> ratios;
    for (const Pair& pair : pairs)
        if (pair.truth > kTruth) ratios.push_back(pair.told / pair.truth);
    std::sort(ratios.begin(), ratios.end());
    const auto too_small = std::lower_bound(ratios.begin(), ratios.end(), kTooSmall);
    const std::string setting = std::to_string(scenes) + " scenes, " + std::to_string(settings)
        + " settings, " + std::to_string(pairs.size()) + " steps";
    bench.forgive_residual();
    bench.report(setting, "1 less the rank correlation of told and true errors",
                 1 - rank_correlation(pairs), 0.2, "1");
    bench.report(setting, "share of steps told less than half the truth",
                 static_cast<double>(too_small - ratios.begin())
                     / static_cast<double>(ratios.size()),
                 0.05, "1");
    bench.show(setting, "told over true error, in the middle", ratios[ratios.size() / 2], "1");
    if (!bench.brief()) time_it(bench);
}

}  // namespace throng
