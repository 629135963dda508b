// Wake touched: whoever somebody awake touches wakes, with all that fell asleep with it.
#include "pipeline/stages.hpp"

#include <algorithm>

namespace throng {

namespace {

void wake_bed(std::uint32_t bed, Beds& beds, BodyStates& states, Rest& rest)
{
    for (const std::uint32_t body : beds.sleepers[bed]) {
        states.awake[body] = 1;
        states.quiet_time[body] = 0;
        states.bed[body] = kNobody;
        rest.awoken.push_back(body);
    }
    beds.sleepers[bed].clear();
    beds.free.push_back(bed);
}

}  // namespace

template <class Real>
void wake_touched(const Pairs& pairs,
                  const Colliders& colliders,
                  const ConvexContacts<Real>& contacts,
                  Beds& beds,
                  BodyStates& states,
                  Rest& rest)
{
    rest.awoken.clear();
    if (beds.sleepers.size() == beds.free.size()) return;
    for (std::size_t i = 0; i < pairs.keys.size(); ++i) {
        if (contacts.of_pair[i].count == 0) continue;
        const std::uint32_t a = colliders.body[first_of(pairs.keys[i])];
        const std::uint32_t b = colliders.body[second_of(pairs.keys[i])];
        if (states.moves(a) == states.moves(b)) continue;
        const std::uint32_t asleep = states.moves(a) ? b : a;
        if (states.bed[asleep] != kNobody) wake_bed(states.bed[asleep], beds, states, rest);
    }
    std::sort(rest.awoken.begin(), rest.awoken.end());
}

template void wake_touched<float>(
    const Pairs&, const Colliders&, const ConvexContacts<float>&, Beds&, BodyStates&, Rest&);
template void wake_touched<double>(
    const Pairs&, const Colliders&, const ConvexContacts<double>&, Beds&, BodyStates&, Rest&);

}  // namespace throng
