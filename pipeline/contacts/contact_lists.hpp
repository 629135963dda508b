// Contact lists: where the contacts of this step are kept, each kind by itself.
#pragma once

#include "kernels/data/contacts.hpp"

#include <array>

namespace throng {

/// The contact that an entry stands for, as const as the lists are.
template <class Convex, class Meshes, class Solids, class Joined>
auto& contact_of(Convex& convex,
                 Meshes& meshes,
                 Solids& solids,
                 Joined& joined,
                 const ActiveContacts::Entry& entry)
{
    switch (entry.list) {
    case ContactList::joined:
        return joined.contacts[entry.list_index].contact;
    case ContactList::mesh:
        return meshes.entries[entry.list_index].contact;
    case ContactList::solid:
        return solids.entries[entry.list_index].contact;
    case ContactList::convex:
        break;
    }
    return convex.contacts[entry.list_index];
}

/// Pairs that for_each_contact_of_block() may be asked for at once.
inline constexpr std::size_t kPairsAtOnce = 2048;

/// Calls for each of some pairs of convex colliders that has a contact: its place and that of the
/// contact. Which have one is anybody's guess, and a branch for each takes longer than all the
/// rest: they are listed first.
template <class Real, class Each>
void for_each_contact_of_block(const ConvexContacts<Real>& convex,
                               std::size_t begin,
                               std::size_t end,
                               const Each& each)
{
    std::array<std::uint32_t, kPairsAtOnce> places;
    std::size_t count = 0;
    for (std::size_t i = begin; i < end; ++i) {
        places[count] = static_cast<std::uint32_t>(i);
        count += convex.of_pair[i].contact != PairState::kApart ? 1 : 0;
    }
    for (std::size_t k = 0; k < count; ++k) each(places[k], convex.of_pair[places[k]].contact);
}

/// Calls for the key of each pair that a step goes through, and the contact, once a contact.
template <class Real, class Each>
void for_each_contact(const Pairs& pairs,
                      const ConvexContacts<Real>& convex,
                      const MeshContacts<Real>& meshes,
                      const SolidContacts<Real>& solids,
                      const Each& each)
{
    for (std::size_t i = 0; i < convex.of_pair.size(); ++i)
        if (const Contact<Real>* contact = convex.at(i)) each(pairs.keys[i], *contact);
    for (const auto& entry : meshes.entries) each(pairs.keys[entry.pair], entry.contact);
    for (const auto& entry : solids.entries) each(pairs.keys[entry.pair], entry.contact);
}

}  // namespace throng
