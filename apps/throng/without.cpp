#include "apps/throng/without.hpp"

#include "apps/throng/interrupt.hpp"
#include "apps/throng/json_lines.hpp"
#include "apps/throng/progress.hpp"
#include "cost/windows/windows.hpp"
#include "scene/files/json.hpp"
#include "scene/files/json_writer.hpp"
#include "scene/names.hpp"
#include "throng/leave_out.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>

namespace throng {

namespace {

// With what calls for it taken out.
World world_without(SceneArgument argument, Effect effect, int threads)
{
    argument.scene = leave_out(argument.scene, effect);
    World world = make_world(argument, threads, true);
    if (kLeftOutByWorld.has(effect)) world.leave_out({effect});
    return world;
}

double ms_of_step(World& world)
{
    using Clock = std::chrono::steady_clock;
    const auto begin = Clock::now();
    world.step();
    return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

// Who cannot turn is not begun with a spin.
BodyStates beginnings(const BodyStates& states, Effect left_out)
{
    BodyStates begun = states;
    if (left_out == Effect::rotation)
        for (BodyState& state : begun) state.spin = Vec3::Zero();
    return begun;
}

// Both on from where the full run is.
void run_window(std::int64_t steps,
                StepGuard& guard,
                World& full,
                World& other,
                WithoutReport& report,
                std::vector<Errors>& errors)
{
    const std::int64_t settled = steps / 3;  // contacts are found again
    double ms = 0, ms_without = 0;
    for (std::int64_t i = 0; i < steps && !interrupted(); ++i) {
        guard.begin_step();
        // By turns the first: who is the second finds code and tables in cache.
        double of_full = 0, of_other = 0;
        if (i % 2 == 0) of_full = ms_of_step(full);
        of_other = ms_of_step(other);
        if (i % 2 == 1) of_full = ms_of_step(full);
        guard.end_step();
        if (i < settled) continue;
        ms += of_full;
        ms_without += of_other;
    }
    compare(states_of(other), states_of(full), errors.emplace_back());
    const double share = 1 / static_cast<double>(steps - settled);
    report.ms += ms * share;
    report.ms_without += ms_without * share;
    ++report.windows;
}

}  // namespace

Effect effect_asked(std::string_view option, std::string_view name)
{
    std::string spaced(name);
    for (char& letter : spaced)
        if (letter == '_' || letter == '-') letter = ' ';
    std::vector<std::string_view> names;
    for (int i = 0; i < kEffects; ++i) {
        const auto effect = static_cast<Effect>(i);
        if (effect == Effect::motion) continue;  // without it there is nothing
        if (name_of(effect) == spaced) return effect;
        names.push_back(name_of(effect));
    }
    const std::string near = nearest_names(spaced, names);
    throw BadInput(
        std::string(option) + ": wanted an effect, got " + in_quotes(name)
        + (near.empty() ? "; there are: " + either_of(names) : "; did you mean " + near + "?"));
}

WithoutReport
run_without(const SceneArgument& argument, Effect effect, std::int64_t steps, int threads)
{
    World full = make_world(argument, threads, true);
    World other = world_without(argument, effect, threads);
    WithoutReport report;
    report.effect = effect;
    report.on = full.effects().on.has(effect);
    const double dt = argument.scene.settings.dt;
    const auto of_window = std::min(
        steps, std::max<std::int64_t>(1, std::llround(std::ceil(WindowPlan{}.length / dt - 1e-9))));
    report.length = static_cast<double>(of_window) * dt;
    std::vector<Errors> errors;
    Progress progress(steps, true);
    StepGuard guard([] {});
    for (std::int64_t done = 0; done + of_window <= steps && !interrupted(); done += of_window) {
        if (done > 0) {
            const BodyStates states = states_of(full);
            put_states(full, states);
            put_states(other, beginnings(states, effect));
        }
        run_window(of_window, guard, full, other, report, errors);
        progress.show(done + of_window, full.report().bodies_awake);
    }
    if (report.windows > 0) {
        report.ms /= static_cast<double>(report.windows);
        report.ms_without /= static_cast<double>(report.windows);
    }
    report.drift = rms(errors, place_of(Measure::drift));
    report.turn = rms(errors, place_of(Measure::turn));
    report.velocity = rms(errors, place_of(Measure::velocity));
    return report;
}

void print_without(const WithoutReport& report)
{
    std::cout << "\nwithout " << name_of(report.effect) << '\n';
    if (!report.on) std::cout << "  nobody calls for it: nothing changes\n";
    char text[256];
    std::snprintf(text, sizeof text,
                  "  ms_per_step  %.4g, with it %.4g: %.3g %% less\n"
                  "  error        %.3g m, %.3g rad, %.3g m/s at the end of %.3g s\n"
                  "               (root mean square over bodies, %zu windows)\n",
                  report.ms_without, report.ms,
                  report.ms > 0 ? 100 * (1 - report.ms_without / report.ms) : 0, report.drift,
                  report.turn, report.velocity, report.length, report.windows);
    std::cout << text;
}

std::string without_json(const WithoutReport& report)
{
    return JsonMembers()
        .add_text("effect", name_of(report.effect))
        .add("on", report.on ? "true" : "false")
        .add("windows", std::to_string(report.windows))
        .add("window_s", report.length)
        .add("ms_per_step", report.ms)
        .add("ms_per_step_without", report.ms_without)
        .add("drift_m", report.drift)
        .add("turn_rad", report.turn)
        .add("velocity_m_s", report.velocity)
        .text();
}

}  // namespace throng
