// Gather contacts: both kinds into one order, by pair, convex ones before those on meshes.
#include "kernels/parallel/blocks.hpp"
#include "pipeline/stages.hpp"

#include <algorithm>

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
                          bool on_mesh, std::vector<ActiveContacts::Entry>& entries) {
        const std::uint32_t a = first_of(pairs.keys[pair]), b = second_of(pairs.keys[pair]);
        const std::uint32_t body_a = colliders.body[a], body_b = colliders.body[b];
        const bool pushes_a = states.dynamic(body_a) && states.moves(body_a);
        const bool pushes_b = states.dynamic(body_b) && states.moves(body_b);
        if (!pushes_a && !pushes_b) return;
        const auto meeting = surfaces.between(colliders.material[a], colliders.material[b]);
        entries.push_back(
            {body_a, body_b, static_cast<std::uint32_t>(slot), on_mesh,
             static_cast<std::uint8_t>(contact.count), static_cast<float>(meeting.friction),
             static_cast<float>(meeting.restitution), static_cast<float>(meeting.rolling_friction),
             static_cast<float>(std::min(extent_of(a), extent_of(b)))});
    };
    active.entries.clear();
    const std::size_t count = convex.of_pair.size();
    active.of_block.start(block_count(count, kGrain));
    for_each_block(count, kGrain, [&](std::size_t begin, std::size_t end, std::size_t block) {
        for (std::size_t i = begin; i < end; ++i)
            if (const Contact<Real>* contact = convex.at(i))
                take(i, *contact, convex.of_pair[i].contact, false, active.of_block[block]);
    });
    active.of_block.append_to(active.entries);
    for (std::size_t i = 0; i < meshes.entries.size(); ++i)
        if (meshes.entries[i].contact.count > 0)
            take(meshes.entries[i].pair, meshes.entries[i].contact, i, true, active.entries);
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template void gather_contacts<Real>(const Pairs&, const Colliders&, const Surfaces&,           \
                                        const BodyStates&, const ConvexContacts<Real>&,            \
                                        const MeshContacts<Real>&, ActiveContacts&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
