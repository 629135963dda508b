// Effects: what this scene calls for, and which body or material called for it.
//
// The only place that asks what a scene needs. A stage is in the step when an effect that wants it
// is on, and never asks again.
#pragma once

#include "kernels/data/bodies.hpp"
#include "kernels/data/forces.hpp"
#include "throng/effects.hpp"
#include "throng/settings.hpp"

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

struct PairFilter;

/// Everything that decides about effects.
struct EffectFacts {
    const Settings& settings;
    const Vec3& gravity;
    const BodyStates& states;
    const Poses& poses;
    const Velocities& velocities;
    const Masses& masses;
    const PrescribedVelocities& prescribed;
    const Forces& forces;
    const Shapes& shapes;
    const Colliders& colliders;
    const Surfaces& surfaces;
    const PairFilter& filter;
    const Requests& requests;
    const std::vector<std::string>& body_names;  // may be shorter than the bodies
    const std::vector<std::string>& material_names;
};

Effects find_effects(const EffectFacts& facts);

}  // namespace throng
