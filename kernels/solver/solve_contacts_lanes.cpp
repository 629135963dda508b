// One iteration of the solver, written once over the width of the machine's registers: friction at
// the middle of a contact's points, in a round cone. For the other choices see
// point_friction_lanes.cpp.
#include "kernels/solver/impact_lanes.hpp"

namespace throng::THRONG_LANES {

namespace {

// Friction at the middle of the points.
template <class L, bool turns>
void solve_friction(Contacts<L, turns>& c, L friction_limit)
{
    using Real = typename L::Number;
    ContactConstraintWide<Real>& block = c.block;
    const FrictionMass<L> mass = friction_mass<L>(block, c.at);
    const FrictionImpulse<L> old{lane<L>(block.friction_impulse[0], c.at),
                                 lane<L>(block.friction_impulse[1], c.at)};
    const FrictionImpulse<L> held =
        solve_friction_cone(mass, old, c.relative.v1, c.relative.v2, friction_limit);
    held.impulse_1.store(block.friction_impulse[0].at + c.at);
    held.impulse_2.store(block.friction_impulse[1].at + c.at);
    c.applied.v1 += held.impulse_1 - old.impulse_1;
    c.applied.v2 += held.impulse_2 - old.impulse_2;
}

// What a point did to the slip.
template <class L, bool turns>
void add_applied_normal(Contacts<L, turns>& c)
{
    const L n1 = c.inverse_mass(inverse_mass_entry::n1),
            n2 = c.inverse_mass(inverse_mass_entry::n2);
    c.relative.v1 = mul_add(n1, c.applied.n, c.relative.v1);
    c.relative.v2 = mul_add(n2, c.applied.n, c.relative.v2);
}

// What torsional friction did to it.
template <class L>
void add_applied_torsion(Contacts<L, true>& c)
{
    c.relative.v1 = mul_add(c.angular_inverse_mass(2, 1), c.applied.wn, c.relative.v1);
    c.relative.v2 = mul_add(c.angular_inverse_mass(2, 2), c.applied.wn, c.relative.v2);
}

// Friction of contacts that stand on one point: the three velocities are all there is.
template <class L, bool turns>
void solve_center_friction(Contacts<L, turns>& c, L load)
{
    add_applied_normal(c);
    solve_friction(c, lane<L>(c.block.friction, c.at) * load);
    if constexpr (turns)
        c.relative.n =
            mul_add(c.inverse_mass(inverse_mass_entry::n2), c.applied.v2,
                    mul_add(c.inverse_mass(inverse_mass_entry::n1), c.applied.v1, c.relative.n));
}

// Friction of contacts of several points, or that roll.
template <class L>
void solve_center_friction_with_spin(Contacts<L, true>& c,
                                     RollingFrictionWide<typename L::Number>* rolling,
                                     L load,
                                     L torsional_load)
{
    update_slip_velocities(c);
    if (rolling != nullptr) apply_angular_impulse(c, solve_rolling_friction(c, *rolling, load));
    const L friction = lane<L>(c.block.friction, c.at);
    if (c.block.points > 1) c.applied.wn += solve_torsional_friction(c, friction * torsional_load);
    add_applied_torsion(c);
    solve_friction(c, friction * load);
    update_point_velocities(c);
}

template <class L, bool turns, int most>
[[gnu::flatten]] void solve_lanes(const ContactConstraintsView<typename L::Number>& constraints,
                                  std::size_t place,
                                  int at,
                                  const SolverIteration<typename L::Number>& iteration)
{
    Contacts<L, turns> c(constraints, place, at);
    NormalConstraint<L> normals[most];
    build_normal_constraints(c, constraints.bodies, iteration, normals);
    if (constraints.surface_velocities != nullptr)
        add_surface_velocity(c, constraints.surface_velocities[place]);
    if (constraints.restitutions != nullptr && !iteration.use_bias)
        leave_to_restitution(c, constraints.restitutions[place], iteration, normals);
    if constexpr (turns && most > 1) solve_normals_as_block(c, normals);
    for (int pass = 1; pass < iteration.normal_iterations; ++pass) solve_normals(c, normals);
    if (iteration.has_friction) {
        L load, torsional_load;
        sum_normal_impulses(c, normals, load, torsional_load);
        if constexpr (turns && most > 1)
            solve_center_friction_with_spin(
                c, iteration.has_rolling_friction ? constraints.rolling_frictions + place : nullptr,
                load, torsional_load);
        else
            solve_center_friction(c, load);
    }
    // Last, so that whatever friction did to the normal speeds is put right.
    solve_normals(c, normals);
    store_normal_impulses(c, normals);
    c.write(constraints.bodies);
}

template <class L, bool turns>
[[gnu::flatten]] void
warm_start_lanes(const ContactConstraintsView<typename L::Number>& constraints,
                 std::size_t place,
                 int at,
                 const SolverIteration<typename L::Number>& iteration)
{
    Contacts<L, turns> c(constraints, place, at);
    apply_normal_impulses(c);
    if (iteration.has_friction) {
        c.applied.v1 = lane<L>(c.block.friction_impulse[0], at);
        c.applied.v2 = lane<L>(c.block.friction_impulse[1], at);
        if constexpr (turns) {
            c.applied.wn = lane<L>(c.block.torsional_impulse, at);
            if (iteration.has_rolling_friction)
                apply_rolling_impulses(c, constraints.rolling_frictions[place]);
        }
    }
    c.write(constraints.bodies);
}

// Friction in an impact, within the cone of its load: beside what the contact holds at rest.
template <class L, bool turns>
void slide(Contacts<L, turns>& c, L friction_limit)
{
    const L zero = typename L::Number(0);
    const FrictionImpulse<L> held =
        solve_friction_cone(friction_mass<L>(c.block, c.at), FrictionImpulse<L>{zero, zero},
                            c.relative.v1, c.relative.v2, friction_limit);
    c.applied.v1 += held.impulse_1;
    c.applied.v2 += held.impulse_2;
}

template <class L, bool turns>
void slide_point(Contacts<L, turns>& c, const ImpactPoints<L>& impact)
{
    add_applied_normal(c);
    slide(c, lane<L>(c.block.friction, c.at) * impact.load);
}

template <class L>
void slide_points(Contacts<L, true>& c,
                  const RollingFrictionWide<typename L::Number>* rolling,
                  const ImpactPoints<L>& impact)
{
    const L zero = typename L::Number(0), friction = lane<L>(c.block.friction, c.at);
    update_slip_velocities(c);
    if (rolling != nullptr)
        apply_angular_impulse(
            c, rolling_friction_impulse(c, *rolling, V3<L>{zero, zero, zero}, impact.load));
    if (c.block.points > 1)
        c.applied.wn += torsional_friction_impulse(c, zero, friction * impact.torsional_load);
    add_applied_torsion(c);
    slide(c, friction * impact.load);
}

template <class L, bool turns>
[[gnu::flatten]] bool
apply_restitution_lanes(const ContactConstraintsView<typename L::Number>& constraints,
                        std::size_t place,
                        int at,
                        const SolverIteration<typename L::Number>& iteration)
{
    Contacts<L, turns> c(constraints, place, at);
    ImpactPoints<L> impact;
    find_impact_points(c, constraints, constraints.restitutions[place], iteration, impact);
    if (impact.lanes == 0) return false;
    const bool spins = c.block.points > 1 || iteration.has_rolling_friction;
    reflect(c, constraints.restitutions[place], spins, impact);
    if (iteration.has_friction) {
        if constexpr (turns) {
            if (spins)
                slide_points(c,
                             iteration.has_rolling_friction ? constraints.rolling_frictions + place
                                                            : nullptr,
                             impact);
            else
                slide_point(c, impact);
        } else {
            slide_point(c, impact);
        }
    }
    apply_impact(c, constraints, constraints.restitutions[place], impact);
    return impact.lasts;
}

template <bool value>
struct Flag {
    static constexpr bool kValue = value;
};

// Calls body(numbers, turns, place, first lane) for the lanes of a block from `at` on, where one of
// them changes a body.
template <class L, class Real, class Body>
void for_group(
    const ContactConstraintWide<Real>& block, bool turns, std::size_t place, int at, Body body)
{
    const unsigned changes = (unsigned{block.writes_a} | block.writes_b) >> at;
    if ((changes & ((1u << L::kWidth) - 1)) == 0) return;
    if (turns)
        body(L{}, Flag<true>{}, place, at);
    else
        body(L{}, Flag<false>{}, place, at);
}

// The same for all lanes of the blocks. Where a body meets very many, blocks have hardly a lane
// each: these are done by themselves.
template <class Real, class Body>
void for_lanes(const ContactConstraintsView<Real>& constraints,
               std::size_t begin,
               std::size_t end,
               bool turns,
               Body body)
{
    constexpr int kFew = 2;
    for (std::size_t place = begin; place < end; ++place) {
        const ContactConstraintWide<Real>& block = constraints.blocks[place];
        if (__builtin_popcount(unsigned{block.writes_a} | block.writes_b) <= kFew)
            for (int at = 0; at < kBlock; ++at)
                for_group<Wide<Real, 1>>(block, turns, place, at, body);
        else
            for (int at = 0; at < kBlock; at += Lanes<Real>::kWidth)
                for_group<Lanes<Real>>(block, turns, place, at, body);
    }
}

template <class Real>
void warm_start(const ContactConstraintsView<Real>& constraints,
                std::size_t begin,
                std::size_t end,
                const SolverIteration<Real>& iteration)
{
    const auto start = [&](auto numbers, auto turns, std::size_t place, int at) {
        warm_start_lanes<decltype(numbers), turns.kValue>(constraints, place, at, iteration);
    };
    for_lanes(constraints, begin, end, iteration.turns, start);
}

// Asks for the bodies of a block before it is its turn: they lie anywhere, so the machine cannot
// foresee them as it does the constraints.
template <class Real>
void fetch_bodies(const ContactConstraintsView<Real>& constraints, std::size_t place)
{
    const ContactConstraintWide<Real>& block = constraints.blocks[place];
    for (const auto& side : {block.a, block.b})
        for (int k = 0; k < kBlock; ++k) {
            __builtin_prefetch(constraints.bodies[side[k]].motion);
            __builtin_prefetch(constraints.bodies[side[k]].inertia);
        }
}

template <class Real>
void solve(const ContactConstraintsView<Real>& constraints,
           std::size_t begin,
           std::size_t end,
           const SolverIteration<Real>& iteration)
{
    const auto iterate = [&](auto numbers, auto turns, std::size_t place, int at) {
        using L = decltype(numbers);
        if (at == 0 && place + 1 < end) fetch_bodies(constraints, place + 1);
        if (constraints.blocks[place].points == 1 && !iteration.has_rolling_friction)
            solve_lanes<L, turns.kValue, 1>(constraints, place, at, iteration);
        else
            solve_lanes<L, turns.kValue, 4>(constraints, place, at, iteration);
    };
    for_lanes(constraints, begin, end, iteration.turns, iterate);
}

template <class Real>
bool apply_restitution(const ContactConstraintsView<Real>& constraints,
                       std::size_t begin,
                       std::size_t end,
                       const SolverIteration<Real>& iteration)
{
    bool any = false;
    const auto bounce = [&](auto numbers, auto turns, std::size_t place, int at) {
        using L = decltype(numbers);
        any |= apply_restitution_lanes<L, turns.kValue>(constraints, place, at, iteration);
    };
    for_lanes(constraints, begin, end, iteration.turns, bounce);
    return any;
}

template <class Real>
constexpr SolveKernels<Real> table()
{
    return {THRONG_LANES_NAME,
            Lanes<Real>::kWidth,
            prepare<Real>,
            update_masses<Real>,
            warm_start<Real>,
            update_surface_velocity<Real>,
            walk_surface_velocity<Real>,
            solve<Real>,
            apply_restitution<Real>,
            begin_substep<Real>,
            advance<Real>,
            warm_start_point_friction<Real>,
            solve_point_friction<Real>,
            apply_restitution_point_friction<Real>};
}

}  // namespace

extern const SolveKernels<float> kSolveFloat;
extern const SolveKernels<double> kSolveDouble;
const SolveKernels<float> kSolveFloat = table<float>();
const SolveKernels<double> kSolveDouble = table<double>();

}  // namespace throng::THRONG_LANES
