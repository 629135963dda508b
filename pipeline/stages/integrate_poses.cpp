// Integrate poses: bodies that touch nothing, and those that move by themselves.
//
// In double throughout: free flight is exact where the integrator is.
#include "kernels/math/rotation.hpp"
#include "kernels/motion/flight.hpp"
#include "kernels/parallel/blocks.hpp"
#include "pipeline/stages.hpp"

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
    if (!holdable(position) || !orientation.coeffs().allFinite() || !holdable(linear)
        || !holdable(angular))
        return false;
    poses.position[body] = position;
    poses.orientation[body] = orientation;
    velocities.linear[body] = linear;
    velocities.angular[body] = angular;
    return true;
}

}  // namespace

void integrate_poses(const Conditions& conditions,
                     const Islands& islands,
                     const Masses& masses,
                     const BodyStates& states,
                     Poses& poses,
                     Velocities& velocities,
                     Trouble& trouble)
{
    // Without contact there are no islands: every awake body flies.
    const bool alone = !conditions.has(Effect::contact);
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
    fly(alone ? states.movers.dynamic : islands.lone);
    fly(states.movers.kinematic);
}

}  // namespace throng
