#include "kernels/solver/turning_arms.hpp"

#include "kernels/solver/contact_packing.hpp"
#include "kernels/solver/solver_bodies.hpp"

#include <algorithm>

namespace throng {

namespace {

constexpr double kFarthestTurn = 0.3;  // rad, in a step

// What b, or a against it, has of impulses at an arm.
template <class Real>
void push(SolverBody<Real>& body, const Vec3& impulse, const Vec3& torque)
{
    const Real* const inertia = body.inertia;
    const Sym3 inverse{double{inertia[1]}, double{inertia[2]}, double{inertia[3]},
                       double{inertia[4]}, double{inertia[5]}, double{inertia[6]}};
    const Vec3 velocity = impulse * double{inertia[0]}, spin = inverse.matrix() * torque;
    for (int k = 0; k < 3; ++k) {
        body.motion[k] += static_cast<Real>(velocity[k]);
        body.motion[4 + k] += static_cast<Real>(spin[k]);
    }
}

template <class Real>
void store(const Vec3& vector, Lane16<Real> (&to)[3], std::size_t lane)
{
    for (int k = 0; k < 3; ++k) to[k].at[lane] = static_cast<Real>(vector[k]);
}

// N s on b, at the center; of friction at points their sum.
template <class Real>
Vec3 impulse_of(const ContactConstraintsView<Real>& constraints,
                const ContactConstraintWide<Real>& block,
                std::size_t lane)
{
    double load = 0;
    for (std::size_t k = 0; k < static_cast<std::size_t>(block.points); ++k)
        load += double{constraints.points[block.first_point + k].impulse.at[lane]};
    const double along{block.friction_impulse[0].at[lane]},
        other{block.friction_impulse[1].at[lane]};
    const Vec3 normal = in_double(block.normal, lane), tangent = in_double(block.tangent, lane);
    return normal * load + tangent * along + normal.cross(tangent) * other;
}

bool has(std::uint16_t lanes, std::size_t lane) { return (lanes >> lane & 1) != 0; }

void set(std::uint16_t& lanes, std::size_t lane, bool to)
{
    const unsigned bit = 1u << lane;
    lanes = static_cast<std::uint16_t>(to ? lanes | bit : lanes & ~bit);
}

// A contact of which both bodies are where they were as the step began.
template <class Real>
MovedContact begun_contact(const ContactConstraintWide<Real>& block,
                           const TurningArmsWide<Real>& begun,
                           std::size_t lane)
{
    MovedContact contact;
    contact.normal = in_double(begun.normal, lane);
    contact.round_a = double{block.round_a.at[lane]};
    contact.round_b = double{block.round_b.at[lane]};
    contact.core_a = in_double(begun.center_a, lane) - contact.normal * contact.round_a;
    contact.core_b = in_double(begun.center_b, lane) + contact.normal * contact.round_b;
    contact.center_offset = in_double(begun.center_offset, lane);
    contact.flat = has(begun.flat_a, lane) ? RollsFlat::a
        : has(begun.flat_b, lane)          ? RollsFlat::b
                                           : RollsFlat::no;
    return contact;
}

// Whether the contact that was there as the step began says nothing of where that leads to.
bool is_far(const MovedContact& contact, const PlacedContact& placed)
{
    const double half = std::max(contact.turn_a.vec().norm(), contact.turn_b.vec().norm());
    return half > (contact.flat == RollsFlat::no ? kFarthestTurn : kFarthestFlatTurn) / 2
        || placed.rolled > kFarthestFlatRoll;
}

// m, what a constraint that is placed there, and adds what has moved since the step began, is to
// have for a point to come out where it is now.
//
//   moved   m, b against a
//   begun   tangent as the step began; `tangent` by now
//   point   of a lever arm (see ContactPointWide)
template <class Real>
double separation_for(const MovedContact& contact,
                      const PlacedContact& placed,
                      const Vec3& moved,
                      const Vec3& begun,
                      const Vec3& tangent,
                      const ContactPointWide<Real>& point,
                      std::size_t lane)
{
    const double first{point.lever_arm[0].at[lane]}, second{point.lever_arm[1].at[lane]};
    const Vec3& normal = placed.normal;
    const Vec3 off = contact.normal.cross(begun) * first - begun * second;
    const Vec3 turn_a = contact.turn_a.conjugate() * normal - normal,
               turn_b = contact.turn_b.conjugate() * normal - normal;
    const double now = placed.separation + normal.dot(contact.turn_b * off - contact.turn_a * off);
    const double added = normal.dot(moved) + turn_b.dot(placed.arm_b + normal * contact.round_b)
        - turn_a.dot(placed.arm_a - normal * contact.round_a);
    const Vec3 turn = turn_b - turn_a;
    return now - added - first * turn.dot(normal.cross(tangent)) + second * turn.dot(tangent);
}

template <class Real>
void turn_lane(const ContactConstraintsView<Real>& constraints, std::size_t at, std::size_t lane)
{
    ContactConstraintWide<Real>& block = constraints.blocks[at];
    TurningArmsWide<Real>& begun = constraints.turning_arms[at];
    SolverBody<Real>& a = constraints.bodies[block.a[lane]];
    SolverBody<Real>& b = constraints.bodies[block.b[lane]];
    const MovedContact still = begun_contact(block, begun, lane);
    MovedContact contact = still;
    Vec3 moved = vector_at(b.delta_pose) - vector_at(a.delta_pose);
    contact.center_offset -= moved;
    contact.turn_a = turn_of(a);
    contact.turn_b = turn_of(b);
    PlacedContact now = place(contact);
    if (is_far(contact, now)) {
        contact = still;
        moved = Vec3::Zero();
        now = place(still);
        set(begun.lanes, lane, false);
    }
    const Vec3 begun_tangent = in_double(begun.tangent, lane);
    const Vec3 tangent = (contact.flat == RollsFlat::a       ? contact.turn_a
                              : contact.flat == RollsFlat::b ? contact.turn_b
                                                             : Quat(Quat::Identity()))
        * begun_tangent;

    const Vec3 before = impulse_of(constraints, block, lane);
    const Vec3 torque_a = vector_at(begun.now_a, lane).cross(before),
               torque_b = vector_at(begun.now_b, lane).cross(before);
    store(now.normal, block.normal, lane);
    store(tangent, block.tangent, lane);
    store(now.arm_a, block.center_a, lane);
    store(now.arm_b, block.center_b, lane);
    store(now.arm_a, begun.now_a, lane);
    store(now.arm_b, begun.now_b, lane);
    const Vec3 impulse = impulse_of(constraints, block, lane), more = impulse - before;
    if (has(block.writes_a, lane)) push(a, -more, torque_a - now.arm_a.cross(impulse));
    if (has(block.writes_b, lane)) push(b, more, now.arm_b.cross(impulse) - torque_b);
    for (std::size_t k = 0; k < static_cast<std::size_t>(block.points); ++k) {
        ContactPointWide<Real>& point = constraints.points[block.first_point + k];
        point.separation.at[lane] = static_cast<Real>(
            double{begun.beyond[k].at[lane]}
            + separation_for(contact, now, moved, begun_tangent, tangent, point, lane));
    }
}

}  // namespace

PlacedContact place(const MovedContact& contact)
{
    PlacedContact now;
    now.normal = contact.normal;
    if (contact.flat == RollsFlat::a) now.normal = contact.turn_a * contact.normal;
    if (contact.flat == RollsFlat::b) now.normal = contact.turn_b * contact.normal;
    now.arm_a = contact.turn_a * contact.core_a + now.normal * contact.round_a;
    now.arm_b = contact.turn_b * contact.core_b - now.normal * contact.round_b;
    now.separation = now.normal.dot(now.arm_b - contact.center_offset - now.arm_a);
    const auto roll = [&](Vec3& arm, const Vec3& there, double round) {
        now.rolled = (there - arm).norm() / (arm.norm() + round);
        arm = there;
    };
    const Vec3 apart = contact.center_offset + now.normal * now.separation;
    if (contact.flat == RollsFlat::a) roll(now.arm_a, now.arm_b - apart, contact.round_b);
    if (contact.flat == RollsFlat::b) roll(now.arm_b, now.arm_a + apart, contact.round_a);
    return now;
}

template <class Real>
void note_turning_arms(const ContactConstraintsView<Real>& constraints,
                       std::size_t place,
                       std::size_t lane,
                       const Contact<Real>& contact,
                       double extent)
{
    const ContactConstraintWide<Real>& block = constraints.blocks[place];
    TurningArmsWide<Real>& begun = constraints.turning_arms[place];
    const bool moves_a = has(block.writes_a, lane), moves_b = has(block.writes_b, lane);
    const RollsFlat flat = rolls_flat(contact, extent, moves_a, moves_b);
    const Vec3T<Real> outward = vector_at(block.normal, lane);
    const bool held =
        (moves_a && is_held_beyond<Real>(vector_at(block.center_a, lane), outward, contact.round_a))
        || (moves_b
            && is_held_beyond<Real>(vector_at(block.center_b, lane), -outward, contact.round_b));
    if (!held && flat == RollsFlat::no) return;

    const Vec3 normal = outward.template cast<double>(), center_a = in_double(block.center_a, lane),
               center_b = in_double(block.center_b, lane);
    set(begun.lanes, lane, true);
    set(begun.flat_a, lane, flat == RollsFlat::a);
    set(begun.flat_b, lane, flat == RollsFlat::b);
    store(normal, begun.normal, lane);
    store(in_double(block.tangent, lane), begun.tangent, lane);
    store(center_a, begun.center_a, lane);
    store(center_b, begun.center_b, lane);
    store(center_a, begun.now_a, lane);
    store(center_b, begun.now_b, lane);
    const Vec3 offset = contact.center_offset.template cast<double>();
    store(offset, begun.center_offset, lane);
    const double apart = normal.dot(center_b - offset - center_a);
    for (std::size_t k = 0; k < static_cast<std::size_t>(contact.count); ++k)
        begun.beyond[k].at[lane] = static_cast<Real>(double{contact.points[k].separation} - apart);
}

template <class Real>
void turn_arms(const ContactConstraintsView<Real>& constraints, std::size_t begin, std::size_t end)
{
    for (std::size_t place = begin; place < end; ++place) {
        const std::uint16_t lanes = constraints.turning_arms[place].lanes;
        if (lanes == 0) continue;
        for (std::size_t lane = 0; lane < kBlock; ++lane)
            if (has(lanes, lane)) turn_lane(constraints, place, lane);
        solve_kernels<Real>().update_masses(constraints, place);
    }
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template void note_turning_arms<Real>(const ContactConstraintsView<Real>&, std::size_t,        \
                                          std::size_t, const Contact<Real>&, double);              \
    template void turn_arms<Real>(const ContactConstraintsView<Real>&, std::size_t, std::size_t);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
