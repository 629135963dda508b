#include "broadphase/layers.hpp"

#include "kernels/check.hpp"

#include <algorithm>
#include <cmath>

namespace throng {
namespace {

// Beyond this a float cannot hold what an index computes.
constexpr double kFarthest = 1e17;
// Sizes are judged by a sample: more would cost time and tell little else.
constexpr std::size_t kSample = 1024;
// A share of the moving ones from which building anew is cheaper than keeping them apart.
constexpr double kManyMoved = 0.3;
// A share from which joining the new layer with itself beats asking it one by one.
constexpr double kManyAsked = 0.5;
constexpr std::size_t kAsideGrain = 1024;

double largest_side(const Box3& box) { return (box.upper - box.lower).maxCoeff(); }

// The size that nearly all boxes stay below. The sample is taken at even distances, so it is the
// same on every run.
double usual_size(std::span<const Box3> boxes, const std::vector<std::uint32_t>& ids)
{
    std::vector<double> sizes;
    const std::size_t stride = std::max<std::size_t>(1, ids.size() / kSample);
    for (std::size_t i = 0; i < ids.size(); i += stride) {
        const double size = largest_side(boxes[ids[i]]);
        if (std::isfinite(size)) sizes.push_back(size);
    }
    if (sizes.empty()) return kFarthest;
    const auto place = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() * 95 / 100);
    std::nth_element(sizes.begin(), place, sizes.end());
    return *place > 0 ? *place : kFarthest;  // mostly points: whatever is larger stays
}

bool stands_aside(const Box3& box, double limit)
{
    return !(largest_side(box) <= limit) || box.lower.minCoeff() < -kFarthest
        || box.upper.maxCoeff() > kFarthest;
}

// Merges into an ascending list the ascending tail that starts at `middle`.
void merge_tail(std::vector<std::uint32_t>& ids, std::size_t middle)
{
    std::inplace_merge(ids.begin(), ids.begin() + static_cast<std::ptrdiff_t>(middle), ids.end());
}

}  // namespace

Vec3 middle_of(std::span<const Box3> boxes, const std::vector<std::uint32_t>& ids)
{
    const std::size_t stride = std::max<std::size_t>(1, ids.size() / kSample);
    Vec3 middle = Vec3::Zero();
    std::vector<double> places;
    for (int axis = 0; axis < 3; ++axis) {
        places.clear();
        for (std::size_t i = 0; i < ids.size(); i += stride)
            places.push_back(boxes[ids[i]].lower[axis]);
        const auto half = places.begin() + static_cast<std::ptrdiff_t>(places.size() / 2);
        std::nth_element(places.begin(), half, places.end());
        middle[axis] = *half;
    }
    return middle;
}

void Layers::update(const OverlapQuery& query)
{
    const std::size_t count = query.boxes.size(), before = place.size();
    THRONG_CHECK(query.moving.size() == count, "a flag for each box");
    THRONG_CHECK(std::adjacent_find(query.asked.begin(), query.asked.end(), std::greater_equal<>())
                     == query.asked.end(),
                 "asked ids ascend");
    for (const std::uint32_t id : named_)
        if (id < count) asked[id] = 0;
    place.resize(count, Place::nowhere);
    asked.resize(count, 0);
    named_.assign(query.asked.begin(), query.asked.end());
    for (const std::uint32_t id : named_) asked[id] = 1;

    // A moving collider that came in unasked has no place yet: only a renewal sees it.
    bool all_anew = !started_ || count < before;
    for (std::size_t id = before; id < count; ++id)
        all_anew |= query.moving[id] != 0 && asked[id] == 0;
    started_ = true;

    still_renewed = query.still_changed || all_anew;
    settled_renewed = all_anew || due();
    std::erase_if(aside, [&](auto id) { return id >= count; });
    if (settled_renewed) {
        renew_settled(query);
        still_renewed |= follow(query.boxes);
    }
    if (still_renewed) renew_still(query);
    if (!settled_renewed) move_asked(query);
    note_askers();
}

bool Layers::due() const
{
    const double many = kManyMoved * static_cast<double>(moving_count_);
    return static_cast<double>(named_.size()) > many || static_cast<double>(moved.size()) > many
        || spent_ > moving_count_;
}

// Sorts out those in `ids` that are too large for an index.
void Layers::split_off(std::vector<std::uint32_t>& ids, std::span<const Box3> boxes, double limit)
{
    const auto keep = std::stable_partition(
        ids.begin(), ids.end(), [&](auto id) { return !stands_aside(boxes[id], limit); });
    for (auto id = keep; id != ids.end(); ++id) place[*id] = Place::aside;
    const std::size_t before = aside.size();
    aside.insert(aside.end(), keep, ids.end());
    merge_tail(aside, before);
    ids.erase(keep, ids.end());
}

void Layers::renew_still(const OverlapQuery& query)
{
    const auto is_still = [&](auto id) { return query.moving[id] == 0; };
    still.clear();
    std::erase_if(aside, is_still);
    std::erase_if(moved, is_still);
    for (std::uint32_t id = 0; id < query.boxes.size(); ++id) {
        if (query.moving[id] != 0) {
            if (place[id] == Place::still) place[id] = Place::nowhere;
            continue;
        }
        const bool absent = meets_nothing(query.boxes[id]);
        place[id] = absent ? Place::nowhere : Place::still;
        if (!absent) still.push_back(id);
    }
    split_off(still, query.boxes, aside_ratio_ * usual_size(query.boxes, still));
}

void Layers::renew_settled(const OverlapQuery& query)
{
    settled.clear();
    moved.clear();
    std::erase_if(aside, [&](auto id) { return query.moving[id] != 0; });
    for (std::uint32_t id = 0; id < query.boxes.size(); ++id) {
        if (query.moving[id] == 0) continue;
        const bool absent = meets_nothing(query.boxes[id]);
        place[id] = absent ? Place::nowhere : Place::settled;
        if (!absent) settled.push_back(id);
    }
    moving_limit_ = aside_ratio_ * usual_size(query.boxes, settled);
    split_off(settled, query.boxes, moving_limit_);
    moving_count_ = settled.size();
    spent_ = 0;
}

// Moves the origin to the middle of the settled ones, once a float counted from where it is would
// be coarse beside their sizes. True if it moved.
bool Layers::follow(std::span<const Box3> boxes)
{
    if (settled.empty()) return false;
    const Vec3 middle = middle_of(boxes, settled);
    const double coarseness = 1e-6 * (middle - origin).cwiseAbs().maxCoeff();
    if (coarseness <= moving_limit_ / aside_ratio_) return false;
    origin = middle;
    return true;
}

void Layers::move_asked(const OverlapQuery& query)
{
    const std::size_t moved_before = moved.size(), aside_before = aside.size();
    std::size_t still_in_moved = 0;
    for (const std::uint32_t id : named_) {
        if (query.moving[id] == 0) continue;
        const Place was = place[id];
        place[id] = meets_nothing(query.boxes[id])         ? Place::nowhere
            : stands_aside(query.boxes[id], moving_limit_) ? Place::aside
                                                           : Place::moved;
        if (place[id] == Place::moved && was != Place::moved) moved.push_back(id);
        if (place[id] == Place::aside && was != Place::aside) aside.push_back(id);
        if (place[id] == Place::moved) ++still_in_moved;
    }
    merge_tail(moved, moved_before);
    merge_tail(aside, aside_before);
    std::erase_if(moved, [&](auto id) { return place[id] != Place::moved; });
    std::erase_if(aside, [&](auto id) { return place[id] != Place::aside; });
    // Those moved earlier and not asked now are what keeping apart costs.
    spent_ += moved.size() - still_in_moved;
}

void Layers::note_askers()
{
    askers.clear();
    for (const std::uint32_t id : named_)
        if (place[id] != Place::nowhere && place[id] != Place::aside) askers.push_back(id);
    join_all = settled_renewed
        && static_cast<double>(askers.size()) >= kManyAsked * static_cast<double>(settled.size());
}

void compare_aside(const OverlapQuery& query,
                   const Layers& layers,
                   BlockLists<PairKey>& lists,
                   std::vector<PairKey>& pairs)
{
    if (layers.aside.empty()) return;
    const auto compare = [&](const PairRule& rule, std::uint32_t a, std::uint32_t b, auto& list) {
        if (a != b && query.boxes[a].overlaps(query.boxes[b]) && rule.allows(a, b))
            list.push_back(pair_key(a, b));
    };
    const PairRule rule{query, layers, Place::aside, false};
    lists.start(block_count(query.asked.size(), kAsideGrain));
    for_each_block(query.asked.size(), kAsideGrain, [&](auto begin, auto end, auto block) {
        for (std::size_t i = begin; i < end; ++i)
            if (layers.place[query.asked[i]] != Place::nowhere)
                for (const std::uint32_t b : layers.aside)
                    compare(rule, query.asked[i], b, lists[block]);
    });
    lists.append_to(pairs);

    // The other way round: one that stands aside and is asked about meets everybody else.
    for (const std::uint32_t a : layers.aside) {
        if (layers.asked[a] == 0) continue;
        lists.start(block_count(query.boxes.size(), kAsideGrain));
        for_each_block(query.boxes.size(), kAsideGrain, [&](auto begin, auto end, auto block) {
            for (std::size_t b = begin; b < end; ++b)
                if (layers.place[b] != Place::nowhere && layers.place[b] != Place::aside)
                    compare(rule, a, static_cast<std::uint32_t>(b), lists[block]);
        });
        lists.append_to(pairs);
    }
}

}  // namespace throng
