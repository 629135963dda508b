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
                  const Layout& layout,
                  const Forces& forces,
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
    const auto apply = [&](std::span<const std::uint32_t> bodies) {
        const Flights none;
        for_each_block(bodies.size(), kGrain, [&](auto begin, auto end, std::size_t) {
            RigidMotion law(rule, {forces, masses, poses, velocities});
            for (std::size_t i = begin; i < end; ++i) {
                const std::uint32_t body = bodies[i];
                accelerations.linear[body] = accelerations.angular[body] = Vec3::Zero();
                if (forces.depends_on_state(body) || !forces.push(body)) continue;
                law.take({&body, 1}, none);
                const RigidMotion::Acceleration pull = law.mean_acceleration(0, context.dt);
                accelerations.linear[body] = pull.linear;
                accelerations.angular[body] = pull.angular;
            }
        });
    };
    for_each_block(layout.batches.size(), 1, [&](auto begin, auto end, std::size_t) {
        for (std::size_t i = begin; i < end; ++i)
            if (layout.batches[i].calls.effects.meets(kForces))
                apply(layout.bodies_of(layout.batches[i]));
    });
}

}  // namespace throng
