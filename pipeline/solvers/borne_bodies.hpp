// Borne bodies: who of those that state-dependent forces act on is held by contacts, and where they
// press.
#pragma once

#include "pipeline/forces/state_dependent_forces.hpp"
#include "pipeline/step/step_data.hpp"

#include <algorithm>

namespace throng {

/// Which forced bodies of a batch are borne as the step begins: what contacts gave them in a
/// substep, as their impulses say, takes back what acts on them in one; or, where none has an
/// impulse yet, they stand on somebody who is. Who bounces gets many times as much, or nothing.
///
///   forced   of the batch, with what acts on each
///   substep  s
template <class Real>
void find_borne(const Layout& layout,
                const Batch& batch,
                const ContactConstraints<Real>& constraints,
                const Masses& masses,
                double substep,
                std::span<ForcedBody> forced);

/// m/s: who comes in slower than twice what acts in a step presses two bodies together by is
/// resting there, not bouncing.
///
///   normal    from a to b
///   change_a  m/s, what all that acts does to it in a substep
inline double
least_speed_of(const Vec3& normal, const Vec3& change_a, const Vec3& change_b, int substeps)
{
    return 2 * substeps * std::max(0.0, normal.dot(Vec3(change_a - change_b)));
}

/// The same for all contacts of forced bodies, and of their islands what is slow there: sets
/// RestitutionWide::least_speed.
///
///   slow  m/s, of each island of the batch: twice the least of what acts on a forced body in a
///         step; 0 where there is none
///   fall  m/s, what gravity does in a substep
template <class Real>
void find_least_speeds(const Layout& layout,
                       const Batch& batch,
                       std::span<const ForcedBody> forced,
                       std::span<const double> slow,
                       const Vec3& fall,
                       int substeps,
                       ContactConstraints<Real>& constraints);

}  // namespace throng
