// Effects: what this scene calls for, and which body or material called for it.
//
// The only place that asks what a scene needs. A stage is in the step when an effect that wants it
// is on, and never asks again.
#pragma once

#include "pipeline/step/effect_census.hpp"
#include "throng/effects.hpp"

#include <array>
#include <string>
#include <vector>

namespace throng {

/// What a user asked for that leaves no trace in the arrays of the step: who was the first to.
struct Requests {
    std::array<std::string, kEffects> first;  // by Effect; empty: nobody
    void ask(Effect effect, const std::string& who)
    {
        std::string& cause = first[static_cast<std::size_t>(effect)];
        if (cause.empty()) cause = who;
    }
};

/// Everything that decides about effects, besides who calls for what.
struct EffectFacts {
    BodyFacts bodies;
    const PrescribedVelocities& prescribed;
    const Surfaces& surfaces;
    const Requests& requests;
    const std::vector<std::string>& body_names;  // may be shorter than the bodies
    const std::vector<std::string>& material_names;
    Set<Effect> left_out;  // whoever calls for them
};

/// What is called for. Takes no longer where there are more bodies.
Set<Effect> effects_called_for(const EffectFacts& facts, const EffectCensus& census);

/// The same with the first that calls for each.
Effects find_effects(const EffectFacts& facts, const EffectCensus& census);

}  // namespace throng
