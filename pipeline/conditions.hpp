// Conditions: what holds for a whole step, the same for every body.
#pragma once

#include "kernels/math/types.hpp"
#include "pipeline/effects.hpp"
#include "pipeline/settings.hpp"

namespace throng {

struct Conditions {
    Settings settings;
    Vec3 gravity = Vec3(0, 0, -9.81);
    Set<Effect> effects;
    double last_substep = 0;  // s, of the step before; 0 before the first
    double time = 0;          // s, since the world began

    double substep() const { return settings.dt / settings.substeps; }
    bool has(Effect effect) const { return effects.has(effect); }
};

}  // namespace throng
