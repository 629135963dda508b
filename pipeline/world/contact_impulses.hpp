// Contact impulses: what the contacts of the last step did to bodies, whichever list they are in.
#pragma once

#include "pipeline/contacts/contact_lists.hpp"
#include "pipeline/contacts/impacts.hpp"
#include "pipeline/contacts/wake_pairs.hpp"
#include "pipeline/world/world_state.hpp"

namespace throng {

/// Calls for every contact of the lists, in their order: its two bodies, and a function that adds
/// up what it did to the second over the last substep, N s, friction included. Then, where anything
/// bounces, for every contact's impacts of the whole step; those of islands that the direct solver
/// took are among what their contacts hold.
template <class Real, class Each>
void for_each_contact_impulse(const StepData<Real>& data, bool may_bounce, const Each& each)
{
    const auto& colliders = std::get<Colliders>(data);
    const auto add = [&](PairKey key, const Contact<Real>& contact) {
        if (contact.count == 0) return;
        const auto on_b = [&] {
            Vec3 impulse = contact.friction.template cast<double>();
            for (int k = 0; k < contact.count; ++k)
                impulse += contact.normal.template cast<double>()
                    * double{contact.points[static_cast<std::size_t>(k)].impulse};
            return impulse;
        };
        each(colliders.body[first_of(key)], colliders.body[second_of(key)], on_b);
    };
    for_each_contact(std::get<Pairs>(data), std::get<ConvexContacts<Real>>(data),
                     std::get<MeshContacts<Real>>(data), std::get<SolidContacts<Real>>(data), add);
    for_each_sleeping_contact(std::get<SleepingPairs>(data), std::get<SleepingContacts<Real>>(data),
                              add);

    if (!may_bounce) return;
    for_each_impact(std::get<ActiveContacts>(data), std::get<Layout>(data),
                    std::get<ContactConstraints<Real>>(data),
                    [&](const ActiveContacts::Entry& entry, const Vec3T<Real>& on_b) {
                        each(entry.body_a, entry.body_b,
                             [&]() -> Vec3 { return on_b.template cast<double>(); });
                    });
}

/// The same of a world.
template <class Each>
void for_each_contact_impulse(const WorldState& state, const Each& each)
{
    std::visit(
        [&](const auto& chosen) {
            using Real = typename std::decay_t<decltype(chosen)>::Number;
            for_each_contact_impulse<Real>(chosen.data, state.effects.on.has(Effect::restitution),
                                           each);
        },
        state.step);
}

}  // namespace throng
