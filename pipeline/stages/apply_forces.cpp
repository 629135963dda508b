// Apply forces: what acts besides gravity and contacts and stays as it is through a step, on
// whoever a contact may hold. What follows the bodies is asked within the step: see
// following_forces.hpp.
#include "kernels/parallel/blocks.hpp"
#include "pipeline/forces/rigid_law.hpp"
#include "pipeline/step/stages.hpp"

namespace throng {

namespace {

constexpr std::size_t kGrain = 64;  // bodies a block

}  // namespace

void apply_forces(const Conditions& conditions,
                  const Forces& forces,
                  const Rest& rest,
                  const Poses& poses,
                  const Velocities& velocities,
                  const Masses& masses,
                  const BodyStates& states,
                  Pulls& pulls)
{
    if (!conditions.has(Effect::contact)) return;
    pulls.linear.resize(states.kind.size());
    pulls.angular.resize(states.kind.size());
    const RigidRule rule = rigid_rule(conditions);
    const Flights none;
    std::vector<std::uint32_t> movers = states.movers.dynamic;
    if (conditions.has(Effect::sleeping))  // who awoke in this step is moved in it
        movers.insert(movers.end(), rest.awoken.begin(), rest.awoken.end());
    for_each_block(movers.size(), kGrain, [&](std::size_t begin, std::size_t end, std::size_t) {
        RigidMotion law(rule, {forces, masses, poses, velocities});
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t body = movers[i];
            pulls.linear[body] = pulls.angular[body] = Vec3::Zero();
            if (forces.follow(body)) continue;
            law.take({&body, 1}, none);
            const RigidMotion::Pull pull = law.pull_over(0, conditions.settings.dt);
            pulls.linear[body] = pull.linear;
            pulls.angular[body] = pull.angular;
        }
    });
}

}  // namespace throng
