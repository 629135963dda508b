// Contacts as they are kept, made into constraints: written once over the width of the registers.
#include "kernels/solver/solve_lanes.hpp"

#include <array>

namespace throng::THRONG_LANES {

namespace {

// Packed contacts, their numbers side by side.
template <class L>
struct PackedLanes {
    struct Point {
        L there;  // 1 where the lane has this point, else 0, and so is all the rest
        V3<L> anchor_a;
        L separation, impulse;
    };
    V3<L> normal, center_offset, held, rolling;
    L round_a, round_b, torsional_impulse;
    Point point[4];

    PackedLanes(const PackedContacts<typename L::Number>& block, int at, int points)
    {
        namespace of = contact_numbers;
        using Real = typename L::Number;
        const auto line = [&](int first, L(&out)[8]) {
            gather_8<Real, L::kWidth>([&](int i) { return block.contact[at + i] + first; }, out);
        };
        L x[8], y[8];
        line(0, x);
        line(8, y);
        const auto number = [&](int place) { return place < 8 ? x[place] : y[place - 8]; };
        const auto three = [&](int place) -> V3<L> {
            return {number(place), number(place + 1), number(place + 2)};
        };
        normal = three(of::kNormal);
        center_offset = three(of::kCenterOffset);
        held = three(of::kFriction);
        rolling = three(of::kRolling);
        round_a = number(of::kRoundA);
        round_b = number(of::kRoundB);
        torsional_impulse = number(of::kTorsionalImpulse);
        const L count = lane<L>(block.count, at), zero = Real(0);
        for (int k = 0; k < points; ++k) {
            // The last line ends where the contact does.
            const int place = of::kPoints + of::kPoint * k, first = place < 32 ? place : 32;
            line(first, x);
            const auto has = count > L(Real(k));
            const auto its = [&](int k_th) { return select(has, x[place - first + k_th], zero); };
            point[k] = {select(has, L(Real(1)), zero),
                        {its(of::kAnchorA), its(of::kAnchorA + 1), its(of::kAnchorA + 2)},
                        its(of::kSeparation),
                        its(of::kImpulse)};
        }
    }
};

// A tangent along the longest way between points, where there are several: on needles and plates
// that keeps what turns easily apart from what does not.
template <class L>
V3<L> along_points(const PackedLanes<L>& packed, int count, const V3<L>& n)
{
    using Real = typename L::Number;
    const V3<L> first = packed.point[0].anchor_a;
    const L zero = Real(0), one = Real(1);
    V3<L> way{zero, zero, zero};
    L longest = zero;
    for (int k = 1; k < count; ++k) {
        const V3<L> between = packed.point[k].anchor_a - first;
        const V3<L> flat = (between - n * dot(n, between)) * packed.point[k].there;
        const L length = dot(flat, flat);
        const auto longer = length > longest;
        way = {select(longer, flat.x, way.x), select(longer, flat.y, way.y),
               select(longer, flat.z, way.z)};
        longest = max(length, longest);
    }
    // What is short beside the arms is mostly rounding.
    const auto found = longest > dot(first, first) * L(Real(1e-4)) + L(Real(1e-30));
    const V3<L> any = across(n);
    const V3<L> flat = way - n * dot(n, way);
    const V3<L> unit = flat * (one / sqrt(select(found, dot(flat, flat), one)));
    return {select(found, unit.x, any.x), select(found, unit.y, any.y),
            select(found, unit.z, any.z)};
}

// What one side answers to pushes along the contact's axes at an arm: torques and spins.
template <class L>
struct AngularJacobian {
    V3<L> torque[3], spin[3];

    AngularJacobian(const Mobility<L, true>& how, const V3<L>& arm, const V3<L> (&axes)[3])
    {
        for (int k = 0; k < 3; ++k) {
            torque[k] = cross(arm, axes[k]);
            spin[k] = how.turned_by(torque[k]);
        }
    }
};

template <class L>
void fill_inverse_mass(ContactConstraintWide<typename L::Number>& block,
                       int at,
                       bool spins,
                       const Mobility<L, true>& a,
                       const Mobility<L, true>& b)
{
    const Frame<L, true> frame(block, at);
    const V3<L> axes[3] = {frame.normal, frame.tangent, frame.other};
    const V3<L> spin_axes[3] = {frame.tangent, frame.other, frame.normal};
    const AngularJacobian<L> from_a(a, frame.center_a, axes), from_b(b, frame.center_b, axes);
    const L mass = a.inverse_mass + b.inverse_mass;
    const auto put = [&](int place, L value) { value.store(block.inverse_mass[place].at + at); };
    const auto linear = [&](int i, int k) {
        return dot(from_a.torque[i], from_a.spin[k]) + dot(from_b.torque[i], from_b.spin[k]);
    };
    put(inverse_mass_entry::nn, mass + linear(0, 0));
    put(inverse_mass_entry::n1, linear(0, 1));
    put(inverse_mass_entry::n2, linear(0, 2));
    put(inverse_mass_entry::v11, mass + linear(1, 1));
    put(inverse_mass_entry::v12, linear(1, 2));
    put(inverse_mass_entry::v22, mass + linear(2, 2));
    if (!spins) return;
    for (int k = 0; k < 3; ++k) {
        const V3<L> spin = from_a.spin[k] + from_b.spin[k];
        for (int i = 0; i < 3; ++i)
            put(inverse_mass_entry::kSpin + 3 * i + k, dot(spin_axes[i], spin));
    }
    V3<L> turned[3];
    for (int i = 0; i < 3; ++i) turned[i] = a.turned_by(spin_axes[i]) + b.turned_by(spin_axes[i]);
    put(inverse_mass_entry::w11, dot(spin_axes[0], turned[0]));
    put(inverse_mass_entry::w22, dot(spin_axes[1], turned[1]));
    put(inverse_mass_entry::wnn, dot(spin_axes[2], turned[2]));
    put(inverse_mass_entry::w12, dot(spin_axes[0], turned[1]));
    put(inverse_mass_entry::w1n, dot(spin_axes[0], turned[2]));
    put(inverse_mass_entry::w2n, dot(spin_axes[1], turned[2]));
}

// Without rotation only masses answer.
template <class L>
void fill_inverse_mass(ContactConstraintWide<typename L::Number>& block,
                       int at,
                       bool,
                       const Mobility<L, false>& a,
                       const Mobility<L, false>& b)
{
    using Real = typename L::Number;
    const L mass = a.inverse_mass + b.inverse_mass, zero = Real(0);
    const L values[6] = {mass, zero, zero, mass, zero, mass};
    for (int k = 0; k < 6; ++k) values[k].store(block.inverse_mass[k].at + at);
}

template <class L>
void fill_friction(ContactConstraintWide<typename L::Number>& block, int at)
{
    const auto mass = FrictionMass<L>::of(lane<L>(block.inverse_mass[inverse_mass_entry::v11], at),
                                          lane<L>(block.inverse_mass[inverse_mass_entry::v22], at),
                                          lane<L>(block.inverse_mass[inverse_mass_entry::v12], at));
    mass.m11.store(block.friction_mass[0].at + at);
    mass.m22.store(block.friction_mass[1].at + at);
    mass.m12.store(block.friction_mass[2].at + at);
    mass.sliding_mass.store(block.sliding_mass.at + at);
    mass.sliding_inverse_mass.store(block.sliding_inverse_mass.at + at);
}

// How a body gives way by turning to a push along the normal, and by how much of that counts: none
// where the arm all but lies along the normal. Told by the arm alone: a needle, which turns so
// easily about its own axis, has lever arms all the same.
template <class L>
struct Turning {
    V3<L> torque;
    L inverse_mass, by_lever_arm;

    Turning(const Mobility<L, true>& how, const V3<L>& arm, const V3<L>& normal)
        : torque(cross(arm, normal)), inverse_mass(dot(torque, how.turned_by(torque)))
    {
        using Real = typename L::Number;
        constexpr Real kLever = Real(kLeastLeverArm);
        const auto has_lever_arm = dot(torque, torque) > dot(arm, arm) * L(kLever * kLever);
        by_lever_arm = select(has_lever_arm, inverse_mass, L(Real(0)));
    }
};

// The effective mass of a point along the normal; 0 where it gives way by no lever arm: see
// kLeastLeverArm.
template <class L, bool turns>
L normal_mass(const Mobility<L, turns>& a,
              const Mobility<L, turns>& b,
              const V3<L>& normal,
              const V3<L>& arm_a,
              const V3<L>& arm_b)
{
    using Real = typename L::Number;
    const L mass = a.inverse_mass + b.inverse_mass;
    if constexpr (!turns) {
        return inverse_or_zero(mass);
    } else {
        const Turning<L> of_a(a, arm_a, normal), of_b(b, arm_b, normal);
        const L inverse_mass = mass + of_a.inverse_mass + of_b.inverse_mass;
        const L by_lever_arms = of_a.by_lever_arm + of_b.by_lever_arm;
        const L counts = select(mass > L(Real(0)), inverse_mass, by_lever_arms + by_lever_arms);
        return inverse_or_zero(select(counts < inverse_mass, L(Real(0)), inverse_mass));
    }
}

// The friction that carried over, within the cone of the impulses that did.
template <class L, bool turns>
void fill_held(ContactConstraintWide<typename L::Number>& block,
               int at,
               const V3<L>& held,
               const Frame<L, turns>& frame,
               L load)
{
    using Real = typename L::Number;
    const L one = Real(1);
    // Measured in units of the greatest that may be held: squares leave float where bodies are
    // huge.
    const L most = lane<L>(block.friction, at) * load;
    // Impulses that fade away pass through numbers too small to have an inverse.
    constexpr Real kLeast = sizeof(Real) == 4 ? Real(1e-37) : Real(1e-307);
    const L unit = select(most > L(kLeast), one / most, L(Real(0)));
    const L held_1 = dot(held, frame.tangent) * unit, held_2 = dot(held, frame.other) * unit;
    const L length = sqrt(held_1 * held_1 + held_2 * held_2);
    const L shrink = most * select(length > one, one / select(length > one, length, one), one);
    (held_1 * shrink).store(block.friction_impulse[0].at + at);
    (held_2 * shrink).store(block.friction_impulse[1].at + at);
}

template <class L>
void fill_bounce(RestitutionWide<typename L::Number>& bounce,
                 int at,
                 const PackedContacts<typename L::Number>& packed)
{
    using Real = typename L::Number;
    const L zero = Real(0);
    lane<L>(packed.restitution, at).store(bounce.restitution.at + at);
    zero.store(bounce.least_speed.at + at);
    store3(V3<L>{zero, zero, zero}, bounce.impulse, at);
}

template <class L, bool turns>
void fill_rolling(RollingFrictionWide<typename L::Number>& rolling,
                  int at,
                  const PackedContacts<typename L::Number>& block,
                  const V3<L>& impulse,
                  const Frame<L, turns>& frame,
                  const Mobility<L, turns>& a,
                  const Mobility<L, turns>& b)
{
    lane<L>(block.rolling_friction, at).store(rolling.rolling.at + at);
    // The trace is at least the greatest eigenvalue: one number that never overshoots.
    if constexpr (turns)
        inverse_or_zero(a.xx + b.xx + a.yy + b.yy + a.zz + b.zz).store(rolling.mass.at + at);
    store3(
        V3<L>{dot(frame.tangent, impulse), dot(frame.other, impulse), dot(frame.normal, impulse)},
        rolling.impulse, at);
}

// Impulses whose sum is no more have no middle that could be told, N s.
template <class Real>
constexpr Real kLeastLoad = sizeof(Real) == 4 ? Real(1e-30) : Real(1e-300);

// Of all but the points.
template <class L, bool turns>
void fill_masses(const ContactConstraintsView<typename L::Number>& constraints,
                 std::size_t place,
                 int at,
                 const V3<L>& normal,
                 const Mobility<L, turns>& a,
                 const Mobility<L, turns>& b)
{
    ContactConstraintWide<typename L::Number>& block = constraints.blocks[place];
    // A single point has no lever arm: only what resists rolling asks what spins do, and friction
    // of another kind than the usual, which goes one way for any number of points.
    const bool asked =
        constraints.rolling_frictions != nullptr || constraints.point_frictions != nullptr;
    fill_inverse_mass(block, at, block.points > 1 || asked, a, b);
    if constexpr (turns)
        inverse_or_zero(dot(normal, a.turned_by(normal)) + dot(normal, b.turned_by(normal)))
            .store(block.torsional_mass.at + at);
    fill_friction<L>(block, at);
}

template <class L, bool turns>
[[gnu::flatten]] void prepare_lanes(const PackedContacts<typename L::Number>& from,
                                    std::size_t place,
                                    int at,
                                    const ContactConstraintsView<typename L::Number>& constraints)
{
    using Real = typename L::Number;
    ContactConstraintWide<Real>& block = constraints.blocks[place];
    ContactPointWide<Real>* const points = constraints.points + block.first_point;
    const L zero = Real(0);
    const Mobility<L, turns> a(constraints.bodies, block.a + at),
        b(constraints.bodies, block.b + at);

    const PackedLanes<L> packed(from, at, block.points);
    const V3<L> normal = packed.normal;
    store3(normal, block.normal, at);
    store3(along_points(packed, block.points, normal), block.tangent, at);
    const auto copy = [at](const Lane16<Real>& number, Lane16<Real>& to) {
        lane<L>(number, at).store(to.at + at);
    };
    copy(from.friction, block.friction);
    copy(from.bias_rate, block.bias_rate);
    copy(from.impulse_scale, block.impulse_scale);
    inverse_or_zero(lane<L>(from.deep, at)).store(block.inverse_deep.at + at);
    packed.round_a.store(block.round_a.at + at);
    packed.round_b.store(block.round_b.at + at);
    packed.torsional_impulse.store(block.torsional_impulse.at + at);

    // The middle of the points, on either surface. Of round sides and rims it is that of the load:
    // friction in the middle of a wheel that rolls on one rim would hold the other.
    L count = zero, load = zero;
    for (int k = 0; k < block.points; ++k) {
        count += packed.point[k].there;
        load += packed.point[k].impulse;
    }
    const L round = packed.round_a + packed.round_b + lane<L>(from.on_rim, at);
    const L rolls = select(round > zero, load, zero);
    const auto borne = rolls > L(kLeastLoad<Real>);
    const L share = L(Real(1)) / select(borne, load, count);
    V3<L> middle{zero, zero, zero};
    L mean_separation = zero;
    for (int k = 0; k < block.points; ++k) {
        const auto& point = packed.point[k];
        const L weight = select(borne, point.impulse, point.there);
        middle = middle + point.anchor_a * weight;
        mean_separation += point.separation * weight;
    }
    const V3<L> center_a = middle * share;
    const V3<L> between = packed.center_offset;
    store3(center_a, block.center_a, at);
    store3(center_a + normal * (mean_separation * share) + between, block.center_b, at);

    const Frame<L, turns> frame(block, at);
    for (int k = 0; k < block.points; ++k) {
        const auto& [there, arm, separation, impulse] = packed.point[k];
        ContactPointWide<Real>& to = points[k];
        const V3<L> off = (arm - center_a) * there;
        const L along = dot(off, frame.tangent), other = dot(off, frame.other);
        other.store(to.lever_arm[0].at + at);
        (-along).store(to.lever_arm[1].at + at);
        sqrt(along * along + other * other).store(to.center_distance.at + at);
        separation.store(to.separation.at + at);
        impulse.store(to.impulse.at + at);
        const L mass = normal_mass(a, b, normal, arm, arm + normal * separation + between);
        (mass * there).store(to.mass.at + at);
    }
    fill_masses(constraints, place, at, normal, a, b);
    fill_held(block, at, packed.held, frame, load);

    if (constraints.rolling_frictions != nullptr)
        fill_rolling(constraints.rolling_frictions[place], at, from, packed.rolling, frame, a, b);
    if (constraints.restitutions != nullptr)
        fill_bounce<L>(constraints.restitutions[place], at, from);
}

template <class L>
[[gnu::flatten]] void update_masses_lanes(
    const ContactConstraintsView<typename L::Number>& constraints, std::size_t place, int at)
{
    using Real = typename L::Number;
    const ContactConstraintWide<Real>& block = constraints.blocks[place];
    const Mobility<L, true> a(constraints.bodies, block.a + at),
        b(constraints.bodies, block.b + at);
    const Frame<L, true> frame(block, at);
    const L zero = Real(0);
    for (int k = 0; k < block.points; ++k) {
        ContactPointWide<Real>& point = constraints.points[block.first_point + std::uint32_t(k)];
        const V3<L> off = frame.other * lane<L>(point.lever_arm[0], at)
            - frame.tangent * lane<L>(point.lever_arm[1], at);
        const L mass =
            normal_mass<L, true>(a, b, frame.normal, frame.center_a + off, frame.center_b + off);
        // One that bears nothing is not there, or has no lever arm.
        select(lane<L>(point.mass, at) > zero, mass, zero).store(point.mass.at + at);
    }
    fill_masses(constraints, place, at, frame.normal, a, b);
}

}  // namespace

// The other lanes keep their very bits: made of other numbers they would differ by the last one.
template <class Real>
void update_masses(const ContactConstraintsView<Real>& constraints,
                   std::size_t place,
                   std::uint16_t lanes)
{
    ContactConstraintWide<Real>& block = constraints.blocks[place];
    ContactPointWide<Real>* const points = constraints.points + block.first_point;
    const ContactConstraintWide<Real> before = block;
    std::array<Lane16<Real>, 4> mass_before;
    for (int k = 0; k < block.points; ++k) mass_before[std::size_t(k)] = points[k].mass;

    constexpr int kWidth = Lanes<Real>::kWidth;
    for (int at = 0; at < kBlock; at += kWidth)
        if ((lanes >> at & ((1u << kWidth) - 1)) != 0)
            update_masses_lanes<Lanes<Real>>(constraints, place, at);

    const auto keep = [&](Lane16<Real>& now, const Lane16<Real>& then) {
        for (int lane = 0; lane < kBlock; ++lane)
            now.at[lane] = (lanes >> lane & 1) != 0 ? now.at[lane] : then.at[lane];
    };
    for (int k = 0; k < block.points; ++k) keep(points[k].mass, mass_before[std::size_t(k)]);
    for (int k = 0; k < 21; ++k) keep(block.inverse_mass[k], before.inverse_mass[k]);
    for (int k = 0; k < 3; ++k) keep(block.friction_mass[k], before.friction_mass[k]);
    keep(block.sliding_mass, before.sliding_mass);
    keep(block.sliding_inverse_mass, before.sliding_inverse_mass);
    keep(block.torsional_mass, before.torsional_mass);
}

template void
update_masses<float>(const ContactConstraintsView<float>&, std::size_t, std::uint16_t);
template void
update_masses<double>(const ContactConstraintsView<double>&, std::size_t, std::uint16_t);

template <class Real>
void prepare(const PackedContacts<Real>& packed,
             std::size_t place,
             const ContactConstraintsView<Real>& constraints,
             bool turns)
{
    for (int at = 0; at < kBlock; at += Lanes<Real>::kWidth)
        if (turns)
            prepare_lanes<Lanes<Real>, true>(packed, place, at, constraints);
        else
            prepare_lanes<Lanes<Real>, false>(packed, place, at, constraints);
}

template void prepare<float>(const PackedContacts<float>&,
                             std::size_t,
                             const ContactConstraintsView<float>&,
                             bool);
template void prepare<double>(const PackedContacts<double>&,
                              std::size_t,
                              const ContactConstraintsView<double>&,
                              bool);

}  // namespace throng::THRONG_LANES
