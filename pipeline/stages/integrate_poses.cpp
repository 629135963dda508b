// Integrate poses: bodies that touch nothing, and those that move by themselves.
//
// In double throughout: free flight is exact where the integrator is.
#include "kernels/math/rotation.hpp"
#include "kernels/motion/flight.hpp"
#include "kernels/motion/spring_limit.hpp"
#include "kernels/motion/stiff_springs.hpp"
#include "kernels/parallel/blocks.hpp"
#include "pipeline/stages.hpp"
#include "pipeline/stages/following_forces.hpp"
#include "pipeline/stages/rigid_law.hpp"

#include <algorithm>

namespace throng {

namespace {

constexpr std::size_t kGrain = 1024;  // bodies a block: some 20 microseconds of work

FlightRule rule_of(const Conditions& conditions)
{
    FlightRule rule;
    rule.substep = conditions.substep();
    rule.substeps = conditions.settings.substeps;
    for (int axis = 0; axis < 3; ++axis)
        rule.gravity[axis] = conditions.has(Effect::gravity) ? conditions.gravity[axis] : 0;
    rule.turns = conditions.has(Effect::rotation);
    rule.gyroscopic = conditions.has(Effect::gyroscopic)
        && conditions.settings.gyroscopic == Gyroscopic::implicit;
    return rule;
}

FlightArrays arrays_of(const Masses& masses, Poses& poses, Velocities& velocities)
{
    if (poses.position.empty()) return {};
    return {poses.position[0].data(),    poses.orientation[0].coeffs().data(),
            velocities.linear[0].data(), velocities.angular[0].data(),
            &masses.inertia[0].xx,       masses.inverse_mass.data(),
            masses.spins_unevenly.data()};
}

// What the wide kernel leaves: any inertia, any speed. False, and the body as it was, where it
// would become what a step cannot hold.
bool fly_one(const Conditions& conditions,
             const Masses& masses,
             std::uint32_t body,
             Poses& poses,
             Velocities& velocities)
{
    const double h = conditions.substep(), n = conditions.settings.substeps;
    const bool falls = conditions.has(Effect::gravity) && masses.inverse_mass[body] > 0;
    const Vec3 pull = falls ? conditions.gravity : Vec3(Vec3::Zero());
    const Vec3 linear = velocities.linear[body] + pull * (n * h);
    const Vec3 position = poses.position[body] + velocities.linear[body] * (n * h)
        + pull * (h * h * (n * (n + 1) / 2));
    Quat orientation = poses.orientation[body];
    Vec3 angular = velocities.angular[body];
    if (conditions.has(Effect::rotation)) {
        // In body axes: about them the angular velocity stays as it is while the body turns by it.
        const bool precesses =
            conditions.has(Effect::gyroscopic) && masses.spins_unevenly[body] != 0;
        const auto torque = conditions.settings.gyroscopic == Gyroscopic::implicit
            ? after_gyroscopic_torque_local
            : after_explicit_gyroscopic_torque_local;
        Vec3 w = orientation.conjugate() * angular;
        for (int step = 0; step < conditions.settings.substeps; ++step) {
            if (precesses) w = torque(w, masses.inertia[body], h);
            orientation = orientation * exponential(h * w);
        }
        orientation.coeffs() /= std::sqrt(orientation.squaredNorm());
        if (precesses) angular = orientation * w;
    }
    if (!holdable(position, orientation, linear, angular)) return false;
    poses.position[body] = position;
    poses.orientation[body] = orientation;
    velocities.linear[body] = linear;
    velocities.angular[body] = angular;
    return true;
}

// Bodies by the law of rigid motion: any integrator, any rotation, any forces.
class LawFlight {
public:
    LawFlight(const Conditions& conditions,
              const RigidFacts& facts,
              Poses& poses,
              Velocities& velocities,
              Flights& flights)
        : conditions_(conditions), rule_(rigid_rule(conditions)), facts_(facts),
          integrator_(integrators()[static_cast<std::size_t>(conditions.settings.integrator)]),
          poses_(poses), velocities_(velocities), flights_(flights)
    { }

    /// Each body for itself, but for those that springs join: they go together.
    ///
    ///   bodies  ascending
    void fly(const std::vector<std::uint32_t>& bodies, const BodyStates& states, Trouble& trouble)
    {
        flights_.memory.resize(states.kind.size());
        const Forces& forces = facts_.forces;
        // The outcome is written down when all have read.
        std::vector<std::vector<Landing>> landings(block_count(bodies.size(), kBodies));
        for_each_block(bodies.size(), kBodies, [&](auto begin, auto end, auto block) {
            RigidMotion law(rule_, facts_);
            for (std::size_t i = begin; i < end; ++i) {
                const std::uint32_t body = bodies[i];
                if (!states.moves(body)) continue;
                const std::uint32_t group =
                    body < forces.group_of.size() ? forces.group_of[body] : kNobody;
                if (group == kNobody) {
                    carry(law, {&body, 1}, landings[block]);
                    continue;
                }
                // Of a group of which one touches something nobody is here.
                std::vector<std::uint32_t> flying;
                for (const std::uint32_t member : forces.groups[group])
                    if (states.movable(member)) flying.push_back(member);
                if (flying.front() == body) carry_joined(law, flying, landings[block]);
            }
        });
        for (const auto& list : landings)
            for (const Landing& landing : list)
                if (!land(landing)) trouble.quarantined.push_back(landing.body);
        std::sort(trouble.quarantined.begin(), trouble.quarantined.end());
    }

private:
    static constexpr std::size_t kBodies = 64;  // a block: some 20 microseconds of work
    struct Landing {
        std::uint32_t body = 0;
        RigidMotion::Outcome outcome;
    };

    void
    carry(RigidMotion& law, std::span<const std::uint32_t> bodies, std::vector<Landing>& landings)
    {
        const double span = conditions_.substep();
        law.take(bodies, flights_);
        IntegratorRoom room;
        for (int step = 0; step < conditions_.settings.substeps; ++step) {
            integrator_.advance(law, step * span, span, room, law.state());
            law.settle();
        }
        note(law, bodies, landings);
    }

    // Who springs join, by the rule that such springs ask for.
    void carry_joined(RigidMotion& law,
                      std::span<const std::uint32_t> bodies,
                      std::vector<Landing>& landings)
    {
        if (by_stiff_springs(conditions_, facts_.forces, facts_.masses, bodies))
            carry_stiff(bodies, landings);
        else
            carry(law, bodies, landings);
    }

    // What else acts is taken half before places change and half after it, as springs are.
    void carry_stiff(std::span<const std::uint32_t> bodies, std::vector<Landing>& landings)
    {
        const double span = conditions_.substep();
        RigidMotion law(rule_, facts_);
        law.leave_springs();
        law.take(bodies, flights_);
        StiffSprings springs(facts_.forces, facts_.masses, facts_.poses, facts_.velocities, bodies);
        const auto look = [&] {
            for (std::size_t i = 0; i < bodies.size(); ++i) {
                const RigidMotion::Going going = law.going(i);
                SpringBody& body = springs.bodies()[i];
                body.position = going.position;
                body.turn = going.turn;
                body.velocity = going.velocity;
                body.spin = going.spin;
                body.inverse_inertia = going.inverse_inertia;
            }
        };
        const auto give = [&](std::span<const StiffSprings::Six> change) {
            for (std::size_t i = 0; i < bodies.size(); ++i)
                law.add_speed(i, change[i].linear, change[i].angular);
        };
        for (int step = 0; step < conditions_.settings.substeps; ++step) {
            law.kick(step * span, 0.5 * span, law.state());
            look();
            give(springs.begin(step * span, span));
            law.coast(span, law.state());
            look();
            give(springs.end());
            law.kick((step + 1) * span, 0.5 * span, law.state());
            law.settle();
        }
        note(law, bodies, landings);
    }

    void note(const RigidMotion& law,
              std::span<const std::uint32_t> bodies,
              std::vector<Landing>& landings)
    {
        const std::size_t first = landings.size();
        for (std::size_t i = 0; i < bodies.size(); ++i)
            landings.push_back({bodies[i], law.outcome(i)});
        // One that is lost takes none along that a spring joins to it.
        const auto lost = [](const Landing& landing) { return !sound(landing.outcome); };
        if (bodies.size() == 1
            || std::none_of(landings.begin() + static_cast<std::ptrdiff_t>(first), landings.end(),
                            lost))
            return;
        landings.resize(first);
        RigidMotion alone(rule_, facts_);
        for (const std::uint32_t body : bodies) carry(alone, {&body, 1}, landings);
    }

    // Whether a step can hold it.
    static bool sound(const RigidMotion::Outcome& now)
    {
        return holdable(now.position, now.orientation, now.velocity, now.angular_velocity);
    }

    // False, and the body as it was, where it would become what a step cannot hold.
    bool land(const Landing& landing)
    {
        const RigidMotion::Outcome& now = landing.outcome;
        if (!sound(now)) return false;
        poses_.position[landing.body] = now.position;
        poses_.orientation[landing.body] = now.orientation;
        velocities_.linear[landing.body] = now.velocity;
        velocities_.angular[landing.body] = now.angular_velocity;
        flights_.memory[landing.body] = now.memory;
        return true;
    }

    const Conditions& conditions_;
    RigidRule rule_;
    RigidFacts facts_;
    const IntegratorRow& integrator_;
    Poses& poses_;
    Velocities& velocities_;
    Flights& flights_;
};

// Whether the wide kernel, or what it leaves to fly_one(), is the law that is asked for.
bool falls_alone(const Conditions& conditions)
{
    return conditions.settings.integrator == Integrator::semi_implicit
        && conditions.settings.rotation == Rotation::quaternion
        && !conditions.effects.meets(kForces);
}

}  // namespace

void integrate_poses(const Conditions& conditions,
                     const Islands& islands,
                     const Masses& masses,
                     const BodyStates& states,
                     const Forces& forces,
                     Flights& flights,
                     Poses& poses,
                     Velocities& velocities,
                     Trouble& trouble)
{
    // Without contact there are no islands: every awake body flies.
    const bool alone = !conditions.has(Effect::contact) && !conditions.effects.meets(kCarried);
    if (alone) trouble.quarantined.clear();

    const FlightRule rule = rule_of(conditions);
    const FlightArrays arrays = arrays_of(masses, poses, velocities);
    const FlyKernel kernel = fly_kernel();
    const bool wide = !conditions.has(Effect::gyroscopic) || rule.gyroscopic;
    const auto fly = [&](const std::vector<std::uint32_t>& bodies) {
        trouble.of_block.start(block_count(bodies.size(), kGrain));
        for_each_block(bodies.size(), kGrain, [&](auto begin, auto end, auto block) {
            std::array<std::uint32_t, kGrain> chosen, left;
            std::size_t count = 0;
            for (std::size_t i = begin; i < end; ++i)
                if (states.moves(bodies[i])) chosen[count++] = bodies[i];
            if (wide) count = kernel(rule, arrays, chosen.data(), count, left.data());
            auto& lost = trouble.of_block[block];
            for (std::size_t i = 0; i < count; ++i)
                if (!fly_one(conditions, masses, wide ? left[i] : chosen[i], poses, velocities))
                    lost.push_back(wide ? left[i] : chosen[i]);
        });
        trouble.of_block.append_to(trouble.quarantined);
    };
    const auto& free = alone ? states.movers.dynamic : islands.lone;
    if (falls_alone(conditions))
        fly(free);
    else
        LawFlight(conditions, {forces, masses, poses, velocities}, poses, velocities, flights)
            .fly(free, states, trouble);
    fly(states.movers.kinematic);
}

}  // namespace throng
