// Contact lists: where the contacts of this step are kept, each kind by itself.
#pragma once

#include "kernels/data/contacts.hpp"

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

}  // namespace throng
