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
void wake_pairs(const Colliders& colliders, const PairData<Real>& data);

/// Calls for all pairs that sleep, whoever sleeps on; they leave again with the next that do.
void call_all(SleepingPairs& sleeping);

/// Takes the pairs of which neither moves and somebody sleeps out of the lists.
template <class Real>
void put_to_sleep(const Colliders& colliders, const BodyStates& states, const PairData<Real>& data);

/// Takes the pairs that go, by their keys, out of the lists with all they remember.
template <class Real>
void drop_pairs(const std::function<bool(PairKey)>& goes, const PairData<Real>& data);

/// Calls for each contact of a pair that is kept at a place: its key and the contact.
template <class Real, class Each>
void for_each_contact_at(std::size_t place,
                         const SleepingPairs& sleeping,
                         const SleepingContacts<Real>& contacts,
                         const Each& each)
{
    const PairKey key = sleeping.kept[place].key;
    const auto& of_kept = contacts.of_kept[place];
    if (of_kept.state.contact != PairState::kApart)
        each(key, contacts.contacts[of_kept.state.contact]);
    if (of_kept.many == kNoBody) return;
    for (const auto& entry : contacts.many[of_kept.many].entries) each(key, entry.contact);
}

/// The same for each convex contact, contact with a mesh and contact of a solid that sleeps, in an
/// order that does not depend on threads.
template <class Real, class Each>
void for_each_sleeping_contact(const SleepingPairs& sleeping,
                               const SleepingContacts<Real>& contacts,
                               const Each& each)
{
    for (std::size_t place = 0; place < sleeping.kept.size(); ++place)
        for_each_contact_at(place, sleeping, contacts, each);
}

/// Calls for the key of each pair that touches and that a sleeping island holds.
template <class Real, class Each>
void for_each_touching_pair_of(std::uint32_t island,
                               const SleepingPairs& sleeping,
                               const SleepingContacts<Real>& contacts,
                               const Each& each)
{
    if (island >= sleeping.of_island.size()) return;
    for (const SleepingPairs::Ref& ref : sleeping.of_island[island].refs) {
        const auto& of_kept = contacts.of_kept[ref.at];
        const bool touches = of_kept.state.contact != PairState::kApart
            || (of_kept.many != kNoBody && !contacts.many[of_kept.many].entries.empty());
        if (touches && sleeping.holds(ref)) each(sleeping.kept[ref.at].key);
    }
}

}  // namespace throng
