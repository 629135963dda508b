// Escalation: islands whose loads are too much for the solver, found by what their contacts bear.
//
// A soft contact gives way under its load. Where it gives way so far that it turns rigid, one
// iteration a substep no longer settles it, and the less the higher a body stands on others: that
// is what a heavy box on a light one, a tower, a column of dice and a house of cards have in
// common.
#pragma once

#include "kernels/solver/direct/direct.hpp"
#include "pipeline/step/step_data.hpp"

namespace throng {

/// Strain from which an island is stubborn, and below which it is no more. Equal boxes, heavy ones
/// on light ones and uneven columns of any size, by the default dials with sleep off, stand for
/// 20 s up to a strain of 1.8; the first fall at 2.4.
inline constexpr double kStrained = 2, kRelieved = 1.2;

/// Strain beyond which the finest substeps do not do.
inline constexpr double kExactStrain = 256 * kStrained;

/// Contacts up to which an island is looked at: twice the substeps for so many are half of what a
/// step may cost beyond the usual.
inline constexpr std::size_t kMostEscalated = 1 << 14;

/// Contacts up to which an island may be solved exactly, and contacts times bodies: of more than
/// that only columns, which are solved in a step or two as they stand. A heap of thirty bodies
/// takes all the steps that it may, in every step, 50 ms of them; finer substeps hold it as well.
inline constexpr std::size_t kExactContacts = 48, kExactTangle = 256;

inline bool is_column(std::size_t bodies, std::size_t contacts) { return contacts <= bodies + 1; }

inline bool may_be_exact(std::size_t bodies, std::size_t contacts)
{
    return contacts <= kExactContacts
        && (is_column(bodies, contacts) || contacts * bodies <= kExactTangle);
}

/// What an island of that strain needs, which may be solved exactly or not. Strain goes with the
/// square of the substep. Twice the substeps are for those whose strain fades: a column whose load
/// grows as it settles would be thrown by a change to four times.
Effort effort_for(double strain, bool exact);

/// What is put into a solve of an island that is escalated: what float tells of its speeds.
inline constexpr DirectEffort kExactEffort = {.steps = 24, .enough = 1e-7, .pivots = false};

}  // namespace throng
