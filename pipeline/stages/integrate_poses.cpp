// Integrate poses: bodies that touch nothing, and those that move by themselves.
//
// In double throughout: free flight is exact where the integrator is.
#include "kernels/math/rotation.hpp"
#include "kernels/parallel/blocks.hpp"
#include "pipeline/stages.hpp"

namespace throng {

namespace {

constexpr std::size_t kGrain = 256;  // bodies a block: some 50 microseconds of work

struct Flight {
    Pose pose;
    Vec3 linear, angular;

    bool sound() const
    {
        return holdable(pose.position) && pose.orientation.coeffs().allFinite() && holdable(linear)
            && holdable(angular);
    }
};

void fly(const Conditions& conditions, const Masses& masses, std::uint32_t body, Flight& flight)
{
    const double h = conditions.substep();
    const bool falls = conditions.has(Effect::gravity) && masses.inverse_mass[body] > 0;
    const bool turns = conditions.has(Effect::rotation);
    const bool gyroscopic = conditions.has(Effect::gyroscopic) && masses.spins_unevenly[body] != 0;
    const auto torque = conditions.settings.gyroscopic == Gyroscopic::implicit
        ? after_gyroscopic_torque
        : after_explicit_gyroscopic_torque;
    for (int step = 0; step < conditions.settings.substeps; ++step) {
        if (falls) flight.linear += conditions.gravity * h;
        if (gyroscopic)
            flight.angular =
                torque(flight.angular, masses.inertia[body], flight.pose.orientation, h);
        flight.pose.position += flight.linear * h;
        if (turns) flight.pose.orientation = turned(flight.pose.orientation, flight.angular, h);
    }
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
    const std::size_t count = states.kind.size();
    std::vector<std::uint8_t> lone;
    if (!alone) {
        lone.assign(count, 0);
        for (const std::uint32_t body : islands.lone) lone[body] = 1;
    } else {
        trouble.quarantined.clear();
    }
    trouble.of_block.resize(block_count(count, kGrain));
    for_each_block(count, kGrain, [&](std::size_t begin, std::size_t end, std::size_t block) {
        trouble.of_block[block].clear();
        for (std::size_t i = begin; i < end; ++i) {
            const bool flies = states.kind[i] == BodyKind::kinematic
                || (states.dynamic(i) && (alone || lone[i] != 0));
            if (!flies || !states.moves(i)) continue;
            const auto body = static_cast<std::uint32_t>(i);
            Flight flight{poses.at(i), velocities.linear[i], velocities.angular[i]};
            fly(conditions, masses, body, flight);
            if (!flight.sound()) {
                trouble.of_block[block].push_back(body);
                continue;
            }
            poses.position[i] = flight.pose.position;
            poses.orientation[i] = flight.pose.orientation;
            velocities.linear[i] = flight.linear;
            velocities.angular[i] = flight.angular;
        }
    });
    for (const auto& found : trouble.of_block)
        trouble.quarantined.insert(trouble.quarantined.end(), found.begin(), found.end());
}

}  // namespace throng
