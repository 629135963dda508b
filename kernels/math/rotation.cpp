#include "kernels/math/rotation.hpp"

#include "kernels/math/gyroscopic_theta.hpp"

#include <algorithm>
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

Vec3 times(const Sym3& m, const Vec3& v)
{
    return {m.xx * v.x() + m.xy * v.y() + m.xz * v.z(), m.xy * v.x() + m.yy * v.y() + m.yz * v.z(),
            m.xz * v.x() + m.yz * v.y() + m.zz * v.z()};
}

// The solution of [a b c] x = right, its columns given: by Cramer's rule.
Vec3 solved(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& right)
{
    const Vec3 bc = b.cross(c);
    return Vec3(bc.dot(right), c.cross(a).dot(right), a.cross(b).dot(right)) / a.dot(bc);
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

Sym3 in_world_axes(const Sym3& local, const Quat& orientation)
{
    // A ball's and a cube's are the same about every axis, and so is that of who never turns.
    const bool even = local.xx == local.yy && local.yy == local.zz && local.xy == 0 && local.xz == 0
        && local.yz == 0;
    if (even) return local;

    const Mat3 r = orientation.toRotationMatrix();
    const Sym3& s = local;
    // Rows of r times s, then what each row of that has in common with rows of r.
    double t[3][3];
    for (int i = 0; i < 3; ++i) {
        t[i][0] = r(i, 0) * s.xx + r(i, 1) * s.xy + r(i, 2) * s.xz;
        t[i][1] = r(i, 0) * s.xy + r(i, 1) * s.yy + r(i, 2) * s.yz;
        t[i][2] = r(i, 0) * s.xz + r(i, 1) * s.yz + r(i, 2) * s.zz;
    }
    const auto at = [&](int i, int k) {
        return t[i][0] * r(k, 0) + t[i][1] * r(k, 1) + t[i][2] * r(k, 2);
    };
    return {at(0, 0), at(1, 1), at(2, 2), at(0, 1), at(0, 2), at(1, 2)};
}

Vec3 after_gyroscopic_torque(const Vec3& angular_velocity,
                             const Sym3& inertia_local,
                             const Quat& orientation,
                             double time)
{
    const Vec3 w = orientation.conjugate() * angular_velocity;
    return orientation * after_gyroscopic_torque_local(w, inertia_local, time);
}

namespace {

// before / after, where before = after + lost. The loss is told apart, and no more of it made up
// for than is left: of the least moments of a needle rounding may leave nothing but the loss.
double gained_back(double before, double after, double lost)
{
    constexpr double kLeast = 1e-300;  // squares of a spin that is none
    return lost > 0 ? (after + std::min(lost, after) + kLeast) / (after + kLeast)
                    : (before + kLeast) / (before - lost + kLeast);
}

}  // namespace

Vec3 after_gyroscopic_torque_local(const Vec3& w, const Sym3& inertia, double time)
{
    const Vec3 momentum = times(inertia, w);
    const Vec3 residual = time * w.cross(momentum);
    const double ahead = time * gyroscopic_theta(time * time * w.squaredNorm());
    // Column k of the matrix is I e + ahead (w x I e - I w x e), with e the unit vector along k.
    const Vec3 x(inertia.xx, inertia.xy, inertia.xz), y(inertia.xy, inertia.yy, inertia.yz),
        z(inertia.xz, inertia.yz, inertia.zz);
    const Vec3 a = x + ahead * (w.cross(x) - Vec3(0, momentum.z(), -momentum.y()));
    const Vec3 b = y + ahead * (w.cross(y) - Vec3(-momentum.z(), 0, momentum.x()));
    const Vec3 c = z + ahead * (w.cross(z) - Vec3(momentum.y(), -momentum.x(), 0));
    const Vec3 change = solved(a, b, c, residual), momentum_change = times(inertia, change);
    const Vec3 after = w - change, momentum_after = momentum - momentum_change;
    const Vec3 both = momentum + momentum_after;
    const double kept = gained_back(momentum.squaredNorm(), momentum_after.squaredNorm(),
                                    momentum_change.dot(both));
    const double allowed =
        gained_back(w.dot(momentum), after.dot(momentum_after), change.dot(both));
    return after * std::sqrt(std::min(kept, allowed));
}

Vec3 after_explicit_gyroscopic_torque(const Vec3& angular_velocity,
                                      const Sym3& inertia_local,
                                      const Quat& orientation,
                                      double time)
{
    const Vec3 w = orientation.conjugate() * angular_velocity;
    return orientation * after_explicit_gyroscopic_torque_local(w, inertia_local, time);
}

Vec3 after_explicit_gyroscopic_torque_local(const Vec3& w, const Sym3& inertia, double time)
{
    const Mat3 columns = inertia.matrix();
    const Vec3 torque = w.cross(times(inertia, w));
    return w - time * solved(columns.col(0), columns.col(1), columns.col(2), torque);
}

}  // namespace throng
