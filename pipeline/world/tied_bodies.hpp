// Tied bodies: who shares what happens to momentum and energy in a step.
#pragma once

#include "kernels/parallel/disjoint_sets.hpp"
#include "pipeline/world/world_state.hpp"

namespace throng {

/// Makes sets of all bodies of a world, joined where the last step had a contact for two, or a
/// spring is between them; only those are joined of which `is_member(body)` says so.
template <class IsMember>
void join_tied_bodies(const WorldState& state, const IsMember& is_member, DisjointSets& sets)
{
    const auto count = static_cast<std::uint32_t>(state.get<BodyStates>().kind.size());
    sets.reset(count);
    for (std::uint32_t body = 0; body < count; ++body) sets.add(body);
    const auto join = [&](std::uint32_t a, std::uint32_t b) {
        if (a != kNoBody && b != kNoBody && is_member(a) && is_member(b)) sets.join(a, b);
    };
    for (const auto& entry : state.get<ActiveContacts>().entries) join(entry.body_a, entry.body_b);
    for (const SpringForce& spring : state.get<Forces>().springs) join(spring.a, spring.b);
}

}  // namespace throng
