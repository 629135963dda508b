#include "kernels/solver/carried_points.hpp"

namespace throng {

namespace {

// Turned for a time, by a rotation that is exact to the third order and one for any spin.
Vec3 turned_on(const Vec3& arm, const Vec3& spin, double time)
{
    const Vec3 u = spin * (time / 2), across = u.cross(arm);
    return arm + (across + u.cross(across)) * (2 / (1 + u.dot(u)));
}

}  // namespace

double goes_with_b(double round_a, double round_b, bool carried_by_a)
{
    if (round_a > 0 && round_b > 0) return round_a / (round_a + round_b);
    if (round_a > 0 || round_b > 0) return round_b > 0 ? 1 : 0;
    return carried_by_a ? 1 : 0;
}

CarriedSide carried_side(
    const Vec3& moved, const Quat& turned, const DirectBody& body, const Vec3& core, double half)
{
    const Vec3 center = moved + body.velocity * half;
    return {center, center + turned_on(turned * core, body.spin, half) - core,
            inverse_mass_of(body).angular > 0};
}

void carry_arms(const CarriedSide& a, const CarriedSide& b, double share_of_b, DirectPoint& point)
{
    const Vec3 goes = a.material * (1 - share_of_b) + b.material * share_of_b;
    const Vec3 from_a = goes - a.center, from_b = goes - b.center;
    if (from_a.squaredNorm() > range_of(point.arm_a.squaredNorm(), a.turns)) return;
    if (from_b.squaredNorm() > range_of(point.arm_b.squaredNorm(), b.turns)) return;
    point.arm_a += from_a;
    point.arm_b += from_b;
}

}  // namespace throng
