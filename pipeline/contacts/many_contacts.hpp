// Many contacts: what the stages share whose pairs may have any number of contacts.
#pragma once

#include "kernels/parallel/blocks.hpp"
#include "kernels/solver/contact_packing.hpp"
#include "narrowphase/manifold/recycling.hpp"
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

/// How the two of a pair stand to one another: the mesh or the solid, and what is looked at in its
/// frame.
///
///   radius, other_radius  m, of balls about their origins that they are in
///   speculative_margin    m
struct PairSight {
    Pose pose;
    double radius = 0, other_radius = 0;
    double speculative_margin = 0;
};

/// Of what was found in the last step, the manifolds of a pair.
template <class Real>
std::span<const PartManifold> manifolds_of(const ManyContacts<Real>& contacts,
                                           const typename ManyContacts<Real>::Found& kept)
{
    return std::span(contacts.found_before.manifolds).subspan(kept.first, kept.count);
}

/// A pair that is looked at, one of a block of them.
///
///   pair  its place
///   old   its contacts of the last step
template <class Real>
struct PairOfBlock {
    std::uint32_t pair = 0;
    PairPlace place;
    std::span<const typename ManyContacts<Real>::Entry> old;
    std::size_t block = 0, in_block = 0;
};

/// Whether what was found of a pair may be told from where its two are now: they have moved by no
/// more than `most` (m) against one another since.
template <class Found>
bool may_recycle(const Found& kept, const PairSight& sight, double most)
{
    const double near = sight.radius + std::max(sight.speculative_margin, kept.speculative_margin);
    const double moved = furthest_moved_near(kept.b_in_a, sight.pose, near, sight.other_radius);
    // What was beyond the margin then may be within a greater margin now.
    const double nearer = std::max(0.0, sight.speculative_margin - kept.speculative_margin);
    return moved + nearer <= most;
}

/// Tells what was found of a pair from where its two are now.
///
///   take  (part, its manifold), of those that have a point within the margin
template <class Real, class Take>
void recycle_finds(ManyContacts<Real>& contacts,
                   const typename ManyContacts<Real>::Found& kept,
                   const PairSight& sight,
                   const PairOfBlock<Real>& at,
                   Take take)
{
    CachedManifold<double> then{{}, kept.b_in_a, kept.speculative_margin};
    LocalManifold<double> now;
    for (const PartManifold& part : manifolds_of(contacts, kept)) {
        then.manifold = part.manifold;
        move_manifold(then, sight.pose, sight.speculative_margin, now);
        contacts.scratch.manifolds_of_block[at.block].push_back(part);
        if (now.count > 0) take(part.part, now);
    }
    auto& found = contacts.scratch.found_of_block[at.block].emplace_back(kept);
    found.pair = at.pair;
    found.left_out = 0;
}

/// Puts what blocks have found in order of pair, and manifolds in that of their pairs.
template <class Real>
void join_finds(ManyContacts<Real>& contacts)
{
    auto& [pairs, manifolds] = contacts.found;
    pairs.clear();
    manifolds.clear();
    contacts.scratch.found_of_block.append_to(pairs);
    contacts.scratch.manifolds_of_block.append_to(manifolds);
    std::uint32_t first = 0;
    for (auto& found : pairs) {
        found.first = first;
        first += found.count;
    }
}

/// Finds the contacts of the listed pairs anew, in blocks of `grain`. Pairs that sleep, or that
/// nothing can push, keep what they have, but for what was found.
///
///   prepare  (pairs of a block that will be asked for)
///   find     (one of them, entries to add to)
template <class Real, class Prepare, class Find>
void refresh_contacts(const StepContext& context,
                      const Pairs& pairs,
                      std::span<const std::uint32_t> listed,
                      const Colliders& colliders,
                      const Bounds& bounds,
                      const BodyStates& states,
                      std::size_t grain,
                      ManyContacts<Real>& contacts,
                      Prepare prepare,
                      Find find)
{
    std::swap(contacts.entries, contacts.before);
    std::swap(contacts.found, contacts.found_before);
    contacts.entries.clear();
    const Real scale = static_cast<Real>(impulse_scale(context));
    const std::size_t blocks = block_count(listed.size(), grain);
    contacts.scratch.of_block.start(blocks);
    contacts.scratch.found_of_block.start(blocks);
    contacts.scratch.manifolds_of_block.start(blocks);
    for_each_block(listed.size(), grain,
                   [&](std::size_t begin, std::size_t end, std::size_t block) {
                       static thread_local std::vector<PairOfBlock<Real>> asked;
                       asked.clear();
                       const auto old_of = [&](std::uint32_t i) {
                           return items_of(contacts.before, old_place(pairs, i));
                       };
                       for (std::size_t k = begin; k < end; ++k) {
                           const std::uint32_t i = listed[k];
                           const PairPlace place = place_of(pairs.keys[i], colliders, bounds);
                           if (wants_contact(place, states))
                               asked.push_back({i, place, old_of(i), block, asked.size()});
                       }
                       prepare(std::span<const PairOfBlock<Real>>(asked));
                       ContactEntries<Real>& out = contacts.scratch.of_block[block];
                       std::size_t next = 0;
                       for (std::size_t k = begin; k < end; ++k) {
                           const std::uint32_t i = listed[k];
                           const std::size_t first = out.size();
                           if (next < asked.size() && asked[next].pair == i) {
                               find(asked[next++], out);
                           } else {
                               const std::span old = old_of(i);
                               out.insert(out.end(), old.begin(), old.end());
                               for (std::size_t n = first; n < out.size(); ++n)
                                   scale_impulses(out[n].contact, scale);
                           }
                           for (std::size_t n = first; n < out.size(); ++n) out[n].pair = i;
                       }
                   });
    contacts.scratch.of_block.append_to(contacts.entries);
    join_finds(contacts);
}

}  // namespace throng
