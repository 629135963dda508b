// Turning arms: who hangs, who stands on a round side whose middle is above his center, and what
// lies with a flat side on a round one, swings.
//
// Constraints see arms and normals as the step began. What brings a body back that swings is that
// these turn along: told a step later they push on for too long each time, and the swing grows, by
// a share of the time times the step times the square of its frequency. With one substep it does
// not, as the body then moves on at the speed that it has by the end; the more substeps, the more
// it does. So these contacts, and no other, follow their bodies from substep to substep.
//
// Who stands on what is below his center does not swing: he falls, or several points hold him.
#pragma once

#include "kernels/data/contacts.hpp"
#include "kernels/solver/solve_kernels.hpp"

#include <algorithm>
#include <cstddef>

namespace throng {

/// Whether a contact holds a body beyond its center: for then its push brings the body back from a
/// turn.
///
///   arm      m, from the body's center
///   outward  normal, away from the body
///   round    m, radius of its side about that normal
template <class Real>
bool is_held_beyond(const Vec3T<Real>& arm, const Vec3T<Real>& outward, Real round)
{
    constexpr Real kBeyond = Real(1e-3);  // of the arm: less is rounding
    const Real beyond = round - arm.dot(outward);
    return beyond > 0 && beyond * beyond > kBeyond * kBeyond * arm.squaredNorm();
}

/// How far a flat side may turn in a step, rad, and how far a round one may roll along it, as a
/// share of the arm there and its radius: the contact of the step's beginning says nothing of where
/// more leads to.
inline constexpr double kFarthestFlatTurn = 0.1, kFarthestFlatRoll = 0.1;

/// Who rolls with a flat side on a round one, that of the other.
enum class RollsFlat : std::uint8_t { no, a, b };

/// Along two points and more a round side touches nothing but a flat one, or another. Where they do
/// not touch yet nothing rolls; and of what is much thinner than its arm is long the digits of
/// float do not tell where it would roll to.
///
///   extent  m, the lesser of the smallest half extents of the two
template <class Real>
RollsFlat rolls_flat(const Contact<Real>& contact, double extent, bool moves_a, bool moves_b)
{
    constexpr double kTouching = 0.1, kLongest = 1e3;  // of the extent
    const bool round_a = contact.round_a > 0, round_b = contact.round_b > 0;
    if (contact.count < 2 || round_a == round_b || !(round_b ? moves_a : moves_b))
        return RollsFlat::no;
    const auto& first = contact.points[0];
    if (std::min(first.separation, contact.points[1].separation) > kTouching * extent)
        return RollsFlat::no;
    const double arm{(round_b ? first.anchor_a : contact.anchor_b(0)).norm()};
    if (arm > kLongest * extent) return RollsFlat::no;
    return round_b ? RollsFlat::a : RollsFlat::b;
}

/// A contact as the step began, and how its two bodies have gone since.
///
///   core_a, core_b  m, arms without the radius of a round side, which does not turn along
///   center_offset   m, from b's center of mass to a's, as they are by now
struct MovedContact {
    Vec3 normal, core_a, core_b;
    double round_a = 0, round_b = 0;
    RollsFlat flat = RollsFlat::no;
    Vec3 center_offset;
    Quat turn_a = Quat::Identity(), turn_b = Quat::Identity();
};

/// Where a contact is by now: the normal goes with a flat side that rolls, and the point on that
/// with the round one.
///
///   rolled  along a flat side, as a share of the arm there and the radius of the other
struct PlacedContact {
    Vec3 normal, arm_a, arm_b;
    double separation = 0, rolled = 0;
};
PlacedContact place(const MovedContact& contact);

/// Notes whether a contact is one of those, once its constraint is made.
///
///   extent  m, as of rolls_flat()
template <class Real>
void note_turning_arms(const ContactConstraintsView<Real>& constraints,
                       std::size_t place,
                       std::size_t lane,
                       const Contact<Real>& contact,
                       double extent);

/// Puts the contacts of blocks where their bodies are, once velocities of a substep are integrated,
/// and what they gave in the last one with them.
template <class Real>
void turn_arms(const ContactConstraintsView<Real>& constraints, std::size_t begin, std::size_t end);

}  // namespace throng
