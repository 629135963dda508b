#include "kernels/dynamics/energy.hpp"

#include "kernels/dynamics/attraction.hpp"
#include "kernels/math/rotation.hpp"

namespace throng {

double spring_energy(const SpringForce& spring, const Forces& forces, const Poses& poses)
{
    return spring_energy(spring, forces, [&](std::uint32_t body) { return poses.at(body); });
}

double attraction_of(const Forces& forces,
                     const Masses& masses,
                     const Poses& poses,
                     std::uint32_t body,
                     double substep)
{
    double energy = 0;
    for (const AttractorForce& attractor : forces.attractors) {
        const Vec3 place = poses.at(body) * forces.pivot_to_center_of(body);
        const double distance = (place - attractor.position).norm();
        if (masses.mass[body] > 0)
            energy -= attraction_energy(attractor, masses.mass[body], distance, substep);
    }
    return energy;
}

double springs_energy_of(std::uint32_t body, const Forces& forces, const Poses& poses)
{
    double energy = 0;
    if (!forces.has_springs(body)) return energy;
    for (std::uint32_t k = forces.first_spring[body]; k < forces.first_spring[body + 1]; ++k)
        energy += spring_energy(forces.springs[forces.spring_of[k]], forces, poses);
    return energy;
}

double kinetic_energy_of(std::uint32_t body,
                         const Masses& masses,
                         const Poses& poses,
                         const Velocities& velocities)
{
    const Vec3& w = velocities.angular[body];
    const Vec3 spin = in_world_axes(masses.inertia[body], poses.orientation[body]).matrix() * w;
    // About a pivot all of the motion is in the spin.
    return 0.5 * (masses.mass[body] * velocities.linear[body].squaredNorm() + w.dot(spin));
}

double potential_of(const Forces& forces, const Masses& masses, const Poses& poses, double substep)
{
    double energy = 0;
    for (const SpringForce& spring : forces.springs) energy += spring_energy(spring, forces, poses);
    for (std::uint32_t body = 0; body < masses.mass.size(); ++body)
        energy += attraction_of(forces, masses, poses, body, substep);
    return energy;
}

}  // namespace throng
