// Impacts: what bouncing contacts did in the last step.
#pragma once

#include "kernels/data/contact_constraints.hpp"
#include "kernels/data/contacts.hpp"
#include "kernels/solver/contact_packing.hpp"

namespace throng {

/// Calls for every contact that may have bounced in the step: its entry, and what its impacts did
/// to the second body, N s. Not for those that the direct solver took, whose impacts are among what
/// their contacts hold.
template <class Real, class Each>
void for_each_impact(const ActiveContacts& active,
                     const Layout& layout,
                     const ContactConstraints<Real>& constraints,
                     const Each& each)
{
    if (constraints.restitutions.empty()) return;
    for (const Batch& batch : layout.batches) {
        if (batch.direct || !batch.calls.effects.has(Effect::restitution)) continue;
        const Slice &first = layout.slices[batch.first_slice],
                    &last = layout.slices[batch.first_slice + batch.slices - 1];
        for (std::size_t i = first.first_contact; i < last.first_contact + last.contacts; ++i) {
            const std::size_t lane = layout.lane[i];
            each(active.entries[layout.contacts[i]],
                 impact_impulse(constraints, lane / kBlock, static_cast<int>(lane % kBlock)));
        }
    }
}

}  // namespace throng
