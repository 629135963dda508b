// Sleeping pairs: what is kept of pairs of which neither can move until somebody wakes, apart from
// the lists that a step goes through. So whoever sleeps costs a step nothing.
#pragma once

#include "kernels/data/contacts.hpp"
#include "narrowphase/alternatives/method_contacts.hpp"

#include <array>
#include <unordered_map>
#include <vector>

namespace throng {

/// Which pairs sleep, and who calls them back: a sleeping island with the first of its bodies that
/// wakes, and a body that stands still as it is moved or removed.
///
///   kept    the pairs, in any order; some places are free
///   free    those places
///   called  places of those that are to come back; nobody holds them any more
///   mixed   pairs that may sleep are among those that a step goes through: all were called, for a
///           step in which what they know is to follow new settings
///   seen    that step was begun
///   told    changes are noted, for who keeps a list of his own
///   changes pairs that fell asleep or came back since he looked, in the order of that
struct SleepingPairs {
    struct Holder {
        std::uint32_t place = kNoBody;  // of a sleeping island, or a body; kNoBody: nobody
        bool still = false;             // a body that stands still
    };
    struct Kept {
        PairKey key = 0;
        std::uint32_t generation = 0;  // how many held it before
        std::array<Holder, 2> holders;
    };
    /// Who is kept at a place, as long as the generation there is this.
    struct Ref {
        std::uint32_t at = 0, generation = 0;
    };
    struct Change {
        PairKey key = 0;
        bool sleeps = false;
    };
    struct Held {
        std::vector<Ref> refs;
        std::size_t stale = 0;  // of those, called by their other holder
    };
    std::vector<Kept> kept;
    std::vector<std::uint32_t> free;
    std::vector<Held> of_island;                       // [sleeping islands] may be shorter
    std::unordered_map<std::uint32_t, Held> of_still;  // by body
    std::vector<std::uint32_t> called;
    bool mixed = false, seen = false;
    bool told = false;
    std::vector<Change> changes;

    bool holds(const Ref& ref) const { return kept[ref.at].generation == ref.generation; }
    /// Of pairs that sleep.
    std::size_t size() const { return kept.size() - free.size(); }
};

/// What they know, as it was among the others.
///
///   of_kept   [kept] a contact is a place among `contacts`
///   found     [contacts] of pairs that are recycled; may be shorter
///   many      of pairs that may have any number of contacts: what was found of solids is forgotten
///             in any step that they sleep through
///   memories  [kept] of a method of choice; may be shorter
template <class Real>
struct SleepingContacts {
    struct OfKept {
        PairState state;
        float apart_until = 0;
        std::uint32_t many = kNoBody;  // a place among `many`, if any
    };
    struct Many {
        std::vector<typename ManyContacts<Real>::Entry> entries;
        bool on_mesh = false;  // of MeshContacts
    };
    std::vector<OfKept> of_kept;
    std::vector<Contact<Real>> contacts;
    std::vector<CachedManifold<Real>> found;
    std::vector<Many> many;
    std::vector<std::uint32_t> free_contacts, free_many;
    std::vector<MethodMemory> memories;
};

}  // namespace throng
