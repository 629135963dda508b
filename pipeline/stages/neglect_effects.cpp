// Neglect effects: gyroscopic torques that hardly turn anybody are left out of this step.
//
// Left to itself a body with principal moments I1, I2, I3 gains angular velocity about axis k at
// (Ii - Ij) / Ik wi wj (Euler's equations), and in all no more than Masses::gyroscopic_rate times
// the square of its spin. Without that for a time T it is off by half of it times T squared, rad,
// or that share of its radius. Each step asks anew: who has come to spin faster has his torque back
// at once. Who is on a pivot keeps it: he is carried by his angular momentum, which saves more.
#include "kernels/parallel/blocks.hpp"
#include "pipeline/step/neglect.hpp"
#include "pipeline/step/stages.hpp"

#include <algorithm>

namespace throng {

namespace {

constexpr std::size_t kBodies = 4096;  // a block

// Who is beyond the error by no more than this by its greatest rate may be below it as it turns.
constexpr double kWorthALook = 8;

// What a body's spin makes of itself, rad/s2.
double gyroscopic_acceleration(const Masses& masses,
                               const Quat& orientation,
                               const Vec3& spin,
                               std::uint32_t body)
{
    const Vec3 w = orientation.conjugate() * spin;
    const Vec3 torque = w.cross(Vec3(masses.inertia[body].matrix() * w));
    return Vec3(masses.inverse_inertia[body].matrix() * torque).norm();
}

}  // namespace

void neglect_effects(const StepContext& context,
                     const NeglectParameters& parameters,
                     const Forces& forces,
                     const BodyStates& states,
                     const Poses& poses,
                     const Velocities& velocities,
                     Masses& masses,
                     NeglectedEffects& neglected)
{
    const std::vector<std::uint32_t>& bodies = states.active_bodies.dynamic;
    std::vector<NeglectedEffects::Share>& of_block = neglected.scratch.of_block;
    of_block.assign(block_count(bodies.size(), kBodies), {});
    for_each_block(bodies.size(), kBodies, [&](auto begin, auto end, auto block) {
        // A byte that is written might be any of what vectors hold: theirs is looked up once.
        const std::uint32_t* const who = bodies.data();
        const std::uint8_t* const kinds = masses.inertia_kind.data();
        const float* const rates = masses.gyroscopic_rate.data();
        const Vec3* const spins = velocities.angular.data();
        std::uint8_t* const wanted = masses.gyroscopic_kind.data();
        const double error = kOfError * parameters.error;
        const bool pivots = context.has(Effect::pivot);
        std::size_t callers = 0;
        double bound = 0;
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t body = who[i];
            if (kinds[body] == 0 || (pivots && forces.on_pivot(body))) continue;
            double off = turned_in_window(double{rates[body]} * spins[body].squaredNorm());
            if (off > error && off < kWorthALook * error)
                off = turned_in_window(
                    gyroscopic_acceleration(masses, poses.orientation[body], spins[body], body));
            const bool neglects = off <= error;
            wanted[body] = neglects ? 0 : kinds[body];
            callers += neglects ? 1 : 0;
            bound = std::max(bound, neglects ? off : 0.0);
        }
        of_block[block] = {callers, bound};
    });
    neglected.gyroscopic = {};
    for (const NeglectedEffects::Share& share : of_block) neglected.gyroscopic.add(share);
}

}  // namespace throng
