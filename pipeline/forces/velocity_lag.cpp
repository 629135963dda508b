#include "pipeline/forces/velocity_lag.hpp"

#include "pipeline/forces/rigid_law.hpp"

#include <algorithm>

namespace throng {

namespace {

// In what contacts leave a velocity behind; none where nothing falls.
Vec3 half_fall(const StepContext& context, int times = 1)
{
    if (!context.has(Effect::gravity)) return Vec3::Zero();
    return 0.5 * context.substep() / times * context.gravity;
}

// From half of one of the usual substeps behind to half of a finer one.
Vec3 between(const StepContext& context, int times)
{
    return half_fall(context) - half_fall(context, times);
}

template <class Real>
void add(Real sign, const Vec3& velocity, SolverBody<Real>& body)
{
    for (int k = 0; k < 3; ++k) body.motion[k] += sign * static_cast<Real>(velocity[k]);
}

// Whether contacts leave the velocity of a body behind: they give half of what depends on its
// state, and of gravity with it, after it moved.
bool lags_in_contact(const StepContext& context, const Forces& forces, std::uint32_t body)
{
    return context.response == Response::penalty || !forces.depends_on_state(body);
}

// Whether a body flies by what leaves velocities of the moment, and contacts do not.
bool differs(const StepContext& context, const Forces& forces, std::uint32_t body)
{
    const bool acted_on = forces.act_on(body);
    if (falls_by_kicks(context.integrator)
        && !(acted_on && context.integrator == Integrator::auto_))
        return false;
    return lags_in_contact(context, forces, body);
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
                    const Layout& layout,
                    Flights& flights,
                    Velocities& velocities)
{
    if (!anybody_differs(context)) return;
    flights.lags.resize(masses.mass.size());
    const auto lag = [&](std::uint32_t body) {
        if (flights.lags[body] != 0 || !(masses.inverse_mass[body] > 0)
            || !differs(context, forces, body))
            return;
        if (has_flown(flights, body)) velocities.linear[body] -= half_fall(context);
        flights.lags[body] = 1;
    };
    // By kicks who is acted on alone.
    const bool all = !falls_by_kicks(context.integrator);
    for (const Batch& batch : layout.batches)
        if (all || batch.calls.effects.meets(kForces))
            std::ranges::for_each(layout.bodies_of(batch), lag);
}

template <class Real>
void lag_by_finer(const StepContext& context,
                  const Forces& forces,
                  const SolvedBodies& solve,
                  const Flights& flights,
                  std::span<SolverBody<Real>> solver)
{
    for (std::size_t i = 0; i < solve.bodies.size(); ++i)
        if (solve.pressed[i] == 0 && flights.lags_of(solve.bodies[i]) <= 1
            && solver[i].inertia[0] > 0 && lags_in_contact(context, forces, solve.bodies[i]))
            add(Real(1), between(context, solve.times), solver[i]);
}

template <class Real>
void lag_by_usual(const StepContext& context,
                  const Forces& forces,
                  const SolvedBodies& solve,
                  Flights& flights,
                  std::span<SolverBody<Real>> solver)
{
    for (std::size_t i = 0; i < solve.bodies.size(); ++i) {
        const std::uint32_t body = solve.bodies[i];
        const int behind = solve.times > 1 ? solve.times : flights.lags_of(body);
        // Who can only turn does not fall.
        const bool falls = solver[i].inertia[0] > 0;
        if (behind <= 1 || !falls || !lags_in_contact(context, forces, body)) continue;
        if (solve.pressed[i] == 0) add(Real(-1), between(context, behind), solver[i]);
        flights.lags[body] = static_cast<std::uint8_t>(solve.pressed[i] != 0 ? solve.times : 1);
    }
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template void lag_by_finer<Real>(const StepContext&, const Forces&, const SolvedBodies&,       \
                                     const Flights&, std::span<SolverBody<Real>>);                 \
    template void lag_by_usual<Real>(const StepContext&, const Forces&, const SolvedBodies&,       \
                                     Flights&, std::span<SolverBody<Real>>);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

void lag_as_kicked(const StepContext& context,
                   std::span<const std::uint32_t> bodies,
                   Flights& flights,
                   Velocities& velocities)
{
    if (flights.lags.empty()) return;
    for (const std::uint32_t body : bodies) {
        const std::uint8_t times = flights.lags_of(body);
        if (times > 1) velocities.linear[body] -= between(context, times);
        if (times > 0) flights.lags[body] = 0;
    }
}

void catch_up_velocities(const StepContext& context,
                         std::span<const std::uint32_t> bodies,
                         Flights& flights,
                         Velocities& velocities)
{
    for (const std::uint32_t body : bodies) {
        const std::uint8_t times = flights.lags_of(body);
        if (times == 0) continue;
        velocities.linear[body] += half_fall(context, times);
        flights.lags[body] = 0;
    }
}

}  // namespace throng
