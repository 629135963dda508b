// Wake islands: whoever somebody awake touches wakes, with all that fell asleep with it.
#include "pipeline/contacts/wake_pairs.hpp"

#include <algorithm>

namespace throng {

template <class Real>
void wake_islands(const Colliders& colliders,
                  const Velocities& velocities,
                  const PairData<Real>& data,
                  SleepingIslands& sleeping_islands,
                  BodyStates& states,
                  SleepEvents& sleep_events)
{
    sleep_events.woke.clear();
    if (sleeping_islands.bodies.size() == sleeping_islands.free.size()) return;
    const auto& pairs = data.template get<Pairs>();
    const auto& contacts = data.template get<ConvexContacts<Real>>();
    const auto& solids = data.template get<SolidContacts<Real>>();
    const auto wake = [&](std::uint32_t body) {
        if (const std::uint32_t island = states.sleeping_island[body]; island != kNoBody)
            wake_island(island, sleeping_islands, states, data.template get<SleepingPairs>(),
                        sleep_events.woke);
    };
    // What moves by itself and stands still disturbs nobody.
    const auto disturbs = [&](std::uint32_t body) {
        return states.moves(body)
            && (states.dynamic(body) || !velocities.linear[body].isZero(0)
                || !velocities.angular[body].isZero(0));
    };
    const auto disturb = [&](std::uint32_t a, std::uint32_t b) {
        if (states.sleeping_island[b] != kNoBody && disturbs(a)) wake(b);
    };
    const auto touch_each_other = [&](PairKey key) {
        const std::uint32_t a = colliders.body[first_of(key)];
        const std::uint32_t b = colliders.body[second_of(key)];
        disturb(a, b);
        disturb(b, a);
    };
    // Somebody who sleeps comes near what stands still only when one of them was put there.
    const auto put_there = [&](std::size_t i) {
        return pairs.changed && pairs.from[i] == Pairs::kNewPair;
    };
    for (std::size_t i = 0; i < pairs.keys.size(); ++i) {
        if (contacts.of_pair[i].contact != PairState::kApart) touch_each_other(pairs.keys[i]);
        if (!put_there(i)) continue;
        const std::uint32_t a = colliders.body[first_of(pairs.keys[i])];
        const std::uint32_t b = colliders.body[second_of(pairs.keys[i])];
        if (!states.dynamic(a)) wake(b);
        if (!states.dynamic(b)) wake(a);
    }
    for (const auto& entry : solids.entries)
        if (entry.contact.count > 0) touch_each_other(pairs.keys[entry.pair]);
    // Contacts with meshes are not known yet: a mesh that moves wakes whoever is near.
    for (const std::uint32_t i : pairs.on_mesh) touch_each_other(pairs.keys[i]);
    std::sort(sleep_events.woke.begin(), sleep_events.woke.end());
    wake_pairs<Real>(colliders, data);
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template void wake_islands<Real>(const Colliders&, const Velocities&, const PairData<Real>&,   \
                                     SleepingIslands&, BodyStates&, SleepEvents&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
