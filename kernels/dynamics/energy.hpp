// Energy: what springs hold, what attractors have given up, and what motion is worth.
#pragma once

#include "kernels/data/bodies.hpp"
#include "kernels/data/forces.hpp"

namespace throng {

/// J that a spring holds; and that attractors have given up for a body, negative, as far as a
/// substep follows them (see attraction.hpp).
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
