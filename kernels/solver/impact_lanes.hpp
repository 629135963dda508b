// Impact lanes: one contact's impact, over the width of the registers.
//
// The points that strike are stopped together, and what stopped them is given once more, as
// restitution has it: they are thrown back along one impulse, by as much as leaves 1 - e2 of the
// energy that it took to stop them behind. So no impact gains energy, whatever moves the two bodies
// by now and however well the points have been stopped, and none loses any where e is 1.
#pragma once

#include "kernels/solver/visit_lanes.hpp"

namespace throng::THRONG_LANES {

// The points of W contacts that strike.
template <class L>
struct Strike {
    L mass[4];     // kg, effective along the normal; 0: does not strike
    L impulse[4];  // N s
    L load = L(typename L::Number(0)), lever = load;  // of all; about the normal, N m s
    unsigned lanes = 0;                               // bit a lane: some point of it strikes
    bool lasts = false;                               // and is not all but at rest
};

// The speed of a point along the normal.
template <class L, bool turns>
L speed_of(const Contacts<L, turns>& c, int k)
{
    if constexpr (turns)
        return c.rel.n + lane<L>(c.points[k].lever[0], c.at) * c.rel.w1
            + lane<L>(c.points[k].lever[1], c.at) * c.rel.w2;
    return c.rel.n;
}

// Whether any lane is below zero.
template <class L>
bool any_below_zero(L x)
{
    typename L::Number at[L::kWidth];
    x.store(at);
    bool any = false;
    for (const auto number : at) any |= number < 0;
    return any;
}

// What gravity adds to the velocity between two in a substep: nothing where both fall.
template <class L, bool turns>
V3<L> fall_between(const Contacts<L, turns>& c,
                   const SolverBody<typename L::Number>* bodies,
                   const Visit<typename L::Number>& visit)
{
    using Real = typename L::Number;
    const L zero = Real(0), one = Real(1);
    const Mobility<L, turns> a(bodies, c.block.a + c.at), b(bodies, c.block.b + c.at);
    const L falls =
        select(b.inverse_mass > zero, one, zero) - select(a.inverse_mass > zero, one, zero);
    return {falls * L(visit.fall[0]), falls * L(visit.fall[1]), falls * L(visit.fall[2])};
}

// Who comes in fast and would touch before the substep ends. From here on the speeds are those in
// the middle of what gravity does in the substep, so that who falls rises again as high.
template <class L, bool turns>
void find_strike(Contacts<L, turns>& c,
                 const RowsView<typename L::Number>& rows,
                 const BounceRows<typename L::Number>& bounce,
                 const Visit<typename L::Number>& visit,
                 Strike<L>& strike)
{
    using Real = typename L::Number;
    const L zero = Real(0);
    const L elastic = lane<L>(bounce.restitution, c.at);
    L fastest = zero;
    for (int k = 0; k < c.block.points; ++k) fastest = min(fastest, speed_of(c, k));
    const auto size = [](Real x) { return x < 0 ? -x : x; };
    const Real fall = size(visit.fall[0]) + size(visit.fall[1]) + size(visit.fall[2]);
    if (!any_below_zero(select(elastic > zero, fastest + L(visit.slow - fall), zero))) return;

    const V3<L> falls = fall_between(c, rows.bodies, visit) * L(Real(0.5));
    c.rel.n += dot(c.frame.normal, falls);
    c.rel.v1 += dot(c.frame.tangent, falls);
    c.rel.v2 += dot(c.frame.other, falls);
    const Opening<L> opening = opening_of(c, rows.bodies);
    const L slow = -visit.slow, at_rest = Real(-kAtRest) * visit.inverse_substep;
    const L deep = lane<L>(c.block.inverse_deep, c.at);
    L strikes = zero, lasts = zero;
    for (int k = 0; k < c.block.points; ++k) {
        const PointRows<Real>& point = c.points[k];
        const L speed = speed_of(c, k);
        L gap = lane<L>(point.gap, c.at) + opening.center;
        if constexpr (turns)
            gap += lane<L>(point.lever[0], c.at) * opening.along_0
                + lane<L>(point.lever[1], c.at) * opening.along_1;
        const L then = gap * L(visit.inverse_substep) + speed + dot(c.frame.normal, falls);
        const L mass = select(elastic > zero, lane<L>(point.mass, c.at), zero);
        strike.mass[k] = select(speed < slow, select(then < zero, mass, zero), zero);
        strikes -= strike.mass[k];
        // What never turns rigid has no such measure.
        const L goes = select(deep > zero, speed * deep, at_rest + at_rest);
        lasts -= select(goes < at_rest, strike.mass[k], zero);
    }
    Real at[L::kWidth];
    strikes.store(at);
    for (int i = 0; i < L::kWidth; ++i) strike.lanes |= at[i] < 0 ? 1u << i : 0u;
    strike.lasts = any_below_zero(lasts);
}

// Stops what strikes, and throws it back. Of a single point the spins are told only where someone
// asks for them.
template <class L, bool turns>
void reflect(Contacts<L, turns>& c,
             const BounceRows<typename L::Number>& bounce,
             bool spins,
             Strike<L>& strike)
{
    using Real = typename L::Number;
    const L zero = Real(0), one = Real(1);
    const int count = c.block.points;
    const Six<L> before = c.rel;
    L came[4];
    for (int k = 0; k < count; ++k) {
        came[k] = speed_of(c, k);
        strike.impulse[k] = zero;
    }
    for (int visit = 0; visit < (count > 1 ? kBounceVisits : 1); ++visit)
        for (int k = 0; k < count; ++k) {
            const L total = max(strike.impulse[k] - strike.mass[k] * speed_of(c, k), zero);
            const L more = total - strike.impulse[k];
            strike.impulse[k] = total;
            c.rel.n += c.answer(response::nn) * more;
            if constexpr (turns) {
                if (!spins) continue;
                const L u = lane<L>(c.points[k].lever[0], c.at);
                const L w = lane<L>(c.points[k].lever[1], c.at);
                const L n1 = c.spin_answer(0, 0), n2 = c.spin_answer(1, 0);
                const L w12 = c.answer(response::w12);
                c.rel.n += (u * n1 + w * n2) * more;
                c.rel.w1 += (n1 + u * c.answer(response::w11) + w * w12) * more;
                c.rel.w2 += (n2 + u * w12 + w * c.answer(response::w22)) * more;
            }
        }
    // As much of that impulse as keeps the energy and once more, seen along it: what came in, and
    // what stopping changed. In units of the load: products leave float where bodies are huge.
    L load = zero, in = zero, change = zero;
    for (int k = 0; k < count; ++k) load += strike.impulse[k];
    const L unit = inverse_or_zero(load);
    for (int k = 0; k < count; ++k) {
        const L share = strike.impulse[k] * unit;
        in -= share * came[k];
        change += share * (speed_of(c, k) - came[k]);
    }
    const L twice = one + lane<L>(bounce.restitution, c.at);
    const L scale = count == 1 ? twice : twice * in * inverse_or_zero(change);
    for (int k = 0; k < count; ++k) {
        const L impulse = strike.impulse[k] = strike.impulse[k] * scale;
        strike.load += impulse;
        c.given.n += impulse;
        if constexpr (turns) {
            c.given.w1 += lane<L>(c.points[k].lever[0], c.at) * impulse;
            c.given.w2 += lane<L>(c.points[k].lever[1], c.at) * impulse;
            strike.lever += lane<L>(c.points[k].reach, c.at) * impulse;
        }
    }
    const auto back = [&](L from, L stopped) { return from + (stopped - from) * scale; };
    c.rel.n = back(before.n, c.rel.n);
    if constexpr (turns) {
        if (!spins) return;
        c.rel.w1 = back(before.w1, c.rel.w1);
        c.rel.w2 = back(before.w2, c.rel.w2);
    }
}

// Gives the bodies of the lanes that strike what they got, and keeps it to be told.
template <class L, bool turns>
void give_strike(Contacts<L, turns>& c,
                 const RowsView<typename L::Number>& rows,
                 BounceRows<typename L::Number>& bounce,
                 const Strike<L>& strike)
{
    const Mobility<L, turns> how_a(rows.bodies, c.block.a + c.at);
    const Mobility<L, turns> how_b(rows.bodies, c.block.b + c.at);
    c.frame.push(c.given, how_a, how_b, c.a, c.b);
    c.a.write_free(rows.bodies, c.block.a + c.at,
                   strike.lanes & unsigned{c.block.writes_a} >> c.at);
    c.b.write_free(rows.bodies, c.block.b + c.at,
                   strike.lanes & unsigned{c.block.writes_b} >> c.at);
    const V3<L> given{c.given.n, c.given.v1, c.given.v2};
    store3(lane3<L>(bounce.impulse, c.at) + given, bounce.impulse, c.at);
}

}  // namespace throng::THRONG_LANES
