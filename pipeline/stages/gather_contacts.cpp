// Gather contacts: both kinds into one order, by pair, convex ones before those on meshes.
#include "kernels/parallel/blocks.hpp"
#include "pipeline/stages.hpp"

#include <algorithm>
#include <numeric>

namespace throng {

namespace {

constexpr std::size_t kGrain = 2048;  // pairs a block: some 10 microseconds of work

}  // namespace

template <class Real>
void gather_contacts(const Pairs& pairs,
                     const Colliders& colliders,
                     const Surfaces& surfaces,
                     const BodyStates& states,
                     const ConvexContacts<Real>& convex,
                     const MeshContacts<Real>& meshes,
                     ActiveContacts& active)
{
    const auto extent_of = [&](std::uint32_t collider) { return colliders.inner_extent[collider]; };
    const auto take = [&](std::size_t pair, const Contact<Real>& contact, std::size_t slot,
                          bool on_mesh, ActiveContacts::Entry& entry) {
        const std::uint32_t a = first_of(pairs.keys[pair]), b = second_of(pairs.keys[pair]);
        const std::uint32_t body_a = colliders.body[a], body_b = colliders.body[b];
        const bool pushes_a = states.dynamic(body_a) && states.moves(body_a);
        const bool pushes_b = states.dynamic(body_b) && states.moves(body_b);
        if (!pushes_a && !pushes_b) return false;
        const auto meeting = surfaces.between(colliders.material[a], colliders.material[b]);
        entry = {body_a,
                 body_b,
                 static_cast<std::uint32_t>(slot),
                 on_mesh,
                 static_cast<std::uint8_t>(contact.count),
                 static_cast<float>(meeting.friction),
                 static_cast<float>(meeting.restitution),
                 static_cast<float>(meeting.rolling_friction),
                 static_cast<float>(std::min(extent_of(a), extent_of(b)))};
        return true;
    };
    // Each block of pairs has room for all its contacts, wherever that begins.
    const std::size_t count = convex.of_pair.size(), blocks = block_count(count, kGrain);
    std::vector<std::size_t>& begins = active.begin;
    begins.assign(blocks + 1, 0);
    for_each_block(count, kGrain, [&](std::size_t begin, std::size_t end, std::size_t block) {
        std::size_t touching = 0;
        for (std::size_t i = begin; i < end; ++i)
            touching += convex.of_pair[i].contact != PairState::kApart ? 1 : 0;
        begins[block + 1] = touching;
    });
    std::partial_sum(begins.begin(), begins.end(), begins.begin());
    resize_closely(active.entries, begins.back());
    std::vector<std::size_t>& ends = active.end;
    ends.resize(blocks);
    for_each_block(count, kGrain, [&](std::size_t begin, std::size_t end, std::size_t block) {
        std::size_t at = begins[block];
        for (std::size_t i = begin; i < end; ++i)
            if (const Contact<Real>* contact = convex.at(i))
                at += take(i, *contact, convex.of_pair[i].contact, false, active.entries[at]);
        ends[block] = at;
    });
    // Contacts of sleepers left some of it free.
    const auto place = [&](std::size_t at) {
        return active.entries.begin() + static_cast<std::ptrdiff_t>(at);
    };
    std::size_t size = 0;
    for (std::size_t block = 0; block < blocks; ++block) {
        if (begins[block] != size) std::copy(place(begins[block]), place(ends[block]), place(size));
        size += ends[block] - begins[block];
    }
    active.entries.resize(size);
    for (std::size_t i = 0; i < meshes.entries.size(); ++i) {
        const auto& [pair, triangle, contact] = meshes.entries[i];
        if (ActiveContacts::Entry entry; contact.count > 0 && take(pair, contact, i, true, entry))
            active.entries.push_back(entry);
    }
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template void gather_contacts<Real>(const Pairs&, const Colliders&, const Surfaces&,           \
                                        const BodyStates&, const ConvexContacts<Real>&,            \
                                        const MeshContacts<Real>&, ActiveContacts&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
