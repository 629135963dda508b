// Surface velocities: how contacts that a turning surface carries along slide by where they are
// now, those of wheels whose axes turn, and those who walk. Written once over the width of the
// machine's registers.
#include "kernels/solver/solve_lanes.hpp"

namespace throng::THRONG_LANES {

namespace {

// Turned for a time, by a rotation that is exact to the third order and one for any spin.
template <class L>
V3<L> turned_on(const V3<L>& arm, const V3<L>& spin, L time)
{
    using Real = typename L::Number;
    const V3<L> u = spin * (time * L(Real(0.5))), across = cross(u, arm);
    return arm + (across + cross(u, across)) * (L(Real(2)) / (L(Real(1)) + dot(u, u)));
}

// One side of W contacts: how it spins, and how far the middle of the substep finds its center, and
// what was at the contact as the step began.
template <class L>
struct Side {
    using Real = typename L::Number;
    V3<L> spin, center, material;

    Side(const SolverBody<Real>* bodies, const std::int32_t* index, const V3<L>& arm, L half)
    {
        const Motion<L, true> motion(bodies, index);
        const DeltaPose<L, true> delta_pose(bodies, index);
        const V3<L> now = arm + delta_pose.change_of(arm);
        spin = motion.spin;
        center = delta_pose.moved + motion.velocity * half;
        material = center + turned_on(now, spin, half) - arm;
    }
};

template <class L>
[[gnu::flatten]] void carry_lanes(const ContactConstraintsView<typename L::Number>& constraints,
                                  std::size_t place,
                                  int at,
                                  typename L::Number half)
{
    const auto& block = constraints.blocks[place];
    auto& carried = constraints.surface_velocities[place];
    const Frame<L, true> frame(block, at);
    // A round side is the same however it turns.
    const V3<L> core_a = frame.center_a - frame.normal * lane<L>(block.round_a, at);
    const V3<L> core_b = frame.center_b + frame.normal * lane<L>(block.round_b, at);
    const Side<L> a(constraints.bodies, block.a + at, core_a, half);
    const Side<L> b(constraints.bodies, block.b + at, core_b, half);
    const L by_a = lane<L>(carried.by_a, at), by_b = lane<L>(carried.by_b, at);
    const V3<L> contact = a.material * by_a + b.material * by_b;
    const V3<L> from_a = contact - a.center, from_b = contact - b.center;
    const V3<L> slip = cross(b.spin, from_b) - cross(a.spin, from_a);
    // Out of range of a side nothing is carried.
    const L past = max(dot(from_a, from_a) - lane<L>(carried.range_a, at),
                       dot(from_b, from_b) - lane<L>(carried.range_b, at));
    const L zero = typename L::Number(0), carried_at_first = by_a + by_b;
    const L acts = select(past > zero, zero, carried_at_first);
    // Where nothing is carried the speed is what it was: of who walks, or none.
    const auto carries = carried_at_first > zero;
    const auto tell = [&](const V3<L>& along, Lane16<typename L::Number>& speed) {
        select(carries, dot(along, slip) * acts, lane<L>(speed, at)).store(speed.at + at);
    };
    tell(frame.tangent, carried.speed[0]);
    tell(frame.other, carried.speed[1]);
}

// The velocity that its spin gives one side at its center, turned with the axes that the spin is in
// (see spin_frame, of what is symmetric about an axis) to the middle of the substep, less what it
// is as the spin stands.
template <class L>
V3<L> turn_of_axis(const ContactConstraintsView<typename L::Number>& constraints,
                   const std::int32_t* index,
                   const V3<L>& arm,
                   L half)
{
    using Real = typename L::Number;
    const Motion<L, true> motion(constraints.bodies, index);
    L own[8];
    gather_8(constraints.inertias->axis, 16, index, own);
    const V3<L> axis{own[0], own[1], own[2]};
    const V3<L> now = axis + DeltaPose<L, true>(constraints.bodies, index).change_of(axis);
    const ShortestTurn<L> turn(axis, now);
    const V3<L> still = cross(motion.spin, arm), spin = turn * motion.spin;
    const V3<L> turned = turned_on(turn * still, spin - now * dot(now, spin), half);
    const auto far = dot(axis, now) < L(Real(1 - kFarthestAxisTurn * kFarthestAxisTurn / 2));
    const auto change = [&](L to, L from) { return select(far, L(Real(0)), to - from); };
    return {change(turned.x, still.x), change(turned.y, still.y), change(turned.z, still.z)};
}

// One where a lane has its bit, else 0.
template <class L>
L of_bits(unsigned bits)
{
    using Real = typename L::Number;
    Real ones[L::kWidth];
    for (int k = 0; k < L::kWidth; ++k) ones[k] = Real(bits >> k & 1);
    return L::load(ones);
}

template <class L>
[[gnu::flatten]] void turn_lanes(const ContactConstraintsView<typename L::Number>& constraints,
                                 std::size_t place,
                                 int at,
                                 typename L::Number half)
{
    using Real = typename L::Number;
    const auto& block = constraints.blocks[place];
    const L by_a = of_bits<L>(unsigned{block.axis_turns_a} >> at),
            by_b = of_bits<L>(unsigned{block.axis_turns_b} >> at);
    const Frame<L, true> frame(block, at);
    const V3<L> slip = turn_of_axis<L>(constraints, block.b + at, frame.center_b, half) * by_b
        - turn_of_axis<L>(constraints, block.a + at, frame.center_a, half) * by_a;
    const auto turns = by_a + by_b > L(Real(0));
    const auto tell = [&](const V3<L>& along, Lane16<Real>& speed) {
        select(turns, dot(along, slip), lane<L>(speed, at)).store(speed.at + at);
    };
    tell(frame.tangent, constraints.surface_velocities[place].speed[0]);
    tell(frame.other, constraints.surface_velocities[place].speed[1]);
}

// As walk_of() has it: b walks on a, or a on b.
template <class L>
[[gnu::flatten]] void walk_lanes(const ContactConstraintsView<typename L::Number>& constraints,
                                 std::size_t place,
                                 int at,
                                 const V3<L>& up)
{
    using Real = typename L::Number;
    const auto& block = constraints.blocks[place];
    auto& carried = constraints.surface_velocities[place];
    const L zero = Real(0), one = Real(1);
    const Frame<L, true> frame(block, at);
    const auto driven = [&](const std::int32_t* index, L(&drive)[8]) {
        gather_8(constraints.prescribed->number, 8, index, drive);
    };
    L a[8], b[8];
    driven(block.a + at, a);
    driven(block.b + at, b);
    const L rises = dot(frame.normal, up);
    // 1 where a side walks.
    const auto walks = [&](const L(&drive)[8], L stands, const Lane16<Real>& round) {
        const L rolls = select(lane<L>(round, at) > zero, drive[3], zero);
        const L acts = drive[4] + drive[5] + drive[6];
        return select(stands < L(Real(kSteepestWalk)), zero,
                      select(acts > zero, one - rolls, zero));
    };
    const L by_b = walks(b, rises, block.round_b);
    const L by_a = select(by_b > zero, zero, walks(a, zero - rises, block.round_a));
    const L side = by_b - by_a, any = by_b + by_a;
    const auto of_walker = [&](int k) { return select(by_b > zero, b[k], a[k]); };
    const V3<L> acts{of_walker(4), of_walker(5), of_walker(6)};
    const V3<L> of_a = Motion<L, true>(constraints.bodies, block.a + at).at(frame.center_a);
    const V3<L> of_b = Motion<L, true>(constraints.bodies, block.b + at).at(frame.center_b);
    const auto against = [&](int k, L ground_a, L ground_b, L act) {
        return (of_walker(k) - select(by_b > zero, ground_a, ground_b)) * act;
    };
    V3<L> walk{against(0, of_a.x, of_b.x, acts.x), against(1, of_a.y, of_b.y, acts.y),
               against(2, of_a.z, of_b.z, acts.z)};
    // Where the ground slopes, what follows on the axes that the drive leaves free.
    const V3<L>& n = frame.normal;
    const V3<L> free{n.x * (one - acts.x), n.y * (one - acts.y), n.z * (one - acts.z)};
    walk = walk - free * (dot(n, walk) / max(dot(free, free), L(Real(kLeastFreeWalk))));
    const auto tell = [&](const V3<L>& along, Lane16<Real>& speed) {
        select(any > zero, zero - side * dot(along, walk), lane<L>(speed, at)).store(speed.at + at);
    };
    tell(frame.tangent, carried.speed[0]);
    tell(frame.other, carried.speed[1]);
    for (Lane16<Real>* const by : {&carried.by_a, &carried.by_b})
        select(any > zero, zero, lane<L>(*by, at)).store(by->at + at);
}

}  // namespace

template <class Real>
void walk_surface_velocity(const ContactConstraintsView<Real>& constraints,
                           std::size_t place,
                           const Real (&up)[3])
{
    using L = Lanes<Real>;
    for (int at = 0; at < kBlock; at += L::kWidth)
        walk_lanes<L>(constraints, place, at, V3<L>{L(up[0]), L(up[1]), L(up[2])});
}

template void
walk_surface_velocity<float>(const ContactConstraintsView<float>&, std::size_t, const float (&)[3]);
template void walk_surface_velocity<double>(const ContactConstraintsView<double>&,
                                            std::size_t,
                                            const double (&)[3]);

template <class Real>
void update_surface_velocity(const ContactConstraintsView<Real>& constraints,
                             std::size_t begin,
                             std::size_t end,
                             Real half)
{
    for (std::size_t place = begin; place < end; ++place) {
        const ContactConstraintWide<Real>& block = constraints.blocks[place];
        const bool carries = constraints.surface_velocities[place].carries;
        const bool turns = (block.axis_turns_a | block.axis_turns_b) != 0;
        for (int at = 0; at < kBlock; at += Lanes<Real>::kWidth) {
            if (carries) carry_lanes<Lanes<Real>>(constraints, place, at, half);
            if (turns) turn_lanes<Lanes<Real>>(constraints, place, at, half);
        }
    }
}

template void update_surface_velocity<float>(const ContactConstraintsView<float>&,
                                             std::size_t,
                                             std::size_t,
                                             float);
template void update_surface_velocity<double>(const ContactConstraintsView<double>&,
                                              std::size_t,
                                              std::size_t,
                                              double);

}  // namespace throng::THRONG_LANES
