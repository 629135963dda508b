// One visit of the solver, written once over the width of the machine's registers.
#include "kernels/solve/sweep.hpp"

#include "kernels/solve/contact_lanes.hpp"

namespace throng::THRONG_LANES {

namespace {

// One point: towards the wanted normal speed, then refuse to pull. Returns the total impulse.
template <class L, bool turns>
L push_point(Contacts<L, turns>& c, PointRows<typename L::Number>& point, L bias, L leak)
{
    using Real = typename L::Number;
    const V3<L> arm_a = lane3<L>(point.from_a, c.at);
    const V3<L> arm_b = lane3<L>(point.from_b, c.at);
    const L speed = dot(c.normal, c.b.at(arm_b) - c.a.at(arm_a));
    const L old = lane<L>(point.impulse, c.at);
    const L change =
        -(lane<L>(point.mass, c.at) * (L(Real(1)) - leak) * (speed + bias)) - leak * old;
    const L total = max(old + change, L(Real(0)));
    total.store(point.impulse.at + c.at);
    c.push(c.normal * (total - old), arm_a, arm_b);
    return total;
}

// How much deeper a contact may be that three or four points carry before it turns rigid.
constexpr int kShared = 3;

// What each point of a visit aims at.
template <class L>
struct Aims {
    L bias[4], leak[4];
};

template <class L, bool turns>
Aims<L> aims_of(const Contacts<L, turns>& c,
                const SolverBody<typename L::Number>* bodies,
                const Visit<typename L::Number>& visit)
{
    using Real = typename L::Number;
    Aims<L> aims;
    const Drift<L, turns> drift_a(bodies, c.block.a + c.at);
    const Drift<L, turns> drift_b(bodies, c.block.b + c.at);
    const L zero = Real(0), one = Real(1);
    const L limit = -visit.push_limit;
    // A round side is the same however it turns: only what lies within it turns with the body.
    const V3<L> round_a = c.normal * lane<L>(c.block.round_a, c.at);
    const V3<L> round_b = c.normal * lane<L>(c.block.round_b, c.at);
    L separation[4], loaded = zero;
    for (int k = 0; k < c.block.points; ++k) {
        const PointRows<Real>& point = c.block.point[k];
        const V3<L> apart = drift_b.of(lane3<L>(point.from_b, c.at) + round_b)
            - drift_a.of(lane3<L>(point.from_a, c.at) - round_a);
        separation[k] = dot(c.normal, apart) + lane<L>(point.gap, c.at);
        // A point that this contact has not got, but another of the block has, bears nothing.
        const L there = select(lane<L>(point.mass, c.at) > zero, one, zero);
        loaded += select(separation[k] < zero, there, zero);
    }
    // Three points or four share a load well; one or two may be a corner that carries everything.
    const L eased = select(loaded > L(Real(2.5)), L(Real(1) / Real(kShared)), one);
    for (int k = 0; k < c.block.points; ++k) {
        // Apart: let it close, but no further. Overlapping: a soft spring, within the push limit.
        const auto open = separation[k] > zero;
        const L closing = separation[k] * L(visit.inverse_substep);
        if (visit.push) {
            const L soft = max(lane<L>(c.block.bias_rate, c.at) * separation[k], limit);
            aims.bias[k] = select(open, closing, soft);
            // A corner under a heavy load would sink without end: from `deep` on its spring leaks
            // less, and at twice that not at all.
            const L depth = -separation[k] * lane<L>(c.block.inverse_deep, c.at) * eased;
            const L soft_share = max(min(L(Real(2)) - depth, one), zero);
            aims.leak[k] = select(open, zero, lane<L>(c.block.impulse_scale, c.at) * soft_share);
        } else {
            aims.bias[k] = select(open, closing, zero);
            aims.leak[k] = zero;
        }
    }
    return aims;
}

template <class L, bool turns>
void push_points(Contacts<L, turns>& c, const Aims<L>& aims)
{
    for (int k = 0; k < c.block.points; ++k) {
        auto& point = c.block.point[k];
        const L total = push_point(c, point, aims.bias[k], aims.leak[k]);
        max(total, lane<L>(point.greatest, c.at)).store(point.greatest.at + c.at);
    }
}

// Friction at the middle of the points. Sticking is tried with the full 2x2 mass; what leaves the
// cone slides, straight against the velocity whatever the shape of the bodies.
template <class L, bool turns>
void grip(Contacts<L, turns>& c, L reach)
{
    using Real = typename L::Number;
    ContactBlock<Real>& block = c.block;
    const V3<L> arm_a = lane3<L>(block.center_a, c.at);
    const V3<L> arm_b = lane3<L>(block.center_b, c.at);
    const V3<L> tangent = lane3<L>(block.tangent, c.at);
    const V3<L> other = cross(c.normal, tangent);
    const V3<L> slip = c.b.at(arm_b) - c.a.at(arm_a);
    const L slip_1 = dot(tangent, slip), slip_2 = dot(other, slip);
    const L old_1 = lane<L>(block.friction_impulse[0], c.at);
    const L old_2 = lane<L>(block.friction_impulse[1], c.at);

    const L m11 = lane<L>(block.friction_mass[0], c.at);
    const L m22 = lane<L>(block.friction_mass[1], c.at);
    const L m12 = lane<L>(block.friction_mass[2], c.at);
    const L stick_1 = old_1 - (m11 * slip_1 + m12 * slip_2);
    const L stick_2 = old_2 - (m12 * slip_1 + m22 * slip_2);
    // Compared as speeds: squares of impulses leave float where bodies are huge or tiny.
    const L answer = lane<L>(block.sliding_answer, c.at);
    const L limit = reach * answer;
    const L try_1 = stick_1 * answer, try_2 = stick_2 * answer;
    const auto slides = try_1 * try_1 + try_2 * try_2 > limit * limit;

    const L slide_1 = old_1 * answer - slip_1;
    const L slide_2 = old_2 * answer - slip_2;
    const L length = sqrt(slide_1 * slide_1 + slide_2 * slide_2);
    const L shrink = lane<L>(block.sliding_mass, c.at)
        * select(length > limit, limit / select(length > L(Real(0)), length, L(Real(1))),
                 L(Real(1)));
    const L new_1 = select(slides, slide_1 * shrink, stick_1);
    const L new_2 = select(slides, slide_2 * shrink, stick_2);
    new_1.store(block.friction_impulse[0].at + c.at);
    new_2.store(block.friction_impulse[1].at + c.at);
    c.push(tangent * (new_1 - old_1) + other * (new_2 - old_2), arm_a, arm_b);
}

// Friction about the normal, for contacts of several points.
template <class L, bool turns>
void hold_twist(Contacts<L, turns>& c, L most)
{
    const L speed = dot(c.normal, c.b.spin - c.a.spin);
    const L old = lane<L>(c.block.twist_impulse, c.at);
    const L wanted = old - lane<L>(c.block.twist_mass, c.at) * speed;
    const L total = max(min(wanted, most), -most);
    total.store(c.block.twist_impulse.at + c.at);
    c.twist(c.normal * (total - old));
}

template <class L, bool turns>
void resist_rolling(Contacts<L, turns>& c, L most)
{
    using Real = typename L::Number;
    const V3<L> old = lane3<L>(c.block.rolling_impulse, c.at);
    const L mass = lane<L>(c.block.rolling_mass, c.at);
    const V3<L> wanted = old - (c.b.spin - c.a.spin) * mass;
    // In units of its greatest part: squares leave float where bodies are huge or tiny.
    const L greatest =
        max(max(max(wanted.x, -wanted.x), max(wanted.y, -wanted.y)), max(wanted.z, -wanted.z));
    const V3<L> parts = wanted * (L(Real(1)) / select(greatest > L(Real(0)), greatest, L(Real(1))));
    const L length = greatest * sqrt(dot(parts, parts));
    const L shrink =
        select(length > most, most / select(length > L(Real(0)), length, L(Real(1))), L(Real(1)));
    const V3<L> total = wanted * shrink;
    total.x.store(c.block.rolling_impulse[0].at + c.at);
    total.y.store(c.block.rolling_impulse[1].at + c.at);
    total.z.store(c.block.rolling_impulse[2].at + c.at);
    c.twist(total - old);
}

template <class L, bool turns>
void sweep_lanes(ContactBlock<typename L::Number>& block,
                 int at,
                 SolverBody<typename L::Number>* bodies,
                 const Visit<typename L::Number>& visit)
{
    using Real = typename L::Number;
    Contacts<L, turns> c(block, at, bodies);
    const Aims<L> aims = aims_of(c, bodies, visit);
    for (int sweep = 1; sweep < visit.normal_sweeps; ++sweep) push_points(c, aims);
    if (visit.grips) {
        L total = Real(0), lever = Real(0);
        for (int k = 0; k < block.points; ++k) {
            const L impulse = lane<L>(block.point[k].impulse, at);
            total += impulse;
            lever += impulse * lane<L>(block.reach[k], at);
        }
        const L friction = lane<L>(block.friction, at);
        if constexpr (turns) {
            if (visit.rolls) resist_rolling(c, lane<L>(block.rolling, at) * total);
            if (block.points > 1) hold_twist(c, friction * lever);
        }
        grip(c, friction * total);
    }
    // Last, so that whatever friction did to the normal speeds is put right.
    push_points(c, aims);
    c.write(bodies);
}

template <class L, bool turns>
void warm_start_lanes(ContactBlock<typename L::Number>& block,
                      int at,
                      SolverBody<typename L::Number>* bodies,
                      const Visit<typename L::Number>& visit)
{
    Contacts<L, turns> c(block, at, bodies);
    for (int k = 0; k < block.points; ++k) {
        const auto& point = block.point[k];
        c.push(c.normal * lane<L>(point.impulse, at), lane3<L>(point.from_a, at),
               lane3<L>(point.from_b, at));
    }
    if (visit.grips) {
        const V3<L> tangent = lane3<L>(block.tangent, at);
        c.push(tangent * lane<L>(block.friction_impulse[0], at)
                   + cross(c.normal, tangent) * lane<L>(block.friction_impulse[1], at),
               lane3<L>(block.center_a, at), lane3<L>(block.center_b, at));
        c.twist(c.normal * lane<L>(block.twist_impulse, at));
        if (visit.rolls) c.twist(lane3<L>(block.rolling_impulse, at));
    }
    c.write(bodies);
}

template <class L, bool turns>
void restitute_lanes(ContactBlock<typename L::Number>& block,
                     int at,
                     SolverBody<typename L::Number>* bodies,
                     typename L::Number threshold)
{
    using Real = typename L::Number;
    const L zero = Real(0);
    Contacts<L, turns> c(block, at, bodies);
    const L bounce = lane<L>(block.restitution, at);
    for (int k = 0; k < block.points; ++k) {
        PointRows<Real>& point = block.point[k];
        const L approach = lane<L>(point.approach, at);
        // Only what came in fast and did touch; the others keep what the solver gave them.
        const L fast = select(approach < L(-threshold), L(Real(1)), zero);
        const L bounces = select(lane<L>(point.greatest, at) > zero, fast, zero) * bounce;
        const V3<L> arm_a = lane3<L>(point.from_a, at), arm_b = lane3<L>(point.from_b, at);
        const L speed = dot(c.normal, c.b.at(arm_b) - c.a.at(arm_a));
        const L old = lane<L>(point.impulse, at);
        const L wanted = old - lane<L>(point.mass, at) * (speed + bounce * approach);
        const L total = select(bounces > zero, max(wanted, zero), old);
        total.store(point.impulse.at + at);
        max(total, lane<L>(point.greatest, at)).store(point.greatest.at + at);
        c.push(c.normal * (total - old), arm_a, arm_b);
    }
    c.write(bodies);
}

template <bool value>
struct Flag {
    static constexpr bool kValue = value;
};

// Calls body(turns, block, first lane) for each group of lanes of the blocks.
template <class Real, class Body>
void for_lanes(ContactBlock<Real>* blocks, std::size_t count, bool turns, Body body)
{
    for (std::size_t i = 0; i < count; ++i)
        for (int at = 0; at < kBlock; at += Lanes<Real>::kWidth)
            if (turns)
                body(Flag<true>{}, blocks[i], at);
            else
                body(Flag<false>{}, blocks[i], at);
}

template <class Real>
void warm_start(ContactBlock<Real>* blocks,
                std::size_t count,
                SolverBody<Real>* bodies,
                const Visit<Real>& visit)
{
    for_lanes(blocks, count, visit.turns, [&](auto turns, ContactBlock<Real>& block, int at) {
        warm_start_lanes<Lanes<Real>, turns.kValue>(block, at, bodies, visit);
    });
}

template <class Real>
void sweep(ContactBlock<Real>* blocks,
           std::size_t count,
           SolverBody<Real>* bodies,
           const Visit<Real>& visit)
{
    for_lanes(blocks, count, visit.turns, [&](auto turns, ContactBlock<Real>& block, int at) {
        sweep_lanes<Lanes<Real>, turns.kValue>(block, at, bodies, visit);
    });
}

template <class Real>
void restitute(ContactBlock<Real>* blocks,
               std::size_t count,
               SolverBody<Real>* bodies,
               Real threshold,
               const Visit<Real>& visit)
{
    for_lanes(blocks, count, visit.turns, [&](auto turns, ContactBlock<Real>& block, int at) {
        restitute_lanes<Lanes<Real>, turns.kValue>(block, at, bodies, threshold);
    });
}

template <class Real>
constexpr SolveKernels<Real> table()
{
    return {THRONG_LANES_NAME, Lanes<Real>::kWidth, warm_start<Real>, sweep<Real>, restitute<Real>};
}

}  // namespace

extern const SolveKernels<float> kSolveFloat;
extern const SolveKernels<double> kSolveDouble;
const SolveKernels<float> kSolveFloat = table<float>();
const SolveKernels<double> kSolveDouble = table<double>();

}  // namespace throng::THRONG_LANES
