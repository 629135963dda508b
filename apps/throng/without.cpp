#include "apps/throng/without.hpp"

#include "scene/files/json.hpp"
#include "scene/names.hpp"
#include "throng/leave_out.hpp"

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

// Who cannot turn is not begun with a spin.
BodyStates beginnings(const BodyStates& states, Effect left_out)
{
    BodyStates begun = states;
    if (left_out == Effect::rotation)
        for (BodyState& state : begun) state.spin = Vec3::Zero();
    return begun;
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
    report.beside = run_beside(
        full, other, steps, [&](const BodyStates& states) { return beginnings(states, effect); });
    return report;
}

void print_without(const WithoutReport& report)
{
    std::cout << "\nwithout " << name_of(report.effect) << '\n';
    if (!report.on) std::cout << "  nobody calls for it: nothing changes\n";
    const BesideReport& beside = report.beside;
    char text[256];
    std::snprintf(text, sizeof text,
                  "  ms_per_step  %.4g, with it %.4g: %.3g %% less\n"
                  "  error        %.3g m, %.3g rad, %.3g m/s at the end of %.3g s\n"
                  "               (root mean square over bodies, %zu windows)\n",
                  beside.ms_other, beside.ms, 100 * beside.saved(), beside.drift, beside.turn,
                  beside.velocity, beside.length, beside.windows);
    std::cout << text;
}

std::string without_json(const WithoutReport& report)
{
    JsonMembers json;
    json.add_text("effect", name_of(report.effect))
        .add("on", report.on ? "true" : "false")
        .add("ms_per_step", report.beside.ms)
        .add("ms_per_step_without", report.beside.ms_other);
    add_windows(report.beside, json);
    return json.text();
}

}  // namespace throng
