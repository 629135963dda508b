// Find touching pairs: what began and what ended among those who touch.
//
// A pair touches when a contact of it overlaps as the step begins, bears anything at its end, or
// threw the two apart in between. Pairs that fall asleep go on touching, and are not looked at.
#include "kernels/parallel/blocks.hpp"
#include "pipeline/contacts/contact_lists.hpp"
#include "pipeline/contacts/impacts.hpp"
#include "pipeline/step/stages.hpp"

#include <algorithm>

namespace throng {

void TouchingPairs::follow(std::vector<SleepingPairs::Change>& changes)
{
    bool sorted = true, fewer = false;
    for (const auto& [key, sleeps] : changes) {
        if (!sleeps) {
            if (asleep.erase(key) == 0) continue;
            keys.push_back(key);
            sorted = false;
            continue;
        }
        if (!sorted) keep_each_once(keys);
        sorted = true;
        if (!std::binary_search(keys.begin(), keys.end(), key)) continue;
        asleep.insert(key);
        fewer = true;
    }
    changes.clear();
    if (!sorted) keep_each_once(keys);
    if (fewer) std::erase_if(keys, [&](PairKey key) { return asleep.contains(key); });
}

namespace {

template <class Real>
bool touches(const Contact<Real>& contact)
{
    if (contact.count > 0 && !contact.friction.isZero(0)) return true;
    for (std::size_t k = 0; k < static_cast<std::size_t>(contact.count); ++k)
        if (contact.points[k].impulse > 0 || contact.points[k].separation <= 0) return true;
    return false;
}

// Marks the contacts of each list whose impacts threw anybody apart.
template <class Real>
void mark_thrown(const JoinedContacts<Real>& joined,
                 const ActiveContacts& active,
                 const Layout& layout,
                 const ContactConstraints<Real>& constraints,
                 TouchingPairs::Scratch& scratch)
{
    const auto mark = [&](const ActiveContacts::Entry& entry) {
        auto& list = entry.list == ContactList::convex ? scratch.convex
            : entry.list == ContactList::mesh          ? scratch.meshes
                                                       : scratch.solids;
        if (list.size() <= entry.list_index) list.resize(entry.list_index + std::size_t{1}, 0);
        list[entry.list_index] = 1;
    };
    for_each_impact(active, layout, constraints,
                    [&](const ActiveContacts::Entry& entry, const Vec3T<Real>& impulse) {
                        if (impulse.isZero(0)) return;
                        if (entry.list != ContactList::joined) {
                            mark(entry);
                            return;
                        }
                        const auto& one = joined.contacts[entry.list_index];
                        for (std::uint32_t k = 0; k < one.count; ++k)
                            mark(joined.sources[one.first + k]);
                    });
}

// What is new and what is gone of two ascending lists that are all but the same.
void compare(const std::vector<PairKey>& before, TouchingPairs& touching)
{
    touching.begun.clear();
    touching.ended.clear();
    auto old = before.begin();
    for (const PairKey key : touching.keys) {
        for (; old != before.end() && *old < key; ++old) touching.ended.push_back(*old);
        if (old != before.end() && *old == key)
            ++old;
        else
            touching.begun.push_back(key);
    }
    touching.ended.insert(touching.ended.end(), old, before.end());
}

}  // namespace

template <class Real>
void find_touching_pairs(const Pairs& pairs,
                         const ConvexContacts<Real>& convex,
                         const MeshContacts<Real>& meshes,
                         const SolidContacts<Real>& solids,
                         const JoinedContacts<Real>& joined,
                         const ActiveContacts& active,
                         const Layout& layout,
                         const ContactConstraints<Real>& constraints,
                         SleepingPairs& sleeping,
                         TouchingPairs& touching)
{
    touching.follow(sleeping.changes);
    TouchingPairs::Scratch& scratch = touching.scratch;
    for (auto* list : {&scratch.convex, &scratch.meshes, &scratch.solids}) list->clear();
    mark_thrown(joined, active, layout, constraints, scratch);
    const auto thrown = [](const std::vector<std::uint8_t>& list, std::size_t at) {
        return at < list.size() && list[at] != 0;
    };

    std::swap(touching.keys, scratch.before);
    touching.keys.clear();
    const std::size_t count = convex.of_pair.size();
    scratch.keys_of_block.start(block_count(count, kPairsAtOnce));
    for_each_block(count, kPairsAtOnce, [&](auto begin, auto end, auto block) {
        std::vector<PairKey>& found = scratch.keys_of_block[block];
        for_each_contact_of_block(convex, begin, end, [&](std::uint32_t i, std::uint32_t at) {
            if (touches(convex.contacts[at]) || thrown(scratch.convex, at))
                found.push_back(pairs.keys[i]);
        });
    });
    scratch.keys_of_block.append_to(touching.keys);
    const auto add_many = [&](const ManyContacts<Real>& many, const auto& list) {
        for (std::size_t i = 0; i < many.entries.size(); ++i)
            if (touches(many.entries[i].contact) || thrown(list, i))
                touching.keys.push_back(pairs.keys[many.entries[i].pair]);
    };
    add_many(meshes, scratch.meshes);
    add_many(solids, scratch.solids);
    if (!touching.keys.empty() && !(meshes.entries.empty() && solids.entries.empty()))
        keep_each_once(touching.keys);

    compare(scratch.before, touching);
    touching.hits.clear();
    for (const TouchingPairs::Approach& approach : touching.approaches)
        if (std::ranges::binary_search(touching.keys, approach.key))
            touching.hits.push_back(approach);
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template void find_touching_pairs<Real>(                                                       \
        const Pairs&, const ConvexContacts<Real>&, const MeshContacts<Real>&,                      \
        const SolidContacts<Real>&, const JoinedContacts<Real>&, const ActiveContacts&,            \
        const Layout&, const ContactConstraints<Real>&, SleepingPairs&, TouchingPairs&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
