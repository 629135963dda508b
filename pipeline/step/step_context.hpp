// Step context: what holds for a whole step, the same for every body: how time goes on.
#pragma once

#include "kernels/data/islands.hpp"
#include "pipeline/step/effects.hpp"
#include "throng/math.hpp"
#include "throng/settings.hpp"

namespace throng {

struct StepContext {
    double dt = 1.0 / 60;  // s
    int substeps = 4;
    int times_finer = 1;  // as many of them as the settings say, of an island that is escalated
    Integrator integrator = Integrator::auto_;
    Rotation rotation = Rotation::quaternion;
    Gyroscopic gyroscopic = Gyroscopic::implicit;
    Response response = Response::impulse;
    Vec3 gravity = Vec3(0, 0, -9.81);
    Set<Effect> effects;
    double last_substep = 0;  // s, of the step before; 0 before the first
    double time = 0;          // s, since the world began

    void set(const Settings& settings)
    {
        dt = settings.dt;
        substeps = settings.substeps;
        integrator = settings.integrator;
        rotation = settings.rotation;
        gyroscopic = settings.gyroscopic;
        response = settings.response;
    }
    double substep() const { return dt / substeps; }
    /// s, by the settings: what attractors are followed by, however finely an island is solved, as
    /// one that drew harder within finer substeps would give energy that it does not take back.
    double substep_of_settings() const { return dt * times_finer / substeps; }
    /// m/s: slower than what gravity gives in two steps is resting, not bouncing.
    double resting_speed() const { return 2 * gravity.norm() * dt; }
    bool has(Effect effect) const { return effects.has(effect); }
    /// The same for islands that call for no more than that.
    StepContext of(const IslandCalls& calls) const
    {
        StepContext narrowed = *this;
        narrowed.effects = effects.without(kOfIslands) | (effects & calls.effects);
        return narrowed;
    }
};

}  // namespace throng
