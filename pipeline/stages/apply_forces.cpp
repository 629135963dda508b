// Apply forces: what acts besides gravity and contacts and stays as it is through a step, on
// whoever a contact may hold. What follows the bodies is asked within the step: see
// state_dependent_forces.hpp.
#include "kernels/parallel/blocks.hpp"
#include "pipeline/forces/rigid_law.hpp"
#include "pipeline/step/stages.hpp"

namespace throng {

namespace {

constexpr std::size_t kGrain = 64;  // bodies a block

}  // namespace

void apply_forces(const StepContext& context,
                  const Forces& forces,
                  const SleepEvents& sleep_events,
                  const Poses& poses,
                  const Velocities& velocities,
                  const Masses& masses,
                  const BodyStates& states,
                  ExternalAcceleration& accelerations)
{
    if (!context.has(Effect::contact)) return;
    accelerations.linear.resize(states.kind.size());
    accelerations.angular.resize(states.kind.size());
    const RigidRule rule = rigid_rule(context);
    const Flights none;
    std::vector<std::uint32_t> active_bodies = states.active_bodies.dynamic;
    if (context.has(Effect::sleeping))  // who awoke in this step is moved in it
        active_bodies.insert(active_bodies.end(), sleep_events.woke.begin(),
                             sleep_events.woke.end());
    for_each_block(
        active_bodies.size(), kGrain, [&](std::size_t begin, std::size_t end, std::size_t) {
            RigidMotion law(rule, {forces, masses, poses, velocities});
            for (std::size_t i = begin; i < end; ++i) {
                const std::uint32_t body = active_bodies[i];
                accelerations.linear[body] = accelerations.angular[body] = Vec3::Zero();
                if (forces.depends_on_state(body)) continue;
                law.take({&body, 1}, none);
                const RigidMotion::Acceleration pull = law.mean_acceleration(0, context.dt);
                accelerations.linear[body] = pull.linear;
                accelerations.angular[body] = pull.angular;
            }
        });
}

}  // namespace throng
