#include "kernels/math/rotation.hpp"

#include <cmath>

namespace throng {

namespace {

// Minimax polynomials on [-pi/4, pi/4].
double sin_near_zero(double x)
{
    const double z = x * x;
    const double tail = 8.33333333332248946124e-03
        + z
            * (-1.98412698298579493134e-04
               + z
                   * (2.75573137070700676789e-06
                      + z * (-2.50507602534068634195e-08 + z * 1.58969099521155010221e-10)));
    return x + z * x * (-1.66666666666666324348e-01 + z * tail);
}

double cos_near_zero(double x)
{
    const double z = x * x;
    const double tail = z
        * (4.16666666666666019037e-02
           + z
               * (-1.38888888888741095749e-03
                  + z
                      * (2.48015872894767294178e-05
                         + z
                             * (-2.75573143513906633035e-07
                                + z
                                    * (2.08757232129817482790e-09
                                       - z * 1.13596475577881948265e-11)))));
    const double half = 0.5 * z;
    const double near_one = 1.0 - half;
    return near_one + ((1.0 - near_one) - half + z * tail);
}

Mat3 skew(const Vec3& v)
{
    Mat3 m;
    m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
    return m;
}

}  // namespace

SinCos sin_cos(double angle)
{
    // pi/2 in three parts, the first two with enough zeros at the end that products are exact.
    constexpr double kFirst = 1.57079632673412561417e+00;
    constexpr double kSecond = 6.07710050630396597660e-11;
    constexpr double kThird = 2.02226624879595063154e-21;
    // Further out the parts no longer fit. Whole turns are dropped first, which fmod does without
    // rounding; the answer is then of an angle that is off by its own last bit, and still finite.
    if (!(std::abs(angle) < 1e9)) {
        constexpr double kWholeTurn = 6.28318530717958647692;
        angle = std::fmod(angle, kWholeTurn);
        if (std::isnan(angle)) return {angle, angle};
    }
    const double quarters = std::nearbyint(angle * 0.63661977236758134308);
    const double x = ((angle - quarters * kFirst) - quarters * kSecond) - quarters * kThird;
    const double s = sin_near_zero(x);
    const double c = cos_near_zero(x);
    switch (static_cast<std::int64_t>(quarters) & 3) {
    case 0:
        return {s, c};
    case 1:
        return {c, -s};
    case 2:
        return {-s, -c};
    default:
        return {-c, s};
    }
}

Quat exponential(const Vec3& turn)
{
    const double squared = turn.squaredNorm();
    // Below this the next term of the series is under the last bit.
    if (squared < 1e-16) {
        const Vec3 v = 0.5 * turn;
        return {1.0, v.x(), v.y(), v.z()};
    }
    const double angle = std::sqrt(squared);
    const SinCos half = sin_cos(0.5 * angle);
    const Vec3 v = (half.sin / angle) * turn;
    return {half.cos, v.x(), v.y(), v.z()};
}

Quat turned(const Quat& orientation, const Vec3& angular_velocity, double time)
{
    const Quat result = exponential(time * angular_velocity) * orientation;
    const double length = std::sqrt(result.squaredNorm());
    return Quat(result.coeffs() / length);
}

Mat3 in_world_axes(const Sym3& local, const Quat& orientation)
{
    const Mat3 axes = orientation.toRotationMatrix();
    return axes * local.matrix() * axes.transpose();
}

Vec3 after_gyroscopic_torque(const Vec3& angular_velocity,
                             const Sym3& inertia_local,
                             const Quat& orientation,
                             double time)
{
    const Mat3 inertia = inertia_local.matrix();
    const Vec3 w = orientation.conjugate() * angular_velocity;
    const Vec3 momentum = inertia * w;
    const Vec3 residual = time * w.cross(momentum);
    const Mat3 jacobian = inertia + time * (skew(w) * inertia - skew(momentum));
    Vec3 after = w - jacobian.inverse() * residual;
    // A body that turns by a radian and more in this time may come out of a single step faster.
    const double energy = w.dot(momentum), energy_after = after.dot(inertia * after);
    if (energy_after > energy) after *= std::sqrt(energy / energy_after);
    return orientation * after;
}

Vec3 after_explicit_gyroscopic_torque(const Vec3& angular_velocity,
                                      const Sym3& inertia_local,
                                      const Quat& orientation,
                                      double time)
{
    const Mat3 inertia = inertia_local.matrix();
    const Vec3 w = orientation.conjugate() * angular_velocity;
    return orientation * (w - time * (inertia.inverse() * w.cross(inertia * w)));
}

}  // namespace throng
