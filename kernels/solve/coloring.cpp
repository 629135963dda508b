#include "kernels/solve/coloring.hpp"

#include <algorithm>
#include <bit>

namespace throng {

namespace {

// Colors are bits of a word. A body that has used them all (a plate under a hundred things) puts
// its further contacts into a last color whose blocks go one after another.
constexpr int kColors = 63;
constexpr std::uint32_t kPoints = 4;  // a contact has at most

constexpr std::uint32_t kStill = 0xffffffffu;

struct Range {
    std::size_t begin = 0, end = 0;  // islands
};

// Islands of one batch: as many in a row as fit.
std::vector<Range> batches_of(const Islands& islands)
{
    std::vector<Range> ranges;
    std::size_t held = 0;
    for (std::size_t island = 0; island < islands.size(); ++island) {
        const std::size_t size = islands.contact_begin[island + 1] - islands.contact_begin[island];
        if (ranges.empty() || held + size > kBatchContacts) {
            ranges.push_back({island, island});
            held = 0;
        }
        ranges.back().end = island + 1;
        held += size;
    }
    return ranges;
}

class Painter {
public:
    Painter(const Islands& islands,
            const ActiveContacts& contacts,
            const BodyStates& states,
            Layout& layout)
        : islands_(islands), contacts_(contacts), states_(states), layout_(layout),
          slot_(layout.slot), used_(layout.used)
    {
        slot_.resize(states.kind.size(), kStill);
        used_.resize(states.kind.size());
    }

    void paint(const Range& range)
    {
        Batch batch;
        batch.first_body = static_cast<std::uint32_t>(layout_.body_of_slot.size());
        batch.first_color = static_cast<std::uint32_t>(layout_.colors.size());
        batch.first_block = static_cast<std::uint32_t>(layout_.lanes.size() / kBlock);
        first_ = islands_.contact_begin[range.begin];
        count_ = islands_.contact_begin[range.end] - first_;
        seat_bodies(range, batch);
        choose_colors();
        place(batch);
        batch.contacts = static_cast<std::uint32_t>(count_);
        batch.wide = count_ > kBatchContacts;
        layout_.batches.push_back(batch);
        // Clean for the next batch, and for the next step.
        for (std::size_t i = batch.first_body + 1u; i < layout_.body_of_slot.size(); ++i)
            slot_[layout_.body_of_slot[i]] = kStill;
    }

private:
    const auto& contact(std::size_t i) const
    {
        return contacts_.entries[islands_.contacts[first_ + i]];
    }
    bool movable(std::uint32_t body) const { return states_.dynamic(body) && states_.moves(body); }

    // The still one first, then the movable ones of the islands, then those they touch.
    void seat_bodies(const Range& range, Batch& batch)
    {
        auto& seats = layout_.body_of_slot;
        seats.push_back(kNobody);
        for (std::size_t i = islands_.body_begin[range.begin]; i < islands_.body_begin[range.end];
             ++i) {
            slot_[islands_.bodies[i]] = static_cast<std::uint32_t>(seats.size());
            used_[islands_.bodies[i]] = 0;
            seats.push_back(islands_.bodies[i]);
            ++batch.dynamic;
        }
        batch.kinematic = seat_visitors(
            [&](std::uint32_t body) { return states_.kind[body] == BodyKind::kinematic; });
        // Conveyors last: they have a velocity and go nowhere.
        seat_visitors([&](std::uint32_t body) { return states_.carries(body); });
    }

    // Seats those that the batch touches and other batches may touch too: each has its own copy.
    template <class Wanted>
    std::uint32_t seat_visitors(Wanted wanted)
    {
        auto& seats = layout_.body_of_slot;
        std::uint32_t seated = 0;
        for (std::size_t i = 0; i < count_; ++i)
            for (const std::uint32_t body : {contact(i).body_a, contact(i).body_b}) {
                if (slot_[body] != kStill || !wanted(body)) continue;
                slot_[body] = static_cast<std::uint32_t>(seats.size());
                seats.push_back(body);
                ++seated;
            }
        return seated;
    }

    void choose_colors()
    {
        color_.resize(count_);
        for (std::size_t i = 0; i < count_; ++i) {
            const auto& [a, b] = std::pair(contact(i).body_a, contact(i).body_b);
            const std::uint64_t taken = (movable(a) ? used_[a] : 0) | (movable(b) ? used_[b] : 0);
            const int color = std::min(std::countr_one(taken), kColors);
            color_[i] = static_cast<std::uint8_t>(color);
            if (color == kColors) continue;
            if (movable(a)) used_[a] |= std::uint64_t{1} << color;
            if (movable(b)) used_[b] |= std::uint64_t{1} << color;
        }
    }

    // Counting sort by color, and by number of points within a color: the fewer points a block has
    // at most, the less there is to do for it.
    void place(Batch& batch)
    {
        std::array<std::uint32_t, kPoints*(kColors + 1)> size{};
        for (std::size_t i = 0; i < count_; ++i) ++size[bin(i)];
        std::array<std::uint32_t, kPoints*(kColors + 1)> next{};
        std::uint32_t block = batch.first_block;
        for (std::uint32_t color = 0; color <= kColors; ++color) {
            const std::uint32_t per_block = color == kColors ? 1 : kBlock, first = block;
            std::uint32_t held = 0;
            for (std::uint32_t kind = 0; kind < kPoints; ++kind) {
                next[kPoints * color + kind] = first * kBlock + held * (kBlock / per_block);
                held += size[kPoints * color + kind];
            }
            block += (held + per_block - 1) / per_block;
            if (held > 0) layout_.colors.push_back({first, block - first, color == kColors});
        }
        batch.colors = static_cast<std::uint32_t>(layout_.colors.size()) - batch.first_color;
        batch.blocks = block - batch.first_block;
        layout_.lanes.resize(std::size_t{block} * kBlock);
        layout_.points.resize(block, 1);
        layout_.slot_a.resize(layout_.lanes.size(), static_cast<std::int32_t>(batch.first_body));
        layout_.slot_b.resize(layout_.lanes.size(), static_cast<std::int32_t>(batch.first_body));
        for (std::size_t i = 0; i < count_; ++i) {
            const std::uint32_t lane = next[bin(i)];
            next[bin(i)] += color_[i] == kColors ? kBlock : 1;
            layout_.lanes[lane].entry = islands_.contacts[first_ + i];
            layout_.slot_a[lane] = seat(contact(i).body_a, batch);
            layout_.slot_b[lane] = seat(contact(i).body_b, batch);
            if (contact(i).points >= 3) ++batch.on_faces;
            std::uint8_t& most = layout_.points[lane / kBlock];
            most = std::max(most, contact(i).points);
        }
    }

    std::size_t bin(std::size_t i) const
    {
        return kPoints * std::size_t{color_[i]} + (kPoints - contact(i).points);
    }
    std::int32_t seat(std::uint32_t body, const Batch& batch) const
    {
        const std::uint32_t slot = slot_[body];
        return static_cast<std::int32_t>(slot == kStill ? batch.first_body : slot);
    }

    const Islands& islands_;
    const ActiveContacts& contacts_;
    const BodyStates& states_;
    Layout& layout_;
    std::vector<std::uint32_t>& slot_;
    std::vector<std::uint64_t>& used_;
    std::vector<std::uint8_t> color_;
    std::size_t first_ = 0, count_ = 0;
};

}  // namespace

void lay_out(const Islands& islands,
             const ActiveContacts& contacts,
             const BodyStates& states,
             Layout& layout)
{
    layout.batches.clear();
    layout.colors.clear();
    layout.lanes.clear();
    layout.points.clear();
    layout.slot_a.clear();
    layout.slot_b.clear();
    layout.body_of_slot.clear();
    Painter painter(islands, contacts, states, layout);
    for (const Range& range : batches_of(islands)) painter.paint(range);
}

}  // namespace throng
