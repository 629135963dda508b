#include "broadphase/grid_index.hpp"

#include "kernels/parallel/sort_keys.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace throng {
namespace {

// A row is this many usual sizes wide: narrower ones are more rows to search, wider ones hold more
// boxes that are not met.
constexpr double kRowWidth = 1.0;
constexpr std::size_t kSample = 1024;
constexpr std::size_t kGrain = 1024;
constexpr int kStepBits = 20;

// Without a branch for each of the six: which of them fails is anybody's guess.
bool overlap(const Box3& a, const Box3& b)
{
    return (a.lower.x() <= b.upper.x()) & (b.lower.x() <= a.upper.x())
        & (a.lower.y() <= b.upper.y()) & (b.lower.y() <= a.upper.y()) & (a.lower.z() <= b.upper.z())
        & (b.lower.z() <= a.upper.z());
}

// The value that a share of them stays below.
double quantile(std::vector<double>& values, double share)
{
    const auto place = values.begin()
        + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), place, values.end());
    return *place;
}

std::uint64_t clamped(double value, std::uint64_t count)
{
    if (!(value > 0)) return 0;
    const auto last = static_cast<double>(count - 1);
    return value >= last ? count - 1 : static_cast<std::uint64_t>(value);
}

}  // namespace

// Where neighbouring rows were left: along a row, searches only ever move on.
struct GridIndex::Cursors {
    static constexpr std::size_t kSide = 4;
    static constexpr std::uint32_t kUnset = ~0u;
    std::size_t row = ~std::size_t{0};
    std::uint32_t at[kSide][2 * kSide];

    void reset(std::size_t to)
    {
        row = to;
        std::fill(&at[0][0], &at[0][0] + 2 * kSide * kSide, kUnset);
    }
};

std::uint64_t GridIndex::step(double place) const
{
    return clamped((place - start_[along_]) * steps_per_m_, steps_);
}

std::size_t GridIndex::row(int side, double place) const
{
    return clamped((place - start_[across_[side]]) * rows_per_m_, rows_[side]);
}

// Chooses axes, extent and row width. All but a few strays lie inside the extent; those beyond it
// are taken for the outermost rows, which is right for any search and slow for none but strays.
void GridIndex::lay_out(const std::vector<std::uint32_t>& ids, std::span<const Box3> boxes)
{
    std::vector<double> places, sizes;
    Vec3 extent;
    const std::size_t stride = std::max<std::size_t>(1, ids.size() / kSample);
    for (int axis = 0; axis < 3; ++axis) {
        places.clear();
        for (std::size_t i = 0; i < ids.size(); i += stride) {
            places.push_back(boxes[ids[i]].lower[axis]);
            sizes.push_back(boxes[ids[i]].upper[axis] - boxes[ids[i]].lower[axis]);
        }
        const double low = quantile(places, 0.02), high = quantile(places, 0.98);
        extent[axis] = 1.2 * (high - low);
        start_[axis] = low - 0.1 * (high - low);
    }
    along_ = 0;
    for (int axis = 1; axis < 3; ++axis)
        if (extent[axis] > extent[along_]) along_ = axis;
    across_[0] = (along_ + 1) % 3;
    across_[1] = (along_ + 2) % 3;

    // Rows are never many more than boxes.
    const double most = std::sqrt(2.0 * static_cast<double>(ids.size())) + 1;
    const double width = std::max({kRowWidth * quantile(sizes, 0.9), extent[across_[0]] / most,
                                   extent[across_[1]] / most, 1e-300});
    rows_per_m_ = 1 / width;
    for (int side = 0; side < 2; ++side)
        rows_[side] = static_cast<std::uint64_t>(extent[across_[side]] / width) + 1;
    // Row, step and place in the list share 64 bits.
    const auto taken = static_cast<int>(std::bit_width(rows_[0] * rows_[1]))
        + static_cast<int>(std::bit_width(ids.size()));
    steps_ = std::uint64_t{1} << std::min(kStepBits, 63 - taken);
    steps_per_m_ = static_cast<double>(steps_) / std::max(extent[along_], 1e-300);
}

void GridIndex::build(const std::vector<std::uint32_t>& ids,
                      std::span<const Box3> boxes,
                      const Vec3&)
{
    slots_.resize(ids.size());
    boxes_.resize(ids.size());
    ids_.resize(ids.size());
    keys_.resize(ids.size());
    bounds_ = Box3();
    if (ids.empty()) return;
    lay_out(ids, boxes);

    Vec3 longest = Vec3::Zero();
    for (const std::uint32_t id : ids) {
        bounds_.lower = bounds_.lower.cwiseMin(boxes[id].lower);
        bounds_.upper = bounds_.upper.cwiseMax(boxes[id].upper);
        longest = longest.cwiseMax(boxes[id].upper - boxes[id].lower);
    }
    // A little more than the longest: subtraction rounds, more so far from the origin.
    const double furthest = std::max(-bounds_.lower.minCoeff(), bounds_.upper.maxCoeff());
    reach_ = longest * (1 + 1e-12) + Vec3::Constant(std::abs(furthest) * 1e-15);
    reach_steps_ = clamped(reach_[along_] * steps_per_m_ + 2, steps_);

    // Slot and place in the list make one number to sort by.
    const auto place_bits = static_cast<int>(std::bit_width(ids.size()));
    const std::uint64_t places = (std::uint64_t{1} << place_bits) - 1;
    for_each_block(ids.size(), 4 * kGrain, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t i = begin; i < end; ++i) {
            const Vec3& corner = boxes[ids[i]].lower;
            const std::uint64_t at =
                row(1, corner[across_[1]]) * rows_[0] + row(0, corner[across_[0]]);
            keys_[i] = (at * steps_ + step(corner[along_])) << place_bits | i;
        }
    });
    sort_keys(keys_, scratch_);
    for_each_block(ids.size(), 4 * kGrain, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t i = begin; i < end; ++i) {
            slots_[i] = keys_[i] >> place_bits;
            ids_[i] = ids[keys_[i] & places];
            boxes_[i] = boxes[ids_[i]];
        }
    });

    row_begin_.assign(rows_[0] * rows_[1] + 1, static_cast<std::uint32_t>(ids.size()));
    std::size_t next = 0;
    for (std::size_t i = 0; i < slots_.size(); ++i)
        for (const std::size_t at = slots_[i] / steps_; next <= at; ++next)
            row_begin_[next] = static_cast<std::uint32_t>(i);
}

void GridIndex::walk(const Box3& box,
                     std::uint32_t id,
                     std::size_t begin,
                     std::uint64_t end_slot,
                     const PairRule& rule,
                     std::vector<PairKey>& found) const
{
    for (std::size_t b = begin; b < slots_.size() && slots_[b] <= end_slot; ++b)
        if (overlap(box, boxes_[b]) && ids_[b] != id && rule.wants(id, ids_[b]))
            found.push_back(pair_key(id, ids_[b]));
}

// Looks along its own row, and along the rows that come later in the order: the earlier ones have
// looked, or will look, along this one.
void GridIndex::join_one(std::size_t a,
                         Cursors& cursors,
                         const PairRule& rule,
                         std::vector<PairKey>& found) const
{
    const Box3& box = boxes_[a];
    const std::size_t own = slots_[a] / steps_;
    const std::uint64_t own_step = slots_[a] - own * steps_;
    const std::uint64_t first_step = own_step - std::min(own_step, reach_steps_);
    const std::uint64_t last_step = step(box.upper[along_]);
    walk(box, ids_[a], a + 1, own * steps_ + last_step, rule, found);
    if (cursors.row != own) cursors.reset(own);

    const int u = across_[0], v = across_[1];
    const std::size_t own_v = own / rows_[0], own_u = own - own_v * rows_[0];
    const std::size_t first_u = row(0, box.lower[u] - reach_[u]), last_u = row(0, box.upper[u]);
    const std::size_t last_v = row(1, box.upper[v]);
    for (std::size_t at_v = own_v; at_v <= last_v; ++at_v) {
        for (std::size_t at_u = at_v == own_v ? own_u + 1 : first_u; at_u <= last_u; ++at_u) {
            const std::size_t at = at_v * rows_[0] + at_u;
            const std::uint32_t row_end = row_begin_[at + 1];
            if (row_begin_[at] == row_end) continue;
            const std::uint64_t first_slot = at * steps_ + first_step;
            // Near rows are remembered; far ones, which only large boxes reach, are searched.
            const std::size_t side = at_u + Cursors::kSide - own_u;
            const bool near = at_v - own_v < Cursors::kSide && side < 2 * Cursors::kSide;
            std::uint32_t* cursor = near ? &cursors.at[at_v - own_v][side] : nullptr;
            std::uint32_t begin = near ? *cursor : Cursors::kUnset;
            if (begin == Cursors::kUnset)
                begin = static_cast<std::uint32_t>(std::lower_bound(slots_.begin() + row_begin_[at],
                                                                    slots_.begin() + row_end,
                                                                    first_slot)
                                                   - slots_.begin());
            while (begin < row_end && slots_[begin] < first_slot) ++begin;
            if (near) *cursor = begin;
            walk(box, ids_[a], begin, at * steps_ + last_step, rule, found);
        }
    }
}

void GridIndex::join(const PairRule& rule, std::vector<PairKey>& pairs)
{
    lists_.start(block_count(ids_.size(), kGrain));
    for_each_block(ids_.size(), kGrain, [&](std::size_t begin, std::size_t end, std::size_t block) {
        Cursors cursors;
        for (std::size_t a = begin; a < end; ++a) join_one(a, cursors, rule, lists_[block]);
    });
    lists_.append_to(pairs);
}

// Looks along every row that holds a box which might reach this one.
void GridIndex::meet_one(const Box3& box,
                         std::uint32_t id,
                         const PairRule& rule,
                         std::vector<PairKey>& found) const
{
    if (!overlap(box, bounds_)) return;
    const int u = across_[0], v = across_[1];
    const std::uint64_t first_step = step(box.lower[along_] - reach_[along_]);
    const std::uint64_t last_step = step(box.upper[along_]);
    const std::size_t first_u = row(0, box.lower[u] - reach_[u]), last_u = row(0, box.upper[u]);
    const std::size_t first_v = row(1, box.lower[v] - reach_[v]), last_v = row(1, box.upper[v]);
    for (std::size_t at_v = first_v; at_v <= last_v; ++at_v)
        for (std::size_t at_u = first_u; at_u <= last_u; ++at_u) {
            const std::size_t at = at_v * rows_[0] + at_u;
            const auto row_end = slots_.begin() + row_begin_[at + 1];
            const auto begin = std::lower_bound(slots_.begin() + row_begin_[at], row_end,
                                                at * steps_ + first_step);
            walk(box, id, static_cast<std::size_t>(begin - slots_.begin()), at * steps_ + last_step,
                 rule, found);
        }
}

void GridIndex::meet(const GridIndex& other, const PairRule& rule, std::vector<PairKey>& pairs)
{
    if (other.ids_.empty()) return;
    lists_.start(block_count(ids_.size(), kGrain));
    for_each_block(ids_.size(), kGrain, [&](std::size_t begin, std::size_t end, std::size_t block) {
        for (std::size_t a = begin; a < end; ++a)
            other.meet_one(boxes_[a], ids_[a], rule, lists_[block]);
    });
    lists_.append_to(pairs);
}

}  // namespace throng
