#include "pipeline/world/body_mass.hpp"

#include "pipeline/world/grown_list.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>

namespace throng {

namespace {

// Principal moments that differ by more than rounding.
bool uneven(const Sym3& inertia)
{
    const double size = inertia.xx + inertia.yy + inertia.zz;
    const double spread =
        std::max({std::abs(inertia.xx - inertia.yy), std::abs(inertia.yy - inertia.zz),
                  std::abs(inertia.xy), std::abs(inertia.xz), std::abs(inertia.yz)});
    return spread > 1e-9 * size;
}

// The axis about which an inertia is all but symmetric, or zero. What is taken for symmetric has
// its energy off by as much as its moments across differ: by a ten thousandth at most. Those of a
// needle of 1:100, of which rounding leaves the least moment few digits, never differ by more,
// whatever its profile.
Vec3 symmetry_axis_of(const PrincipalInertia& principal)
{
    constexpr double kAlike = 1.0 / 16384;  // the difference, of their sum
    const int axis = principal.axis_of_symmetry();
    if (principal.asymmetry(axis) > kAlike) return Vec3::Zero();
    return principal.axes.col(axis);
}

// See Masses. Of Euler's equations the greatest factor counts; no three products of two components
// of a vector come to more than its square over the root of 3.
float gyroscopic_rate(const Vec3& moments)
{
    double greatest = 0;
    for (int k = 0; k < 3; ++k)
        greatest =
            std::max(greatest, std::abs(moments[(k + 1) % 3] - moments[(k + 2) % 3]) / moments[k]);
    const double rate = greatest / std::sqrt(3.0);
    return std::nextafter(static_cast<float>(rate), std::numeric_limits<float>::infinity());
}

// What an impulse turns. Of a needle, the ease of turning about its length is cut to `most` times
// that of turning across: in world axes the two stand side by side in numbers of one precision, and
// what rounding takes from the greater must not drown the lesser.
Sym3 turning_inverse_mass(const Sym3& inertia, double most)
{
    const Mat3 inverse = inertia.matrix().inverse();
    if (inverse.trace() * inertia.matrix().trace() < most) return Sym3::from(inverse);
    const Eigen::SelfAdjointEigenSolver<Mat3> solver(inertia.matrix());
    const Vec3 moments = solver.eigenvalues();  // ascending
    const Vec3 inverse_mass = moments.cwiseMax(moments[2] / most).cwiseInverse();
    return Sym3::from(solver.eigenvectors() * inverse_mass.asDiagonal()
                      * solver.eigenvectors().transpose());
}

}  // namespace

Sym3 scaled(const Sym3& m, double by)
{
    return {m.xx * by, m.yy * by, m.zz * by, m.xy * by, m.xz * by, m.yz * by};
}

Sym3 shifted(const Sym3& inertia, double mass, const Vec3& off)
{
    const double x = off.x(), y = off.y(), z = off.z();
    return {inertia.xx + mass * (y * y + z * z), inertia.yy + mass * (x * x + z * z),
            inertia.zz + mass * (x * x + y * y), inertia.xy - mass * x * y,
            inertia.xz - mass * x * z,           inertia.yz - mass * y * z};
}

void give_no_mass(std::uint32_t body, Masses& masses)
{
    put(masses.mass, body, 0.0);
    put(masses.inverse_mass, body, 0.0);
    put(masses.inertia, body, Sym3{});
    put(masses.inverse_inertia, body, Sym3{});
    put(masses.inertia_kind, body, std::uint8_t{0});
    put(masses.gyroscopic_kind, body, std::uint8_t{0});
    put(masses.gyroscopic_rate, body, 0.0f);
    put(masses.symmetry_axis, body, Vec3(Vec3::Zero()));
}

void give_mass(std::uint32_t body,
               double mass,
               const Sym3& inertia,
               bool lock_position,
               bool lock_rotation,
               bool in_double,
               Masses& masses)
{
    const Sym3 given = inertia;  // it may be the very place that is written
    give_no_mass(body, masses);
    masses.mass[body] = mass;
    masses.inertia[body] = given;
    if (!lock_position) masses.inverse_mass[body] = 1 / mass;
    if (given.has_products()) put(masses.principal, body, principal_inertia(given));
    if (lock_rotation || given == Sym3{}) return;
    masses.inverse_inertia[body] = turning_inverse_mass(given, in_double ? 1e14 : 1e6);
    if (!uneven(given)) return;
    const PrincipalInertia principal = masses.principal_of(body);
    masses.inertia_kind[body] = masses.gyroscopic_kind[body] = given.has_products() ? 2 : 1;
    masses.gyroscopic_rate[body] = gyroscopic_rate(principal.moments);
    masses.symmetry_axis[body] = symmetry_axis_of(principal);
}

}  // namespace throng
