// Without: a scene with one effect off beside the same with all, and what changed.
#pragma once

#include "apps/throng/scene_argument.hpp"
#include "cost/windows/body_states.hpp"
#include "throng/effects.hpp"

#include <string_view>

namespace throng {

/// What an effect is worth to a scene.
///
///   windows, length  stretches of the run, each begun by both from where the full run was; s
///   ms, ms_without   a step, without those after a beginning anew, which find their contacts
///   drift, turn, velocity  at a window's end, of the bodies from where all effects have them, root
///                          of the mean square; m, rad, m/s
struct WithoutReport {
    Effect effect = Effect::motion;
    bool on = false;  // somebody calls for it
    std::size_t windows = 0;
    double length = 0;
    double ms = 0, ms_without = 0;
    double drift = 0, turn = 0, velocity = 0;
};

/// One that can be left out. Throws BadInput, which names what there is.
Effect effect_asked(std::string_view option, std::string_view name);

/// Runs both, step by step in turn. Ends early where it is interrupted.
WithoutReport
run_without(const SceneArgument& argument, Effect effect, std::int64_t steps, int threads);

void print_without(const WithoutReport& report);
std::string without_json(const WithoutReport& report);

}  // namespace throng
