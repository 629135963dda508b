// Without: a scene with one effect off beside the same with all, and what changed.
#pragma once

#include "apps/throng/beside.hpp"
#include "apps/throng/scene_argument.hpp"
#include "throng/effects.hpp"

#include <string_view>

namespace throng {

/// What an effect is worth to a scene.
struct WithoutReport {
    Effect effect = Effect::motion;
    bool on = false;  // somebody calls for it
    BesideReport beside;
};

/// One that can be left out. Throws BadInput, which names what there is.
Effect effect_asked(std::string_view option, std::string_view name);

/// Runs both. Ends early where it is interrupted.
WithoutReport
run_without(const SceneArgument& argument, Effect effect, std::int64_t steps, int threads);

void print_without(const WithoutReport& report);
std::string without_json(const WithoutReport& report);

}  // namespace throng
