// A visit of the solver with friction of another kind than the usual: at every point of a contact,
// within a pyramid, or both. Written once over the width of the machine's registers.
//
// At a point the speeds are v1 - lever[0] wn and v2 - lever[1] wn (see PointRows), and an impulse
// has that torque about the normal: friction at points needs no twist of its own. A contact keeps
// what its points add up to, so that steps with and without hand one another the same impulses.
//
// The pyramid has its sides along and across a direction that depends on the normal alone: each of
// its two impulses goes up to friction times load by itself, so that along a diagonal they add up
// to sqrt(2) times that.
#include "kernels/solver/impact_lanes.hpp"

namespace throng::THRONG_LANES {

namespace {

// A matrix of W contacts, symmetric.
template <class L>
struct Square {
    L m11, m22, m12;
};

// The sides of a pyramid, as the tangent sees them.
template <class L>
struct Sides {
    L cos, sin;
};

template <class L>
Sides<L> sides_of(const Contacts<L, true>& c)
{
    const V3<L> side = across(c.frame.normal);
    return {dot(side, c.frame.tangent), dot(side, c.frame.other)};
}

template <class L>
L clamped(L x, L reach)
{
    return max(min(x, reach), -reach);
}

// The impulse seen from the sides, cut to the pyramid, and seen from the tangents again.
template <class L>
Grip<L> within(const Sides<L>& sides, L side, L across_it, L reach)
{
    const L p = clamped(side, reach), q = clamped(across_it, reach);
    return {sides.cos * p - sides.sin * q, sides.sin * p + sides.cos * q};
}

template <class L>
Grip<L> cut_to_pyramid(const Sides<L>& sides, const Grip<L>& held, L reach)
{
    return within(sides, sides.cos * held.impulse_1 + sides.sin * held.impulse_2,
                  sides.cos * held.impulse_2 - sides.sin * held.impulse_1, reach);
}

template <class L>
Grip<L> cut_to_cone(const Grip<L>& held, L reach)
{
    using Real = typename L::Number;
    // In units of the reach: squares leave float where bodies are huge or tiny.
    const L unit = inverse_or_zero(reach), one = Real(1);
    const L x = held.impulse_1 * unit, y = held.impulse_2 * unit;
    const L length = sqrt(x * x + y * y);
    const L shrink = reach * select(length > one, one / select(length > one, length, one), one);
    return {x * shrink, y * shrink};
}

// Friction within a pyramid, at a place that slides by (slip_1, slip_2). Sticking is tried with the
// full matrix; what leaves the pyramid slides along one side after the other.
template <class L>
Grip<L> grip_in_pyramid(
    const Sides<L>& sides, const Square<L>& k, const Grip<L>& old, L slip_1, L slip_2, L reach)
{
    const L cos = sides.cos, sin = sides.sin;
    const L held_p = cos * old.impulse_1 + sin * old.impulse_2;
    const L held_q = cos * old.impulse_2 - sin * old.impulse_1;
    const L slip_p = cos * slip_1 + sin * slip_2, slip_q = cos * slip_2 - sin * slip_1;
    const L cross_k = cos * sin * k.m12;
    const L k_pp = cos * cos * k.m11 + sin * sin * k.m22 + (cross_k + cross_k);
    const L k_qq = sin * sin * k.m11 + cos * cos * k.m22 - (cross_k + cross_k);
    const L k_pq = cos * sin * (k.m22 - k.m11) + (cos * cos - sin * sin) * k.m12;

    const auto mass = FrictionMass<L>::of(k_pp, k_qq, k_pq);
    const L stick_p = held_p - (mass.m11 * slip_p + mass.m12 * slip_q);
    const L stick_q = held_q - (mass.m12 * slip_p + mass.m22 * slip_q);
    const auto slides = max(max(stick_p, -stick_p), max(stick_q, -stick_q)) > reach;

    const L slide_p = clamped(held_p - slip_p * inverse_or_zero(k_pp), reach);
    const L then_q = slip_q + k_pq * (slide_p - held_p);
    const L slide_q = clamped(held_q - then_q * inverse_or_zero(k_qq), reach);
    return within(sides, select(slides, slide_p, stick_p), select(slides, slide_q, stick_q), reach);
}

// Friction of one kind or the other, at a place of matrix k.
template <class L>
Grip<L> grip_at(
    const Sides<L>* pyramid, const Square<L>& k, const Grip<L>& old, L slip_1, L slip_2, L reach)
{
    if (pyramid != nullptr) return grip_in_pyramid(*pyramid, k, old, slip_1, slip_2, reach);
    return grip_in_cone(FrictionMass<L>::of(k.m11, k.m22, k.m12), old, slip_1, slip_2, reach);
}

// What an impulse (1, 2) and its torque about the normal do to (v1, v2, wn), and that they were
// given.
template <class L>
void give(Contacts<L, true>& c, L by_1, L by_2, L twist)
{
    const L k_12 = c.answer(response::v12);
    const L n1 = c.spin_answer(2, 1), n2 = c.spin_answer(2, 2);
    c.given.v1 += by_1;
    c.given.v2 += by_2;
    c.given.wn += twist;
    c.rel.v1 += c.answer(response::v11) * by_1 + k_12 * by_2 + n1 * twist;
    c.rel.v2 += k_12 * by_1 + c.answer(response::v22) * by_2 + n2 * twist;
    c.rel.wn += n1 * by_1 + n2 * by_2 + c.answer(response::wnn) * twist;
}

// The matrix at the middle (levers 0) or at a point.
template <class L>
Square<L> matrix_at(const Contacts<L, true>& c, L u, L w)
{
    const L n1 = c.spin_answer(2, 1), n2 = c.spin_answer(2, 2), nn = c.answer(response::wnn);
    const L un1 = u * n1, wn2 = w * n2;
    return {c.answer(response::v11) - (un1 + un1) + u * u * nn,
            c.answer(response::v22) - (wn2 + wn2) + w * w * nn,
            c.answer(response::v12) - (w * n1 + u * n2) + u * w * nn};
}

template <class L>
Grip<L> kept(const Lane16<typename L::Number> (&impulse)[2], int at)
{
    return {lane<L>(impulse[0], at), lane<L>(impulse[1], at)};
}
template <class L>
void keep(const Grip<L>& held, Lane16<typename L::Number> (&impulse)[2], int at)
{
    held.impulse_1.store(impulse[0].at + at);
    held.impulse_2.store(impulse[1].at + at);
}

// What the friction of a contact's points adds up to.
template <class L>
struct Whole {
    Grip<L> force = {L(typename L::Number(0)), L(typename L::Number(0))};
    L twist = L(typename L::Number(0));

    void add(const Grip<L>& held, L u, L w)
    {
        force.impulse_1 += held.impulse_1;
        force.impulse_2 += held.impulse_2;
        twist += -(u * held.impulse_1 + w * held.impulse_2);
    }
};

// Friction at the middle of the points, and about the normal.
template <class L>
void hold_middle(Contacts<L, true>& c, const Sides<L>* pyramid, L load, L lever)
{
    using Real = typename L::Number;
    const L zero = Real(0), friction = lane<L>(c.block.friction, c.at);
    if (c.block.points > 1) give(c, zero, zero, hold_twist(c, friction * lever));
    const Grip<L> old = kept<L>(c.block.friction_impulse, c.at);
    const Grip<L> held =
        grip_at(pyramid, matrix_at(c, zero, zero), old, c.rel.v1, c.rel.v2, friction * load);
    keep(held, c.block.friction_impulse, c.at);
    give(c, held.impulse_1 - old.impulse_1, held.impulse_2 - old.impulse_2, zero);
}

// Friction at every point, one after another, each by its own load.
template <class L>
void hold_each(Contacts<L, true>& c,
               GripRows<typename L::Number>* grips,
               const Sides<L>* pyramid,
               const Aim<L> (&aims)[4])
{
    const L friction = lane<L>(c.block.friction, c.at);
    Whole<L> whole;
    for (int k = 0; k < c.block.points; ++k) {
        const L u = lane<L>(c.points[k].lever[0], c.at), w = lane<L>(c.points[k].lever[1], c.at);
        const Grip<L> old = kept<L>(grips[k].impulse, c.at);
        const Grip<L> held = grip_at(pyramid, matrix_at(c, u, w), old, c.rel.v1 - u * c.rel.wn,
                                     c.rel.v2 - w * c.rel.wn, friction * aims[k].impulse);
        keep(held, grips[k].impulse, c.at);
        const L by_1 = held.impulse_1 - old.impulse_1, by_2 = held.impulse_2 - old.impulse_2;
        give(c, by_1, by_2, -(u * by_1 + w * by_2));
        whole.add(held, u, w);
    }
    keep(whole.force, c.block.friction_impulse, c.at);
    whole.twist.store(c.block.twist_impulse.at + c.at);
}

template <class L>
[[gnu::flatten]] void sweep_grips_lanes(const RowsView<typename L::Number>& rows,
                                        std::size_t place,
                                        int at,
                                        const Visit<typename L::Number>& visit)
{
    Contacts<L, true> c(rows, place, at);
    Aim<L> aims[4];
    take_aim(c, rows.bodies, visit, aims);
    if (rows.carries != nullptr) slide_along(c, rows.carries[place]);
    if (rows.bounces != nullptr && !visit.push)
        leave_to_impact(c, rows.bounces[place], visit, aims);
    push_together(c, aims);
    for (int sweep = 1; sweep < visit.normal_sweeps; ++sweep) push_points(c, aims);
    L load, lever;
    weigh(c, aims, load, lever);
    settle_slip(c);
    if (visit.rolls) give_turn(c, resist_rolling(c, rows.rollings[place], load));
    // What resisting to spin did besides turning, which settle_slip leaves to what follows it.
    c.rel.v1 += c.spin_answer(2, 1) * c.given.wn;
    c.rel.v2 += c.spin_answer(2, 2) * c.given.wn;
    const Sides<L> sides = sides_of(c);
    const Sides<L>* const pyramid = visit.pyramid ? &sides : nullptr;
    if (visit.at_points)
        hold_each(c, rows.grips + c.block.first_point, pyramid, aims);
    else
        hold_middle(c, pyramid, load, lever);
    tell_points(c);
    push_points(c, aims);
    keep_impulses(c, aims);
    c.write(rows.bodies);
}

// Friction in an impact, beside what the contact holds at rest: at every point by its own load, or
// at the middle and about the normal.
template <class L>
void slide(Contacts<L, true>& c, const Sides<L>* pyramid, bool at_points, const Strike<L>& strike)
{
    const L zero = typename L::Number(0), friction = lane<L>(c.block.friction, c.at);
    const Grip<L> none{zero, zero};
    if (!at_points) {
        if (c.block.points > 1) give(c, zero, zero, twist_within(c, zero, friction * strike.lever));
        const Grip<L> held = grip_at(pyramid, matrix_at(c, zero, zero), none, c.rel.v1, c.rel.v2,
                                     friction * strike.load);
        return give(c, held.impulse_1, held.impulse_2, zero);
    }
    for (int k = 0; k < c.block.points; ++k) {
        const L u = lane<L>(c.points[k].lever[0], c.at), w = lane<L>(c.points[k].lever[1], c.at);
        const Grip<L> held = grip_at(pyramid, matrix_at(c, u, w), none, c.rel.v1 - u * c.rel.wn,
                                     c.rel.v2 - w * c.rel.wn, friction * strike.impulse[k]);
        give(c, held.impulse_1, held.impulse_2, -(u * held.impulse_1 + w * held.impulse_2));
    }
}

template <class L>
[[gnu::flatten]] bool bounce_grips_lanes(const RowsView<typename L::Number>& rows,
                                         std::size_t place,
                                         int at,
                                         const Visit<typename L::Number>& visit)
{
    Contacts<L, true> c(rows, place, at);
    Strike<L> strike;
    find_strike(c, rows, rows.bounces[place], visit, strike);
    if (strike.lanes == 0) return false;
    reflect(c, rows.bounces[place], true, strike);
    const L zero = typename L::Number(0);
    settle_slip(c);
    if (visit.rolls)
        give_turn(c, rolling_within(c, rows.rollings[place], V3<L>{zero, zero, zero}, strike.load));
    c.rel.v1 += c.spin_answer(2, 1) * c.given.wn;
    c.rel.v2 += c.spin_answer(2, 2) * c.given.wn;
    const Sides<L> sides = sides_of(c);
    slide(c, visit.pyramid ? &sides : nullptr, visit.at_points, strike);
    give_strike(c, rows, rows.bounces[place], strike);
    return strike.lasts;
}

// How the friction that a contact holds is shared among its points: each takes its share of the
// load, and turns about where the load's middle is. They add up to the same force and torque.
template <class L>
struct Shares {
    L friction_1, friction_2, middle_u, middle_w, turn;  // of each unit of load
    // Of the contact's extent, squared: closer together than that, no point has a lever to turn by.
    static constexpr double kSpread = 1e-3;

    Shares(const Contacts<L, true>& c, const Grip<L>& whole, L twist)
    {
        using Real = typename L::Number;
        L load = Real(0), u_load = Real(0), w_load = Real(0), spread = Real(0), extent = Real(0);
        const auto at_each = [&](auto what) {
            for (int k = 0; k < c.block.points; ++k)
                what(lane<L>(c.points[k].impulse, c.at), lane<L>(c.points[k].lever[0], c.at),
                     lane<L>(c.points[k].lever[1], c.at));
        };
        at_each([&](L by, L u, L w) {
            load += by;
            u_load += by * u;
            w_load += by * w;
            extent = max(extent, u * u + w * w);
        });
        const L share = inverse_or_zero(load);
        friction_1 = whole.impulse_1 * share;
        friction_2 = whole.impulse_2 * share;
        middle_u = u_load * share;
        middle_w = w_load * share;
        at_each([&](L by, L u, L w) {
            const L off_u = u - middle_u, off_w = w - middle_w;
            spread += by * (off_u * off_u + off_w * off_w);
        });
        const L rest = twist + middle_u * whole.impulse_1 + middle_w * whole.impulse_2;
        turn = select(spread > load * extent * L(Real(kSpread)), rest * inverse_or_zero(spread),
                      L(Real(0)));
    }
    Grip<L> of(L load, L u, L w) const
    {
        return {load * (friction_1 - turn * (u - middle_u)),
                load * (friction_2 - turn * (w - middle_w))};
    }
};

// Returns what the contact holds about the normal.
template <class L>
L start_each(Contacts<L, true>& c,
             GripRows<typename L::Number>* grips,
             const Sides<L>* pyramid,
             const Grip<L>& before)
{
    const L friction = lane<L>(c.block.friction, c.at);
    const Shares<L> shares(c, before, lane<L>(c.block.twist_impulse, c.at));
    Whole<L> whole;
    for (int k = 0; k < c.block.points; ++k) {
        const L load = lane<L>(c.points[k].impulse, c.at);
        const L u = lane<L>(c.points[k].lever[0], c.at), w = lane<L>(c.points[k].lever[1], c.at);
        const Grip<L> share = shares.of(load, u, w);
        const Grip<L> held = pyramid != nullptr ? cut_to_pyramid(*pyramid, share, friction * load)
                                                : cut_to_cone(share, friction * load);
        keep(held, grips[k].impulse, c.at);
        whole.add(held, u, w);
    }
    keep(whole.force, c.block.friction_impulse, c.at);
    return whole.twist;
}

template <class L>
[[gnu::flatten]] void warm_start_grips_lanes(const RowsView<typename L::Number>& rows,
                                             std::size_t place,
                                             int at,
                                             const Visit<typename L::Number>& visit)
{
    Contacts<L, true> c(rows, place, at);
    give_points(c);
    const Sides<L> sides = sides_of(c);
    const Sides<L>* const pyramid = visit.pyramid ? &sides : nullptr;
    const Grip<L> whole = kept<L>(c.block.friction_impulse, at);
    L twist = lane<L>(c.block.twist_impulse, at);
    if (visit.at_points) {
        twist = start_each(c, rows.grips + c.block.first_point, pyramid, whole);
        twist.store(c.block.twist_impulse.at + at);
    } else if (pyramid != nullptr) {
        keep(cut_to_pyramid(sides, whole, lane<L>(c.block.friction, at) * c.given.n),
             c.block.friction_impulse, at);
    }
    const Grip<L> held = kept<L>(c.block.friction_impulse, at);
    c.given.v1 = held.impulse_1;
    c.given.v2 = held.impulse_2;
    c.given.wn = twist;
    if (visit.rolls) give_rolling(c, rows.rollings[place]);
    c.write(rows.bodies);
}

}  // namespace

template <class Real>
void warm_start_grips(const RowsView<Real>& rows,
                      std::size_t begin,
                      std::size_t end,
                      const Visit<Real>& visit)
{
    for (std::size_t place = begin; place < end; ++place)
        for (int at = 0; at < kBlock; at += Lanes<Real>::kWidth)
            warm_start_grips_lanes<Lanes<Real>>(rows, place, at, visit);
}

template <class Real>
void sweep_grips(const RowsView<Real>& rows,
                 std::size_t begin,
                 std::size_t end,
                 const Visit<Real>& visit)
{
    for (std::size_t place = begin; place < end; ++place)
        for (int at = 0; at < kBlock; at += Lanes<Real>::kWidth)
            sweep_grips_lanes<Lanes<Real>>(rows, place, at, visit);
}

template <class Real>
bool bounce_grips(const RowsView<Real>& rows,
                  std::size_t begin,
                  std::size_t end,
                  const Visit<Real>& visit)
{
    bool any = false;
    for (std::size_t place = begin; place < end; ++place)
        for (int at = 0; at < kBlock; at += Lanes<Real>::kWidth)
            any |= bounce_grips_lanes<Lanes<Real>>(rows, place, at, visit);
    return any;
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template bool bounce_grips<Real>(const RowsView<Real>&, std::size_t, std::size_t,              \
                                     const Visit<Real>&);                                          \
    template void warm_start_grips<Real>(const RowsView<Real>&, std::size_t, std::size_t,          \
                                         const Visit<Real>&);                                      \
    template void sweep_grips<Real>(const RowsView<Real>&, std::size_t, std::size_t,               \
                                    const Visit<Real>&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng::THRONG_LANES
