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

/// Who rolls with a flat side on a round one, that of the other.
enum class RollsFlat : std::uint8_t { no, a, b };

/// Along two points and more a round side touches nothing but a flat one, or another.
template <class Real>
RollsFlat rolls_flat(const Contact<Real>& contact, bool moves_a, bool moves_b)
{
    const bool round_a = contact.round_a > 0, round_b = contact.round_b > 0;
    if (contact.count < 2 || round_a == round_b) return RollsFlat::no;
    if (round_b) return moves_a ? RollsFlat::a : RollsFlat::no;
    return moves_b ? RollsFlat::b : RollsFlat::no;
}

/// Notes whether a contact is one of those, once its constraint is made.
///
///   arms  of its block, where no lane was noted before the first
template <class Real>
void note_turning_arms(const ContactConstraintsView<Real>& constraints,
                       std::size_t place,
                       std::size_t lane,
                       const Contact<Real>& contact);

/// Puts the contacts of blocks where their bodies are, once velocities of a substep are integrated,
/// and what they gave in the last one with them. Effective masses stay: they say how fast
/// iterations come to an answer, and not which.
template <class Real>
void turn_arms(const ContactConstraintsView<Real>& constraints, std::size_t begin, std::size_t end);

}  // namespace throng
