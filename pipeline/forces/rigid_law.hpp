// Rigid law: the conditions of a step as the law of flight takes them.
#pragma once

#include "kernels/dynamics/rigid_motion.hpp"
#include "pipeline/step/step_context.hpp"

namespace throng {

/// By which integrator a body goes; see chosen(). An explicit gyroscopic torque is the first
/// order's.
inline const IntegratorRow& integrator_of(const StepContext& context, bool acted_on)
{
    const bool kicked = context.integrator == Integrator::auto_ && !acted_on
        && context.gyroscopic == Gyroscopic::explicit_;
    return chosen(kicked ? Integrator::semi_implicit : context.integrator, acted_on);
}

inline RigidRule rigid_rule(const StepContext& context)
{
    using Law = RigidRule::Gyroscopic;
    RigidRule rule;
    rule.gravity = context.gravity;
    rule.time = context.time;
    rule.substep = context.substep_of_settings();
    rule.turns = context.has(Effect::rotation);
    rule.rotation = context.rotation;
    rule.gyroscopic = !context.has(Effect::gyroscopic) ? Law::off
        : context.gyroscopic == Gyroscopic::implicit   ? Law::implicit
                                                       : Law::direct;
    // Methods of first order keep the damped gyroscopic torque, which never gains energy.
    constexpr bool kActedOn = true;  // by its pivot
    rule.momentum_on_pivots =
        context.gyroscopic != Gyroscopic::off && chosen(context.integrator, kActedOn).order > 1;
    return rule;
}

}  // namespace throng
