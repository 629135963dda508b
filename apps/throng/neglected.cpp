#include "apps/throng/neglected.hpp"

#include "apps/throng/interrupt.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <tuple>

namespace throng {

namespace {

// m, root of the mean square over the bodies that errors are taken over.
double rms_radius(const World& world)
{
    double sum = 0;
    std::size_t bodies = 0;
    for (const BodyState& state : states_of(world)) {
        if (!state.counts) continue;
        const double radius = world.radius(state.body);
        sum += radius * radius;
        ++bodies;
    }
    return bodies > 0 ? std::sqrt(sum / static_cast<double>(bodies)) : 0;
}

// Of few bodies what comes of the last digits is told by several ways of being off: one says little
// of how far a body that tumbles may be taken.
constexpr std::size_t kFewBodies = 16, kWays = 6;

std::size_t ways_of_being_off(const World& world)
{
    const BodyStates states = states_of(world);
    const auto bodies =
        std::count_if(states.begin(), states.end(), [](const auto& state) { return state.counts; });
    return static_cast<std::size_t>(bodies) < kFewBodies ? kWays : 1;
}

// Each off to another side, which are others by every way.
BodyStates shaken(const World& world, BodyStates states, std::size_t way)
{
    constexpr double kShare = 1e-7;
    for (std::size_t i = 0; i < states.size(); ++i) {
        if (!states[i].counts) continue;
        Vec3 by = Vec3::Zero();
        by[static_cast<Eigen::Index>((i + way) % 3)] = (i + way / 3) % 2 == 0 ? 1 : -1;
        states[i].pose.position += kShare * world.radius(states[i].body) * by;
    }
    return states;
}

bool is_within(double error, double of_last_digits, double promised)
{
    return error * error - of_last_digits * of_last_digits <= promised * promised;
}

}  // namespace

bool NeglectReport::kept() const
{
    return is_within(beside.turn, shaken.turn, promised_rad)
        && is_within(beside.drift, shaken.drift, promised_m);
}

NeglectReport run_neglected(const SceneArgument& argument, std::int64_t steps, int threads)
{
    SceneArgument called = argument;
    called.scene.settings.effects = EffectChoice::called;
    const auto by_called = [&] { return make_world(called, threads, true); };
    const auto by_auto = [&] { return make_world(argument, threads, true); };
    NeglectReport report;
    {
        World full = by_called(), other = by_auto();
        std::tie(report.ms_called, report.ms) = time_beside(full, other, steps);
    }
    {
        World full = by_called(), other = by_auto();
        report.promised_rad = argument.scene.settings.effects_error;
        report.promised_m = report.promised_rad * rms_radius(full);
        report.beside = run_beside(full, other, steps, {});
    }
    const std::size_t ways = ways_of_being_off(by_called());
    for (std::size_t way = 0; way < ways && !interrupted(); ++way) {
        World full = by_called(), other = by_called();
        const BesideReport one = run_beside(full, other, steps, [&](const BodyStates& states) {
            return shaken(full, states, way);
        });
        report.shaken.drift = std::max(report.shaken.drift, one.drift);
        report.shaken.turn = std::max(report.shaken.turn, one.turn);
    }
    return report;
}

void print_neglected(const NeglectReport& report, const std::vector<EffectEntry>& entries)
{
    char text[512];
    std::cout << "\nneglected by effects=auto in the last step\n";
    bool any = false;
    for (const EffectEntry& entry : entries) {
        if (entry.neglected == 0) continue;
        any = true;
        std::snprintf(text, sizeof text, "  %-16s  in %zu %s, each off by no more than %.3g\n",
                      std::string(name_of(entry.effect)).c_str(), entry.neglected,
                      entry.effect == Effect::rolling_friction ? "contacts" : "bodies",
                      entry.bound);
        std::cout << text;
    }
    if (!any) std::cout << "  nothing\n";
    std::snprintf(text, sizeof text,
                  "  ms_per_step  %.4g, by effects=called %.4g: %.3g %% less\n"
                  "  error        %.3g m, %.3g rad at the end of %.3g s (root mean square over "
                  "bodies, %zu windows)\n"
                  "  last digits  %.3g m, %.3g rad: what comes of them alone\n"
                  "  promised     %.3g m, %.3g rad beyond that: %s\n",
                  report.ms, report.ms_called, 100 * report.saved(), report.beside.drift,
                  report.beside.turn, report.beside.length, report.beside.windows,
                  report.shaken.drift, report.shaken.turn, report.promised_m, report.promised_rad,
                  report.kept() ? "kept" : "not kept");
    std::cout << text;
}

std::string neglected_json(const NeglectReport& report)
{
    JsonMembers json;
    json.add("promised_m", report.promised_m)
        .add("promised_rad", report.promised_rad)
        .add("kept", report.kept() ? "true" : "false")
        .add("ms_per_step", report.ms)
        .add("ms_per_step_called", report.ms_called)
        .add("last_digits_m", report.shaken.drift)
        .add("last_digits_rad", report.shaken.turn);
    add_windows(report.beside, json);
    return json.text();
}

}  // namespace throng
