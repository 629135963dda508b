#include "broadphase/cell_table.hpp"

#include "kernels/check.hpp"
#include "kernels/parallel/capacity.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace throng {
namespace {

constexpr double kFarthest = 1e300;  // m, beyond it differences are no longer finite
// Cells of a level are this many times larger than those of the one below.
constexpr int kStep = 2;
// The middle level holds boxes down to so small a share of its cells, the others down to half.
constexpr double kSmall = 8;
// The share of boxes that fit a cell of the middle level. With larger cells a search passes more
// boxes that are not met, with smaller ones more cells.
constexpr double kUsual = 0.9, kWidestCell = 2.5;
constexpr std::size_t kSample = 1024;
// A place is so many cells from the origin at most: further out only larger cells tell places
// apart.
constexpr double kPlaces = 0x1p40;

// A look into a level, from each of the asked boxes, takes as long as so many cells. Boxes of a
// level of which there are more than a so-manieth of the asked ones do not look for these.
constexpr double kCellsALook = 8, kFew = 16;

constexpr std::uint32_t kFirstCapacity = 2;  // entries
// In large worlds memory is what a search waits for: so many places are asked for ahead.
constexpr std::size_t kAhead = 8, kCellsAhead = 32;

float rounded_down(double x)
{
    const auto near = static_cast<float>(std::min(x, 3e38));
    return near - (std::abs(near) * (3 * 0x1p-24f) + 0x1p-126f);
}
float rounded_up(double x)
{
    const auto near = static_cast<float>(std::max(x, -3e38));
    return near + (std::abs(near) * (3 * 0x1p-24f) + 0x1p-126f);
}

std::int64_t cell_at(double place, double per_m)
{
    constexpr double kMost = 0x1p61;  // so that the difference of two is still a number
    const double cell = std::clamp(place * per_m, -kMost, kMost);
    const auto whole = static_cast<std::int64_t>(cell);
    return whole - (cell < static_cast<double>(whole) ? 1 : 0);
}

std::uint64_t mixed(std::uint64_t z)
{
    z = (z ^ (z >> 32)) * 0xd6e8feb86659fd93u;
    return z ^ (z >> 32);
}

template <class Entry>
bool near(const Entry& a, const Entry& b)
{
    return boxes_overlap(a.lower, a.upper, b.lower, b.upper);
}

// The size that nearly all boxes stay below. The sample is taken at even distances, so it is the
// same on every run.
double usual_size(std::span<const Box3> boxes)
{
    std::vector<double> sizes;
    const std::size_t stride = std::max<std::size_t>(1, boxes.size() / kSample);
    for (std::size_t i = 0; i < boxes.size(); i += stride) {
        const double size = (boxes[i].upper - boxes[i].lower).maxCoeff();
        if (size > 0 && size < kFarthest) sizes.push_back(size);
    }
    if (sizes.empty()) return 1;
    const auto at = static_cast<std::size_t>(kUsual * static_cast<double>(sizes.size() - 1));
    std::nth_element(sizes.begin(), sizes.begin() + static_cast<std::ptrdiff_t>(at), sizes.end());
    return kWidestCell * sizes[at];
}

}  // namespace

std::uint8_t CellTable::level_of(const Box3& box) const
{
    if (meets_nothing(box)) return kNowhere;
    const double farthest =
        std::max(box.lower.cwiseAbs().maxCoeff(), box.upper.cwiseAbs().maxCoeff());
    if (!(farthest < kFarthest)) return kAside;
    const double size = std::max((box.upper - box.lower).maxCoeff(), farthest / kPlaces);
    double cell = usual_;
    std::uint8_t level = kMiddle;
    for (; size > cell; ++level) cell *= kStep;
    if (size * kSmall >= cell) return level;
    for (; level > kLowest && size * kStep < cell; --level) cell /= kStep;
    return level;
}

// Where the cells of a row along x begin among the buckets: neighbors in it are neighbors there.
std::uint64_t CellTable::row_of(std::uint8_t level, std::int64_t y, std::int64_t z) const
{
    return mixed(static_cast<std::uint64_t>(y) * 0xc2b2ae3d27d4eb4fu
                 + static_cast<std::uint64_t>(z) * 0x165667b19e3779f9u
                 + level * 0x27d4eb2f165667c5u);
}

void CellTable::take_out(std::uint32_t id)
{
    const std::uint8_t level = level_[id];
    level_[id] = kNowhere;
    if (level == kNowhere) return;
    if (level == kAside) {
        std::erase(aside_, id);
        return;
    }
    --levels_[level].count;
    if (level != kMiddle) {
        std::vector<std::uint32_t>& ids = levels_[level].ids;
        ids[seat_[id]] = ids.back();
        seat_[ids.back()] = seat_[id];
        ids.pop_back();
    }
    // The last of its bucket takes its seat.
    Bucket& bucket = buckets_[places_[id].bucket];
    const Entry& last = entries_[bucket.begin + --bucket.count];
    entries_[places_[id].at] = last;
    places_[last.id].at = places_[id].at;
    if (bucket.count > 0) return;
    leave_room(bucket);
    bucket.capacity = 0;
}

// Somebody else may have the room of a bucket.
void CellTable::leave_room(const Bucket& bucket)
{
    if (bucket.capacity > 0)
        free_places_[std::countr_zero(bucket.capacity)].push_back(bucket.begin);
}

// Where there is room for so many, a power of two.
std::uint32_t CellTable::find_free_places(std::uint32_t capacity)
{
    std::vector<std::uint32_t>& free = free_places_[std::countr_zero(capacity)];
    if (free.empty()) {
        resize_closely(entries_, entries_.size() + capacity);
        return static_cast<std::uint32_t>(entries_.size() - capacity);
    }
    const std::uint32_t begin = free.back();
    free.pop_back();
    return begin;
}

void CellTable::insert(const Entry& entry, std::uint32_t at)
{
    Bucket& bucket = buckets_[at];
    if (bucket.count == bucket.capacity) {
        // Moves to where there is room for twice as many.
        const std::uint32_t capacity = std::max(kFirstCapacity, 2 * bucket.capacity),
                            begin = find_free_places(capacity);
        for (std::uint32_t i = 0; i < bucket.count; ++i) {
            entries_[begin + i] = entries_[bucket.begin + i];
            places_[entries_[begin + i].id].at = begin + i;
        }
        leave_room(bucket);
        bucket.begin = begin;
        bucket.capacity = capacity;
    }
    places_[entry.id] = {at, bucket.begin + bucket.count};
    entries_[bucket.begin + bucket.count++] = entry;
}

void CellTable::put(std::uint32_t id, const Box3& box)
{
    take_out(id);
    const std::uint8_t at = level_of(box);
    level_[id] = at;
    if (at == kNowhere) return;
    if (at == kAside) {
        aside_.push_back(id);
        return;
    }
    Level& level = levels_[at];
    if (level.cell == 0) {
        active_.push_back(at);
        level.cell = usual_ * std::pow(kStep, at - kMiddle);
        level.per_m = 1 / level.cell;
    }
    ++level.count;
    if (at != kMiddle) {
        seat_[id] = static_cast<std::uint32_t>(level.ids.size());
        level.ids.push_back(id);
    }
    level.longest = level.longest.cwiseMax(box.upper - box.lower);
    const auto cell = [&](int axis) { return cell_at(box.lower[axis], level.per_m); };
    const std::uint64_t bucket = row_of(at, cell(1), cell(2)) + static_cast<std::uint64_t>(cell(0));
    insert(entry_of(id, box), static_cast<std::uint32_t>(bucket & (buckets_.size() - 1)));
}

CellTable::Entry CellTable::entry_of(std::uint32_t id, const Box3& box)
{
    Entry entry{};
    entry.id = id;
    for (int axis = 0; axis < 3; ++axis) {
        entry.lower[axis] = rounded_down(box.lower[axis]);
        entry.upper[axis] = rounded_up(box.upper[axis]);
    }
    return entry;
}

void CellTable::rebuild(const OverlapQuery& query)
{
    const std::size_t count = query.boxes.size();
    buckets_.assign(std::bit_ceil(2 * count + 1), {});
    entries_.clear();
    for (std::vector<std::uint32_t>& free : free_places_) free.clear();
    places_.assign(count, {});
    level_.assign(count, kNowhere);
    seat_.assign(count, 0);
    aside_.clear();
    active_.clear();
    levels_.fill({});
    usual_ = usual_size(query.boxes);
    for (std::uint32_t id = 0; id < count; ++id) put(id, query.boxes[id]);
}

void CellTable::update(const OverlapQuery& query)
{
    take_in(query);
    choose_searched(query);
}

// Whether the boxes of a level are so few, and their surroundings so small, that to look there for
// those of smaller cells is less than to have these look for them.
bool CellTable::pays_to_look_down(const OverlapQuery& query, std::uint8_t level) const
{
    const std::vector<std::uint32_t>& ids = levels_[level].ids;
    const auto asked = static_cast<double>(named_.size());
    if (ids.empty() || static_cast<double>(ids.size()) * kFew > asked) return false;
    double cells = 0;
    for (const std::uint8_t below : active_) {
        if (below >= level || levels_[below].count == 0) continue;
        for (const std::uint32_t id : ids) {
            cells += cells_round(query.boxes[id], levels_[below]).count;
            if (!(cells < kCellsALook * asked)) return false;
        }
    }
    return cells > 0;
}

void CellTable::choose_searched(const OverlapQuery& query)
{
    searched_ = named_;
    for (const std::uint8_t at : active_) {
        Level& level = levels_[at];
        level.looks_down = pays_to_look_down(query, at);
        if (!level.looks_down) continue;
        for (const std::uint32_t id : level.ids)
            if (asked_[id] == 0) searched_.push_back(id);
    }
}

void CellTable::take_in(const OverlapQuery& query)
{
    const std::size_t count = query.boxes.size(), before = level_.size();
    THRONG_CHECK(query.moving.size() == count, "a flag for each box");
    THRONG_CHECK(std::adjacent_find(query.asked.begin(), query.asked.end(), std::greater_equal<>())
                     == query.asked.end(),
                 "asked ids ascend");
    for (const std::uint32_t id : named_)
        if (id < asked_.size()) asked_[id] = 0;
    asked_.resize(count, 0);
    named_.assign(query.asked.begin(), query.asked.end());
    for (const std::uint32_t id : named_) asked_[id] = 1;

    // Once in a while a world outgrows its table, or all change at once.
    const bool grown = 2 * count > buckets_.size();
    if (before == 0 || count < before || grown || 2 * named_.size() > count) {
        rebuild(query);
        return;
    }
    places_.resize(count);
    level_.resize(count, kNowhere);
    seat_.resize(count, 0);
    for (std::size_t i = 0; i < named_.size(); ++i) {
        if (i + kAhead < named_.size()) {
            const EntryPlace& place = places_[named_[i + kAhead]];
            if (place.bucket < buckets_.size()) __builtin_prefetch(&buckets_[place.bucket]);
            if (place.at < entries_.size()) __builtin_prefetch(&entries_[place.at]);
        }
        put(named_[i], query.boxes[named_[i]]);
    }
    for (auto id = static_cast<std::uint32_t>(before); id < count; ++id)
        if (asked_[id] == 0) put(id, query.boxes[id]);
}

// The cells in which a box may lie that meets this one.
CellTable::Cells CellTable::cells_round(const Box3& box, const Level& level) const
{
    Cells cells;
    cells.count = 1;
    for (int axis = 0; axis < 3; ++axis) {
        // A little more than the longest: subtraction rounds, more so far from the origin.
        const double longest = level.longest[axis];
        const double slack = longest * 1e-12 + (std::abs(box.lower[axis]) + longest) * 1e-15;
        cells.first[axis] = cell_at(box.lower[axis] - longest - slack, level.per_m);
        cells.last[axis] = cell_at(box.upper[axis], level.per_m);
        cells.count *= static_cast<double>(cells.last[axis] - cells.first[axis] + 1);
    }
    return cells;
}

// What one box meets. Buckets first, then their entries, then a look: each round waits for memory
// once.
class CellTable::Search {
public:
    Search(const CellTable& table,
           const OverlapQuery& query,
           std::uint32_t id,
           std::vector<PairKey>& pairs)
        : table_(table), query_(query), id_(id), box_(query.boxes[id]),
          moves_(query.moving[id] != 0), asked_(table.asked_[id] != 0), level_(table.level_[id]),
          mine_(entry_of(id, box_)), pairs_(pairs)
    { }

    // Whether pairs with boxes of a level are found by this one, whoever is asked; or by those.
    bool looks_down_to(std::uint8_t level) const
    {
        return level >= kLowest && level < level_ && table_.levels_[level_].looks_down;
    }
    bool is_found_from(std::uint8_t level) const
    {
        return level_ >= kLowest && level > level_ && table_.levels_[level].looks_down;
    }
    bool searches(std::uint8_t level) const
    {
        return table_.levels_[level].count > 0 && !is_found_from(level)
            && (asked_ || looks_down_to(level));
    }

    void add_if_overlapping(std::uint32_t other) const
    {
        if (other == id_) return;
        const bool other_asked = table_.asked_[other] != 0;
        if (!asked_ && !other_asked) return;
        if (other_asked && other < id_ && !looks_down_to(table_.level_[other])) return;
        if (!moves_ && query_.moving[other] == 0) return;
        if (!box_.overlaps(query_.boxes[other])) return;
        if (query_.filter != nullptr && !query_.filter->allows(id_, other)) return;
        pairs_.push_back(pair_key(id_, other));
    }

    // Those of a level that may lie near.
    void look_into(std::uint8_t level, const Cells& cells)
    {
        const std::uint64_t mask = table_.buckets_.size() - 1;
        for (std::int64_t z = cells.first[2]; z <= cells.last[2]; ++z)
            for (std::int64_t y = cells.first[1]; y <= cells.last[1]; ++y) {
                const std::uint64_t row = table_.row_of(level, y, z);
                for (std::int64_t x = cells.first[0]; x <= cells.last[0]; ++x)
                    add(&table_.buckets_[(row + static_cast<std::uint64_t>(x)) & mask]);
            }
    }

    // At those that were added since the last look.
    void look()
    {
        std::size_t full = 0;
        for (std::size_t i = 0; i < ahead_; ++i) {
            if (cells_ahead_[i]->count == 0) continue;
            __builtin_prefetch(table_.entries_.data() + cells_ahead_[i]->begin);
            cells_ahead_[full++] = cells_ahead_[i];
        }
        for (std::size_t i = 0; i < full; ++i)
            walk(*cells_ahead_[i], [](std::uint32_t) { return true; });
        ahead_ = 0;
    }

    template <class Wanted>
    void walk(const Bucket& bucket, const Wanted& wanted) const
    {
        const Entry* const begin = table_.entries_.data() + bucket.begin;
        for (const Entry* entry = begin; entry < begin + bucket.count; ++entry)
            if (near(mine_, *entry) && wanted(entry->id)) add_if_overlapping(entry->id);
    }

private:
    void add(const Bucket* bucket)
    {
        __builtin_prefetch(bucket);
        cells_ahead_[ahead_++] = bucket;
        if (ahead_ == kCellsAhead) look();
    }

    const CellTable& table_;
    const OverlapQuery& query_;
    const std::uint32_t id_;
    const Box3& box_;
    const bool moves_, asked_;
    const std::uint8_t level_;
    const Entry mine_;
    std::vector<PairKey>& pairs_;
    std::array<const Bucket*, kCellsAhead> cells_ahead_;
    std::size_t ahead_ = 0;
};

void CellTable::find_overlaps(const OverlapQuery& query,
                              std::uint32_t id,
                              std::vector<PairKey>& pairs) const
{
    if (level_[id] == kNowhere) return;
    Search search(*this, query, id, pairs);
    std::array<bool, 256> all{};
    bool scans = false;
    for (const std::uint8_t at : active_) {
        if (!search.searches(at)) continue;
        const Cells cells = cells_round(query.boxes[id], levels_[at]);
        // A large box beside small ones: to look at each of them is less than to look for them.
        if (level_[id] == kAside || !(cells.count < static_cast<double>(level_.size()) / 2 + 64))
            all[at] = scans = true;
        else
            search.look_into(at, cells);
    }
    search.look();
    if (scans)
        for (const Bucket& bucket : buckets_)
            search.walk(bucket, [&](std::uint32_t other) { return all[level_[other]]; });
    if (asked_[id] == 0) return;
    for (const std::uint32_t other : aside_) search.add_if_overlapping(other);
}

}  // namespace throng
