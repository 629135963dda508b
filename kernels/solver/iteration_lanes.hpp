// Iteration lanes: what every iteration of the solver is made of, over the width of the registers.
//
// An iteration works in the axes of the contact: it asks the bodies once for the six numbers of
// their relative motion, solves all constraints of the contact among these six by what each row
// does to them (ContactConstraintWide::inverse_mass), and gives the bodies the sum. It is the same
// Gauss-Seidel over the same constraints as going back to the bodies after each, at a third of the
// arithmetic.
#pragma once

#include "kernels/solver/solve_lanes.hpp"

namespace throng::THRONG_LANES {

// The constraints of W contacts in the middle of an iteration.
template <class L, bool turns>
struct Contacts {
    using Real = typename L::Number;
    ContactConstraintWide<Real>& block;
    ContactPointWide<Real>* points;
    int at;  // first lane
    Motion<L, turns> a, b;
    Frame<L, turns> frame;
    ContactSpaceVector<L> relative;  // relative motion as the constraints leave it
    ContactSpaceVector<L> applied = {L(Real(0)), L(Real(0)), L(Real(0)),
                                     L(Real(0)), L(Real(0)), L(Real(0))};

    Contacts(const ContactConstraintsView<Real>& constraints, std::size_t place, int first)
        : block(constraints.blocks[place]), points(constraints.points + block.first_point),
          at(first), a(constraints.bodies, block.a + at), b(constraints.bodies, block.b + at),
          frame(block, at), relative(frame.between(a, b))
    { }
    L inverse_mass(int row) const { return lane<L>(block.inverse_mass[row], at); }
    L angular_inverse_mass(int spin, int velocity) const
    {
        return inverse_mass(inverse_mass_entry::kSpin + 3 * spin + velocity);
    }
    void write(SolverBody<Real>* bodies)
    {
        const Mobility<L, turns> how_a(bodies, block.a + at), how_b(bodies, block.b + at);
        frame.apply(applied, how_a, how_b, a, b);
        a.write(bodies, block.a + at, unsigned{block.writes_a} >> at);
        b.write(bodies, block.b + at, unsigned{block.writes_b} >> at);
    }
};

// What a point of an iteration aims at, and what an impulse on it does to the normal speeds of
// those that follow.
template <class L>
struct NormalConstraint {
    L bias, scaled_mass, impulse_scale;  // scaled_mass: less the share that impulse_scale takes
    L on_later[3];
    L impulse;
};

// How far apart the surfaces are at the center, beyond the separation, and by how much that changes
// per lever arm.
template <class L>
struct SeparationChange {
    L center, along_0, along_1;
};

template <class L, bool turns>
SeparationChange<L> separation_change(const Contacts<L, turns>& c,
                                      const SolverBody<typename L::Number>* bodies)
{
    const DeltaPose<L, turns> delta_a(bodies, c.block.a + c.at);
    const DeltaPose<L, turns> delta_b(bodies, c.block.b + c.at);
    SeparationChange<L> change{dot(c.frame.normal, delta_b.moved - delta_a.moved), {}, {}};
    if constexpr (turns) {
        const V3<L> turn_a = delta_a.turned_back(c.frame.normal);
        const V3<L> turn_b = delta_b.turned_back(c.frame.normal);
        // A round side is the same however it turns: only what lies within it turns with the body.
        const V3<L> arm_a =
            mul_add(c.frame.normal, -lane<L>(c.block.round_a, c.at), c.frame.center_a);
        const V3<L> arm_b =
            mul_add(c.frame.normal, lane<L>(c.block.round_b, c.at), c.frame.center_b);
        change.center = change.center + (dot(turn_b, arm_b) - dot(turn_a, arm_a));
        const V3<L> turn = turn_b - turn_a;
        change.along_0 = dot(turn, c.frame.other);
        change.along_1 = -dot(turn, c.frame.tangent);
    }
    return change;
}

// What a point has of a number that changes by the two lever arms.
template <class L, bool turns>
L at_lever_arms(const Contacts<L, turns>& c, int point, L along_0, L along_1, L center)
{
    return mul_add(lane<L>(c.points[point].lever_arm[1], c.at), along_1,
                   mul_add(lane<L>(c.points[point].lever_arm[0], c.at), along_0, center));
}

// Adds an impulse on a point: along the normal, and its torques about the two tangents.
template <class L, bool turns>
void add_at_point(const Contacts<L, turns>& c, int point, L impulse, V3<L>& to)
{
    to = {to.x + impulse, mul_add(lane<L>(c.points[point].lever_arm[0], c.at), impulse, to.y),
          mul_add(lane<L>(c.points[point].lever_arm[1], c.at), impulse, to.z)};
}

template <class L, bool turns, int most>
void build_normal_constraints(const Contacts<L, turns>& c,
                              const SolverBody<typename L::Number>* bodies,
                              const SolverIteration<typename L::Number>& iteration,
                              NormalConstraint<L> (&normals)[most])
{
    using Real = typename L::Number;
    const L zero = Real(0), one = Real(1);
    const L limit = -iteration.push_limit;
    const SeparationChange<L> change = separation_change(c, bodies);
    const int count = most == 1 ? 1 : c.block.points;
    L separation[most], loaded = zero;
    for (int k = 0; k < count; ++k) {
        const ContactPointWide<Real>& point = c.points[k];
        separation[k] = lane<L>(point.separation, c.at) + change.center;
        if constexpr (turns && most > 1)
            separation[k] = at_lever_arms(c, k, change.along_0, change.along_1, separation[k]);
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
        const ContactPointWide<Real>& point = c.points[k];
        NormalConstraint<L>& normal = normals[k];
        normal.impulse = lane<L>(point.impulse, c.at);
        const L mass = lane<L>(point.mass, c.at);
        // Apart: let it close, but no further. Overlapping: a soft spring, within the push limit.
        const auto open = separation[k] > zero;
        const L closing = separation[k] * L(iteration.inverse_substep);
        if (iteration.use_bias) {
            const L soft = max(lane<L>(c.block.bias_rate, c.at) * separation[k], limit);
            normal.bias = select(open, closing, soft);
            // A corner under a heavy load would sink without end: from `deep` on its spring leaks
            // less, and at twice that not at all.
            const L depth = separation[k] * lane<L>(c.block.inverse_deep, c.at);
            const L soft_share = max(min(mul_add(depth, eased, L(Real(2))), one), zero);
            normal.impulse_scale =
                select(open, zero, lane<L>(c.block.impulse_scale, c.at) * soft_share);
            normal.scaled_mass = neg_mul_add(mass, normal.impulse_scale, mass);
        } else {
            normal.bias = select(open, closing, zero);
            normal.impulse_scale = zero;
            normal.scaled_mass = mass;
        }
        if constexpr (turns && most > 1) {
            if (k + 1 == count) continue;
            const L u = lane<L>(point.lever_arm[0], c.at), w = lane<L>(point.lever_arm[1], c.at);
            const L n1 = c.angular_inverse_mass(0, 0), n2 = c.angular_inverse_mass(1, 0);
            const L w12 = c.inverse_mass(inverse_mass_entry::w12);
            const L n = mul_add(w, n2, mul_add(u, n1, c.inverse_mass(inverse_mass_entry::nn)));
            const L w1 = mul_add(w, w12, mul_add(u, c.inverse_mass(inverse_mass_entry::w11), n1));
            const L w2 = mul_add(w, c.inverse_mass(inverse_mass_entry::w22), mul_add(u, w12, n2));
            for (int later = k + 1; later < count; ++later)
                normal.on_later[later - k - 1] = at_lever_arms(c, later, w1, w2, n);
        }
    }
}

// What slides is told where the contact is by now.
template <class L, bool turns>
void add_surface_velocity(Contacts<L, turns>& c,
                          const SurfaceVelocityWide<typename L::Number>& carried)
{
    c.relative.v1 += lane<L>(carried.speed[0], c.at);
    c.relative.v2 += lane<L>(carried.speed[1], c.at);
}

// What comes in fast is left to its impact, which the next substep begins with.
template <class L, bool turns, int most>
void leave_to_restitution(const Contacts<L, turns>& c,
                          const RestitutionWide<typename L::Number>& restitution,
                          const SolverIteration<typename L::Number>& iteration,
                          NormalConstraint<L> (&normals)[most])
{
    using Real = typename L::Number;
    const L zero = Real(0);
    // Nobody is as fast as that where nothing bounces.
    const L resting =
        max(L(iteration.restitution_threshold), lane<L>(restitution.least_speed, c.at));
    const L slow =
        select(lane<L>(restitution.restitution, c.at) > zero, zero - resting, L(Real(-1e30)));
    const int count = most == 1 ? 1 : c.block.points;
    for (int k = 0; k < count; ++k) {
        L speed = c.relative.n;
        if constexpr (turns && most > 1)
            speed = at_lever_arms(c, k, c.relative.w1, c.relative.w2, speed);
        normals[k].scaled_mass = select(speed < slow, zero, normals[k].scaled_mass);
    }
}

// An impulse along the normal at the center.
template <class L, bool turns>
void apply_normal(Contacts<L, turns>& c, L impulse)
{
    c.applied.n += impulse;
    c.relative.n = mul_add(c.inverse_mass(inverse_mass_entry::nn), impulse, c.relative.n);
}

// The same, and torques about the two tangents.
template <class L>
void apply_normal(Contacts<L, true>& c, const V3<L>& by)
{
    c.applied.n += by.x;
    c.applied.w1 += by.y;
    c.applied.w2 += by.z;
    const L n1 = c.angular_inverse_mass(0, 0), n2 = c.angular_inverse_mass(1, 0),
            w12 = c.inverse_mass(inverse_mass_entry::w12);
    c.relative.n += dot(c.inverse_mass(inverse_mass_entry::nn), n1, n2, by.x, by.y, by.z);
    c.relative.w1 += dot(n1, c.inverse_mass(inverse_mass_entry::w11), w12, by.x, by.y, by.z);
    c.relative.w2 += dot(n2, w12, c.inverse_mass(inverse_mass_entry::w22), by.x, by.y, by.z);
}

// A point towards its wanted normal speed, that it misses by so much; then refuse to pull. Returns
// the change of its impulse.
template <class L>
L solve_normal(NormalConstraint<L>& normal, L missed)
{
    const L kept = neg_mul_add(normal.impulse_scale, normal.impulse, normal.impulse);
    const L total = max(neg_mul_add(normal.scaled_mass, missed, kept), L(typename L::Number(0)));
    const L more = total - normal.impulse;
    normal.impulse = total;
    return more;
}

template <class L, bool turns>
void solve_normals(Contacts<L, turns>& c, NormalConstraint<L> (&normals)[1])
{
    apply_normal(c, solve_normal(normals[0], c.relative.n + normals[0].bias));
}

// The same, one point after another. What each does to those that follow is told to them at once,
// not by way of the contact's speeds: a point waits for nothing else of those before it.
template <class L>
void solve_normals(Contacts<L, true>& c, NormalConstraint<L> (&normals)[4])
{
    const L zero = typename L::Number(0);
    const int count = c.block.points;
    L missed[4];
    for (int k = 0; k < count; ++k)
        missed[k] = mul_add(lane<L>(c.points[k].lever_arm[0], c.at), c.relative.w1, c.relative.n)
            + mul_add(lane<L>(c.points[k].lever_arm[1], c.at), c.relative.w2, normals[k].bias);
    V3<L> by{zero, zero, zero};
    for (int k = 0; k < count; ++k) {
        const L more = solve_normal(normals[k], missed[k]);
        for (int later = k + 1; later < count; ++later)
            missed[later] = mul_add(normals[k].on_later[later - k - 1], more, missed[later]);
        add_at_point(c, k, more, by);
    }
    apply_normal(c, by);
}

// Without rotation all points have one speed.
template <class L>
void solve_normals(Contacts<L, false>& c, NormalConstraint<L> (&normals)[4])
{
    for (int k = 0; k < c.block.points; ++k)
        apply_normal(c, solve_normal(normals[k], c.relative.n + normals[k].bias));
}

// Least that a point gives way, as a share of what it answers alone, while all are pushed at once:
// four points of a face are one more than what they hold, and without it there would be many
// answers.
constexpr float kGive = 0.03f;

// All points at once, as if none had to be held back from pulling: exact where none has, left to
// the iterations where one has. One alone gives the first of four points too much and tilts the
// body a little, always the same way: tall walls come down by it.
//
// Each point gives way by impulse_scale / scaled_mass of its impulse, so with S the sum of lever
// arms over that, and K what impulses do to (vn, w1, w2), the impulses add up to p with (1 + S K) p
// = -pull.
template <class L>
void solve_normals_as_block(Contacts<L, true>& c, NormalConstraint<L> (&normals)[4])
{
    using Real = typename L::Number;
    const L zero = Real(0), one = Real(1), least = Real(kGive);
    const int count = c.block.points;
    V3<L> s_n{zero, zero, zero}, pull{zero, zero, zero};
    L s_11 = zero, s_12 = zero, s_22 = zero;
    L stiff[4], alone[4];
    // What is less than 1 / impulse_scale only nears the answer more slowly: so one number does for
    // all points that give way.
    const L soft = one / max(lane<L>(c.block.impulse_scale, c.at), least), hard = one / least;
    for (int k = 0; k < count; ++k) {
        const L u = lane<L>(c.points[k].lever_arm[0], c.at),
                w = lane<L>(c.points[k].lever_arm[1], c.at);
        const NormalConstraint<L>& normal = normals[k];
        const L give = select(normal.impulse_scale > zero, soft, hard);
        stiff[k] = normal.scaled_mass * give;
        const L speed = at_lever_arms(c, k, c.relative.w1, c.relative.w2, c.relative.n);
        alone[k] =
            mul_add(normal.impulse, normal.impulse_scale * give, (speed + normal.bias) * stiff[k]);
        add_at_point(c, k, alone[k], pull);
        const L su = stiff[k] * u, sw = stiff[k] * w;
        s_n = s_n + V3<L>{stiff[k], su, sw};
        s_11 = mul_add(su, u, s_11);
        s_12 = mul_add(su, w, s_12);
        s_22 = mul_add(sw, w, s_22);
    }
    const V3<L> s_1{s_n.y, s_11, s_12}, s_2{s_n.z, s_12, s_22};
    const L n1 = c.angular_inverse_mass(0, 0), n2 = c.angular_inverse_mass(1, 0),
            w12 = c.inverse_mass(inverse_mass_entry::w12);
    const V3<L> k_n{c.inverse_mass(inverse_mass_entry::nn), n1, n2},
        k_1{n1, c.inverse_mass(inverse_mass_entry::w11), w12},
        k_2{n2, w12, c.inverse_mass(inverse_mass_entry::w22)};
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
        const L there = at_lever_arms(c, k, moved.y, moved.z, moved.x);
        total[k] = normals[k].impulse - mul_add(stiff[k], there, alone[k]);
        smallest = min(smallest, total[k]);
        add_at_point(c, k, total[k] - normals[k].impulse, by);
    }
    // On needles the soft direction may drown in rounding: such an answer, or one that is no
    // number, is not taken.
    const L doubt = abs(by.x - p.x) - abs(p.x) * L(Real(1e-3));
    const auto all = select(smallest < zero, one, doubt) < L(Real(1e-30));
    for (int k = 0; k < count; ++k) normals[k].impulse = select(all, total[k], normals[k].impulse);
    apply_normal(c,
                 V3<L>{select(all, by.x, zero), select(all, by.y, zero), select(all, by.z, zero)});
}

// The friction mass of W contacts as they keep it.
template <class L>
FrictionMass<L> friction_mass(const ContactConstraintWide<typename L::Number>& block, int at)
{
    return {lane<L>(block.friction_mass[0], at), lane<L>(block.friction_mass[1], at),
            lane<L>(block.friction_mass[2], at), lane<L>(block.sliding_mass, at),
            lane<L>(block.sliding_inverse_mass, at)};
}

// Friction within a round cone of radius `friction_limit`, at a place that slides by (slip_1,
// slip_2). Sticking is tried with the full 2x2 mass; what leaves the cone slides, straight against
// the velocity whatever the shape of the bodies.
template <class L>
struct FrictionImpulse {
    L impulse_1, impulse_2;
};
template <class L>
FrictionImpulse<L> solve_friction_cone(const FrictionMass<L>& mass,
                                       const FrictionImpulse<L>& old,
                                       L slip_1,
                                       L slip_2,
                                       L friction_limit)
{
    using Real = typename L::Number;
    const L stick_1 = neg_mul_add(mass.m12, slip_2, neg_mul_add(mass.m11, slip_1, old.impulse_1));
    const L stick_2 = neg_mul_add(mass.m22, slip_2, neg_mul_add(mass.m12, slip_1, old.impulse_2));
    // Compared as speeds: squares of impulses leave float where bodies are huge or tiny.
    const L limit = friction_limit * mass.sliding_inverse_mass;
    const L try_1 = stick_1 * mass.sliding_inverse_mass,
            try_2 = stick_2 * mass.sliding_inverse_mass;
    const auto slides = mul_add(try_1, try_1, try_2 * try_2) > limit * limit;

    const L slide_1 = mul_add(old.impulse_1, mass.sliding_inverse_mass, -slip_1);
    const L slide_2 = mul_add(old.impulse_2, mass.sliding_inverse_mass, -slip_2);
    const L length = sqrt(mul_add(slide_1, slide_1, slide_2 * slide_2));
    const L shrink = mass.sliding_mass
        * select(length > limit, limit / select(length > L(Real(0)), length, L(Real(1))),
                 L(Real(1)));
    return {select(slides, slide_1 * shrink, stick_1), select(slides, slide_2 * shrink, stick_2)};
}

// Friction about the normal, for contacts of several points: its impulse, from the old one.
template <class L, bool turns>
L torsional_friction_impulse(const Contacts<L, turns>& c, L old, L most)
{
    const L wanted = neg_mul_add(lane<L>(c.block.torsional_mass, c.at), c.relative.wn, old);
    return max(min(wanted, most), -most);
}

// The same of what the contact holds. Returns the change.
template <class L, bool turns>
L solve_torsional_friction(Contacts<L, turns>& c, L most)
{
    const L old = lane<L>(c.block.torsional_impulse, c.at);
    const L total = torsional_friction_impulse(c, old, most);
    total.store(c.block.torsional_impulse.at + c.at);
    return total - old;
}

// Friction against rolling and spinning, about tangent, other and normal: its impulse, from the old
// one.
template <class L, bool turns>
V3<L> rolling_friction_impulse(const Contacts<L, turns>& c,
                               const RollingFrictionWide<typename L::Number>& rolling,
                               const V3<L>& old,
                               L load)
{
    using Real = typename L::Number;
    const L most = lane<L>(rolling.rolling, c.at) * load;
    const L mass = lane<L>(rolling.mass, c.at);
    const V3<L> wanted = mul_add(V3<L>{c.relative.w1, c.relative.w2, c.relative.wn}, -mass, old);
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
V3<L> solve_rolling_friction(Contacts<L, turns>& c,
                             RollingFrictionWide<typename L::Number>& rolling,
                             L load)
{
    const V3<L> old = lane3<L>(rolling.impulse, c.at);
    const V3<L> total = rolling_friction_impulse(c, rolling, old, load);
    store3(total, rolling.impulse, c.at);
    return total - old;
}

// What the points did to the other three numbers.
template <class L>
void update_slip_velocities(Contacts<L, true>& c)
{
    const auto add = [&](L& to, L n, L w1, L w2) {
        to += dot(n, w1, w2, c.applied.n, c.applied.w1, c.applied.w2);
    };
    add(c.relative.v1, c.inverse_mass(inverse_mass_entry::n1), c.angular_inverse_mass(0, 1),
        c.angular_inverse_mass(1, 1));
    add(c.relative.v2, c.inverse_mass(inverse_mass_entry::n2), c.angular_inverse_mass(0, 2),
        c.angular_inverse_mass(1, 2));
    add(c.relative.wn, c.angular_inverse_mass(2, 0), c.inverse_mass(inverse_mass_entry::w1n),
        c.inverse_mass(inverse_mass_entry::w2n));
}

// What resisting to roll does to all, but for what it does about the normal to v1 and v2: that
// counts the whole of given.wn, later.
template <class L>
void apply_angular_impulse(Contacts<L, true>& c, const V3<L>& by)
{
    const L wnn = c.inverse_mass(inverse_mass_entry::wnn),
            w1n = c.inverse_mass(inverse_mass_entry::w1n);
    const L w2n = c.inverse_mass(inverse_mass_entry::w2n),
            w12 = c.inverse_mass(inverse_mass_entry::w12);
    c.applied.w1 += by.x;
    c.applied.w2 += by.y;
    c.applied.wn += by.z;
    c.relative.w1 += c.inverse_mass(inverse_mass_entry::w11) * by.x + w12 * by.y;
    c.relative.w2 += w12 * by.x + c.inverse_mass(inverse_mass_entry::w22) * by.y;
    c.relative.wn += w1n * by.x + w2n * by.y + wnn * by.z;
    c.relative.n += c.angular_inverse_mass(0, 0) * by.x + c.angular_inverse_mass(1, 0) * by.y;
    c.relative.v1 += c.angular_inverse_mass(0, 1) * by.x + c.angular_inverse_mass(1, 1) * by.y;
    c.relative.v2 += c.angular_inverse_mass(0, 2) * by.x + c.angular_inverse_mass(1, 2) * by.y;
}

// What friction did to the speeds of the points.
template <class L>
void update_point_velocities(Contacts<L, true>& c)
{
    const auto add = [&](L& to, L v1, L v2, L wn) {
        to += dot(v1, v2, wn, c.applied.v1, c.applied.v2, c.applied.wn);
    };
    add(c.relative.n, c.inverse_mass(inverse_mass_entry::n1),
        c.inverse_mass(inverse_mass_entry::n2), c.angular_inverse_mass(2, 0));
    add(c.relative.w1, c.angular_inverse_mass(0, 1), c.angular_inverse_mass(0, 2),
        c.inverse_mass(inverse_mass_entry::w1n));
    add(c.relative.w2, c.angular_inverse_mass(1, 1), c.angular_inverse_mass(1, 2),
        c.inverse_mass(inverse_mass_entry::w2n));
}

// The load that the points bear, and how much they resist torsion.
template <class L, bool turns, int most>
void sum_normal_impulses(const Contacts<L, turns>& c,
                         const NormalConstraint<L> (&normals)[most],
                         L& load,
                         L& torsional_load)
{
    using Real = typename L::Number;
    load = torsional_load = Real(0);
    const int count = most == 1 ? 1 : c.block.points;
    for (int k = 0; k < count; ++k) {
        load += normals[k].impulse;
        if constexpr (turns && most > 1)
            torsional_load = mul_add(normals[k].impulse, lane<L>(c.points[k].center_distance, c.at),
                                     torsional_load);
    }
}

// Gives what the points hold, as an iteration left it.
template <class L, bool turns>
void apply_normal_impulses(Contacts<L, turns>& c)
{
    for (int k = 0; k < c.block.points; ++k) {
        const auto& point = c.points[k];
        const L impulse = lane<L>(point.impulse, c.at);
        c.applied.n += impulse;
        if constexpr (turns) {
            c.applied.w1 = mul_add(lane<L>(point.lever_arm[0], c.at), impulse, c.applied.w1);
            c.applied.w2 = mul_add(lane<L>(point.lever_arm[1], c.at), impulse, c.applied.w2);
        }
    }
}

// The same of what resists rolling.
template <class L>
void apply_rolling_impulses(Contacts<L, true>& c,
                            const RollingFrictionWide<typename L::Number>& rolling)
{
    const V3<L> held = lane3<L>(rolling.impulse, c.at);
    c.applied.w1 += held.x;
    c.applied.w2 += held.y;
    c.applied.wn += held.z;
}

// The impulses of the points as an iteration leaves them.
template <class L, bool turns, int most>
void store_normal_impulses(Contacts<L, turns>& c, const NormalConstraint<L> (&normals)[most])
{
    const int count = most == 1 ? 1 : c.block.points;
    for (int k = 0; k < count; ++k) normals[k].impulse.store(c.points[k].impulse.at + c.at);
}

}  // namespace throng::THRONG_LANES
