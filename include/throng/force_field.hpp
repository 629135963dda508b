// Force field: forces of a program's own, asked for as bodies move.
#pragma once

#include "throng/math.hpp"

#include <functional>

namespace throng {

/// A force at the center of mass, N, and a torque about it, N m; world axes.
struct Wrench {
    Vec3 force = Vec3::Zero();
    Vec3 torque = Vec3::Zero();
};

/// What a force field is asked about.
struct FieldPlace {
    std::uint32_t body = 0;
    double time = 0;                       // s, since the world began
    double mass = 0;                       // kg
    Pose center;                           // of mass, with the body's axes
    Vec3 velocity = Vec3::Zero();          // of the center of mass, m/s
    Vec3 angular_velocity = Vec3::Zero();  // world axes, rad/s
};

/// Called for every dynamic body that is awake, as often as the integrator evaluates forces, from
/// any thread: the answer may depend on the place alone, and calls of its world are refused.
using ForceField = std::function<Wrench(const FieldPlace&)>;

}  // namespace throng
