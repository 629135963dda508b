// Many contacts: what the stages share whose pairs may have any number of contacts.
#pragma once

#include "kernels/parallel/blocks.hpp"
#include "kernels/solver/contact_packing.hpp"
#include "pipeline/contacts/collide.hpp"

#include <algorithm>
#include <span>

namespace throng {

template <class Real>
using ContactEntries = std::vector<typename ManyContacts<Real>::Entry>;

/// Of a list in order of `pair`, those of one pair.
template <class Item>
std::span<const Item> items_of(const std::vector<Item>& list, std::uint32_t pair)
{
    struct Order {
        bool operator()(const Item& item, std::uint32_t wanted) const { return item.pair < wanted; }
        bool operator()(std::uint32_t wanted, const Item& item) const { return wanted < item.pair; }
    };
    const auto [first, last] = std::equal_range(list.begin(), list.end(), pair, Order{});
    return {first, last};
}

/// The place that a pair had among those of the last step, or Pairs::kNewPair.
inline std::uint32_t old_place(const Pairs& pairs, std::uint32_t pair)
{
    return pairs.changed ? pairs.from[pair] : pair;
}

/// Finds the contacts of the listed pairs anew, in blocks of `grain`. Pairs that sleep, or that
/// nothing can push, keep what they have.
///
///   find  (pair's place, its colliders, its contacts of the last step, block, entries to add to)
template <class Real, class Find>
void refresh_contacts(const StepContext& context,
                      const Pairs& pairs,
                      std::span<const std::uint32_t> listed,
                      const Colliders& colliders,
                      const Bounds& bounds,
                      const BodyStates& states,
                      std::size_t grain,
                      ManyContacts<Real>& contacts,
                      Find find)
{
    std::swap(contacts.entries, contacts.before);
    contacts.entries.clear();
    const Real scale = static_cast<Real>(impulse_scale(context));
    contacts.scratch.of_block.start(block_count(listed.size(), grain));
    for_each_block(listed.size(), grain,
                   [&](std::size_t begin, std::size_t end, std::size_t block) {
                       ContactEntries<Real>& out = contacts.scratch.of_block[block];
                       for (std::size_t k = begin; k < end; ++k) {
                           const std::uint32_t i = listed[k];
                           const PairPlace pair = place_of(pairs.keys[i], colliders, bounds);
                           const std::span old = items_of(contacts.before, old_place(pairs, i));
                           const std::size_t first = out.size();
                           if (wants_contact(pair, states)) {
                               find(i, pair, old, block, out);
                           } else {
                               out.insert(out.end(), old.begin(), old.end());
                               for (std::size_t n = first; n < out.size(); ++n)
                                   scale_impulses(out[n].contact, scale);
                           }
                           for (std::size_t n = first; n < out.size(); ++n) out[n].pair = i;
                       }
                   });
    contacts.scratch.of_block.append_to(contacts.entries);
}

}  // namespace throng
