// Visit lanes: what every visit of the solver is made of, over the width of the registers.
//
// A visit works in the axes of the contact: it asks the bodies once for the six numbers of their
// relative motion, solves all rows of the contact among these six by what each row does to them
// (ContactBlock::response), and gives the bodies the sum. It is the same Gauss-Seidel over the same
// rows as going back to the bodies after each, at a third of the arithmetic.
#pragma once

#include "kernels/solver/solve_lanes.hpp"

namespace throng::THRONG_LANES {

// The rows of W contacts in the middle of a visit.
template <class L, bool turns>
struct Contacts {
    using Real = typename L::Number;
    ContactBlock<Real>& block;
    PointRows<Real>* points;
    int at;  // first lane
    Motion<L, turns> a, b;
    Frame<L, turns> frame;
    Six<L> rel;  // relative motion as the rows leave it
    Six<L> given = {L(Real(0)), L(Real(0)), L(Real(0)), L(Real(0)), L(Real(0)), L(Real(0))};

    Contacts(const RowsView<Real>& rows, std::size_t place, int first)
        : block(rows.blocks[place]), points(rows.points + block.first_point), at(first),
          a(rows.bodies, block.a + at), b(rows.bodies, block.b + at), frame(block, at),
          rel(frame.between(a, b))
    { }
    L answer(int row) const { return lane<L>(block.response[row], at); }
    L spin_answer(int spin, int velocity) const
    {
        return answer(response::kSpin + 3 * spin + velocity);
    }
    void write(SolverBody<Real>* bodies)
    {
        const Mobility<L, turns> how_a(bodies, block.a + at), how_b(bodies, block.b + at);
        frame.push(given, how_a, how_b, a, b);
        a.write(bodies, block.a + at, unsigned{block.writes_a} >> at);
        b.write(bodies, block.b + at, unsigned{block.writes_b} >> at);
    }
};

// What a point of a visit aims at, and what an impulse on it does to vn, w1, w2.
template <class L>
struct Aim {
    L bias, keep, leak;  // keep: mass, less the share that leaks
    L to_n, to_1, to_2;
    L impulse;
};

// How far apart the surfaces are at the center, beyond the gap, and by how much that changes per
// lever.
template <class L>
struct Opening {
    L center, along_0, along_1;
};

template <class L, bool turns>
Opening<L> opening_of(const Contacts<L, turns>& c, const SolverBody<typename L::Number>* bodies)
{
    const Drift<L, turns> drift_a(bodies, c.block.a + c.at);
    const Drift<L, turns> drift_b(bodies, c.block.b + c.at);
    Opening<L> opening{dot(c.frame.normal, drift_b.moved - drift_a.moved), {}, {}};
    if constexpr (turns) {
        const V3<L> turn_a = drift_a.turned_back(c.frame.normal);
        const V3<L> turn_b = drift_b.turned_back(c.frame.normal);
        // A round side is the same however it turns: only what lies within it turns with the body.
        const V3<L> arm_a = c.frame.center_a - c.frame.normal * lane<L>(c.block.round_a, c.at);
        const V3<L> arm_b = c.frame.center_b + c.frame.normal * lane<L>(c.block.round_b, c.at);
        opening.center = opening.center + (dot(turn_b, arm_b) - dot(turn_a, arm_a));
        const V3<L> turn = turn_b - turn_a;
        opening.along_0 = dot(turn, c.frame.other);
        opening.along_1 = -dot(turn, c.frame.tangent);
    }
    return opening;
}

template <class L, bool turns, int most>
void take_aim(const Contacts<L, turns>& c,
              const SolverBody<typename L::Number>* bodies,
              const Visit<typename L::Number>& visit,
              Aim<L> (&aims)[most])
{
    using Real = typename L::Number;
    const L zero = Real(0), one = Real(1);
    const L limit = -visit.push_limit;
    const Opening<L> opening = opening_of(c, bodies);
    const int count = most == 1 ? 1 : c.block.points;
    L separation[most], loaded = zero;
    for (int k = 0; k < count; ++k) {
        const PointRows<Real>& point = c.points[k];
        separation[k] = lane<L>(point.gap, c.at) + opening.center;
        if constexpr (turns && most > 1)
            separation[k] += lane<L>(point.lever[0], c.at) * opening.along_0
                + lane<L>(point.lever[1], c.at) * opening.along_1;
        // A point that this contact has not got, but another of the block has, bears nothing.
        if constexpr (most > 1) {
            const L there = select(lane<L>(point.mass, c.at) > zero, one, zero);
            loaded += select(separation[k] < zero, there, zero);
        }
    }
    // Three points or four share a load well; one or two may be a corner that carries everything.
    L eased = one;
    if constexpr (most > 1)
        eased = select(loaded > L(Real(2.5)), L(Real(1) / Real(kSharedDeep)), one);
    for (int k = 0; k < count; ++k) {
        const PointRows<Real>& point = c.points[k];
        Aim<L>& aim = aims[k];
        aim.impulse = lane<L>(point.impulse, c.at);
        const L mass = lane<L>(point.mass, c.at);
        // Apart: let it close, but no further. Overlapping: a soft spring, within the push limit.
        const auto open = separation[k] > zero;
        const L closing = separation[k] * L(visit.inverse_substep);
        if (visit.push) {
            const L soft = max(lane<L>(c.block.bias_rate, c.at) * separation[k], limit);
            aim.bias = select(open, closing, soft);
            // A corner under a heavy load would sink without end: from `deep` on its spring leaks
            // less, and at twice that not at all.
            const L depth = -separation[k] * lane<L>(c.block.inverse_deep, c.at) * eased;
            const L soft_share = max(min(L(Real(2)) - depth, one), zero);
            aim.leak = select(open, zero, lane<L>(c.block.impulse_scale, c.at) * soft_share);
            aim.keep = mass * (one - aim.leak);
        } else {
            aim.bias = select(open, closing, zero);
            aim.leak = zero;
            aim.keep = mass;
        }
        if constexpr (turns && most > 1) {
            const L u = lane<L>(point.lever[0], c.at), w = lane<L>(point.lever[1], c.at);
            const L n1 = c.spin_answer(0, 0), n2 = c.spin_answer(1, 0);
            const L w12 = c.answer(response::w12);
            aim.to_n = c.answer(response::nn) + u * n1 + w * n2;
            aim.to_1 = n1 + u * c.answer(response::w11) + w * w12;
            aim.to_2 = n2 + u * w12 + w * c.answer(response::w22);
        } else {
            aim.to_n = c.answer(response::nn);
        }
    }
}

// What slides is told where the contact is by now.
template <class L, bool turns>
void slide_along(Contacts<L, turns>& c, const CarryRows<typename L::Number>& carried)
{
    c.rel.v1 += lane<L>(carried.speed[0], c.at);
    c.rel.v2 += lane<L>(carried.speed[1], c.at);
}

// What comes in fast is left to its impact, which the next substep begins with.
template <class L, bool turns, int most>
void leave_to_impact(const Contacts<L, turns>& c,
                     const BounceRows<typename L::Number>& bounce,
                     const Visit<typename L::Number>& visit,
                     Aim<L> (&aims)[most])
{
    using Real = typename L::Number;
    const L zero = Real(0);
    // Nobody is as fast as that where nothing bounces.
    const L slow = select(lane<L>(bounce.restitution, c.at) > zero, L(-visit.slow), L(Real(-1e30)));
    const int count = most == 1 ? 1 : c.block.points;
    for (int k = 0; k < count; ++k) {
        L speed = c.rel.n;
        if constexpr (turns && most > 1)
            speed += lane<L>(c.points[k].lever[0], c.at) * c.rel.w1
                + lane<L>(c.points[k].lever[1], c.at) * c.rel.w2;
        aims[k].keep = select(speed < slow, zero, aims[k].keep);
    }
}

// Every point towards its wanted normal speed; then refuse to pull.
template <class L, bool turns, int most>
void push_points(Contacts<L, turns>& c, Aim<L> (&aims)[most])
{
    using Real = typename L::Number;
    const int count = most == 1 ? 1 : c.block.points;
    for (int k = 0; k < count; ++k) {
        Aim<L>& aim = aims[k];
        L speed = c.rel.n, u, w;
        if constexpr (turns && most > 1) {
            u = lane<L>(c.points[k].lever[0], c.at);
            w = lane<L>(c.points[k].lever[1], c.at);
            speed += u * c.rel.w1 + w * c.rel.w2;
        }
        const L wanted = aim.impulse - aim.keep * (speed + aim.bias) - aim.leak * aim.impulse;
        const L total = max(wanted, L(Real(0)));
        const L more = total - aim.impulse;
        aim.impulse = total;
        c.given.n += more;
        c.rel.n += aim.to_n * more;
        if constexpr (turns && most > 1) {
            c.given.w1 += u * more;
            c.given.w2 += w * more;
            c.rel.w1 += aim.to_1 * more;
            c.rel.w2 += aim.to_2 * more;
        }
    }
}

// Least that a point gives way, as a share of what it answers alone, while all are pushed at once:
// four points of a face are one more than what they hold, and without it there would be many
// answers.
constexpr float kGive = 0.03f;

// All points at once, as if none had to be held back from pulling: exact where none has, left to
// the sweeps where one has. A sweep alone gives the first of four points too much and tilts the
// body a little, always the same way: tall walls come down by it.
//
// Each point gives way by leak / keep of its impulse, so with S the sum of levers over that, and K
// what impulses do to (vn, w1, w2), the impulses add up to p with (1 + S K) p = -pull.
template <class L>
void push_together(Contacts<L, true>& c, Aim<L> (&aims)[4])
{
    using Real = typename L::Number;
    const L zero = Real(0), one = Real(1), least = Real(kGive);
    const int count = c.block.points;
    V3<L> s_n{zero, zero, zero}, pull{zero, zero, zero};
    L s_11 = zero, s_12 = zero, s_22 = zero;
    L stiff[4], alone[4];
    for (int k = 0; k < count; ++k) {
        const L u = lane<L>(c.points[k].lever[0], c.at), w = lane<L>(c.points[k].lever[1], c.at);
        const Aim<L>& aim = aims[k];
        const L give = one / max(aim.leak, least);
        stiff[k] = aim.keep * give;
        const L speed = c.rel.n + u * c.rel.w1 + w * c.rel.w2;
        alone[k] = (speed + aim.bias) * stiff[k] + aim.impulse * (aim.leak * give);
        pull = pull + V3<L>{alone[k], u * alone[k], w * alone[k]};
        const L su = stiff[k] * u, sw = stiff[k] * w;
        s_n = s_n + V3<L>{stiff[k], su, sw};
        s_11 += su * u;
        s_12 += su * w;
        s_22 += sw * w;
    }
    const V3<L> s_1{s_n.y, s_11, s_12}, s_2{s_n.z, s_12, s_22};
    const L n1 = c.spin_answer(0, 0), n2 = c.spin_answer(1, 0), w12 = c.answer(response::w12);
    const V3<L> k_n{c.answer(response::nn), n1, n2}, k_1{n1, c.answer(response::w11), w12},
        k_2{n2, w12, c.answer(response::w22)};
    const V3<L> x{one + dot(s_n, k_n), dot(s_1, k_n), dot(s_2, k_n)};
    const V3<L> y{dot(s_n, k_1), one + dot(s_1, k_1), dot(s_2, k_1)};
    const V3<L> z{dot(s_n, k_2), dot(s_1, k_2), one + dot(s_2, k_2)};
    const V3<L> yz = cross(y, z);
    const L inverse = -(one / dot(x, yz));
    const V3<L> p{dot(pull, yz) * inverse, dot(pull, cross(z, x)) * inverse,
                  dot(pull, cross(x, y)) * inverse};
    const V3<L> moved{dot(k_n, p), dot(k_1, p), dot(k_2, p)};

    // What the bodies get is the sum of what the points do, to the last bit: the totals are kept.
    L total[4], smallest = zero;
    V3<L> by{zero, zero, zero};
    for (int k = 0; k < count; ++k) {
        const L u = lane<L>(c.points[k].lever[0], c.at), w = lane<L>(c.points[k].lever[1], c.at);
        const L there = moved.x + u * moved.y + w * moved.z;
        total[k] = aims[k].impulse - (alone[k] + stiff[k] * there);
        smallest = min(smallest, total[k]);
        const L more = total[k] - aims[k].impulse;
        by = by + V3<L>{more, u * more, w * more};
    }
    // On needles the soft direction may drown in rounding: such an answer, or one that is no
    // number, is not taken.
    const L doubt = max(by.x - p.x, p.x - by.x) - max(p.x, -p.x) * L(Real(1e-3));
    const auto all = select(smallest < zero, one, doubt) < L(Real(1e-30));
    for (int k = 0; k < count; ++k) aims[k].impulse = select(all, total[k], aims[k].impulse);
    const auto add = [&](L& to, L more) { to += select(all, more, zero); };
    add(c.given.n, by.x);
    add(c.given.w1, by.y);
    add(c.given.w2, by.z);
    add(c.rel.n, dot(k_n, by));
    add(c.rel.w1, dot(k_1, by));
    add(c.rel.w2, dot(k_2, by));
}

// The friction mass of W contacts as they keep it.
template <class L>
FrictionMass<L> friction_mass(const ContactBlock<typename L::Number>& block, int at)
{
    return {lane<L>(block.friction_mass[0], at), lane<L>(block.friction_mass[1], at),
            lane<L>(block.friction_mass[2], at), lane<L>(block.sliding_mass, at),
            lane<L>(block.sliding_answer, at)};
}

// Friction within a round cone of radius `reach`, at a place that slides by (slip_1, slip_2).
// Sticking is tried with the full 2x2 mass; what leaves the cone slides, straight against the
// velocity whatever the shape of the bodies.
template <class L>
struct Grip {
    L impulse_1, impulse_2;
};
template <class L>
Grip<L> grip_in_cone(const FrictionMass<L>& mass, const Grip<L>& old, L slip_1, L slip_2, L reach)
{
    using Real = typename L::Number;
    const L stick_1 = old.impulse_1 - (mass.m11 * slip_1 + mass.m12 * slip_2);
    const L stick_2 = old.impulse_2 - (mass.m12 * slip_1 + mass.m22 * slip_2);
    // Compared as speeds: squares of impulses leave float where bodies are huge or tiny.
    const L limit = reach * mass.sliding_answer;
    const L try_1 = stick_1 * mass.sliding_answer, try_2 = stick_2 * mass.sliding_answer;
    const auto slides = try_1 * try_1 + try_2 * try_2 > limit * limit;

    const L slide_1 = old.impulse_1 * mass.sliding_answer - slip_1;
    const L slide_2 = old.impulse_2 * mass.sliding_answer - slip_2;
    const L length = sqrt(slide_1 * slide_1 + slide_2 * slide_2);
    const L shrink = mass.sliding_mass
        * select(length > limit, limit / select(length > L(Real(0)), length, L(Real(1))),
                 L(Real(1)));
    return {select(slides, slide_1 * shrink, stick_1), select(slides, slide_2 * shrink, stick_2)};
}

// Friction about the normal, for contacts of several points: its impulse, from the old one.
template <class L, bool turns>
L twist_within(const Contacts<L, turns>& c, L old, L most)
{
    const L wanted = old - lane<L>(c.block.twist_mass, c.at) * c.rel.wn;
    return max(min(wanted, most), -most);
}

// The same of what the contact holds. Returns the change.
template <class L, bool turns>
L hold_twist(Contacts<L, turns>& c, L most)
{
    const L old = lane<L>(c.block.twist_impulse, c.at);
    const L total = twist_within(c, old, most);
    total.store(c.block.twist_impulse.at + c.at);
    return total - old;
}

// Friction against rolling and spinning, about tangent, other and normal: its impulse, from the old
// one.
template <class L, bool turns>
V3<L> rolling_within(const Contacts<L, turns>& c,
                     const RollingRows<typename L::Number>& rolling,
                     const V3<L>& old,
                     L load)
{
    using Real = typename L::Number;
    const L most = lane<L>(rolling.rolling, c.at) * load;
    const L mass = lane<L>(rolling.mass, c.at);
    const V3<L> wanted = old - V3<L>{c.rel.w1, c.rel.w2, c.rel.wn} * mass;
    // In units of its greatest part: squares leave float where bodies are huge or tiny.
    const L greatest =
        max(max(max(wanted.x, -wanted.x), max(wanted.y, -wanted.y)), max(wanted.z, -wanted.z));
    const V3<L> parts = wanted * (L(Real(1)) / select(greatest > L(Real(0)), greatest, L(Real(1))));
    const L length = greatest * sqrt(dot(parts, parts));
    const L shrink =
        select(length > most, most / select(length > L(Real(0)), length, L(Real(1))), L(Real(1)));
    return wanted * shrink;
}

// The same of what the contact holds. Returns the change.
template <class L, bool turns>
V3<L> resist_rolling(Contacts<L, turns>& c, RollingRows<typename L::Number>& rolling, L load)
{
    const V3<L> old = lane3<L>(rolling.impulse, c.at);
    const V3<L> total = rolling_within(c, rolling, old, load);
    store3(total, rolling.impulse, c.at);
    return total - old;
}

// What the points did to the other three numbers.
template <class L>
void settle_slip(Contacts<L, true>& c)
{
    const auto spin_by = [&](int velocity) {
        return c.spin_answer(0, velocity) * c.given.w1 + c.spin_answer(1, velocity) * c.given.w2;
    };
    c.rel.v1 += c.answer(response::n1) * c.given.n + spin_by(1);
    c.rel.v2 += c.answer(response::n2) * c.given.n + spin_by(2);
    const L w1n = c.answer(response::w1n), w2n = c.answer(response::w2n);
    c.rel.wn += c.spin_answer(2, 0) * c.given.n + w1n * c.given.w1 + w2n * c.given.w2;
}

// What resisting to roll does to all, but for what it does about the normal to v1 and v2: that
// counts the whole of given.wn, later.
template <class L>
void give_turn(Contacts<L, true>& c, const V3<L>& by)
{
    const L wnn = c.answer(response::wnn), w1n = c.answer(response::w1n);
    const L w2n = c.answer(response::w2n), w12 = c.answer(response::w12);
    c.given.w1 += by.x;
    c.given.w2 += by.y;
    c.given.wn += by.z;
    c.rel.w1 += c.answer(response::w11) * by.x + w12 * by.y;
    c.rel.w2 += w12 * by.x + c.answer(response::w22) * by.y;
    c.rel.wn += w1n * by.x + w2n * by.y + wnn * by.z;
    c.rel.n += c.spin_answer(0, 0) * by.x + c.spin_answer(1, 0) * by.y;
    c.rel.v1 += c.spin_answer(0, 1) * by.x + c.spin_answer(1, 1) * by.y;
    c.rel.v2 += c.spin_answer(0, 2) * by.x + c.spin_answer(1, 2) * by.y;
}

// What friction did to the speeds of the points.
template <class L>
void tell_points(Contacts<L, true>& c)
{
    const L w1n = c.answer(response::w1n), w2n = c.answer(response::w2n);
    const L f1 = c.given.v1, f2 = c.given.v2, twist = c.given.wn;
    c.rel.n +=
        c.answer(response::n1) * f1 + c.answer(response::n2) * f2 + c.spin_answer(2, 0) * twist;
    c.rel.w1 += c.spin_answer(0, 1) * f1 + c.spin_answer(0, 2) * f2 + w1n * twist;
    c.rel.w2 += c.spin_answer(1, 1) * f1 + c.spin_answer(1, 2) * f2 + w2n * twist;
}

// The load that the points bear, and its lever about the normal.
template <class L, bool turns, int most>
void weigh(const Contacts<L, turns>& c, const Aim<L> (&aims)[most], L& load, L& lever)
{
    using Real = typename L::Number;
    load = lever = Real(0);
    const int count = most == 1 ? 1 : c.block.points;
    for (int k = 0; k < count; ++k) {
        load += aims[k].impulse;
        if constexpr (turns && most > 1)
            lever += aims[k].impulse * lane<L>(c.points[k].reach, c.at);
    }
}

// Gives what the points hold, as a visit left it.
template <class L, bool turns>
void give_points(Contacts<L, turns>& c)
{
    for (int k = 0; k < c.block.points; ++k) {
        const auto& point = c.points[k];
        const L impulse = lane<L>(point.impulse, c.at);
        c.given.n += impulse;
        if constexpr (turns) {
            c.given.w1 += lane<L>(point.lever[0], c.at) * impulse;
            c.given.w2 += lane<L>(point.lever[1], c.at) * impulse;
        }
    }
}

// The same of what resists rolling.
template <class L>
void give_rolling(Contacts<L, true>& c, const RollingRows<typename L::Number>& rolling)
{
    const V3<L> held = lane3<L>(rolling.impulse, c.at);
    c.given.w1 += held.x;
    c.given.w2 += held.y;
    c.given.wn += held.z;
}

// The impulses of the points as a visit leaves them.
template <class L, bool turns, int most>
void keep_impulses(Contacts<L, turns>& c, const Aim<L> (&aims)[most])
{
    const int count = most == 1 ? 1 : c.block.points;
    for (int k = 0; k < count; ++k) aims[k].impulse.store(c.points[k].impulse.at + c.at);
}

}  // namespace throng::THRONG_LANES
