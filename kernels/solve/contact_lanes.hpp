// Contact lanes: W contacts side by side as the solver's kernels see them, bodies in registers.
//
// For sources that are compiled once for each instruction set, like lanes.hpp.
#pragma once

#include "kernels/data/rows.hpp"
#include "kernels/math/lanes.hpp"

namespace throng::THRONG_LANES {

template <class L>
struct V3 {
    L x, y, z;
};
template <class L>
V3<L> operator+(const V3<L>& a, const V3<L>& b)
{
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class L>
V3<L> operator-(const V3<L>& a, const V3<L>& b)
{
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class L>
V3<L> operator*(const V3<L>& a, L s)
{
    return {a.x * s, a.y * s, a.z * s};
}
template <class L>
L dot(const V3<L>& a, const V3<L>& b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class L>
V3<L> cross(const V3<L>& a, const V3<L>& b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

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

// One side of W contacts: velocities in registers, with what resists them.
template <class L, bool turns>
struct Side {
    using Real = typename L::Number;
    V3<L> velocity, spin;
    L inverse_mass;
    L xx, yy, zz, xy, xz, yz;

    Side(const SolverBody<Real>* bodies, const std::int32_t* index)
    {
        constexpr int kStride = sizeof(SolverBody<Real>) / sizeof(Real);
        L m[8];
        gather_8(bodies->motion, kStride, index, m);
        velocity = {m[0], m[1], m[2]};
        spin = {m[4], m[5], m[6]};
        L i[8];
        gather_8(bodies->inertia, kStride, index, i);
        inverse_mass = i[0];
        xx = i[1], yy = i[2], zz = i[3], xy = i[4], xz = i[5], yz = i[6];
    }
    void write(SolverBody<Real>* bodies, const std::int32_t* index, unsigned writes) const
    {
        constexpr int kStride = sizeof(SolverBody<Real>) / sizeof(Real);
        const L m[8] = {velocity.x, velocity.y, velocity.z, L(Real(0)),
                        spin.x,     spin.y,     spin.z,     L(Real(0))};
        scatter_8(m, bodies->motion, kStride, index, writes);
    }
    V3<L> at(const V3<L>& arm) const
    {
        if constexpr (turns) return velocity + cross(spin, arm);
        return velocity;
    }
    V3<L> turned_by(const V3<L>& torque) const
    {
        return {xx * torque.x + xy * torque.y + xz * torque.z,
                xy * torque.x + yy * torque.y + yz * torque.z,
                xz * torque.x + yz * torque.y + zz * torque.z};
    }
    void push(const V3<L>& impulse, const V3<L>& arm)
    {
        velocity = velocity + impulse * inverse_mass;
        if constexpr (turns) spin = spin + turned_by(cross(arm, impulse));
    }
    void twist(const V3<L>& impulse)
    {
        if constexpr (turns) spin = spin + turned_by(impulse);
    }
};

// How far W bodies have moved and turned since the step began.
template <class L, bool turns>
struct Drift {
    using Real = typename L::Number;
    V3<L> moved, axis;
    L w;

    Drift(const SolverBody<Real>* bodies, const std::int32_t* index)
    {
        constexpr int kStride = sizeof(SolverBody<Real>) / sizeof(Real);
        L d[8];
        gather_8(bodies->drift, kStride, index, d);
        moved = {d[0], d[1], d[2]};
        axis = {d[4], d[5], d[6]};
        w = d[7];
    }
    V3<L> of(const V3<L>& arm) const
    {
        if constexpr (!turns) return moved + arm;
        const V3<L> t = cross(axis, arm);
        const V3<L> twice = t + t;
        return moved + arm + twice * w + cross(axis, twice);
    }
};

template <class L, bool turns>
struct Contacts {
    using Real = typename L::Number;
    ContactBlock<Real>& block;
    int at;  // first lane
    unsigned writes_a, writes_b;
    Side<L, turns> a, b;
    V3<L> normal;

    Contacts(ContactBlock<Real>& in, int first, const SolverBody<Real>* bodies)
        : block(in), at(first), writes_a(unsigned{in.writes_a} >> first),
          writes_b(unsigned{in.writes_b} >> first), a(bodies, in.a + first),
          b(bodies, in.b + first), normal(lane3<L>(in.normal, first))
    { }
    void write(SolverBody<Real>* bodies) const
    {
        a.write(bodies, block.a + at, writes_a);
        b.write(bodies, block.b + at, writes_b);
    }
    void push(const V3<L>& impulse, const V3<L>& arm_a, const V3<L>& arm_b)
    {
        a.push(impulse * L(Real(-1)), arm_a);
        b.push(impulse, arm_b);
    }
    void twist(const V3<L>& impulse)
    {
        a.twist(impulse * L(Real(-1)));
        b.twist(impulse);
    }
};

}  // namespace throng::THRONG_LANES
