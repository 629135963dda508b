// Wake touched: whoever somebody awake touches wakes, with all that fell asleep with it.
#include "pipeline/step/stages.hpp"

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
                  const Velocities& velocities,
                  const ConvexContacts<Real>& contacts,
                  const SolidContacts<Real>& solids,
                  Beds& beds,
                  BodyStates& states,
                  Rest& rest)
{
    rest.awoken.clear();
    if (beds.sleepers.size() == beds.free.size()) return;
    // What moves by itself and stands still disturbs nobody.
    const auto stirs = [&](std::uint32_t body) {
        return states.moves(body)
            && (states.dynamic(body) || !velocities.linear[body].isZero(0)
                || !velocities.angular[body].isZero(0));
    };
    const auto disturb = [&](std::uint32_t a, std::uint32_t b) {
        if (states.bed[b] != kNobody && stirs(a)) wake_bed(states.bed[b], beds, states, rest);
    };
    const auto meet = [&](PairKey key) {
        const std::uint32_t a = colliders.body[first_of(key)];
        const std::uint32_t b = colliders.body[second_of(key)];
        disturb(a, b);
        disturb(b, a);
    };
    // Somebody who sleeps comes near what stands still only when one of them was put there.
    const auto put_there = [&](std::size_t i) {
        return pairs.changed && pairs.from[i] == Pairs::kNewPair;
    };
    const auto wake = [&](std::uint32_t body) {
        if (states.bed[body] != kNobody) wake_bed(states.bed[body], beds, states, rest);
    };
    for (std::size_t i = 0; i < pairs.keys.size(); ++i) {
        if (contacts.of_pair[i].contact != PairState::kApart) meet(pairs.keys[i]);
        if (!put_there(i)) continue;
        const std::uint32_t a = colliders.body[first_of(pairs.keys[i])];
        const std::uint32_t b = colliders.body[second_of(pairs.keys[i])];
        if (!states.dynamic(a)) wake(b);
        if (!states.dynamic(b)) wake(a);
    }
    for (const auto& entry : solids.entries)
        if (entry.contact.count > 0) meet(pairs.keys[entry.pair]);
    // Contacts with meshes are not known yet: a mesh that moves wakes whoever is near.
    for (const std::uint32_t i : pairs.on_mesh) meet(pairs.keys[i]);
    std::sort(rest.awoken.begin(), rest.awoken.end());
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template void wake_touched<Real>(const Pairs&, const Colliders&, const Velocities&,            \
                                     const ConvexContacts<Real>&, const SolidContacts<Real>&,      \
                                     Beds&, BodyStates&, Rest&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
