#include "pipeline/forces/velocity_lag.hpp"

#include "pipeline/forces/rigid_law.hpp"

namespace throng {

namespace {

Vec3 half_fall(const StepContext& context) { return 0.5 * context.substep() * context.gravity; }

// Whether a body flies by what leaves velocities of the moment, and contacts do not: they give half
// of what depends on its state, and of gravity with it, after it moved.
bool differs(const StepContext& context, const Forces& forces, std::uint32_t body)
{
    const bool acted_on = forces.act_on(body);
    if (falls_by_kicks(context.integrator)
        && !(acted_on && context.integrator == Integrator::auto_))
        return false;
    return context.response == Response::penalty || !forces.depends_on_state(body);
}

// Whether anybody can be such a one: most scenes have none, and nobody is looked at.
bool anybody_differs(const StepContext& context)
{
    return context.has(Effect::gravity)
        && (!falls_by_kicks(context.integrator) || context.effects.meets(kForces));
}

// Whether a body has its velocity from an integrator. Who has not flown yet, and is at a contact,
// may rest there: half a fall less would have friction hold him with half his weight at first.
bool has_flown(const Flights& flights, std::uint32_t body)
{
    return body < flights.memory.size()
        && !flights.memory[body].shown_orientation.coeffs().isZero(0);
}

}  // namespace

void lag_velocities(const StepContext& context,
                    const Forces& forces,
                    const Masses& masses,
                    std::span<const std::uint32_t> bodies,
                    Flights& flights,
                    Velocities& velocities)
{
    if (!anybody_differs(context)) return;
    flights.lags.resize(masses.mass.size());
    for (const std::uint32_t body : bodies) {
        if (flights.lags[body] != 0 || !(masses.inverse_mass[body] > 0)
            || !differs(context, forces, body))
            continue;
        if (has_flown(flights, body)) velocities.linear[body] -= half_fall(context);
        flights.lags[body] = 1;
    }
}

void catch_up_velocities(const StepContext& context,
                         std::span<const std::uint32_t> bodies,
                         Flights& flights,
                         Velocities& velocities)
{
    for (const std::uint32_t body : bodies) {
        if (!flights.lags_of(body)) continue;
        if (context.has(Effect::gravity)) velocities.linear[body] += half_fall(context);
        flights.lags[body] = 0;
    }
}

}  // namespace throng
