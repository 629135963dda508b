// An iteration of the solver with friction of another kind than the usual: at every point of a
// contact, within a pyramid, or both. Written once over the width of the machine's registers.
//
// At a point the speeds are v1 - lever_arm[0] wn and v2 - lever_arm[1] wn (see ContactPointWide),
// and an impulse has that torque about the normal: friction at points needs no twist of its own. A
// contact keeps what its points add up to, so that steps with and without hand one another the same
// impulses.
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
L clamped(L x, L friction_limit)
{
    return max(min(x, friction_limit), -friction_limit);
}

// The impulse seen from the sides, cut to the pyramid, and seen from the tangents again.
template <class L>
FrictionImpulse<L> within(const Sides<L>& sides, L side, L across_it, L friction_limit)
{
    const L p = clamped(side, friction_limit), q = clamped(across_it, friction_limit);
    return {sides.cos * p - sides.sin * q, sides.sin * p + sides.cos * q};
}

template <class L>
FrictionImpulse<L>
cut_to_pyramid(const Sides<L>& sides, const FrictionImpulse<L>& held, L friction_limit)
{
    return within(sides, sides.cos * held.impulse_1 + sides.sin * held.impulse_2,
                  sides.cos * held.impulse_2 - sides.sin * held.impulse_1, friction_limit);
}

template <class L>
FrictionImpulse<L> cut_to_cone(const FrictionImpulse<L>& held, L friction_limit)
{
    using Real = typename L::Number;
    // In units of the reach: squares leave float where bodies are huge or tiny.
    const L unit = inverse_or_zero(friction_limit), one = Real(1);
    const L x = held.impulse_1 * unit, y = held.impulse_2 * unit;
    const L length = sqrt(x * x + y * y);
    const L shrink =
        friction_limit * select(length > one, one / select(length > one, length, one), one);
    return {x * shrink, y * shrink};
}

// Friction within a pyramid, at a place that slides by (slip_1, slip_2). Sticking is tried with the
// full matrix; what leaves the pyramid slides along one side after the other.
template <class L>
FrictionImpulse<L> solve_friction_pyramid(const Sides<L>& sides,
                                          const Square<L>& k,
                                          const FrictionImpulse<L>& old,
                                          L slip_1,
                                          L slip_2,
                                          L friction_limit)
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
    const auto slides = max(max(stick_p, -stick_p), max(stick_q, -stick_q)) > friction_limit;

    const L slide_p = clamped(held_p - slip_p * inverse_or_zero(k_pp), friction_limit);
    const L then_q = slip_q + k_pq * (slide_p - held_p);
    const L slide_q = clamped(held_q - then_q * inverse_or_zero(k_qq), friction_limit);
    return within(sides, select(slides, slide_p, stick_p), select(slides, slide_q, stick_q),
                  friction_limit);
}

// Friction of one kind or the other, at a place of matrix k.
template <class L>
FrictionImpulse<L> solve_friction_at(const Sides<L>* pyramid,
                                     const Square<L>& k,
                                     const FrictionImpulse<L>& old,
                                     L slip_1,
                                     L slip_2,
                                     L friction_limit)
{
    if (pyramid != nullptr)
        return solve_friction_pyramid(*pyramid, k, old, slip_1, slip_2, friction_limit);
    return solve_friction_cone(FrictionMass<L>::of(k.m11, k.m22, k.m12), old, slip_1, slip_2,
                               friction_limit);
}

// What an impulse (1, 2) and its torque about the normal do to (v1, v2, wn), and that they were
// given.
template <class L>
void give(Contacts<L, true>& c, L by_1, L by_2, L torsional_impulse)
{
    const L k_12 = c.inverse_mass(inverse_mass_entry::v12);
    const L n1 = c.angular_inverse_mass(2, 1), n2 = c.angular_inverse_mass(2, 2);
    c.applied.v1 += by_1;
    c.applied.v2 += by_2;
    c.applied.wn += torsional_impulse;
    c.relative.v1 +=
        c.inverse_mass(inverse_mass_entry::v11) * by_1 + k_12 * by_2 + n1 * torsional_impulse;
    c.relative.v2 +=
        k_12 * by_1 + c.inverse_mass(inverse_mass_entry::v22) * by_2 + n2 * torsional_impulse;
    c.relative.wn +=
        n1 * by_1 + n2 * by_2 + c.inverse_mass(inverse_mass_entry::wnn) * torsional_impulse;
}

// The matrix at the middle (lever arms 0) or at a point.
template <class L>
Square<L> matrix_at(const Contacts<L, true>& c, L u, L w)
{
    const L n1 = c.angular_inverse_mass(2, 1), n2 = c.angular_inverse_mass(2, 2),
            nn = c.inverse_mass(inverse_mass_entry::wnn);
    const L un1 = u * n1, wn2 = w * n2;
    return {c.inverse_mass(inverse_mass_entry::v11) - (un1 + un1) + u * u * nn,
            c.inverse_mass(inverse_mass_entry::v22) - (wn2 + wn2) + w * w * nn,
            c.inverse_mass(inverse_mass_entry::v12) - (w * n1 + u * n2) + u * w * nn};
}

template <class L>
FrictionImpulse<L> kept(const Lane16<typename L::Number> (&impulse)[2], int at)
{
    return {lane<L>(impulse[0], at), lane<L>(impulse[1], at)};
}
template <class L>
void keep(const FrictionImpulse<L>& held, Lane16<typename L::Number> (&impulse)[2], int at)
{
    held.impulse_1.store(impulse[0].at + at);
    held.impulse_2.store(impulse[1].at + at);
}

// What the friction of a contact's points adds up to.
template <class L>
struct Whole {
    FrictionImpulse<L> force = {L(typename L::Number(0)), L(typename L::Number(0))};
    L torsional_impulse = L(typename L::Number(0));

    void add(const FrictionImpulse<L>& held, L u, L w)
    {
        force.impulse_1 += held.impulse_1;
        force.impulse_2 += held.impulse_2;
        torsional_impulse += -(u * held.impulse_1 + w * held.impulse_2);
    }
};

// Friction at the middle of the points, and about the normal.
template <class L>
void solve_center_friction(Contacts<L, true>& c, const Sides<L>* pyramid, L load, L torsional_load)
{
    using Real = typename L::Number;
    const L zero = Real(0), friction = lane<L>(c.block.friction, c.at);
    if (c.block.points > 1)
        give(c, zero, zero, solve_torsional_friction(c, friction * torsional_load));
    const FrictionImpulse<L> old = kept<L>(c.block.friction_impulse, c.at);
    const FrictionImpulse<L> held = solve_friction_at(
        pyramid, matrix_at(c, zero, zero), old, c.relative.v1, c.relative.v2, friction * load);
    keep(held, c.block.friction_impulse, c.at);
    give(c, held.impulse_1 - old.impulse_1, held.impulse_2 - old.impulse_2, zero);
}

// Friction at every point, one after another, each by its own load.
template <class L>
void hold_each(Contacts<L, true>& c,
               PointFrictionWide<typename L::Number>* point_frictions,
               const Sides<L>* pyramid,
               const NormalConstraint<L> (&normals)[4])
{
    const L friction = lane<L>(c.block.friction, c.at);
    Whole<L> whole;
    for (int k = 0; k < c.block.points; ++k) {
        const L u = lane<L>(c.points[k].lever_arm[0], c.at),
                w = lane<L>(c.points[k].lever_arm[1], c.at);
        const FrictionImpulse<L> old = kept<L>(point_frictions[k].impulse, c.at);
        const FrictionImpulse<L> held =
            solve_friction_at(pyramid, matrix_at(c, u, w), old, c.relative.v1 - u * c.relative.wn,
                              c.relative.v2 - w * c.relative.wn, friction * normals[k].impulse);
        keep(held, point_frictions[k].impulse, c.at);
        const L by_1 = held.impulse_1 - old.impulse_1, by_2 = held.impulse_2 - old.impulse_2;
        give(c, by_1, by_2, -(u * by_1 + w * by_2));
        whole.add(held, u, w);
    }
    keep(whole.force, c.block.friction_impulse, c.at);
    whole.torsional_impulse.store(c.block.torsional_impulse.at + c.at);
}

template <class L>
[[gnu::flatten]] void
solve_point_friction_lanes(const ContactConstraintsView<typename L::Number>& constraints,
                           std::size_t place,
                           int at,
                           const SolverIteration<typename L::Number>& iteration)
{
    Contacts<L, true> c(constraints, place, at);
    NormalConstraint<L> normals[4];
    build_normal_constraints(c, constraints.bodies, iteration, normals);
    if (constraints.surface_velocities != nullptr)
        add_surface_velocity(c, constraints.surface_velocities[place]);
    if (constraints.restitutions != nullptr && !iteration.use_bias)
        leave_to_restitution(c, constraints.restitutions[place], iteration, normals);
    solve_normals_as_block(c, normals);
    for (int pass = 1; pass < iteration.normal_iterations; ++pass) solve_normals(c, normals);
    L load, torsional_load;
    sum_normal_impulses(c, normals, load, torsional_load);
    update_slip_velocities(c);
    if (iteration.has_rolling_friction)
        apply_angular_impulse(
            c, solve_rolling_friction(c, constraints.rolling_frictions[place], load));
    // What resisting to spin did besides turning, which update_slip_velocities leaves to what
    // follows it.
    c.relative.v1 += c.angular_inverse_mass(2, 1) * c.applied.wn;
    c.relative.v2 += c.angular_inverse_mass(2, 2) * c.applied.wn;
    const Sides<L> sides = sides_of(c);
    const Sides<L>* const pyramid = iteration.friction_pyramid ? &sides : nullptr;
    if (iteration.friction_at_points)
        hold_each(c, constraints.point_frictions + c.block.first_point, pyramid, normals);
    else
        solve_center_friction(c, pyramid, load, torsional_load);
    update_point_velocities(c);
    solve_normals(c, normals);
    store_normal_impulses(c, normals);
    c.write(constraints.bodies);
}

// Friction in an impact, beside what the contact holds at rest: at every point by its own load, or
// at the middle and about the normal.
template <class L>
void slide(Contacts<L, true>& c,
           const Sides<L>* pyramid,
           bool friction_at_points,
           const ImpactPoints<L>& impact)
{
    const L zero = typename L::Number(0), friction = lane<L>(c.block.friction, c.at);
    const FrictionImpulse<L> none{zero, zero};
    if (!friction_at_points) {
        if (c.block.points > 1)
            give(c, zero, zero,
                 torsional_friction_impulse(c, zero, friction * impact.torsional_load));
        const FrictionImpulse<L> held =
            solve_friction_at(pyramid, matrix_at(c, zero, zero), none, c.relative.v1, c.relative.v2,
                              friction * impact.load);
        return give(c, held.impulse_1, held.impulse_2, zero);
    }
    for (int k = 0; k < c.block.points; ++k) {
        const L u = lane<L>(c.points[k].lever_arm[0], c.at),
                w = lane<L>(c.points[k].lever_arm[1], c.at);
        const FrictionImpulse<L> held =
            solve_friction_at(pyramid, matrix_at(c, u, w), none, c.relative.v1 - u * c.relative.wn,
                              c.relative.v2 - w * c.relative.wn, friction * impact.impulse[k]);
        give(c, held.impulse_1, held.impulse_2, -(u * held.impulse_1 + w * held.impulse_2));
    }
}

template <class L>
[[gnu::flatten]] bool apply_restitution_point_friction_lanes(
    const ContactConstraintsView<typename L::Number>& constraints,
    std::size_t place,
    int at,
    const SolverIteration<typename L::Number>& iteration)
{
    Contacts<L, true> c(constraints, place, at);
    ImpactPoints<L> impact;
    find_impact_points(c, constraints, constraints.restitutions[place], iteration, impact);
    if (impact.lanes == 0) return false;
    reflect(c, constraints.restitutions[place], true, impact);
    const L zero = typename L::Number(0);
    update_slip_velocities(c);
    if (iteration.has_rolling_friction)
        apply_angular_impulse(c,
                              rolling_friction_impulse(c, constraints.rolling_frictions[place],
                                                       V3<L>{zero, zero, zero}, impact.load));
    c.relative.v1 += c.angular_inverse_mass(2, 1) * c.applied.wn;
    c.relative.v2 += c.angular_inverse_mass(2, 2) * c.applied.wn;
    const Sides<L> sides = sides_of(c);
    slide(c, iteration.friction_pyramid ? &sides : nullptr, iteration.friction_at_points, impact);
    apply_impact(c, constraints, constraints.restitutions[place], impact);
    return impact.lasts;
}

// How the friction that a contact holds is shared among its points: each takes its share of the
// load, and turns about where the load's middle is. They add up to the same force and torque.
template <class L>
struct Shares {
    L friction_1, friction_2, middle_u, middle_w, turn;  // of each unit of load
    // Of the contact's extent, squared: closer together than that, no point has a lever arm to turn
    // by.
    static constexpr double kSpread = 1e-3;

    Shares(const Contacts<L, true>& c, const FrictionImpulse<L>& whole, L torsional_impulse)
    {
        using Real = typename L::Number;
        L load = Real(0), u_load = Real(0), w_load = Real(0), spread = Real(0), extent = Real(0);
        const auto at_each = [&](auto what) {
            for (int k = 0; k < c.block.points; ++k)
                what(lane<L>(c.points[k].impulse, c.at), lane<L>(c.points[k].lever_arm[0], c.at),
                     lane<L>(c.points[k].lever_arm[1], c.at));
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
        const L rest = torsional_impulse + middle_u * whole.impulse_1 + middle_w * whole.impulse_2;
        turn = select(spread > load * extent * L(Real(kSpread)), rest * inverse_or_zero(spread),
                      L(Real(0)));
    }
    FrictionImpulse<L> of(L load, L u, L w) const
    {
        return {load * (friction_1 - turn * (u - middle_u)),
                load * (friction_2 - turn * (w - middle_w))};
    }
};

// Returns what the contact holds about the normal.
template <class L>
L start_each(Contacts<L, true>& c,
             PointFrictionWide<typename L::Number>* point_frictions,
             const Sides<L>* pyramid,
             const FrictionImpulse<L>& before)
{
    const L friction = lane<L>(c.block.friction, c.at);
    const Shares<L> shares(c, before, lane<L>(c.block.torsional_impulse, c.at));
    Whole<L> whole;
    for (int k = 0; k < c.block.points; ++k) {
        const L load = lane<L>(c.points[k].impulse, c.at);
        const L u = lane<L>(c.points[k].lever_arm[0], c.at),
                w = lane<L>(c.points[k].lever_arm[1], c.at);
        const FrictionImpulse<L> share = shares.of(load, u, w);
        const FrictionImpulse<L> held = pyramid != nullptr
            ? cut_to_pyramid(*pyramid, share, friction * load)
            : cut_to_cone(share, friction * load);
        keep(held, point_frictions[k].impulse, c.at);
        whole.add(held, u, w);
    }
    keep(whole.force, c.block.friction_impulse, c.at);
    return whole.torsional_impulse;
}

template <class L>
[[gnu::flatten]] void
warm_start_point_friction_lanes(const ContactConstraintsView<typename L::Number>& constraints,
                                std::size_t place,
                                int at,
                                const SolverIteration<typename L::Number>& iteration)
{
    Contacts<L, true> c(constraints, place, at);
    apply_normal_impulses(c);
    const Sides<L> sides = sides_of(c);
    const Sides<L>* const pyramid = iteration.friction_pyramid ? &sides : nullptr;
    const FrictionImpulse<L> whole = kept<L>(c.block.friction_impulse, at);
    L torsional_impulse = lane<L>(c.block.torsional_impulse, at);
    if (iteration.friction_at_points) {
        torsional_impulse =
            start_each(c, constraints.point_frictions + c.block.first_point, pyramid, whole);
        torsional_impulse.store(c.block.torsional_impulse.at + at);
    } else if (pyramid != nullptr) {
        keep(cut_to_pyramid(sides, whole, lane<L>(c.block.friction, at) * c.applied.n),
             c.block.friction_impulse, at);
    }
    const FrictionImpulse<L> held = kept<L>(c.block.friction_impulse, at);
    c.applied.v1 = held.impulse_1;
    c.applied.v2 = held.impulse_2;
    c.applied.wn = torsional_impulse;
    if (iteration.has_rolling_friction)
        apply_rolling_impulses(c, constraints.rolling_frictions[place]);
    c.write(constraints.bodies);
}

}  // namespace

template <class Real>
void warm_start_point_friction(const ContactConstraintsView<Real>& constraints,
                               std::size_t begin,
                               std::size_t end,
                               const SolverIteration<Real>& iteration)
{
    for (std::size_t place = begin; place < end; ++place)
        for (int at = 0; at < kBlock; at += Lanes<Real>::kWidth)
            warm_start_point_friction_lanes<Lanes<Real>>(constraints, place, at, iteration);
}

template <class Real>
void solve_point_friction(const ContactConstraintsView<Real>& constraints,
                          std::size_t begin,
                          std::size_t end,
                          const SolverIteration<Real>& iteration)
{
    for (std::size_t place = begin; place < end; ++place)
        for (int at = 0; at < kBlock; at += Lanes<Real>::kWidth)
            solve_point_friction_lanes<Lanes<Real>>(constraints, place, at, iteration);
}

template <class Real>
bool apply_restitution_point_friction(const ContactConstraintsView<Real>& constraints,
                                      std::size_t begin,
                                      std::size_t end,
                                      const SolverIteration<Real>& iteration)
{
    bool any = false;
    for (std::size_t place = begin; place < end; ++place)
        for (int at = 0; at < kBlock; at += Lanes<Real>::kWidth)
            any |= apply_restitution_point_friction_lanes<Lanes<Real>>(constraints, place, at,
                                                                       iteration);
    return any;
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template bool apply_restitution_point_friction<Real>(const ContactConstraintsView<Real>&,      \
                                                         std::size_t, std::size_t,                 \
                                                         const SolverIteration<Real>&);            \
    template void warm_start_point_friction<Real>(const ContactConstraintsView<Real>&,             \
                                                  std::size_t, std::size_t,                        \
                                                  const SolverIteration<Real>&);                   \
    template void solve_point_friction<Real>(const ContactConstraintsView<Real>&, std::size_t,     \
                                             std::size_t, const SolverIteration<Real>&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng::THRONG_LANES
