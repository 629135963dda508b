// Gather contacts: both kinds into one order, by pair, convex ones before those on meshes.
#include "pipeline/stages.hpp"

#include <algorithm>

namespace throng {

template <class Real>
void gather_contacts(const Pairs& pairs,
                     const Colliders& colliders,
                     const Surfaces& surfaces,
                     const BodyStates& states,
                     const ConvexContacts<Real>& convex,
                     const MeshContacts<Real>& meshes,
                     ActiveContacts& active)
{
    active.entries.clear();
    const auto extent_of = [&](std::uint32_t collider) { return colliders.inner_extent[collider]; };
    const auto take = [&](std::size_t pair, const Contact<Real>& contact, std::size_t slot,
                          bool on_mesh) {
        if (contact.count == 0) return;
        const std::uint32_t a = first_of(pairs.keys[pair]), b = second_of(pairs.keys[pair]);
        const std::uint32_t body_a = colliders.body[a], body_b = colliders.body[b];
        const bool pushes_a = states.dynamic(body_a) && states.moves(body_a);
        const bool pushes_b = states.dynamic(body_b) && states.moves(body_b);
        if (!pushes_a && !pushes_b) return;
        const auto meeting = surfaces.between(colliders.material[a], colliders.material[b]);
        active.entries.push_back(
            {body_a, body_b, static_cast<std::uint32_t>(slot), on_mesh,
             static_cast<std::uint8_t>(contact.count), static_cast<float>(meeting.friction),
             static_cast<float>(meeting.restitution), static_cast<float>(meeting.rolling_friction),
             static_cast<float>(std::min(extent_of(a), extent_of(b)))});
    };
    for (std::size_t i = 0; i < convex.of_pair.size(); ++i) take(i, convex.of_pair[i], i, false);
    for (std::size_t i = 0; i < meshes.entries.size(); ++i)
        take(meshes.entries[i].pair, meshes.entries[i].contact, i, true);
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template void gather_contacts<Real>(const Pairs&, const Colliders&, const Surfaces&,           \
                                        const BodyStates&, const ConvexContacts<Real>&,            \
                                        const MeshContacts<Real>&, ActiveContacts&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
