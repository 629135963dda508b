// Effects: what this scene calls for, and which body or material called for it.
//
// The only place that asks what a scene needs. A stage is in the step when an effect that wants it
// is on, and never asks again.
#pragma once

#include "kernels/data/bodies.hpp"
#include "kernels/data/forces.hpp"
#include "pipeline/step/set.hpp"

#include <array>
#include <string>
#include <string_view>

namespace throng {

enum class Effect : std::uint8_t {
    motion,  // some body can move at all
    gravity,
    forces,
    drive,
    rotation,
    gyroscopic,
    contact,
    no_overlap,
    little_overlap,
    friction,
    rolling_friction,
    restitution,
    fast_motion,
    mesh_contact,
    voxel_contact,
    sphere_contact,
    image_contact,
    seams,  // between colliders that do not move against one another
    springs,
    attractors,
    wind,
    drag,
    pivot,
    joints,
    motors,
    sleeping,
    escalation,
    sensors,
    events,
    agents,
};
/// What calls for contacts of solids, each by its way.
inline constexpr Set<Effect> kSolidContact = {Effect::voxel_contact, Effect::sphere_contact,
                                              Effect::image_contact};
/// Bodies carried from touch to touch, in place of contact.
inline constexpr Set<Effect> kCarried = {Effect::no_overlap, Effect::little_overlap};
/// What acts on bodies besides gravity and contacts.
inline constexpr Set<Effect> kForces = {Effect::forces, Effect::springs, Effect::attractors,
                                        Effect::wind,   Effect::drag,    Effect::pivot};
inline constexpr int kEffects = static_cast<int>(Effect::agents) + 1;

std::string_view name_of(Effect effect);

/// False for an effect that scenes may call for and this build does not act on yet.
bool acted_on(Effect effect);

/// What a user asked for that leaves no trace in the arrays of the step: who was the first to.
struct Requests {
    std::array<std::string, kEffects> first;  // by Effect; empty: nobody
    void ask(Effect effect, const std::string& who)
    {
        std::string& cause = first[static_cast<std::size_t>(effect)];
        if (cause.empty()) cause = who;
    }
};

/// The effects of a scene, each with the first that calls for it.
struct Effects {
    Set<Effect> on;
    std::array<std::string, kEffects> cause;

    const std::string& cause_of(Effect effect) const
    {
        return cause[static_cast<std::size_t>(effect)];
    }
};

struct Conditions;
struct PairFilter;

/// Everything that decides about effects.
struct EffectFacts {
    const Conditions& conditions;
    const BodyStates& states;
    const Poses& poses;
    const Velocities& velocities;
    const Masses& masses;
    const Drives& drives;
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
