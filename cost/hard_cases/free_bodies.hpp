// Free bodies: what the cases of motion without contact are built from.
#pragma once

#include "cost/hard_cases/cases.hpp"
#include "throng/world.hpp"

#include <initializer_list>
#include <span>
#include <string>
#include <vector>

namespace throng {

/// How a case has a body move.
struct MotionChoice {
    Integrator integrator = Integrator::semi_implicit;
    Rotation rotation = Rotation::quaternion;
    double dt = 1e-3;  // s
    int substeps = 1;
};

/// "rk4, rotation_vector"
std::string name_of(Integrator integrator, Rotation rotation);

/// The integrators that have an order, of the error after a fixed time, and the order that the
/// textbook promises.
struct KnownOrder {
    Integrator which;
    int order;
};
inline constexpr KnownOrder kIntegrators[] = {
    {Integrator::semi_implicit, 1}, {Integrator::euler, 1}, {Integrator::midpoint, 2},
    {Integrator::splitting, 2},     {Integrator::rk4, 4},
};
int order_of(Integrator integrator);

/// An empty scene without gravity, in double, at that choice.
Scene motion_scene(const CaseBench& bench, const MotionChoice& choice);

/// Adds a body without a shape that turns about its center; moments about its own axes, kg m2,
/// spin in those axes, rad/s. Its place is its id.
BodyDescription& add_free_body(Scene& scene, double mass, const Vec3& moments, const Vec3& spin);

/// The angle between two orientations, rad.
double angle_between(const Quat& a, const Quat& b);

/// The slope of log(error) over log(step), by least squares over the points whose error is between
/// `least` and `greatest`; not a number where there are fewer than two.
double fitted_order(std::span<const double> steps,
                    std::span<const double> errors,
                    double least,
                    double greatest);

inline constexpr Rotation kExponentialRotations[] = {Rotation::quaternion,
                                                     Rotation::rotation_vector, Rotation::matrix};
}  // namespace throng
