// Rigid law: the conditions of a step as the law of flight takes them.
#pragma once

#include "kernels/motion/rigid_motion.hpp"
#include "pipeline/conditions.hpp"

namespace throng {

inline RigidRule rigid_rule(const Conditions& conditions)
{
    using Law = RigidRule::Gyroscopic;
    RigidRule rule;
    rule.gravity = conditions.gravity;
    rule.time = conditions.time;
    rule.turns = conditions.has(Effect::rotation);
    rule.rotation = conditions.settings.rotation;
    rule.gyroscopic = !conditions.has(Effect::gyroscopic)        ? Law::off
        : conditions.settings.gyroscopic == Gyroscopic::implicit ? Law::implicit
                                                                 : Law::direct;
    // Methods of first order keep the damped gyroscopic torque, which never gains energy.
    const auto& integrator =
        integrators()[static_cast<std::size_t>(conditions.settings.integrator)];
    rule.momentum_on_pivots =
        conditions.settings.gyroscopic != Gyroscopic::off && integrator.order > 1;
    return rule;
}

}  // namespace throng
