// Step context: what holds for a whole step, the same for every body.
#pragma once

#include "pipeline/step/effects.hpp"
#include "throng/math.hpp"
#include "throng/settings.hpp"

namespace throng {

/// Whether islands whose loads are too much get more than others. The direct solver needs no help,
/// and penalty forces and kinematic pushes go island by island.
inline bool may_escalate(const Settings& settings)
{
    return settings.escalation == Escalation::auto_ && settings.response == Response::impulse
        && settings.solver != Solver::direct;
}

struct StepContext {
    Settings settings;
    Vec3 gravity = Vec3(0, 0, -9.81);
    Set<Effect> effects;
    double last_substep = 0;  // s, of the step before; 0 before the first
    double time = 0;          // s, since the world began

    /// Whether constraints hold friction at every point or within a pyramid, by kernels of their
    /// own. The direct solver has its own friction, and what is too great for it goes by the usual
    /// one.
    bool friction_at_points_or_pyramid() const
    {
        const bool asked = settings.friction_at == FrictionAt::points
            || settings.friction_cone == FrictionCone::pyramid;
        return asked && settings.solver != Solver::direct && effects.has(Effect::friction);
    }
    double substep() const { return settings.dt / settings.substeps; }
    bool has(Effect effect) const { return effects.has(effect); }
};

}  // namespace throng
