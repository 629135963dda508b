// Energy: what springs hold, what attractors have given up, and what motion is worth.
#pragma once

#include "kernels/data/bodies.hpp"
#include "kernels/data/forces.hpp"

namespace throng {

/// J that a spring holds, by the poses of bodies; and that attractors have given up for a body,
/// negative, as far as a substep follows them (see attraction.hpp).
double spring_energy(const SpringForce& spring, const Forces& forces, const auto& pose_of)
{
    const auto end = [&](std::uint32_t body, const Vec3& at) {
        if (body == kNoBody) return at;
        return Vec3(pose_of(body) * Vec3(forces.pivot_to_center_of(body) + at));
    };
    const Vec3 drawn = end(spring.b, spring.at_b) - end(spring.a, spring.at_a);
    const double stretch = drawn.norm() - spring.length;
    return 0.5 * spring.stiffness * stretch * stretch;
}
double spring_energy(const SpringForce& spring, const Forces& forces, const Poses& poses);
double attraction_of(const Forces& forces,
                     const Masses& masses,
                     const Poses& poses,
                     std::uint32_t body,
                     double substep);

/// J that the springs of a body hold.
double springs_energy_of(std::uint32_t body, const Forces& forces, const Poses& poses);

/// J of a dynamic body.
double kinetic_energy_of(std::uint32_t body,
                         const Masses& masses,
                         const Poses& poses,
                         const Velocities& velocities);

/// J that the springs hold, and that attractors have given up.
double potential_of(const Forces& forces, const Masses& masses, const Poses& poses, double substep);

}  // namespace throng
