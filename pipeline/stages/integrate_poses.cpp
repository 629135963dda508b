// Integrate poses: bodies that touch nothing, and those that move by themselves.
//
// In double throughout: free flight is exact where the integrator is.
#include "kernels/dynamics/flight.hpp"
#include "kernels/dynamics/free_rotation.hpp"
#include "kernels/dynamics/stiff_flight.hpp"
#include "kernels/math/rotation.hpp"
#include "kernels/parallel/blocks.hpp"
#include "pipeline/forces/rigid_law.hpp"
#include "pipeline/forces/state_dependent_forces.hpp"
#include "pipeline/forces/velocity_lag.hpp"
#include "pipeline/step/stages.hpp"

#include <algorithm>

namespace throng {

namespace {

constexpr std::size_t kGrain = 1024;  // bodies a block: some 20 microseconds of work

FlightRule rule_of(const StepContext& context)
{
    FlightRule rule;
    rule.substep = context.substep();
    rule.substeps = context.substeps;
    for (int axis = 0; axis < 3; ++axis)
        rule.gravity[axis] = context.has(Effect::gravity) ? context.gravity[axis] : 0;
    rule.turns = context.has(Effect::rotation);
    using Precession = FlightRule::Precession;
    if (context.has(Effect::gyroscopic) && context.gyroscopic == Gyroscopic::implicit)
        rule.precession =
            context.integrator == Integrator::auto_ ? Precession::split : Precession::implicit;
    return rule;
}

FlightArrays arrays_of(const Masses& masses, Poses& poses, Velocities& velocities)
{
    if (poses.position.empty()) return {};
    return {poses.position[0].data(),     poses.orientation[0].coeffs().data(),
            velocities.linear[0].data(),  velocities.angular[0].data(),
            &masses.inertia[0].xx,        masses.inverse_mass.data(),
            masses.gyroscopic_kind.data()};
}

// A body turned through the step by what its angular momentum does, in as many parts as it takes.
// False where that are too many: it is left as it was.
bool turn_in_parts(const FlightRule& rule,
                   const PrincipalInertia& principal,
                   Quat& orientation,
                   Vec3& angular)
{
    constexpr int kMostParts = 256;  // some 20 microseconds
    const FreeRotation rotation = free_rotation(principal.moments);
    const double span = rule.substep * rule.substeps;
    const Vec3 spin = principal.axes.transpose() * (orientation.conjugate() * angular);
    Vec3 momentum = principal.moments.cwiseProduct(spin);
    const int parts = parts_of(rotation, momentum.norm(), span, kMostParts);
    if (parts == 0) return false;
    turn_freely(rotation, span, std::max(parts, rule.substeps), momentum, [&](const Vec3& turn) {
        orientation = orientation * exponential(Vec3(principal.axes * turn));
    });
    orientation.coeffs() /= std::sqrt(orientation.squaredNorm());
    angular = orientation * Vec3(principal.axes * momentum.cwiseQuotient(principal.moments));
    return true;
}

// The same by as many substeps.
void turn_by_steps(const StepContext& context,
                   const Masses& masses,
                   std::uint32_t body,
                   Quat& orientation,
                   Vec3& angular)
{
    // In body axes: about them the angular velocity stays as it is while the body turns by it.
    const bool precesses = context.has(Effect::gyroscopic) && masses.gyroscopic_kind[body] != 0;
    const auto torque = context.gyroscopic == Gyroscopic::implicit
        ? after_gyroscopic_torque_local
        : after_explicit_gyroscopic_torque_local;
    Vec3 w = orientation.conjugate() * angular;
    for (int step = 0; step < context.substeps; ++step) {
        if (precesses) w = torque(w, masses.inertia[body], context.substep());
        orientation = orientation * exponential(context.substep() * w);
    }
    orientation.coeffs() /= std::sqrt(orientation.squaredNorm());
    if (precesses) angular = orientation * w;
}

// What the wide kernel leaves: any inertia, any speed. False, and the body as it was, where it
// would become what a step cannot hold.
bool fly_one(const StepContext& context,
             const FlightRule& rule,
             const Masses& masses,
             std::uint32_t body,
             Poses& poses,
             Velocities& velocities)
{
    const double h = context.substep(), n = context.substeps;
    const bool falls = context.has(Effect::gravity) && masses.inverse_mass[body] > 0;
    const Vec3 pull = falls ? context.gravity : Vec3(Vec3::Zero());
    const Vec3 linear = velocities.linear[body] + pull * (n * h);
    const Vec3 position = poses.position[body] + velocities.linear[body] * (n * h)
        + pull * (h * h * (n * (n + 1) / 2));
    Quat orientation = poses.orientation[body];
    Vec3 angular = velocities.angular[body];
    if (context.has(Effect::rotation)) {
        const bool split =
            rule.precession == FlightRule::Precession::split && masses.gyroscopic_kind[body] != 0;
        if (!split || !turn_in_parts(rule, masses.principal_of(body), orientation, angular))
            turn_by_steps(context, masses, body, orientation, angular);
    }
    return give_motion({position, orientation, linear, angular}, body, poses, velocities);
}

// Bodies on whom nothing but gravity acts: by the wide kernel, and one by one what that leaves.
void fly_freely(const StepContext& context,
                const Masses& masses,
                const BodyStates& states,
                const std::vector<std::uint32_t>& bodies,
                Poses& poses,
                Velocities& velocities,
                StepDiagnostics& diagnostics)
{
    const FlightRule rule = rule_of(context);
    const FlightArrays arrays = arrays_of(masses, poses, velocities);
    const FlyKernel kernel = fly_kernel();
    const bool wide =
        !context.has(Effect::gyroscopic) || rule.precession != FlightRule::Precession::none;
    diagnostics.scratch.of_block.start(block_count(bodies.size(), kGrain));
    for_each_block(bodies.size(), kGrain, [&](auto begin, auto end, auto block) {
        std::array<std::uint32_t, kGrain> chosen, left;
        std::size_t count = 0;
        for (std::size_t i = begin; i < end; ++i)
            if (states.moves(bodies[i])) chosen[count++] = bodies[i];
        if (wide) count = kernel(rule, arrays, chosen.data(), count, left.data());
        auto& lost = diagnostics.scratch.of_block[block];
        for (std::size_t i = 0; i < count; ++i)
            if (!fly_one(context, rule, masses, wide ? left[i] : chosen[i], poses, velocities))
                lost.push_back(wide ? left[i] : chosen[i]);
    });
    diagnostics.scratch.of_block.append_to(diagnostics.quarantined);
}

// Bodies by the law of rigid motion: any integrator, any rotation, any forces.
class LawFlight {
public:
    LawFlight(const StepContext& context,
              const RigidFacts& facts,
              Poses& poses,
              Velocities& velocities,
              Flights& flights)
        : context_(context), rule_(rigid_rule(context)), facts_(facts), poses_(poses),
          velocities_(velocities), flights_(flights)
    { }

    /// Each body for itself, but for those that springs join: they go together.
    ///
    ///   bodies  ascending
    void fly(const std::vector<std::uint32_t>& bodies,
             const BodyStates& states,
             StepDiagnostics& diagnostics)
    {
        flights_.memory.resize(states.kind.size());
        catch_up_velocities(context_, bodies, flights_, velocities_);
        // The outcome is written down when all have read.
        std::vector<std::vector<Landing>> landings(block_count(bodies.size(), kBodies));
        for_each_block(bodies.size(), kBodies, [&](auto begin, auto end, auto block) {
            RigidMotion law(rule_, facts_);
            for (std::size_t i = begin; i < end; ++i)
                if (states.moves(bodies[i])) carry_from(bodies[i], states, law, landings[block]);
        });
        for (const auto& list : landings)
            for (const Landing& landing : list)
                if (!land(landing)) diagnostics.quarantined.push_back(landing.body);
        std::sort(diagnostics.quarantined.begin(), diagnostics.quarantined.end());
    }

private:
    static constexpr std::size_t kBodies = 64;  // a block: some 20 microseconds of work
    struct Landing {
        std::uint32_t body = 0;
        RigidMotion::Outcome outcome;
    };

    // A body, and with the first of a group all that springs join to it.
    void carry_from(std::uint32_t body,
                    const BodyStates& states,
                    RigidMotion& law,
                    std::vector<Landing>& landings)
    {
        const Forces& forces = facts_.forces;
        const std::uint32_t group = body < forces.group_of.size() ? forces.group_of[body] : kNoBody;
        if (group == kNoBody) {
            carry(law, {&body, 1}, landings);
            return;
        }
        // Of a group of which one touches something nobody is here.
        std::vector<std::uint32_t> flying;
        for (const std::uint32_t member : forces.groups[group])
            if (states.movable(member)) flying.push_back(member);
        if (flying.front() == body) carry_joined(law, flying, landings);
    }

    void
    carry(RigidMotion& law, std::span<const std::uint32_t> bodies, std::vector<Landing>& landings)
    {
        const double span = context_.substep();
        law.take(bodies, flights_);
        // Of a group on whom springs act there is no other.
        const IntegratorRow& integrator =
            integrator_of(context_, facts_.forces.act_on(bodies.front()));
        IntegratorScratch scratch;
        for (int step = 0; step < context_.substeps; ++step) {
            law.advance(integrator, step * span, span, scratch);
            law.settle();
        }
        note(law, bodies, landings);
    }

    // Who springs join, by the rule that such springs ask for.
    void carry_joined(RigidMotion& law,
                      std::span<const std::uint32_t> bodies,
                      std::vector<Landing>& landings)
    {
        if (by_stiff_springs(context_, facts_, bodies))
            carry_stiff(bodies, landings);
        else
            carry(law, bodies, landings);
    }

    void carry_stiff(std::span<const std::uint32_t> bodies, std::vector<Landing>& landings)
    {
        const double span = context_.substep();
        StiffFlight flight(rule_, facts_, bodies, flights_);
        for (int step = 0; step < context_.substeps; ++step) flight.carry(step * span, span);
        note(flight.law(), bodies, landings);
    }

    void note(const RigidMotion& law,
              std::span<const std::uint32_t> bodies,
              std::vector<Landing>& landings)
    {
        const std::size_t first = landings.size();
        for (std::size_t i = 0; i < bodies.size(); ++i)
            landings.push_back({bodies[i], law.outcome(i)});
        // One that is lost takes none along that a spring joins to it.
        const auto lost = [](const Landing& landing) { return !holdable(landing.outcome); };
        if (bodies.size() == 1
            || std::none_of(landings.begin() + static_cast<std::ptrdiff_t>(first), landings.end(),
                            lost))
            return;
        landings.resize(first);
        RigidMotion alone(rule_, facts_);
        for (const std::uint32_t body : bodies) carry(alone, {&body, 1}, landings);
    }

    // False, and the body as it was, where it would become what a step cannot hold.
    bool land(const Landing& landing)
    {
        if (!give_motion(landing.outcome, landing.body, poses_, velocities_)) return false;
        flights_.memory[landing.body] = landing.outcome.memory;
        return true;
    }

    const StepContext& context_;
    RigidRule rule_;
    RigidFacts facts_;
    Poses& poses_;
    Velocities& velocities_;
    Flights& flights_;
};

// Whether the wide kernel, and what it leaves to fly_one(), is the law that is asked for where
// nothing but gravity acts.
bool falls_wide(const StepContext& context)
{
    return falls_by_kicks(context.integrator) && context.rotation == Rotation::quaternion;
}

}  // namespace

void integrate_poses(const StepContext& context,
                     const Islands& islands,
                     const Masses& masses,
                     const BodyStates& states,
                     const Forces& forces,
                     Flights& flights,
                     Poses& poses,
                     Velocities& velocities,
                     StepDiagnostics& diagnostics)
{
    // Without contact there are no islands: every awake body flies.
    const bool alone = !context.has(Effect::contact) && !context.effects.meets(kEventDriven);
    if (alone) diagnostics.quarantined.clear();

    const auto fly = [&](const std::vector<std::uint32_t>& bodies) {
        lag_as_kicked(context, bodies, flights, velocities);
        fly_freely(context, masses, states, bodies, poses, velocities, diagnostics);
    };
    const auto& free = alone ? states.active_bodies.dynamic : islands.lone;
    const auto by_law = [&](const std::vector<std::uint32_t>& bodies) {
        LawFlight(context, {forces, masses, poses, velocities}, poses, velocities, flights)
            .fly(bodies, states, diagnostics);
    };
    if (!falls_wide(context)) {
        by_law(free);
    } else if (!context.effects.meets(kForces)) {
        fly(free);
    } else {
        std::vector<std::uint32_t> falling, acted_on;
        for (const std::uint32_t body : free)
            (forces.act_on(body) ? acted_on : falling).push_back(body);
        fly(falling);
        by_law(acted_on);
    }
    fly(states.active_bodies.kinematic);
}

}  // namespace throng
