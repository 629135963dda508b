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

/// One call of a stage that finds the contacts of pairs of which one is a mesh or a solid: what the
/// two such stages share. `Contacts` is the ManyContacts that the call refreshes.
template <class Real, class Contacts>
class ManyCollision {
public:
    ManyCollision(const StepContext& context,
                  const Pairs& pairs,
                  const Shapes& shapes,
                  const Colliders& colliders,
                  const Bounds& bounds,
                  const Poses& poses,
                  const BodyStates& states,
                  Contacts& contacts)
        : pairs_(pairs), shapes_(shapes), colliders_(colliders), bounds_(bounds), poses_(poses),
          states_(states), contacts_(contacts), scale_(static_cast<Real>(impulse_scale(context)))
    { }

protected:
    using Entry = typename Contacts::Entry;
    using Found = typename Contacts::Found;

    // The two of a pair as they are collided: the mesh or the solid first.
    struct Sides {
        std::uint32_t first = 0, other = 0;
        bool swapped = false;
    };

    // A pair that is looked at, one of a block of them.
    struct PairOfBlock {
        std::uint32_t pair = 0;  // its place
        PairPlace place;
        std::span<const Entry> old;  // its contacts of the last step
        std::size_t block = 0, in_block = 0;
    };

    // Finds the contacts of the listed pairs anew, in blocks of `grain`. Pairs that sleep, or that
    // nothing can push, keep what they have, but for what was found.
    //
    //   prepare  (pairs of a block that will be asked for)
    //   find     (one of them, entries to add to)
    template <class Prepare, class Find>
    void refresh(std::span<const std::uint32_t> listed,
                 std::size_t grain,
                 const Prepare& prepare,
                 const Find& find)
    {
        std::swap(contacts_.entries, contacts_.before);
        std::swap(contacts_.found, contacts_.found_before);
        const std::size_t blocks = block_count(listed.size(), grain);
        contacts_.scratch.of_block.start(blocks);
        contacts_.scratch.found_of_block.start(blocks);
        contacts_.scratch.manifolds_of_block.start(blocks);
        for_each_block(listed.size(), grain,
                       [&](std::size_t begin, std::size_t end, std::size_t block) {
                           refresh_block(listed.subspan(begin, end - begin), block, prepare, find);
                       });
        contacts_.entries.clear();
        contacts_.scratch.of_block.append_to(contacts_.entries);
        join_finds();
    }

    Sides sides_of(const PairPlace& place, ShapeKind first) const
    {
        if (colliders_.shape[place.a].kind == first) return {place.a, place.b, false};
        return {place.b, place.a, true};
    }

    PairSight sight_of(const Sides& sides, double speculative_margin) const
    {
        return {pose_seen_from_a(shapes_, colliders_.shape[sides.other],
                                 bounds_.placed[sides.first], bounds_.placed[sides.other]),
                colliders_.outer_radius[sides.first], colliders_.outer_radius[sides.other],
                speculative_margin};
    }

    PairInput<double> input_of(const Sides& sides, const PairSight& sight) const
    {
        return {shapes_, colliders_.shape[sides.first], colliders_.shape[sides.other], sight.pose,
                sight.speculative_margin};
    }

    // What was found of a pair before the last step, or null.
    const Found* kept_of(const PairOfBlock& at) const
    {
        const std::span kept = items_of(contacts_.found_before.pairs, old_place(pairs_, at.pair));
        return kept.empty() ? nullptr : &kept.front();
    }
    std::span<const PartManifold> manifolds_of(const Found& kept) const
    {
        return std::span(contacts_.found_before.manifolds).subspan(kept.first, kept.count);
    }

    // Whether that may be told from where the two are now: they have moved by no more than `most`
    // (m) against one another since.
    bool may_recycle(const Found& kept, const PairSight& sight, double most) const
    {
        const double near =
            sight.radius + std::max(sight.speculative_margin, kept.speculative_margin);
        const double moved = furthest_moved_near(kept.b_in_a, sight.pose, near, sight.other_radius);
        // What was beyond the margin then may be within a greater margin now.
        const double nearer = std::max(0.0, sight.speculative_margin - kept.speculative_margin);
        return moved + nearer <= most;
    }

    // Tells it from there.
    //
    //   take  (part, its manifold), of those that have a point within the margin
    template <class Take>
    void recycle(const Found& kept, const PairSight& sight, const PairOfBlock& at, const Take& take)
    {
        CachedManifold<double> then{{}, kept.b_in_a, kept.speculative_margin};
        LocalManifold<double> now;
        for (const PartManifold& part : manifolds_of(kept)) {
            then.manifold = part.manifold;
            move_manifold(then, sight.pose, sight.speculative_margin, now);
            contacts_.scratch.manifolds_of_block[at.block].push_back(part);
            if (now.count > 0) take(part.part, now);
        }
        Found& found = contacts_.scratch.found_of_block[at.block].emplace_back(kept);
        found.pair = at.pair;
        found.left_out = 0;
    }

    // Adds a contact; the manifold is in the first's frame, first to other.
    Entry& add(const Sides& sides,
               std::uint32_t part,
               const LocalManifold<double>& manifold,
               ContactEntries<Real>& out) const
    {
        const std::uint32_t first = colliders_.body[sides.first];
        const std::uint32_t other = colliders_.body[sides.other];
        Entry& entry = out.emplace_back();
        entry.part = part;
        make_contact(manifold, bounds_.placed[sides.first],
                     anchor_origin(first, other, states_, poses_),
                     anchor_origin(other, first, states_, poses_), entry.contact);
        note_round_sides(shapes_, colliders_.shape[sides.first], colliders_.shape[sides.other],
                         bounds_.placed[sides.first], bounds_.placed[sides.other], entry.contact);
        if (sides.swapped) turn_round(entry.contact);
        return entry;
    }

    const Pairs& pairs_;
    const Shapes& shapes_;
    const Colliders& colliders_;
    const Bounds& bounds_;
    const Poses& poses_;
    const BodyStates& states_;
    Contacts& contacts_;
    Real scale_;  // of impulses of the last step

private:
    std::span<const Entry> old_of(std::uint32_t pair) const
    {
        return items_of(contacts_.before, old_place(pairs_, pair));
    }

    template <class Prepare, class Find>
    void refresh_block(std::span<const std::uint32_t> listed,
                       std::size_t block,
                       const Prepare& prepare,
                       const Find& find)
    {
        static thread_local std::vector<PairOfBlock> asked;
        asked.clear();
        for (const std::uint32_t i : listed) {
            const PairPlace place = place_of(pairs_.keys[i], colliders_, bounds_);
            if (wants_contact(place, states_))
                asked.push_back({i, place, old_of(i), block, asked.size()});
        }
        prepare(std::span<const PairOfBlock>(asked));
        ContactEntries<Real>& out = contacts_.scratch.of_block[block];
        std::size_t next = 0;
        for (const std::uint32_t i : listed) {
            const std::size_t first = out.size();
            if (next < asked.size() && asked[next].pair == i) {
                find(asked[next++], out);
            } else {
                const std::span old = old_of(i);
                out.insert(out.end(), old.begin(), old.end());
                for (std::size_t n = first; n < out.size(); ++n)
                    scale_impulses(out[n].contact, scale_);
            }
            for (std::size_t n = first; n < out.size(); ++n) out[n].pair = i;
        }
    }

    // What blocks have found in order of pair, and manifolds in that of their pairs.
    void join_finds()
    {
        auto& [pairs, manifolds] = contacts_.found;
        pairs.clear();
        manifolds.clear();
        contacts_.scratch.found_of_block.append_to(pairs);
        contacts_.scratch.manifolds_of_block.append_to(manifolds);
        std::uint32_t first = 0;
        for (Found& found : pairs) {
            found.first = first;
            first += found.count;
        }
    }
};

}  // namespace throng
