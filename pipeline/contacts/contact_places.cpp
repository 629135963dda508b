#include "pipeline/contacts/contact_places.hpp"

#include "kernels/parallel/blocks.hpp"
#include "kernels/parallel/follow.hpp"

#include <algorithm>

namespace throng {

namespace {

constexpr std::size_t kOrderGrain = 8192;  // pairs a block
constexpr std::size_t kStrays = 8;         // one contact in so many may be out of order
constexpr std::size_t kMostKept = 4;       // room is kept for one in so many

// What there is of contacts in a block of pairs, or before it.
struct Count {
    std::uint32_t contacts = 0, strays = 0;
    bool ascending = true;  // their places
    std::uint32_t first = 0, last = 0;
};

template <class Real>
Count count_block(const ConvexContacts<Real>& contacts, std::size_t begin, std::size_t end)
{
    Count count;
    for (std::size_t i = begin; i < end; ++i) {
        const std::uint32_t place = contacts.of_pair[i].contact;
        if (place == PairState::kApart) continue;
        if (count.contacts++ == 0)
            count.first = place;
        else
            count.ascending &= place > count.last;
        count.last = place;
        count.strays += contacts.astray[place];
    }
    return count;
}

// Counts into what there is before each block. True where all are in order as it is.
bool sum_up(std::vector<Count>& counts)
{
    Count sum;
    bool ascending = true;
    for (Count& of_block : counts) {
        const Count here = of_block;
        ascending &= here.ascending;
        if (here.contacts > 0) {
            ascending &= sum.contacts == 0 || here.first > sum.last;
            sum.last = here.last;
        }
        of_block = sum;
        sum.contacts += here.contacts;
        sum.strays += here.strays;
    }
    counts.push_back(sum);
    return ascending;
}

// Those that stray are set aside; the others keep their order and make room for them.
template <class Real>
void reorder(ConvexContacts<Real>& contacts, const std::vector<Count>& counts, std::size_t used)
{
    auto& states = contacts.of_pair;
    resize_closely(contacts.scratch.gathered, counts.back().strays);
    resize_closely(contacts.scratch.found_gathered, contacts.recycles ? counts.back().strays : 0);
    resize_closely(contacts.scratch.order, used);
    for_each_block(states.size(), kOrderGrain, [&](auto begin, auto end, auto block) {
        auto [next, strays, ascending, first, last] = counts[block];
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t place = states[i].contact;
            if (place == PairState::kApart) continue;
            const bool stray = contacts.astray[place] != 0;
            if (stray) {
                if (contacts.recycles)
                    contacts.scratch.found_gathered[strays] = contacts.found[place];
                contacts.scratch.gathered[strays++] = contacts.contacts[place];
            }
            contacts.scratch.order[next] = stray ? kNewItem : place;
            states[i].contact = next++;
        }
    });
    follow(
        contacts.scratch.order, contacts.contacts,
        [&](std::size_t n) { return contacts.scratch.gathered[n]; }, [](const Contact<Real>&) {});
    if (contacts.recycles)
        follow(
            contacts.scratch.order, contacts.found,
            [&](std::size_t n) { return contacts.scratch.found_gathered[n]; },
            [](const CachedManifold<Real>&) {});
    contacts.free.clear();
    // Where most began at once, as in a first step, so much will not be needed again.
    if (counts.back().strays * kMostKept > used) {
        contacts.scratch.gathered = {};
        contacts.scratch.found_gathered = {};
    }
}

}  // namespace

template <class Real>
void follow_pairs(const Pairs& pairs, ConvexContacts<Real>& contacts)
{
    follow(
        pairs.from, contacts.of_pair, [](std::size_t) { return PairState{}; },
        [&](const PairState& gone) {
            if (gone.contact != PairState::kApart) contacts.free.push_back(gone.contact);
        });
    if (!contacts.apart_until.empty())
        follow(
            pairs.from, contacts.apart_until, [](std::size_t) { return 0.0F; }, [](float) {});
}

template <class Real>
void move_in_and_out(ConvexContacts<Real>& contacts)
{
    const std::size_t blocks = contacts.scratch.begun.size();
    for (std::size_t block = 0; block < blocks; ++block)
        for (const std::uint32_t pair : contacts.scratch.parted[block]) {
            contacts.free.push_back(contacts.of_pair[pair].contact);
            contacts.of_pair[pair].contact = PairState::kApart;
        }
    std::size_t begun = 0;
    for (const auto& of_block : contacts.scratch.begun) begun += of_block.made.size();
    contacts.strayed += begun;
    auto next = static_cast<std::uint32_t>(contacts.contacts.size());
    if (begun > contacts.free.size())
        resize_closely(contacts.contacts, next + begun - contacts.free.size());
    resize_closely(contacts.astray, contacts.contacts.size());
    if (contacts.recycles) resize_closely(contacts.found, contacts.contacts.size());
    for (auto& of_block : contacts.scratch.begun) {
        for (const auto& made : of_block.made) {
            std::uint32_t place = next;
            if (contacts.free.empty()) {
                ++next;
            } else {
                place = contacts.free.back();
                contacts.free.pop_back();
            }
            contacts.of_pair[made.pair].contact = place;
            contacts.contacts[place].take(made.contact);
            contacts.astray[place] = 1;
        }
        for (const auto& [pair, found] : of_block.found)
            contacts.found[contacts.of_pair[pair].contact] = found;
        // Kept, they would hold in each block the most that ever began there.
        of_block = {};
    }
}

template <class Real>
void put_in_order(ConvexContacts<Real>& contacts)
{
    const std::size_t used = contacts.contacts.size() - contacts.free.size();
    if (contacts.strayed * kStrays <= used) return;
    contacts.strayed = 0;
    const std::size_t states = contacts.of_pair.size();
    std::vector<Count> counts(block_count(states, kOrderGrain));
    for_each_block(states, kOrderGrain, [&](auto begin, auto end, auto block) {
        counts[block] = count_block(contacts, begin, end);
    });
    const bool in_order = sum_up(counts) && contacts.free.empty();
    if (!in_order) reorder(contacts, counts, used);
    contacts.astray.assign(contacts.contacts.size(), 0);
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template void follow_pairs<Real>(const Pairs&, ConvexContacts<Real>&);                         \
    template void move_in_and_out<Real>(ConvexContacts<Real>&);                                    \
    template void put_in_order<Real>(ConvexContacts<Real>&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
