// One visit of the solver, written once over the width of the machine's registers: friction at the
// middle of a contact's points, in a round cone. For the other choices see grip_lanes.cpp.
#include "kernels/solver/impact_lanes.hpp"

namespace throng::THRONG_LANES {

namespace {

// Friction at the middle of the points.
template <class L, bool turns>
void grip(Contacts<L, turns>& c, L reach)
{
    using Real = typename L::Number;
    ContactBlock<Real>& block = c.block;
    const FrictionMass<L> mass = friction_mass<L>(block, c.at);
    const Grip<L> old{lane<L>(block.friction_impulse[0], c.at),
                      lane<L>(block.friction_impulse[1], c.at)};
    const Grip<L> held = grip_in_cone(mass, old, c.rel.v1, c.rel.v2, reach);
    held.impulse_1.store(block.friction_impulse[0].at + c.at);
    held.impulse_2.store(block.friction_impulse[1].at + c.at);
    c.given.v1 += held.impulse_1 - old.impulse_1;
    c.given.v2 += held.impulse_2 - old.impulse_2;
}

// Friction of contacts that stand on one point: the three velocities are all there is.
template <class L, bool turns>
void hold_point(Contacts<L, turns>& c, L load)
{
    c.rel.v1 += c.answer(response::n1) * c.given.n;
    c.rel.v2 += c.answer(response::n2) * c.given.n;
    grip(c, lane<L>(c.block.friction, c.at) * load);
    if constexpr (turns)
        c.rel.n += c.answer(response::n1) * c.given.v1 + c.answer(response::n2) * c.given.v2;
}

// Friction of contacts of several points, or that roll.
template <class L>
void hold_points(Contacts<L, true>& c, RollingRows<typename L::Number>* rolling, L load, L lever)
{
    settle_slip(c);
    if (rolling != nullptr) give_turn(c, resist_rolling(c, *rolling, load));
    const L friction = lane<L>(c.block.friction, c.at);
    if (c.block.points > 1) c.given.wn += hold_twist(c, friction * lever);
    c.rel.v1 += c.spin_answer(2, 1) * c.given.wn;
    c.rel.v2 += c.spin_answer(2, 2) * c.given.wn;
    grip(c, friction * load);
    tell_points(c);
}

template <class L, bool turns, int most>
[[gnu::flatten]] void sweep_lanes(const RowsView<typename L::Number>& rows,
                                  std::size_t place,
                                  int at,
                                  const Visit<typename L::Number>& visit)
{
    Contacts<L, turns> c(rows, place, at);
    Aim<L> aims[most];
    take_aim(c, rows.bodies, visit, aims);
    if (rows.carries != nullptr) slide_along(c, rows.carries[place]);
    if (rows.bounces != nullptr && !visit.push)
        leave_to_impact(c, rows.bounces[place], visit, aims);
    if constexpr (turns && most > 1) push_together(c, aims);
    for (int sweep = 1; sweep < visit.normal_sweeps; ++sweep) push_points(c, aims);
    if (visit.grips) {
        L load, lever;
        weigh(c, aims, load, lever);
        if constexpr (turns && most > 1)
            hold_points(c, visit.rolls ? rows.rollings + place : nullptr, load, lever);
        else
            hold_point(c, load);
    }
    // Last, so that whatever friction did to the normal speeds is put right.
    push_points(c, aims);
    keep_impulses(c, aims);
    c.write(rows.bodies);
}

template <class L, bool turns>
[[gnu::flatten]] void warm_start_lanes(const RowsView<typename L::Number>& rows,
                                       std::size_t place,
                                       int at,
                                       const Visit<typename L::Number>& visit)
{
    Contacts<L, turns> c(rows, place, at);
    give_points(c);
    if (visit.grips) {
        c.given.v1 = lane<L>(c.block.friction_impulse[0], at);
        c.given.v2 = lane<L>(c.block.friction_impulse[1], at);
        if constexpr (turns) {
            c.given.wn = lane<L>(c.block.twist_impulse, at);
            if (visit.rolls) give_rolling(c, rows.rollings[place]);
        }
    }
    c.write(rows.bodies);
}

// Friction in an impact, within the cone of its load: beside what the contact holds at rest.
template <class L, bool turns>
void slide(Contacts<L, turns>& c, L reach)
{
    const L zero = typename L::Number(0);
    const Grip<L> held = grip_in_cone(friction_mass<L>(c.block, c.at), Grip<L>{zero, zero},
                                      c.rel.v1, c.rel.v2, reach);
    c.given.v1 += held.impulse_1;
    c.given.v2 += held.impulse_2;
}

template <class L, bool turns>
void slide_point(Contacts<L, turns>& c, const Strike<L>& strike)
{
    c.rel.v1 += c.answer(response::n1) * c.given.n;
    c.rel.v2 += c.answer(response::n2) * c.given.n;
    slide(c, lane<L>(c.block.friction, c.at) * strike.load);
}

template <class L>
void slide_points(Contacts<L, true>& c,
                  const RollingRows<typename L::Number>* rolling,
                  const Strike<L>& strike)
{
    const L zero = typename L::Number(0), friction = lane<L>(c.block.friction, c.at);
    settle_slip(c);
    if (rolling != nullptr)
        give_turn(c, rolling_within(c, *rolling, V3<L>{zero, zero, zero}, strike.load));
    if (c.block.points > 1) c.given.wn += twist_within(c, zero, friction * strike.lever);
    c.rel.v1 += c.spin_answer(2, 1) * c.given.wn;
    c.rel.v2 += c.spin_answer(2, 2) * c.given.wn;
    slide(c, friction * strike.load);
}

template <class L, bool turns>
[[gnu::flatten]] bool bounce_lanes(const RowsView<typename L::Number>& rows,
                                   std::size_t place,
                                   int at,
                                   const Visit<typename L::Number>& visit)
{
    Contacts<L, turns> c(rows, place, at);
    Strike<L> strike;
    find_strike(c, rows, rows.bounces[place], visit, strike);
    if (strike.lanes == 0) return false;
    const bool spins = c.block.points > 1 || visit.rolls;
    reflect(c, rows.bounces[place], spins, strike);
    if (visit.grips) {
        if constexpr (turns) {
            if (spins)
                slide_points(c, visit.rolls ? rows.rollings + place : nullptr, strike);
            else
                slide_point(c, strike);
        } else {
            slide_point(c, strike);
        }
    }
    give_strike(c, rows, rows.bounces[place], strike);
    return strike.lasts;
}

template <bool value>
struct Flag {
    static constexpr bool kValue = value;
};

// Calls body(turns, place, first lane) for each group of lanes of the blocks.
template <class Real, class Body>
void for_lanes(std::size_t begin, std::size_t end, bool turns, Body body)
{
    for (std::size_t place = begin; place < end; ++place)
        for (int at = 0; at < kBlock; at += Lanes<Real>::kWidth)
            if (turns)
                body(Flag<true>{}, place, at);
            else
                body(Flag<false>{}, place, at);
}

template <class Real>
void warm_start(const RowsView<Real>& rows,
                std::size_t begin,
                std::size_t end,
                const Visit<Real>& visit)
{
    for_lanes<Real>(begin, end, visit.turns, [&](auto turns, std::size_t place, int at) {
        warm_start_lanes<Lanes<Real>, turns.kValue>(rows, place, at, visit);
    });
}

// Asks for the bodies of a block before it is its turn: they lie anywhere, so the machine cannot
// foresee them as it does the rows.
template <class Real>
void fetch_bodies(const RowsView<Real>& rows, std::size_t place)
{
    const ContactBlock<Real>& block = rows.blocks[place];
    for (const auto& side : {block.a, block.b})
        for (int k = 0; k < kBlock; ++k) {
            __builtin_prefetch(rows.bodies[side[k]].motion);
            __builtin_prefetch(rows.bodies[side[k]].inertia);
        }
}

template <class Real>
void sweep(const RowsView<Real>& rows, std::size_t begin, std::size_t end, const Visit<Real>& visit)
{
    for_lanes<Real>(begin, end, visit.turns, [&](auto turns, std::size_t place, int at) {
        if (at == 0 && place + 1 < end) fetch_bodies(rows, place + 1);
        if (rows.blocks[place].points == 1 && !visit.rolls)
            sweep_lanes<Lanes<Real>, turns.kValue, 1>(rows, place, at, visit);
        else
            sweep_lanes<Lanes<Real>, turns.kValue, 4>(rows, place, at, visit);
    });
}

template <class Real>
bool bounce(const RowsView<Real>& rows,
            std::size_t begin,
            std::size_t end,
            const Visit<Real>& visit)
{
    bool any = false;
    for_lanes<Real>(begin, end, visit.turns, [&](auto turns, std::size_t place, int at) {
        any |= bounce_lanes<Lanes<Real>, turns.kValue>(rows, place, at, visit);
    });
    return any;
}

template <class Real>
constexpr SolveKernels<Real> table()
{
    return {THRONG_LANES_NAME,
            Lanes<Real>::kWidth,
            prepare<Real>,
            warm_start<Real>,
            carry<Real>,
            walk<Real>,
            sweep<Real>,
            bounce<Real>,
            begin_substep<Real>,
            advance<Real>,
            warm_start_grips<Real>,
            sweep_grips<Real>,
            bounce_grips<Real>};
}

}  // namespace

extern const SolveKernels<float> kSolveFloat;
extern const SolveKernels<double> kSolveDouble;
const SolveKernels<float> kSolveFloat = table<float>();
const SolveKernels<double> kSolveDouble = table<double>();

}  // namespace throng::THRONG_LANES
