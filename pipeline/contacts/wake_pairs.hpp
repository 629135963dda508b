// Wake pairs: pairs that fall asleep leave the lists that a step goes through, and come back as
// somebody of theirs wakes; those of who is removed leave them for good.
//
// An island wakes in the midst of a step, and what touches it is solved in that very step: its
// pairs come back with their contacts as they left, at the places that their keys have.
#pragma once

#include "pipeline/step/stages.hpp"

#include <functional>

namespace throng {

/// Those of a step.
template <class Real>
PairData<Real> pair_data(StepData<Real>& data)
{
    return detail::Argument<Real, const PairData<Real>&>::of(data);
}

/// Wakes all bodies of a sleeping island and calls for their pairs. Appends the bodies to `woke`.
void wake_island(std::uint32_t island,
                 SleepingIslands& sleeping_islands,
                 BodyStates& states,
                 SleepingPairs& sleeping,
                 std::vector<std::uint32_t>& woke);

/// The sleeping islands that a body which stands still has pairs with; in any order, some more than
/// once.
std::vector<std::uint32_t> islands_beside(std::uint32_t body, const SleepingPairs& sleeping);

/// Puts the pairs that were called for back where they belong.
template <class Real>
void wake_pairs(const PairData<Real>& data);

/// Calls for all pairs that sleep, whoever sleeps on; they leave again with the next that do.
void call_all(SleepingPairs& sleeping);

/// Takes the pairs of which neither moves and somebody sleeps out of the lists.
template <class Real>
void put_to_sleep(const Colliders& colliders, const BodyStates& states, const PairData<Real>& data);

/// Takes the pairs that go, by their keys, out of the lists with all they remember.
template <class Real>
void drop_pairs(const std::function<bool(PairKey)>& goes, const PairData<Real>& data);

/// Calls for each convex contact, contact with a mesh and contact of a solid that sleeps: its key
/// and the contact, in an order that does not depend on threads.
template <class Real, class Each>
void for_each_sleeping_contact(const SleepingPairs& sleeping,
                               const SleepingContacts<Real>& contacts,
                               const Each& each)
{
    for (std::size_t at = 0; at < sleeping.kept.size(); ++at) {
        const PairKey key = sleeping.kept[at].key;
        const auto& of_kept = contacts.of_kept[at];
        if (of_kept.state.contact != PairState::kApart)
            each(key, contacts.contacts[of_kept.state.contact]);
        if (of_kept.many == kNoBody) continue;
        for (const auto& entry : contacts.many[of_kept.many].entries) each(key, entry.contact);
    }
}

}  // namespace throng
