// Contact lanes: the algebra of W contacts side by side. For sources compiled once a width.
#pragma once

#include "kernels/data/contact_constraints.hpp"
#include "kernels/simd/lane_vectors.hpp"

namespace throng::THRONG_LANES {

template <class L>
L lane(const Lane16<typename L::Number>& of, int at)
{
    return L::load(of.at + at);
}
template <class L>
V3<L> lane3(const Lane16<typename L::Number> (&of)[3], int at)
{
    return {lane<L>(of[0], at), lane<L>(of[1], at), lane<L>(of[2], at)};
}
template <class L>
void store3(const V3<L>& v, Lane16<typename L::Number> (&to)[3], int at)
{
    v.x.store(to[0].at + at);
    v.y.store(to[1].at + at);
    v.z.store(to[2].at + at);
}

/// Eight of the numbers of each of W solver bodies.
template <class L>
void gather_bodies(const typename L::Number* line, const std::int32_t* index, L (&out)[8])
{
    using Real = typename L::Number;
    gather_8(line, int(sizeof(SolverBody<Real>) / sizeof(Real)), index, out);
}

/// How one side of W contacts answers to an impulse.
template <class L, bool turns>
struct Mobility {
    using Real = typename L::Number;
    L inverse_mass;
    L xx, yy, zz, xy, xz, yz;

    Mobility(const SolverBody<Real>* bodies, const std::int32_t* index)
    {
        L i[8];
        gather_bodies(bodies->inertia, index, i);
        inverse_mass = i[0];
        if constexpr (turns) xx = i[1], yy = i[2], zz = i[3], xy = i[4], xz = i[5], yz = i[6];
    }
    V3<L> turned_by(const V3<L>& torque) const
    {
        const auto row = [&](L x, L y, L z) { return dot(x, y, z, torque.x, torque.y, torque.z); };
        return {row(xx, xy, xz), row(xy, yy, yz), row(xz, yz, zz)};
    }
};

/// The velocities of one side of W contacts.
template <class L, bool turns>
struct Motion {
    using Real = typename L::Number;
    V3<L> velocity, spin;

    Motion(const SolverBody<Real>* bodies, const std::int32_t* index)
    {
        L m[8];
        gather_bodies(bodies->motion, index, m);
        velocity = {m[0], m[1], m[2]};
        spin = {m[4], m[5], m[6]};
    }
    void write(SolverBody<Real>* bodies, const std::int32_t* index, unsigned writes) const
    {
        constexpr int kStride = sizeof(SolverBody<Real>) / sizeof(Real);
        const L m[8] = {velocity.x, velocity.y, velocity.z, L(Real(0)),
                        spin.x,     spin.y,     spin.z,     L(Real(0))};
        scatter_8(m, bodies->motion, kStride, index, writes);
    }
    /// As write(), and what bodies would do without contacts changes likewise: these give in the
    /// next substep what they gave in this one.
    void write_free(SolverBody<Real>* bodies, const std::int32_t* index, unsigned writes) const
    {
        Real m[6][L::kWidth];
        velocity.x.store(m[0]), velocity.y.store(m[1]), velocity.z.store(m[2]);
        spin.x.store(m[3]), spin.y.store(m[4]), spin.z.store(m[5]);
        for (int lane = 0; lane < L::kWidth; ++lane) {
            if ((writes >> lane & 1) == 0) continue;
            SolverBody<Real>& body = bodies[index[lane]];
            for (int k = 0; k < (turns ? 6 : 3); ++k) {
                const int to = k < 3 ? k : k + 1;
                body.free[to] += m[k][lane] - body.motion[to];
                body.motion[to] = m[k][lane];
            }
        }
    }
    V3<L> at(const V3<L>& arm) const
    {
        if constexpr (turns) return velocity + cross(spin, arm);
        return velocity;
    }
    void apply(const Mobility<L, turns>& how, const V3<L>& impulse, const V3<L>& torque)
    {
        velocity = mul_add(impulse, how.inverse_mass, velocity);
        if constexpr (turns) spin = spin + how.turned_by(torque);
    }
};

/// How far W bodies have moved and turned since the step began.
template <class L, bool turns>
struct DeltaPose {
    using Real = typename L::Number;
    V3<L> moved, axis;
    L w;

    DeltaPose(const SolverBody<Real>* bodies, const std::int32_t* index)
    {
        L d[8];
        gather_bodies(bodies->delta_pose, index, d);
        moved = {d[0], d[1], d[2]};
        axis = {d[4], d[5], d[6]};
        w = d[7];
    }
    /// By how much an arm has changed that turned along.
    V3<L> change_of(const V3<L>& arm) const
    {
        const V3<L> t = cross(axis, arm);
        const V3<L> twice = t + t;
        return mul_add(twice, w, cross(axis, twice));
    }
    /// By how much a direction, turned back by the drift, differs from itself.
    V3<L> turned_back(const V3<L>& direction) const
    {
        const V3<L> t = cross(axis, direction);
        const V3<L> twice = t + t;
        return mul_add(twice, -w, cross(axis, twice));
    }
};

/// The six numbers of W contacts: what the sides do to each other, or push each other with, at the
/// center, along the normal and the two tangents; linear, then about them.
template <class L>
struct ContactSpaceVector {
    L n, v1, v2;
    L w1, w2, wn;
};

/// The axes and arms of W contacts.
template <class L, bool turns>
struct Frame {
    using Real = typename L::Number;
    V3<L> normal, tangent, other;
    V3<L> center_a, center_b;

    Frame(const ContactConstraintWide<Real>& block, int at)
        : normal(lane3<L>(block.normal, at)), tangent(lane3<L>(block.tangent, at)),
          other(cross(normal, tangent))
    {
        if constexpr (turns) {
            center_a = lane3<L>(block.center_a, at);
            center_b = lane3<L>(block.center_b, at);
        }
    }
    ContactSpaceVector<L> between(const Motion<L, turns>& a, const Motion<L, turns>& b) const
    {
        const V3<L> v = b.at(center_b) - a.at(center_a);
        ContactSpaceVector<L> six{dot(normal, v), dot(tangent, v), dot(other, v), {}, {}, {}};
        if constexpr (turns) {
            const V3<L> w = b.spin - a.spin;
            six.w1 = dot(tangent, w);
            six.w2 = dot(other, w);
            six.wn = dot(normal, w);
        }
        return six;
    }
    /// Gives both sides what they push each other with.
    void apply(const ContactSpaceVector<L>& by,
               const Mobility<L, turns>& how_a,
               const Mobility<L, turns>& how_b,
               Motion<L, turns>& a,
               Motion<L, turns>& b) const
    {
        const V3<L> impulse = mul_add(other, by.v2, mul_add(tangent, by.v1, normal * by.n));
        const V3<L> back = impulse * L(Real(-1));
        if constexpr (turns) {
            const V3<L> torque = mul_add(normal, by.wn, mul_add(other, by.w2, tangent * by.w1));
            a.apply(how_a, back, cross(center_a, back) - torque);
            b.apply(how_b, impulse, cross(center_b, impulse) + torque);
        } else {
            a.apply(how_a, back, {});
            b.apply(how_b, impulse, {});
        }
    }
};

/// Nothing is divided by numbers whose inverse is not one, or than which it has to be greater.
template <class L>
L inverse_or_zero(L x, typename L::Number least)
{
    using Real = typename L::Number;
    return select(x > L(least), L(Real(1)) / x, L(Real(0)));
}
template <class L>
L inverse_or_zero(L x)
{
    using Real = typename L::Number;
    return inverse_or_zero(x, sizeof(Real) == 4 ? Real(1.2e-38) : Real(2.3e-308));
}

/// A direction across the normal that depends on it alone. For a round cone any would do; a pyramid
/// has its sides along and across this one.
template <class L>
V3<L> across(const V3<L>& n)
{
    using Real = typename L::Number;
    const L zero = Real(0);
    const auto flat = max(n.x, -n.x) < L(Real(0.6));
    // normal x (the x axis where the normal leans away from it, else the y axis)
    const V3<L> t = {select(flat, zero, -n.z), select(flat, n.z, zero), select(flat, -n.y, n.x)};
    return t * (L(Real(1)) / sqrt(dot(t, t)));
}

/// What friction needs of a place: the inverse of its 2x2 matrix (11, 22, 12), that matrix'
/// greatest eigenvalue as a speed that an impulse gives, 1/kg, and one over it.
template <class L>
struct FrictionMass {
    L m11, m22, m12, sliding_mass, sliding_inverse_mass;

    /// Of a matrix k, 1/kg.
    static FrictionMass of(L k11, L k22, L k12)
    {
        using Real = typename L::Number;
        // In units of its own size: squares of 1/kg leave float where bodies are huge or tiny.
        // Next to a pivot the size is nothing but rounding, and its inverse times a speed may leave
        // float: nobody is as heavy as that.
        constexpr Real kLeast = sizeof(Real) == 4 ? Real(1e-25) : Real(1e-200);
        const L size = (k11 + k22) * L(Real(0.5)), unit = inverse_or_zero(size, kLeast);
        k11 = k11 * unit;
        k22 = k22 * unit;
        k12 = k12 * unit;
        // Beside a pivot a body gives way in one direction alone: there the determinant is
        // rounding, and the matrix is its own pseudoinverse but for its trace, 2, squared.
        constexpr Real kRounding = sizeof(Real) == 4 ? Real(1e-6) : Real(1e-15);
        const L determinant = k11 * k22 - k12 * k12;
        const L inverse = inverse_or_zero(determinant, kRounding) * unit,
                pseudo = select(determinant > L(kRounding), L(Real(0)), unit * L(Real(0.25)));
        const L half = (k11 - k22) * L(Real(0.5));
        const L greatest = L(Real(1)) + sqrt(half * half + k12 * k12);
        return {k22 * inverse + k11 * pseudo, k11 * inverse + k22 * pseudo,
                k12 * pseudo - k12 * inverse, unit / greatest, size * greatest};
    }
};

/// Places of ContactConstraintWide::inverse_mass.
namespace inverse_mass_entry {
enum Place : int { nn, n1, n2, v11, v12, v22 };  // among the velocities
inline constexpr int kSpin = 6;                  // + 3 * spin (w1, w2, wn) + velocity (n, 1, 2)
enum Spins : int { w11 = 15, w22, wnn, w12, w1n, w2n };
}  // namespace inverse_mass_entry

}  // namespace throng::THRONG_LANES
