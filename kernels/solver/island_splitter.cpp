#include "kernels/solver/island_splitter.hpp"

#include "kernels/parallel/blocks.hpp"

#include <algorithm>

namespace throng {

namespace {

constexpr std::size_t kBins = 1024;
constexpr std::size_t kGrain = 4096;

}  // namespace

// False where all bodies stand at one spot.
bool IslandSplitter::bin_bodies(std::span<const std::uint32_t> bodies,
                                std::span<const Vec3> positions)
{
    boxes_.assign(block_count(bodies.size(), kGrain), Box3());
    for_each_block(
        bodies.size(), kGrain, [&](std::size_t begin, std::size_t end, std::size_t block) {
            for (std::size_t i = begin; i < end; ++i)
                boxes_[block] = joined(boxes_[block], {positions[bodies[i]], positions[bodies[i]]});
        });
    Box3 all;
    for (const Box3& box : boxes_) all = joined(all, box);
    Eigen::Index axis = 0;
    const double length = (all.upper - all.lower).maxCoeff(&axis);
    if (!(length > 0)) return false;

    const double low = all.lower[axis], per_meter = static_cast<double>(kBins) / length;
    bin_of_.resize(positions.size());
    of_body_.resize(bodies.size());
    for_each_block(bodies.size(), kGrain, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t i = begin; i < end; ++i) {
            const auto bin =
                static_cast<std::uint32_t>((positions[bodies[i]][axis] - low) * per_meter);
            of_body_[i] = bin_of_[bodies[i]] = std::min<std::uint32_t>(bin, kBins - 1);
        }
    });
    return true;
}

void IslandSplitter::bin_contacts(std::span<const std::uint32_t> contacts,
                                  const ActiveContacts& active,
                                  const BodyStates& states)
{
    of_contact_.resize(contacts.size());
    of_block_.resize(block_count(contacts.size(), kGrain));
    for_each_block(contacts.size(), kGrain,
                   [&](std::size_t begin, std::size_t end, std::size_t block) {
                       std::vector<Bin>& bins = of_block_[block];
                       bins.assign(kBins, {});
                       for (std::size_t i = begin; i < end; ++i) {
                           const auto& contact = active.entries[contacts[i]];
                           const std::uint32_t a = contact.body_a, b = contact.body_b;
                           const std::uint32_t at_a = bin_of_[states.movable(a) ? a : b];
                           const std::uint32_t at_b = bin_of_[states.movable(b) ? b : a];
                           const auto [near, far] = std::minmax(at_a, at_b);
                           of_contact_[i] = near;
                           ++bins[near].contacts;
                           bins[near].last_bin = std::max(bins[near].last_bin, far);
                       }
                   });
    bins_.assign(kBins, {});
    for (const std::vector<Bin>& bins : of_block_)
        for (std::size_t bin = 0; bin < kBins; ++bin) {
            bins_[bin].contacts += bins[bin].contacts;
            bins_[bin].last_bin = std::max(bins_[bin].last_bin, bins[bin].last_bin);
        }
}

// Ends a slice as soon as it has contacts enough and nothing before it reaches beyond its end.
// Returns how many there are.
std::size_t IslandSplitter::choose_slices(std::size_t least)
{
    slice_of_bin_.assign(kBins, 0);
    std::uint32_t slice = 0, last_bin = 0, must_hold = 0;
    std::size_t held = 0, first = 0;
    for (std::size_t bin = 0; bin < kBins; ++bin) {
        slice_of_bin_[bin] = slice;
        held += bins_[bin].contacts;
        last_bin = std::max(last_bin, bins_[bin].last_bin);
        if (held < least || bin < must_hold || bin + 1 == kBins) continue;
        // What begins in this slice must end in the next.
        must_hold = last_bin;
        first = bin + 1;
        held = 0;
        ++slice;
    }
    // A short end goes to the slice before it.
    if (slice > 0 && held < least / 2) {
        for (std::size_t bin = first; bin < kBins; ++bin) slice_of_bin_[bin] = slice - 1;
        --slice;
    }
    return slice + std::size_t{1};
}

void IslandSplitter::put_in_order(std::vector<std::uint32_t>& bin_of_item,
                                  std::size_t slices,
                                  std::span<std::uint32_t> items,
                                  std::vector<std::uint32_t>& begin)
{
    ordered_.resize(items.size());
    for_each_block(items.size(), kGrain, [&](std::size_t from, std::size_t end, std::size_t) {
        for (std::size_t i = from; i < end; ++i) bin_of_item[i] = slice_of_bin_[bin_of_item[i]];
    });
    sort_.sort(bin_of_item, items, slices, begin, ordered_);
    std::copy(ordered_.begin(), ordered_.end(), items.begin());
}

void IslandSplitter::split(const Island& island,
                           const ActiveContacts& active,
                           const BodyStates& states,
                           std::span<const Vec3> positions,
                           const SplitRule& rule,
                           std::vector<Slice>& slices)
{
    const auto& [bodies, contacts, first] = island;
    std::size_t count = 1;
    if (contacts.size() >= rule.from && bin_bodies(bodies, positions)) {
        bin_contacts(contacts, active, states);
        count = choose_slices(rule.slice);
    }
    if (count == 1) {
        Slice& whole = slices.emplace_back(first);
        whole.dynamic = static_cast<std::uint32_t>(bodies.size());
        whole.contacts = static_cast<std::uint32_t>(contacts.size());
        return;
    }
    put_in_order(of_body_, count, bodies, body_begin_);
    put_in_order(of_contact_, count, contacts, contact_begin_);
    for (std::size_t i = 0; i < count; ++i) {
        Slice slice;
        slice.first_body = first.first_body + body_begin_[i];
        slice.dynamic = body_begin_[i + 1] - body_begin_[i];
        slice.first_contact = first.first_contact + contact_begin_[i];
        slice.contacts = contact_begin_[i + 1] - contact_begin_[i];
        slices.push_back(slice);
    }
}

}  // namespace throng
