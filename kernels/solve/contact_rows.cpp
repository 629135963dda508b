#include "kernels/solve/contact_rows.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

template <class Real>
Mat3T<Real> inverse_inertia(const SolverBody<Real>& body)
{
    const Real* i = body.inertia;
    Mat3T<Real> m;
    m << i[1], i[4], i[5], i[4], i[2], i[6], i[5], i[6], i[3];
    return m;
}

template <class Real>
void set3(Lane16<Real> (&to)[3], std::size_t lane, const Vec3T<Real>& v)
{
    for (int k = 0; k < 3; ++k) to[k].at[lane] = v[k];
}

template <class Real>
Real inverse_or_zero(Real x)
{
    return x > 0 ? 1 / x : Real(0);
}

// Any direction across the normal; which one does not matter, friction is a round cone.
template <class Real>
Vec3T<Real> across(const Vec3T<Real>& normal)
{
    const Vec3T<Real> axis =
        std::abs(normal.x()) < Real(0.6) ? Vec3T<Real>::UnitX() : Vec3T<Real>::UnitY();
    return normal.cross(axis).normalized();
}

// What two bodies oppose to an impulse pair along p and felt along q, at their arms.
template <class Real>
struct Response {
    Real inverse_mass;
    Mat3T<Real> inertia_a, inertia_b;
    Vec3T<Real> arm_a, arm_b;

    Real operator()(const Vec3T<Real>& p, const Vec3T<Real>& q) const
    {
        const Real linear = inverse_mass * p.dot(q);
        const Real turn_a = (inertia_a * arm_a.cross(p)).dot(arm_a.cross(q));
        const Real turn_b = (inertia_b * arm_b.cross(p)).dot(arm_b.cross(q));
        return linear + turn_a + turn_b;
    }
};

// The effective mass of a point along the normal. Where neither body can be moved, only turned, a
// point next to below the center has no lever to speak of: pushed there, a body would spin without
// end and part by nothing.
template <class Real>
Real normal_mass(const Response<Real>& response, const Vec3T<Real>& normal)
{
    const Real answer = response(normal, normal);
    if (response.inverse_mass == 0) {
        constexpr Real kLever = Real(1e-2);  // of the arm
        const Real most = response.inertia_a.trace() * response.arm_a.squaredNorm()
            + response.inertia_b.trace() * response.arm_b.squaredNorm();
        if (answer <= kLever * kLever * most) return 0;
    }
    return inverse_or_zero(answer);
}

template <class Real>
void fill_friction(ContactBlock<Real>& block,
                   std::size_t lane,
                   const Contact<Real>& contact,
                   const Response<Real>& response,
                   const Vec3T<Real>& tangent)
{
    const Vec3T<Real> other = contact.normal.cross(tangent);
    // In units of its own size: squares of 1/kg leave float where bodies are huge or tiny.
    Real k11 = response(tangent, tangent), k22 = response(other, other);
    const Real size = (k11 + k22) / 2, unit = inverse_or_zero(size);
    k11 *= unit, k22 *= unit;
    const Real k12 = response(tangent, other) * unit;
    const Real inverse = inverse_or_zero(k11 * k22 - k12 * k12) * unit;
    block.friction_mass[0].at[lane] = k22 * inverse;
    block.friction_mass[1].at[lane] = k11 * inverse;
    block.friction_mass[2].at[lane] = -k12 * inverse;
    const Real half = (k11 - k22) / 2;
    const Real greatest = 1 + std::sqrt(half * half + k12 * k12);
    block.sliding_mass.at[lane] = unit / greatest;
    block.sliding_answer.at[lane] = size * greatest;

    const Mat3T<Real> turning = response.inertia_a + response.inertia_b;
    block.twist_mass.at[lane] = inverse_or_zero(contact.normal.dot(turning * contact.normal));
    // The trace is at least the greatest eigenvalue: one number that never overshoots.
    block.rolling_mass.at[lane] = inverse_or_zero(turning.trace());
    block.friction_impulse[0].at[lane] = contact.friction.dot(tangent);
    block.friction_impulse[1].at[lane] = contact.friction.dot(other);
    block.twist_impulse.at[lane] = contact.twist;
    set3(block.rolling_impulse, lane, contact.rolling);
}

template <class Real>
Vec3T<Real> velocity_at(const SolverBody<Real>& body, const Vec3T<Real>& arm)
{
    const Vec3T<Real> v(body.motion[0], body.motion[1], body.motion[2]);
    const Vec3T<Real> w(body.motion[4], body.motion[5], body.motion[6]);
    return v + w.cross(arm);
}

}  // namespace

template <class Real>
Softness<Real> softness(double rate, double damping_ratio, double substep)
{
    const double omega = 2 * 3.14159265358979323846 * rate;
    const double a1 = 2 * damping_ratio + substep * omega;
    const double a2 = substep * omega * a1;
    const double a3 = 1 / (1 + a2);
    return {static_cast<Real>(omega / a1), static_cast<Real>(a3)};
}

template <class Real>
void fill_lane(ContactBlock<Real>& block,
               int lane_at,
               const Contact<Real>& contact,
               const SolverBody<Real>& a,
               const SolverBody<Real>& b,
               const ContactTerms<Real>& terms)
{
    const auto lane = static_cast<std::size_t>(lane_at);
    const Vec3T<Real> normal = contact.normal;
    const Vec3T<Real> tangent = across(normal);
    set3(block.normal, lane, normal);
    set3(block.tangent, lane, tangent);
    block.round_a.at[lane] = contact.round_a;
    block.round_b.at[lane] = contact.round_b;
    block.friction.at[lane] = terms.friction;
    block.restitution.at[lane] = terms.restitution;
    block.rolling.at[lane] = terms.rolling_friction;
    block.bias_rate.at[lane] = terms.softness.bias_rate;
    block.impulse_scale.at[lane] = terms.softness.impulse_scale;
    block.inverse_deep.at[lane] = inverse_or_zero(terms.deep);

    Response<Real> response{a.inertia[0] + b.inertia[0], inverse_inertia(a), inverse_inertia(b),
                            Vec3T<Real>::Zero(), Vec3T<Real>::Zero()};
    Vec3T<Real> center_a = Vec3T<Real>::Zero(), center_b = Vec3T<Real>::Zero();
    for (int k = 0; k < contact.count; ++k) {
        const auto& from = contact.points[static_cast<std::size_t>(k)];
        PointRows<Real>& point = block.point[k];
        response.arm_a = from.from_a;
        response.arm_b = from.from_b;
        set3(point.from_a, lane, from.from_a);
        set3(point.from_b, lane, from.from_b);
        point.gap.at[lane] = from.separation - normal.dot(from.from_b - from.from_a)
            - (contact.round_a + contact.round_b);
        point.mass.at[lane] = normal_mass(response, normal);
        point.impulse.at[lane] = from.impulse;
        point.greatest.at[lane] = 0;
        point.approach.at[lane] =
            normal.dot(velocity_at(b, from.from_b) - velocity_at(a, from.from_a));
        center_a += from.from_a;
        center_b += from.from_b;
    }
    const Real share = Real(1) / static_cast<Real>(contact.count);
    center_a *= share;
    center_b *= share;
    for (int k = 0; k < contact.count; ++k)
        block.reach[k].at[lane] =
            (contact.points[static_cast<std::size_t>(k)].from_a - center_a).norm();
    set3(block.center_a, lane, center_a);
    set3(block.center_b, lane, center_b);
    response.arm_a = center_a;
    response.arm_b = center_b;
    fill_friction(block, lane, contact, response, tangent);

    // Points that this lane has not got, in a block whose other lanes have.
    for (int k = contact.count; k < block.points; ++k) {
        PointRows<Real>& point = block.point[k];
        set3(point.from_a, lane, Vec3T<Real>(Vec3T<Real>::Zero()));
        set3(point.from_b, lane, Vec3T<Real>(Vec3T<Real>::Zero()));
        point.gap.at[lane] = 0;
        point.mass.at[lane] = 0;
        point.impulse.at[lane] = 0;
        point.greatest.at[lane] = 0;
        point.approach.at[lane] = 0;
        block.reach[k].at[lane] = 0;
    }
}

template <class Real>
void clear_lane(ContactBlock<Real>& block, int lane_at, std::int32_t still)
{
    const auto lane = static_cast<std::size_t>(lane_at);
    block.a[lane] = block.b[lane] = still;
    SolverBody<Real> nobody = {};
    nobody.drift[7] = 1;
    Contact<Real> nothing;
    nothing.count = 1;
    nothing.points[0].from_a = nothing.points[0].from_b = Vec3T<Real>::Zero();
    fill_lane(block, lane_at, nothing, nobody, nobody, {});
}

template <class Real>
void store_impulses(const ContactBlock<Real>& block, int lane_at, Contact<Real>& contact)
{
    const auto lane = static_cast<std::size_t>(lane_at);
    for (int k = 0; k < contact.count; ++k)
        contact.points[static_cast<std::size_t>(k)].impulse = block.point[k].impulse.at[lane];
    const Vec3T<Real> tangent(block.tangent[0].at[lane], block.tangent[1].at[lane],
                              block.tangent[2].at[lane]);
    contact.friction = tangent * block.friction_impulse[0].at[lane]
        + contact.normal.cross(tangent) * block.friction_impulse[1].at[lane];
    contact.twist = block.twist_impulse.at[lane];
    contact.rolling =
        Vec3T<Real>(block.rolling_impulse[0].at[lane], block.rolling_impulse[1].at[lane],
                    block.rolling_impulse[2].at[lane]);
}

template <class Real>
void carry_impulses(const Contact<Real>& before, Real friction, Real scale, Contact<Real>& contact)
{
    Real total = 0;
    bool taken[4] = {};
    for (int k = 0; k < contact.count; ++k) {
        auto& point = contact.points[static_cast<std::size_t>(k)];
        for (int old = 0; old < before.count; ++old) {
            const auto& from = before.points[static_cast<std::size_t>(old)];
            if (taken[old] || from.feature != point.feature) continue;
            taken[old] = true;
            point.impulse = from.impulse * scale;
            total += point.impulse;
            break;
        }
    }
    if (total <= 0) return;
    // Friction lives in the tangent plane and within the cone of the impulses that were kept.
    const Vec3T<Real> flat =
        scale * (before.friction - contact.normal * contact.normal.dot(before.friction));
    const Real length = flat.norm();
    const Real most = friction * total;
    contact.friction = length > most ? Vec3T<Real>(flat * (most / length)) : flat;
    // A single point holds no twist, and would never let go of one.
    if (contact.count > 1) contact.twist = before.twist * scale;
    contact.rolling = before.rolling * scale;
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template Softness<Real> softness<Real>(double, double, double);                                \
    template void fill_lane<Real>(ContactBlock<Real>&, int, const Contact<Real>&,                  \
                                  const SolverBody<Real>&, const SolverBody<Real>&,                \
                                  const ContactTerms<Real>&);                                      \
    template void clear_lane<Real>(ContactBlock<Real>&, int, std::int32_t);                        \
    template void store_impulses<Real>(const ContactBlock<Real>&, int, Contact<Real>&);            \
    template void carry_impulses<Real>(const Contact<Real>&, Real, Real, Contact<Real>&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
