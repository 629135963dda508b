// Sleep pairs: after somebody fell asleep, what only sleeps or stands still is out of the way.
#include "pipeline/contacts/wake_pairs.hpp"

namespace throng {

template <class Real>
void sleep_pairs(const Colliders& colliders,
                 const BodyStates& states,
                 const SleepEvents& sleep_events,
                 const PairData<Real>& data)
{
    auto& sleeping = data.template get<SleepingPairs>();
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
