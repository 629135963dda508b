// Parameters: the dials that stages have to do with, each with its own.
#pragma once

#include "throng/effects.hpp"
#include "throng/settings.hpp"

namespace throng {

/// How pairs of convex shapes are asked.
struct NarrowPhaseParameters {
    NarrowPhase method = NarrowPhase::auto_;
    MethodStart start = MethodStart::cached;
    BoundsFilter filter = BoundsFilter::none;

    void set(const Settings& settings)
    {
        method = settings.narrowphase;
        start = settings.method_start;
        filter = settings.bounds_filter;
    }
};

/// How the time of an impact is found.
///
///   tolerance  of the smallest half extent of the two shapes
struct ImpactParameters {
    ToiMethod method = ToiMethod::newton;
    double tolerance = 0;

    void set(const Settings& settings)
    {
        method = settings.toi_method;
        tolerance = settings.toi_tolerance;
    }
};

/// How contacts are solved: see the dials of these names.
struct SolverParameters {
    Solver solver = Solver::soft_step;
    int iterations = 0, relax_iterations = 0;
    int direct_limit = 0;
    double contact_rate = 0, contact_hertz = 0;
    double push_limit = 0;                                // m/s
    double penalty_stiffness = -1, penalty_damping = -1;  // N/m, N s/m
    ImpactLaw impact_law = ImpactLaw::sequential;
    FrictionAt friction_at = FrictionAt::manifold;
    FrictionCone friction_cone = FrictionCone::cone;
    int halvings = 0;

    void set(const Settings& settings)
    {
        solver = settings.solver;
        iterations = settings.iterations;
        relax_iterations = settings.relax_iterations;
        direct_limit = settings.direct_limit;
        contact_rate = settings.contact_rate;
        contact_hertz = settings.contact_hertz;
        push_limit = settings.push_limit;
        penalty_stiffness = settings.penalty_stiffness;
        penalty_damping = settings.penalty_damping;
        impact_law = settings.impact_law;
        friction_at = settings.friction_at;
        friction_cone = settings.friction_cone;
        halvings = settings.halvings;
    }
    /// Whether constraints hold friction at every point or within a pyramid, by kernels of their
    /// own. The direct solver has its own friction, and what is too great for it goes by the usual
    /// one.
    bool friction_at_points_or_pyramid(Set<Effect> effects) const
    {
        const bool asked =
            friction_at == FrictionAt::points || friction_cone == FrictionCone::pyramid;
        return asked && solver != Solver::direct && effects.has(Effect::friction);
    }
};

/// When an island falls asleep: once all of it has been slower for as long. Who rests by itself
/// wakes as what it bears changes by more than that share of it.
struct SleepParameters {
    double speed = 0, time = 0;  // m/s, s
    bool islands = false;        // as a whole
    double rest_force = 0;

    void set(const Settings& settings)
    {
        speed = settings.sleep_speed;
        time = settings.sleep_time;
        islands = settings.sleep;
        rest_force = settings.rest_force;
    }
};

/// What is left out: see neglect_effects().
struct NeglectParameters {
    bool some = false;
    double error = 0;  // of a body's radius, and rad, that the run may be off by

    void set(const Settings& settings)
    {
        some = settings.effects == EffectChoice::auto_;
        error = settings.effects_error;
    }
};

/// Whether bodies rest by themselves. Other responses know no impulses that could wake them.
inline bool rests_by_force(const Settings& settings)
{
    return settings.partial_rest && settings.response == Response::impulse;
}

/// Whether islands whose loads are too much get more than others. The direct solver needs no help,
/// and penalty forces and kinematic pushes go island by island.
inline bool may_escalate(const Settings& settings)
{
    return settings.escalation == Escalation::auto_ && settings.response == Response::impulse
        && settings.solver != Solver::direct;
}

}  // namespace throng
