// Body mass: what resists motion, as a step wants it, from a mass and an inertia.
#pragma once

#include "kernels/data/bodies.hpp"

namespace throng {

/// Gives a dynamic body a mass, kg, and an inertia about its center (or its pivot), kg m2, body
/// axes; what is locked has no inverse. `in_double`: the step is.
void give_mass(std::uint32_t body,
               double mass,
               const Sym3& inertia,
               bool lock_position,
               bool lock_rotation,
               bool in_double,
               Masses& masses);
/// Of a body that is not dynamic.
void give_no_mass(std::uint32_t body, Masses& masses);

Sym3 scaled(const Sym3& m, double by);
/// Moments about a point that lies off the center.
Sym3 shifted(const Sym3& inertia, double mass, const Vec3& off);

}  // namespace throng
