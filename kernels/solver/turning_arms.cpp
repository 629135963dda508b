#include "kernels/solver/turning_arms.hpp"

#include "kernels/solver/contact_packing.hpp"
#include "kernels/solver/solver_bodies.hpp"
#include "throng/rotation.hpp"

#include <algorithm>

namespace throng {

namespace {

constexpr double kFarthestTurn = 0.3;  // rad, in a step

// What b, or a against it, has of impulses at an arm.
template <class Real>
void push(SolverBody<Real>& body, const Vec3& impulse, const Vec3& torque)
{
    const Vec3 velocity = impulse * double{body.inertia[0]},
               spin = tensor_at(body.inertia + 1).matrix() * torque;
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

// N m s on b beside that: of points beside the center, and of what resists turning.
template <class Real>
Vec3 couple_of(const ContactConstraintsView<Real>& constraints,
               const ContactConstraintWide<Real>& block,
               std::size_t lane)
{
    Vec3 couple(0, 0, double{block.torsional_impulse.at[lane]});
    for (std::size_t k = 0; k < static_cast<std::size_t>(block.points); ++k) {
        const ContactPointWide<Real>& point = constraints.points[block.first_point + k];
        const double impulse{point.impulse.at[lane]};
        couple.x() += double{point.lever_arm[0].at[lane]} * impulse;
        couple.y() += double{point.lever_arm[1].at[lane]} * impulse;
    }
    if (constraints.rolling_frictions != nullptr) {
        const auto place = static_cast<std::size_t>(&block - constraints.blocks);
        couple += in_double(constraints.rolling_frictions[place].impulse, lane);
    }
    const Vec3 normal = in_double(block.normal, lane), tangent = in_double(block.tangent, lane);
    return tangent * couple.x() + normal.cross(tangent) * couple.y() + normal * couple.z();
}

bool has(std::uint16_t lanes, std::size_t lane) { return (lanes >> lane & 1) != 0; }

void set(std::uint16_t& lanes, std::size_t lane, bool to)
{
    const unsigned bit = 1u << lane;
    lanes = static_cast<std::uint16_t>(to ? lanes | bit : lanes & ~bit);
}

// The rim that rolls in a lane, or none.
template <class Real>
RoundRim rim_of(const ContactConstraintsView<Real>& constraints,
                const ContactConstraintWide<Real>& block,
                const TurningArmsWide<Real>& begun,
                std::size_t lane)
{
    if (!has(begun.rims, lane)) return {};
    const auto& side = has(begun.flat_a, lane) ? block.b : block.a;
    return constraints.rims[static_cast<std::size_t>(side[lane])];
}

// A contact of which both bodies are where they were as the step began.
template <class Real>
MovedContact begun_contact(const ContactConstraintsView<Real>& constraints,
                           const ContactConstraintWide<Real>& block,
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
    contact.rim = rim_of(constraints, block, begun, lane);
    return contact;
}

// Axes of a direction that another one is not, as near to that as can be.
Mat3 axes_towards(const Vec3& direction, const Vec3& other)
{
    const Vec3 across = (other - direction * direction.dot(other)).normalized();
    Mat3 axes;
    axes << across, direction.cross(across), direction;
    return axes;
}

Quat turn_of_axes(const Mat3& before, const Mat3& now)
{
    return Quat(Mat3(now * before.transpose()));
}

// The places of touch round a rim go with that where it is lowest. The arm goes round, and tips
// with the body only if that is asked: see turning_arms.hpp.
void place_on_rim(const MovedContact& contact, PlacedContact& now)
{
    const bool is_b = contact.flat == RollsFlat::a;
    const double outward = is_b ? -1 : 1;
    Quat& turn = is_b ? now.turn_b : now.turn_a;
    const Vec3 axis = vector_at(contact.rim.axis), axis_now = turn * axis;
    const Mat3 before = axes_towards(axis, contact.normal * outward),
               by_now = axes_towards(axis_now, now.normal * outward);
    now.rolled = (by_now.col(0) - before.col(0)).norm();
    turn = turn_of_axes(before, by_now);
    now.turn = turn_of_axes(axes_towards(contact.normal, axis), axes_towards(now.normal, axis_now));

    const Vec3 begun_a = contact.core_a + contact.normal * contact.round_a,
               begun_b = contact.core_b - contact.normal * contact.round_b;
    now.arm_a = now.turn_a * begun_a;
    now.arm_b = now.turn_b * begun_b;
    now.separation = now.normal.dot(now.arm_b - contact.center_offset - now.arm_a);
    const Vec3 apart = contact.center_offset + now.normal * now.separation;
    if (is_b) {
        if (!contact.tips) now.arm_b = now.turn * begun_b;
        now.arm_a = now.arm_b - apart;
    } else {
        if (!contact.tips) now.arm_a = now.turn * begun_a;
        now.arm_b = now.arm_a + apart;
    }
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
    const double now = placed.separation + normal.dot(placed.turn_b * off - placed.turn_a * off);
    const double added = normal.dot(moved) + turn_b.dot(placed.arm_b + normal * contact.round_b)
        - turn_a.dot(placed.arm_a - normal * contact.round_a);
    const Vec3 turn = turn_b - turn_a;
    return now - added - first * turn.dot(normal.cross(tangent)) + second * turn.dot(tangent);
}

// The two bodies of a lane, and its contact where they are by now.
template <class Real>
struct LaneBodies {
    SolverBody<Real>&a, &b;
    Vec3 moved;  // m, b against a since the step began

    LaneBodies(const ContactConstraintsView<Real>& constraints,
               const ContactConstraintWide<Real>& block,
               std::size_t lane)
        : a(constraints.bodies[block.a[lane]]), b(constraints.bodies[block.b[lane]]),
          moved(vector_at(b.delta_pose) - vector_at(a.delta_pose))
    { }
    MovedContact contact_now(const MovedContact& begun) const
    {
        MovedContact contact = begun;
        contact.center_offset -= moved;
        contact.turn_a = turn_of(a);
        contact.turn_b = turn_of(b);
        return contact;
    }
};

// Of points where a constraint is placed.
template <class Real>
void store_separations(const ContactConstraintsView<Real>& constraints,
                       std::size_t at,
                       std::size_t lane,
                       const MovedContact& contact,
                       const PlacedContact& placed,
                       const Vec3& moved)
{
    const ContactConstraintWide<Real>& block = constraints.blocks[at];
    const TurningArmsWide<Real>& begun = constraints.turning_arms[at];
    const Vec3 begun_tangent = in_double(begun.tangent, lane),
               tangent = in_double(block.tangent, lane);
    for (std::size_t k = 0; k < static_cast<std::size_t>(block.points); ++k) {
        ContactPointWide<Real>& point = constraints.points[block.first_point + k];
        point.separation.at[lane] = static_cast<Real>(
            double{begun.beyond[k].at[lane]}
            + separation_for(contact, placed, moved, begun_tangent, tangent, point, lane));
    }
}

template <class Real>
void turn_lane(const ContactConstraintsView<Real>& constraints,
               std::size_t at,
               std::size_t lane,
               double time)
{
    ContactConstraintWide<Real>& block = constraints.blocks[at];
    TurningArmsWide<Real>& begun = constraints.turning_arms[at];
    const LaneBodies<Real> bodies(constraints, block, lane);
    const MovedContact still = begun_contact(constraints, block, begun, lane);
    MovedContact contact = bodies.contact_now(still);
    Vec3 moved = bodies.moved;
    const bool on_rim = contact.rim.radius > 0, is_b = contact.flat == RollsFlat::a;
    const auto inertia_of = [&](std::int32_t body) {
        return constraints.inertias == nullptr ? nullptr : constraints.inertias + body;
    };
    PlacedContact now;
    if (on_rim) {
        const auto spin_of = [&](const SolverBody<Real>& body, std::int32_t index) -> Vec3 {
            return spin_frame(body, inertia_of(index)) * vector_at(body.motion + 4);
        };
        now = place_ahead(contact, spin_of(bodies.a, block.a[lane]),
                          spin_of(bodies.b, block.b[lane]), time / 2);
    } else {
        now = place(contact);
    }
    if (is_far(contact, now)) {
        set(begun.lanes, lane, false);
        // A rim has its last place as good as any.
        if (on_rim) return;
        contact = still;
        moved = Vec3::Zero();
        now = place(still);
    }
    // The arms of a rim are in world axes, and so is to be what they turn, if no other contact has
    // a say in that.
    Quat frame_a = Quat::Identity(), frame_b = Quat::Identity();
    if (on_rim && contact.rim.contacts == 1)
        (is_b ? frame_b : frame_a) = take_axes_anew(
            is_b ? bodies.b : bodies.a, inertia_of(is_b ? block.b[lane] : block.a[lane]));

    const Vec3 before = impulse_of(constraints, block, lane);
    const Vec3 turns = couple_of(constraints, block, lane);
    const Vec3 torque_a = frame_a * (vector_at(begun.now_a, lane).cross(before) + turns),
               torque_b = frame_b * (vector_at(begun.now_b, lane).cross(before) + turns);
    store(now.normal, block.normal, lane);
    store(now.turn * in_double(begun.tangent, lane), block.tangent, lane);
    store(now.arm_a, block.center_a, lane);
    store(now.arm_b, block.center_b, lane);
    store(now.arm_a, begun.now_a, lane);
    store(now.arm_b, begun.now_b, lane);
    const Vec3 impulse = impulse_of(constraints, block, lane), more = impulse - before;
    const Vec3 turn_on = couple_of(constraints, block, lane);
    const Vec3 on_a = now.arm_a.cross(impulse) + turn_on, on_b = now.arm_b.cross(impulse) + turn_on;
    if (has(block.writes_a, lane)) push(bodies.a, -more, torque_a - on_a);
    if (has(block.writes_b, lane)) push(bodies.b, more, on_b - torque_b);
    store_separations(constraints, at, lane, contact, now, moved);
}

// What a spin does to the height of a rim is nothing, and as constraints see it much.
template <class Real>
void place_rim(const ContactConstraintsView<Real>& constraints, std::size_t at, std::size_t lane)
{
    const ContactConstraintWide<Real>& block = constraints.blocks[at];
    const TurningArmsWide<Real>& begun = constraints.turning_arms[at];
    const LaneBodies<Real> bodies(constraints, block, lane);
    const MovedContact contact = bodies.contact_now(begun_contact(constraints, block, begun, lane));
    PlacedContact placed = place(contact);
    placed.normal = in_double(block.normal, lane);
    placed.arm_a = vector_at(begun.now_a, lane);
    placed.arm_b = vector_at(begun.now_b, lane);
    store_separations(constraints, at, lane, contact, placed, bodies.moved);
}

}  // namespace

PlacedContact place(const MovedContact& contact)
{
    PlacedContact now;
    now.turn_a = contact.turn_a;
    now.turn_b = contact.turn_b;
    if (contact.flat == RollsFlat::a) now.turn = contact.turn_a;
    if (contact.flat == RollsFlat::b) now.turn = contact.turn_b;
    now.normal = now.turn * contact.normal;
    if (contact.rim.radius > 0) {
        place_on_rim(contact, now);
        return now;
    }
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

PlacedContact
place_ahead(const MovedContact& contact, const Vec3& spin_a, const Vec3& spin_b, double time)
{
    MovedContact later = contact;
    later.turn_a = exponential(spin_a * time) * contact.turn_a;
    later.turn_b = exponential(spin_b * time) * contact.turn_b;
    PlacedContact ahead = place(later);
    ahead.separation = place(contact).separation;
    return ahead;
}

bool is_far(const MovedContact& contact, const PlacedContact& placed)
{
    const double half_a = contact.turn_a.vec().norm(), half_b = contact.turn_b.vec().norm();
    if (contact.rim.radius > 0)
        return (contact.flat == RollsFlat::a ? half_a : half_b) > kFarthestFlatTurn / 2
            || placed.rolled > kFarthestRimRun;
    return std::max(half_a, half_b)
        > (contact.flat == RollsFlat::no ? kFarthestTurn : kFarthestFlatTurn) / 2
        || placed.rolled > kFarthestFlatRoll;
}

template <class Real>
void note_turning_arms(const ContactConstraintsView<Real>& constraints,
                       std::size_t place,
                       std::size_t lane,
                       const Contact<Real>& contact,
                       double extent,
                       RollsFlat on_rim)
{
    ContactConstraintWide<Real>& block = constraints.blocks[place];
    TurningArmsWide<Real>& begun = constraints.turning_arms[place];
    const bool moves_a = has(block.writes_a, lane), moves_b = has(block.writes_b, lane);
    const RollsFlat flat =
        on_rim != RollsFlat::no ? on_rim : rolls_flat(contact, extent, moves_a, moves_b);
    set(begun.rims, lane, on_rim != RollsFlat::no);
    // A rim does not roll as a round side does.
    if (on_rim != RollsFlat::no) {
        set(block.axis_turns_a, lane, false);
        set(block.axis_turns_b, lane, false);
    }
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
void turn_arms(const ContactConstraintsView<Real>& constraints,
               std::size_t begin,
               std::size_t end,
               double time,
               bool first)
{
    for (std::size_t place = begin; place < end; ++place) {
        const TurningArmsWide<Real>& begun = constraints.turning_arms[place];
        const auto lanes = static_cast<std::uint16_t>(begun.lanes & (first ? begun.rims : ~0u));
        if (lanes == 0) continue;
        for (std::size_t lane = 0; lane < kBlock; ++lane)
            if (has(lanes, lane)) turn_lane(constraints, place, lane, time);
        solve_kernels<Real>().update_masses(constraints, place, lanes);
    }
}

template <class Real>
void place_rims(const ContactConstraintsView<Real>& constraints, std::size_t begin, std::size_t end)
{
    for (std::size_t place = begin; place < end; ++place) {
        const TurningArmsWide<Real>& begun = constraints.turning_arms[place];
        for (std::size_t lane = 0; lane < kBlock; ++lane)
            if (has(begun.lanes, lane) && has(begun.rims, lane))
                place_rim(constraints, place, lane);
    }
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template void note_turning_arms<Real>(const ContactConstraintsView<Real>&, std::size_t,        \
                                          std::size_t, const Contact<Real>&, double, RollsFlat);   \
    template void turn_arms<Real>(const ContactConstraintsView<Real>&, std::size_t, std::size_t,   \
                                  double, bool);                                                   \
    template void place_rims<Real>(const ContactConstraintsView<Real>&, std::size_t, std::size_t);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
