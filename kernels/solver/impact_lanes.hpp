// Impact lanes: one contact's impact, over the width of the registers.
//
// The points that strike are stopped together, and what stopped them is given once more, as
// restitution has it: they are thrown back along one impulse, by as much as leaves 1 - e2 of the
// energy that it took to stop them behind. So no impact gains energy, whatever moves the two bodies
// by now and however well the points have been stopped, and none loses any where e is 1.
#pragma once

#include "kernels/solver/iteration_lanes.hpp"

namespace throng::THRONG_LANES {

// The points of W contacts that strike.
template <class L>
struct ImpactPoints {
    L mass[4];     // kg, effective along the normal; 0: does not strike
    L impulse[4];  // N s
    L load = L(typename L::Number(0)), torsional_load = load;  // of all; about the normal, N m s
    unsigned lanes = 0;  // bit a lane: some point of it strikes
    bool lasts = false;  // and is not all but at rest
};

// The speed of a point along the normal.
template <class L, bool turns>
L speed_of(const Contacts<L, turns>& c, int k)
{
    if constexpr (turns)
        return c.relative.n + lane<L>(c.points[k].lever_arm[0], c.at) * c.relative.w1
            + lane<L>(c.points[k].lever_arm[1], c.at) * c.relative.w2;
    return c.relative.n;
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

// What half of a substep's gravity adds to the velocity between two: nothing where both fall.
//
//   all   of the half to come, before they move
//   lags  of the half that is behind but has not been added yet, of those to whom all of it is at
//         once
template <class L>
struct HalfFall {
    V3<L> all, lags;
};
template <class L, bool turns>
HalfFall<L> half_fall_between(const Contacts<L, turns>& c,
                              const SolverBody<typename L::Number>* bodies,
                              const SolverIteration<typename L::Number>& iteration)
{
    using Real = typename L::Number;
    const L zero = Real(0), one = Real(1);
    L a[8], b[8];
    gather_bodies(bodies->inertia, c.block.a + c.at, a);
    gather_bodies(bodies->inertia, c.block.b + c.at, b);
    const auto fall = [&](L of_b, L of_a) -> V3<L> {
        const L falls = select(b[0] > zero, of_b, zero) - select(a[0] > zero, of_a, zero);
        return V3<L>{falls * L(iteration.gravity_step[0]), falls * L(iteration.gravity_step[1]),
                     falls * L(iteration.gravity_step[2])}
        * L(Real(0.5));
    };
    return {fall(one, one), fall(one - b[7], one - a[7])};
}

// Who comes in fast and would touch before the substep ends. From here on the speeds are those in
// the middle of what gravity does in the substep, so that who falls rises again as high.
template <class L, bool turns>
void find_impact_points(Contacts<L, turns>& c,
                        const ContactConstraintsView<typename L::Number>& constraints,
                        const RestitutionWide<typename L::Number>& restitution,
                        const SolverIteration<typename L::Number>& iteration,
                        ImpactPoints<L>& impact)
{
    using Real = typename L::Number;
    const L zero = Real(0);
    const L elastic = lane<L>(restitution.restitution, c.at);
    L fastest = zero;
    for (int k = 0; k < c.block.points; ++k) fastest = min(fastest, speed_of(c, k));
    const auto size = [](Real x) { return x < 0 ? -x : x; };
    const Real fall = size(iteration.gravity_step[0]) + size(iteration.gravity_step[1])
        + size(iteration.gravity_step[2]);
    if (!any_below_zero(
            select(elastic > zero, fastest + L(iteration.restitution_threshold - fall), zero)))
        return;

    const HalfFall<L> fall_between = half_fall_between(c, constraints.bodies, iteration);
    c.relative.n += dot(c.frame.normal, fall_between.lags);
    c.relative.v1 += dot(c.frame.tangent, fall_between.lags);
    c.relative.v2 += dot(c.frame.other, fall_between.lags);
    const SeparationChange<L> change = separation_change(c, constraints.bodies);
    const L slow =
        zero - max(L(iteration.restitution_threshold), lane<L>(restitution.least_speed, c.at));
    const L at_rest = Real(-kAtRest) * iteration.inverse_substep;
    const L deep = lane<L>(c.block.inverse_deep, c.at);
    L hits = zero, lasts = zero;
    for (int k = 0; k < c.block.points; ++k) {
        const ContactPointWide<Real>& point = c.points[k];
        const L speed = speed_of(c, k);
        L separation = lane<L>(point.separation, c.at) + change.center;
        if constexpr (turns)
            separation += lane<L>(point.lever_arm[0], c.at) * change.along_0
                + lane<L>(point.lever_arm[1], c.at) * change.along_1;
        const L then = separation * L(iteration.inverse_substep) + speed
            + dot(c.frame.normal, fall_between.all);
        const L mass = select(elastic > zero, lane<L>(point.mass, c.at), zero);
        impact.mass[k] = select(speed < slow, select(then < zero, mass, zero), zero);
        hits -= impact.mass[k];
        // What never turns rigid has no such measure.
        const L goes = select(deep > zero, speed * deep, at_rest + at_rest);
        lasts -= select(goes < at_rest, impact.mass[k], zero);
    }
    Real at[L::kWidth];
    hits.store(at);
    for (int i = 0; i < L::kWidth; ++i) impact.lanes |= at[i] < 0 ? 1u << i : 0u;
    impact.lasts = any_below_zero(lasts);
}

// Stops what strikes, and throws it back. Of a single point the spins are told only where someone
// asks for them.
template <class L, bool turns>
void reflect(Contacts<L, turns>& c,
             const RestitutionWide<typename L::Number>& restitution,
             bool spins,
             ImpactPoints<L>& impact)
{
    using Real = typename L::Number;
    const L zero = Real(0), one = Real(1);
    const int count = c.block.points;
    const ContactSpaceVector<L> before = c.relative;
    L came[4];
    for (int k = 0; k < count; ++k) {
        came[k] = speed_of(c, k);
        impact.impulse[k] = zero;
    }
    for (int iteration = 0; iteration < (count > 1 ? kRestitutionIterations : 1); ++iteration)
        for (int k = 0; k < count; ++k) {
            const L total = max(impact.impulse[k] - impact.mass[k] * speed_of(c, k), zero);
            const L more = total - impact.impulse[k];
            impact.impulse[k] = total;
            c.relative.n += c.inverse_mass(inverse_mass_entry::nn) * more;
            if constexpr (turns) {
                if (!spins) continue;
                const L u = lane<L>(c.points[k].lever_arm[0], c.at);
                const L w = lane<L>(c.points[k].lever_arm[1], c.at);
                const L n1 = c.angular_inverse_mass(0, 0), n2 = c.angular_inverse_mass(1, 0);
                const L w12 = c.inverse_mass(inverse_mass_entry::w12);
                c.relative.n += (u * n1 + w * n2) * more;
                c.relative.w1 +=
                    (n1 + u * c.inverse_mass(inverse_mass_entry::w11) + w * w12) * more;
                c.relative.w2 +=
                    (n2 + u * w12 + w * c.inverse_mass(inverse_mass_entry::w22)) * more;
            }
        }
    // As much of that impulse as keeps the energy and once more, seen along it: what came in, and
    // what stopping changed. In units of the load: products leave float where bodies are huge.
    L load = zero, in = zero, change = zero;
    for (int k = 0; k < count; ++k) load += impact.impulse[k];
    const L unit = inverse_or_zero(load);
    for (int k = 0; k < count; ++k) {
        const L share = impact.impulse[k] * unit;
        in -= share * came[k];
        change += share * (speed_of(c, k) - came[k]);
    }
    const L twice = one + lane<L>(restitution.restitution, c.at);
    const L scale = count == 1 ? twice : twice * in * inverse_or_zero(change);
    for (int k = 0; k < count; ++k) {
        const L impulse = impact.impulse[k] = impact.impulse[k] * scale;
        impact.load += impulse;
        c.applied.n += impulse;
        if constexpr (turns) {
            c.applied.w1 += lane<L>(c.points[k].lever_arm[0], c.at) * impulse;
            c.applied.w2 += lane<L>(c.points[k].lever_arm[1], c.at) * impulse;
            impact.torsional_load += lane<L>(c.points[k].center_distance, c.at) * impulse;
        }
    }
    const auto back = [&](L from, L stopped) { return from + (stopped - from) * scale; };
    c.relative.n = back(before.n, c.relative.n);
    if constexpr (turns) {
        if (!spins) return;
        c.relative.w1 = back(before.w1, c.relative.w1);
        c.relative.w2 = back(before.w2, c.relative.w2);
    }
}

// Gives the bodies of the lanes that strike what they got, and keeps it to be told.
template <class L, bool turns>
void apply_impact(Contacts<L, turns>& c,
                  const ContactConstraintsView<typename L::Number>& constraints,
                  RestitutionWide<typename L::Number>& restitution,
                  const ImpactPoints<L>& impact)
{
    const Mobility<L, turns> how_a(constraints.bodies, c.block.a + c.at);
    const Mobility<L, turns> how_b(constraints.bodies, c.block.b + c.at);
    c.frame.apply(c.applied, how_a, how_b, c.a, c.b);
    c.a.write_free(constraints.bodies, c.block.a + c.at,
                   impact.lanes & unsigned{c.block.writes_a} >> c.at);
    c.b.write_free(constraints.bodies, c.block.b + c.at,
                   impact.lanes & unsigned{c.block.writes_b} >> c.at);
    const V3<L> given{c.applied.n, c.applied.v1, c.applied.v2};
    store3(lane3<L>(restitution.impulse, c.at) + given, restitution.impulse, c.at);
}

}  // namespace throng::THRONG_LANES
