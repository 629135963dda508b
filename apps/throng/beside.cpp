#include "apps/throng/beside.hpp"

#include "apps/throng/interrupt.hpp"
#include "apps/throng/progress.hpp"
#include "cost/windows/windows.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace throng {

namespace {

double ms_of_step(World& world)
{
    using Clock = std::chrono::steady_clock;
    const auto begin = Clock::now();
    world.step();
    return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

// A step of both, ms of each. By turns the first: who is the second finds code and tables in cache.
std::pair<double, double> step_both(World& full, World& other, bool full_first)
{
    double of_full = 0, of_other = 0;
    if (full_first) of_full = ms_of_step(full);
    of_other = ms_of_step(other);
    if (!full_first) of_full = ms_of_step(full);
    return {of_full, of_other};
}

// Both on from where the full run is.
void run_window(std::int64_t steps,
                StepGuard& guard,
                World& full,
                World& other,
                BesideReport& report,
                std::vector<Errors>& errors)
{
    const std::int64_t settled = steps / 3;  // contacts are found again
    double ms = 0, ms_other = 0;
    for (std::int64_t i = 0; i < steps && !interrupted(); ++i) {
        guard.begin_step();
        const auto [of_full, of_other] = step_both(full, other, i % 2 == 0);
        guard.end_step();
        if (i < settled) continue;
        ms += of_full;
        ms_other += of_other;
    }
    compare(states_of(other), states_of(full), errors.emplace_back());
    const double share = 1 / static_cast<double>(steps - settled);
    report.ms += ms * share;
    report.ms_other += ms_other * share;
    ++report.windows;
}

}  // namespace

BesideReport run_beside(World& full,
                        World& other,
                        std::int64_t steps,
                        const std::function<BodyStates(const BodyStates&)>& begin)
{
    BesideReport report;
    const double dt = full.settings().dt;
    const auto of_window = std::min(
        steps, std::max<std::int64_t>(1, std::llround(std::ceil(WindowPlan{}.length / dt - 1e-9))));
    report.length = static_cast<double>(of_window) * dt;
    std::vector<Errors> errors;
    Progress progress(steps, true);
    StepGuard guard([] {});
    for (std::int64_t done = 0; done + of_window <= steps && !interrupted(); done += of_window) {
        const BodyStates states = states_of(full);
        put_states(full, states);
        put_states(other, begin ? begin(states) : states);
        run_window(of_window, guard, full, other, report, errors);
        progress.show(done + of_window, full.report().bodies_awake);
    }
    if (report.windows > 0) {
        report.ms /= static_cast<double>(report.windows);
        report.ms_other /= static_cast<double>(report.windows);
    }
    report.drift = rms(errors, place_of(Measure::drift));
    report.turn = rms(errors, place_of(Measure::turn));
    report.velocity = rms(errors, place_of(Measure::velocity));
    return report;
}

std::pair<double, double> time_beside(World& full, World& other, std::int64_t steps)
{
    double ms = 0, ms_other = 0;
    std::int64_t done = 0;
    Progress progress(steps, true);
    StepGuard guard([] {});
    while (done < steps && !interrupted()) {
        guard.begin_step();
        const auto [of_full, of_other] = step_both(full, other, done % 2 == 0);
        guard.end_step();
        ms += of_full;
        ms_other += of_other;
        progress.show(++done, full.report().bodies_awake);
    }
    const double share = done > 0 ? 1 / static_cast<double>(done) : 0;
    return {ms * share, ms_other * share};
}

void add_windows(const BesideReport& report, JsonMembers& to)
{
    to.add("windows", std::to_string(report.windows))
        .add("window_s", report.length)
        .add("drift_m", report.drift)
        .add("turn_rad", report.turn)
        .add("velocity_m_s", report.velocity);
}

}  // namespace throng
