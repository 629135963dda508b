// Borne bodies: who of those that state-dependent forces act on is held by contacts.
#pragma once

#include "pipeline/forces/state_dependent_forces.hpp"
#include "pipeline/step/step_data.hpp"

namespace throng {

/// Which forced bodies of a batch are borne as the step begins: what contacts gave them in a
/// substep, as their impulses say, takes back what acts on them in one; or, where none has an
/// impulse yet, they stand on one of them. Who bounces gets many times as much, or nothing.
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

}  // namespace throng
