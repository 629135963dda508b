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

// Of two bodies since the step began: how they turned, and how far b moved against a, m.
struct Travel {
    Quat turn_a = Quat::Identity(), turn_b = Quat::Identity();
    Vec3 moved = Vec3::Zero();
};

// A contact where its bodies are now.
class TurnedContact {
public:
    template <class Real>
    TurnedContact(const ContactConstraintWide<Real>& block,
                  const TurningArmsWide<Real>& begun,
                  const Travel& travel,
                  std::size_t lane)
        : turn_a_(travel.turn_a), turn_b_(travel.turn_b), moved_(travel.moved),
          begun_tangent_(in_double(begun.tangent, lane))
    {
        const bool flat_a = (begun.flat_a >> lane & 1) != 0,
                   flat_b = (begun.flat_b >> lane & 1) != 0;
        const Quat along = flat_a ? turn_a_ : flat_b ? turn_b_ : Quat(Quat::Identity());
        const Vec3 before = in_double(begun.normal, lane);
        const double round_a{block.round_a.at[lane]}, round_b{block.round_b.at[lane]};
        begun_other_ = before.cross(begun_tangent_);
        normal = along * before;
        tangent = along * begun_tangent_;
        offset_ = in_double(begun.center_offset, lane) - moved_;
        // The radius of a round side does not turn along, but with the normal.
        end_a_ = normal * round_a;
        end_b_ = -normal * round_b;
        center_a = turn_a_ * (in_double(begun.center_a, lane) - before * round_a) + end_a_;
        center_b = turn_b_ * (in_double(begun.center_b, lane) + before * round_b) + end_b_;
        apart_ = normal.dot(center_b - offset_ - center_a);
        // On a flat side it goes to where the round one is.
        const Vec3 along_a = center_b - offset_ - normal * apart_,
                   along_b = center_a + offset_ + normal * apart_;
        if (flat_a) rolled_ = (along_a - center_a).norm() / (center_a.norm() + round_b);
        if (flat_b) rolled_ = (along_b - center_b).norm() / (center_b.norm() + round_a);
        flat_ = flat_a || flat_b;
        if (flat_a) center_a = along_a;
        if (flat_b) center_b = along_b;
    }

    /// Whether the contact that was there as the step began says nothing of where that leads to.
    bool is_far() const
    {
        const double half = std::max(turn_a_.vec().norm(), turn_b_.vec().norm());
        return half > (flat_ ? kFarthestFlatTurn : kFarthestTurn) / 2
            || rolled_ > kFarthestFlatRoll;
    }

    Vec3 normal, tangent, center_a, center_b;

    /// m, what a constraint that is given this, and adds what has moved since the step began, is to
    /// have for a point to come out where it is now.
    ///
    ///   first, second  m, see ContactPointWide::lever_arm
    double separation(double first, double second) const
    {
        const Vec3 off = begun_other_ * first - begun_tangent_ * second;
        const Vec3 turn_a = turn_a_.conjugate() * normal - normal,
                   turn_b = turn_b_.conjugate() * normal - normal;
        const double now = apart_ + normal.dot(turn_b_ * off - turn_a_ * off);
        const double added =
            normal.dot(moved_) + turn_b.dot(center_b - end_b_) - turn_a.dot(center_a - end_a_);
        const Vec3 turn = turn_b - turn_a;
        return now - added - first * turn.dot(normal.cross(tangent)) + second * turn.dot(tangent);
    }

private:
    Quat turn_a_, turn_b_;
    Vec3 moved_, begun_tangent_, begun_other_, offset_, end_a_, end_b_;
    double apart_ = 0, rolled_ = 0;
    bool flat_ = false;
};

template <class Real>
void turn_lane(const ContactConstraintsView<Real>& constraints, std::size_t place, std::size_t lane)
{
    ContactConstraintWide<Real>& block = constraints.blocks[place];
    TurningArmsWide<Real>& begun = constraints.turning_arms[place];
    SolverBody<Real>& a = constraints.bodies[block.a[lane]];
    SolverBody<Real>& b = constraints.bodies[block.b[lane]];
    const Travel travel{turn_of(a), turn_of(b), vector_at(b.delta_pose) - vector_at(a.delta_pose)};
    TurnedContact now(block, begun, travel, lane);
    if (now.is_far()) {
        now = TurnedContact(block, begun, Travel{}, lane);
        begun.lanes = static_cast<std::uint16_t>(begun.lanes & ~(1u << lane));
    }
    const Vec3 before = impulse_of(constraints, block, lane);
    const Vec3 torque_a = vector_at(begun.now_a, lane).cross(before),
               torque_b = vector_at(begun.now_b, lane).cross(before);
    store(now.normal, block.normal, lane);
    store(now.tangent, block.tangent, lane);
    store(now.center_a, block.center_a, lane);
    store(now.center_b, block.center_b, lane);
    store(now.center_a, begun.now_a, lane);
    store(now.center_b, begun.now_b, lane);
    const Vec3 impulse = impulse_of(constraints, block, lane), more = impulse - before;
    if ((block.writes_a >> lane & 1) != 0) push(a, -more, torque_a - now.center_a.cross(impulse));
    if ((block.writes_b >> lane & 1) != 0) push(b, more, now.center_b.cross(impulse) - torque_b);
    for (std::size_t k = 0; k < static_cast<std::size_t>(block.points); ++k) {
        ContactPointWide<Real>& point = constraints.points[block.first_point + k];
        point.separation.at[lane] =
            static_cast<Real>(double{begun.beyond[k].at[lane]}
                              + now.separation(double{point.lever_arm[0].at[lane]},
                                               double{point.lever_arm[1].at[lane]}));
    }
}

}  // namespace

template <class Real>
void note_turning_arms(const ContactConstraintsView<Real>& constraints,
                       std::size_t place,
                       std::size_t lane,
                       const Contact<Real>& contact,
                       double extent)
{
    const ContactConstraintWide<Real>& block = constraints.blocks[place];
    TurningArmsWide<Real>& begun = constraints.turning_arms[place];
    const bool moves_a = (block.writes_a >> lane & 1) != 0,
               moves_b = (block.writes_b >> lane & 1) != 0;
    const RollsFlat flat = rolls_flat(contact, extent, moves_a, moves_b);
    const Vec3T<Real> outward = vector_at(block.normal, lane);
    const bool held =
        (moves_a && is_held_beyond<Real>(vector_at(block.center_a, lane), outward, contact.round_a))
        || (moves_b
            && is_held_beyond<Real>(vector_at(block.center_b, lane), -outward, contact.round_b));
    if (!held && flat == RollsFlat::no) return;

    const auto bit = [&](bool is) { return is ? 1u << lane : 0u; };
    const Vec3 normal = outward.template cast<double>(), center_a = in_double(block.center_a, lane),
               center_b = in_double(block.center_b, lane);
    begun.lanes = static_cast<std::uint16_t>(begun.lanes | bit(true));
    begun.flat_a = static_cast<std::uint16_t>(begun.flat_a | bit(flat == RollsFlat::a));
    begun.flat_b = static_cast<std::uint16_t>(begun.flat_b | bit(flat == RollsFlat::b));
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
        if (constraints.turning_arms[place].lanes == 0) continue;
        for (std::size_t lane = 0; constraints.turning_arms[place].lanes >> lane != 0; ++lane)
            if ((constraints.turning_arms[place].lanes >> lane & 1) != 0)
                turn_lane(constraints, place, lane);
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
