// Sleep pairs: after somebody fell asleep, what only sleeps or stands still is out of the way.
#include "pipeline/contacts/wake_pairs.hpp"

namespace throng {

namespace {

// What was found of sleepers on meshes, who may be woken before their meshes are looked at: whether
// or not their pairs went out of the way, it is found anew then.
template <class Real>
void forget_finds(const Colliders& colliders,
                  const BodyStates& states,
                  const Pairs& pairs,
                  MeshContacts<Real>& meshes)
{
    std::erase_if(meshes.found.pairs, [&](const auto& found) {
        const PairKey key = pairs.keys[found.pair];
        return !states.moves(colliders.body[first_of(key)])
            && !states.moves(colliders.body[second_of(key)]);
    });
}

}  // namespace

template <class Real>
void sleep_pairs(const Colliders& colliders,
                 const BodyStates& states,
                 const SleepEvents& sleep_events,
                 const PairData<Real>& data)
{
    auto& sleeping = data.template get<SleepingPairs>();
    if (!sleep_events.fell_asleep.empty())
        forget_finds(colliders, states, data.template get<Pairs>(),
                     data.template get<MeshContacts<Real>>());
    const bool waits = sleeping.mixed && !sleeping.seen;
    sleeping.seen = true;
    if (!waits && (sleeping.mixed || !sleep_events.fell_asleep.empty()))
        put_to_sleep<Real>(colliders, states, data);
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template void sleep_pairs<Real>(const Colliders&, const BodyStates&, const SleepEvents&,       \
                                    const PairData<Real>&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
