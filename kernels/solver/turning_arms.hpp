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
//
// A rim that rolls is the other reason: where a can, a coin or a rod that is set upright touches,
// the place runs round the rim many times as fast as anything moves. Held where the step found it,
// it lags, and its push turns the body on the way that it goes. So this place is told for the
// middle of each substep, and the body's spin in axes taken anew there. As the body tips over the
// arm stays as long and steep as the step found it, like that of a box on its edge. It runs as far
// where it is the flat side that turns, of somebody who leans on a can.
#pragma once

#include "kernels/data/contacts.hpp"
#include "kernels/math/numbers.hpp"
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

/// How far the place of touch may run round a rim in a step, as a share of its radius.
inline constexpr double kFarthestRimRun = 1;

/// Whether all points of a contact are on rims of one of its bodies, b or else a, which is tilted
/// enough for one place to be the lowest.
template <class Real>
bool is_on_rim(const Contact<Real>& contact, const RoundRim& rim, bool is_b)
{
    constexpr double kFlattest = 3e-3, kLying = 5e-2, kBeside = 1e-2;  // sines; of the radius
    if (!(rim.radius > 0)) return false;
    const Vec3 axis = vector_at(rim.axis), normal = contact.normal.template cast<double>();
    if (!(axis.cross(normal).squaredNorm() > kFlattest * kFlattest)) return false;
    // On its side it rolls as what is round does.
    if (contact.count > 1 && !(std::abs(axis.dot(normal)) > kLying)) return false;
    for (int k = 0; k < contact.count; ++k) {
        const Vec3T<Real> on_a = contact.points[static_cast<std::size_t>(k)].anchor_a;
        const Vec3 arm = (is_b ? contact.anchor_b(k) : on_a).template cast<double>();
        if (std::abs(axis.cross(arm).norm() - rim.radius) > kBeside * rim.radius) return false;
    }
    return true;
}

/// The flat side, round in no way, on which a rim of the other body rolls, or which rolls on it.
template <class Real>
RollsFlat rolls_on_rim(const Contact<Real>& contact,
                       const RoundRim& rim_a,
                       const RoundRim& rim_b,
                       bool moves_a,
                       bool moves_b)
{
    const bool on_a = is_on_rim(contact, rim_a, false), on_b = is_on_rim(contact, rim_b, true);
    if (!moves_a && !moves_b) return RollsFlat::no;
    if (on_b && !on_a && !(contact.round_a > 0)) return RollsFlat::a;
    if (on_a && !on_b && !(contact.round_b > 0)) return RollsFlat::b;
    return RollsFlat::no;
}

/// A contact as the step began, and how its two bodies have gone since.
///
///   core_a, core_b  m, arms without the radius of a round side, which does not turn along
///   flat            that on which something rolls
///   rim             of what rolls there; its radius is 0 where that is not a rim
///   tips            the arm of the rim is to be as steep as it is by now
///   center_offset   m, from b's center of mass to a's, as they are by now
struct MovedContact {
    Vec3 normal, core_a, core_b;
    double round_a = 0, round_b = 0;
    RollsFlat flat = RollsFlat::no;
    RoundRim rim;
    bool tips = false;
    Vec3 center_offset;
    Quat turn_a = Quat::Identity(), turn_b = Quat::Identity();
};

/// Where a contact is by now: the normal goes with a flat side that rolls, and the point on that
/// with the round one.
///
///   turn_a, turn_b  of the points on either side: that of the body, or of the place round its rim
///   turn    of tangents
///   rolled  along a flat side, as a share of the arm there and the radius of the other; of a rim
///           round it, as a share of its radius
struct PlacedContact {
    Vec3 normal, arm_a, arm_b;
    Quat turn_a = Quat::Identity(), turn_b = Quat::Identity(), turn = Quat::Identity();
    double separation = 0, rolled = 0;
};
PlacedContact place(const MovedContact& contact);

/// The same a time later, if both bodies turn on as they do; the separation is that of now.
///
///   spin_a, spin_b  rad/s, in world axes
PlacedContact
place_ahead(const MovedContact& contact, const Vec3& spin_a, const Vec3& spin_b, double time);

/// Whether that leads farther than the contact that was there as the step began can tell.
bool is_far(const MovedContact& contact, const PlacedContact& placed);

/// Notes whether a contact is one of those, once its constraint is made.
///
///   extent  m, as of rolls_flat()
///   on_rim  as rolls_on_rim() has it
template <class Real>
void note_turning_arms(const ContactConstraintsView<Real>& constraints,
                       std::size_t place,
                       std::size_t lane,
                       const Contact<Real>& contact,
                       double extent,
                       RollsFlat on_rim);

/// Puts the contacts of blocks where their bodies are, once velocities of a substep are integrated,
/// and what they gave in the last one with them. In the first substep of a step there are no others
/// to put anywhere than rims.
///
///   time  s, of the substep
template <class Real>
void turn_arms(const ContactConstraintsView<Real>& constraints,
               std::size_t begin,
               std::size_t end,
               double time,
               bool first);

/// Tells the separations of rims anew, once bodies have moved: what spins does not rise from where
/// it touches.
template <class Real>
void place_rims(const ContactConstraintsView<Real>& constraints,
                std::size_t begin,
                std::size_t end);

}  // namespace throng
