// Integrators: how a state is carried through time, whatever its numbers mean.
//
// A state is a plain row of numbers, places first and speeds after them. What they are of, a body,
// two bodies on a spring or anything else, is for the law alone to know; so an integrator is a
// page, and a new one is another row of the table.
#pragma once

#include "throng/settings.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace throng {

/// The law by which a state moves.
///
///   state  [places() + speeds()]
class MotionLaw {
public:
    virtual ~MotionLaw() = default;
    virtual std::size_t places() const = 0;
    virtual std::size_t speeds() const = 0;

    /// How fast places change.  rates: [places()]
    virtual void place_rates(const double* state, double* rates) = 0;
    /// How fast speeds change at a time, s since the step began.  rates: [speeds()]
    virtual void speed_rates(double time, const double* state, double* rates) = 0;

    // The same in parts, for those that take them one after another. Each may be solved as the law
    // likes best: exactly, or implicitly.

    /// What acts from outside changes speeds for a span of time, places held.
    virtual void kick(double time, double span, double* state) = 0;
    /// What speeds do to one another, places held.
    virtual void gyrate(double span, double* state) = 0;
    /// Places and speeds when nothing acts from outside: symmetric in time, and what the law
    /// conserves is kept to rounding.
    virtual void drift(double span, double* state) = 0;
};

/// Room that integrators work in, kept from one call to the next.
using IntegratorScratch = std::vector<double>;

/// A row of the table.
struct IntegratorRow {
    Integrator which;
    std::string_view name;
    int order;  // of the error after a fixed time
    /// rad, that what swerves may turn in a span; infinity where the law itself follows it. Beyond
    /// that an explicit rule makes energy of spins alone, more with every span.
    double furthest_turn;
    /// Carries the state from `time` on for a span, both in s.
    void (*advance)(
        MotionLaw& law, double time, double span, IntegratorScratch& scratch, double* state);
};

/// All integrators, in the order of the enumeration; auto_, which is one or another, is none.
///
/// Source: Hairer, Lubich & Wanner, Geometric Numerical Integration (2006), I.1 and II.5.
std::span<const IntegratorRow> integrators();

/// What carries a body: of auto_, splitting where something acts on it. What only falls is kicked
/// once, as the solver does it, and turns as by splitting: exactly but for its nutation.
///
///   acted_on  something other than gravity acts on the body
const IntegratorRow& chosen(Integrator integrator, bool acted_on);

/// Whether what only falls gets its velocity at once for a whole substep, and then its place.
inline bool falls_by_kicks(Integrator integrator)
{
    return integrator == Integrator::auto_ || integrator == Integrator::semi_implicit;
}

/// Whether springs that a substep is too long for go by a rule that bears any: with the
/// integrators that nobody asks for an order.
inline bool bears_stiff_springs(Integrator integrator) { return falls_by_kicks(integrator); }

/// The longest span, as a share of 1 / (angular frequency), at which an oscillation damped by
/// `ratio` of critical does not grow; 0 where it grows at any. Found by trying: the integrator
/// itself is asked for the matrix of one step.
double stable_span(const IntegratorRow& integrator, double ratio);

}  // namespace throng
