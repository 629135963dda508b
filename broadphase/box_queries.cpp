#include "broadphase/box_queries.hpp"

#include "broadphase/layers.hpp"
#include "kernels/parallel/sort_keys.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace throng {
namespace {

constexpr std::size_t kRayGrain = 64;
// Margin of the tree's boxes, of its radius. A ray in floats strays by 4e-7 of it at most.
constexpr double kMargin = 1e-6;
// Boxes that lie this many times further out than nearly all others would widen that margin.
constexpr double kFarOut = 100;
constexpr double kFarthest = 1e16;  // m, beyond it floats give out
constexpr std::size_t kSample = 1024;

bool overlaps(const Box3& region, const Box3& box)
{
    return region.overlaps(box) && !meets_nothing(region) && !meets_nothing(box);
}

// Narrows [first, last] to the part of the ray inside the box. Where a quotient rounds, the part
// grows; a comparison with what is not a number narrows nothing.
void clip(const Ray& ray, const Box3& box, double& first, double& last)
{
    const double widen = 8 * std::numeric_limits<double>::epsilon();
    for (int axis = 0; axis < 3; ++axis) {
        const double from = ray.from[axis], along = ray.along[axis];
        if (along == 0) {
            if (from < box.lower[axis] || from > box.upper[axis]) last = -1;
            continue;
        }
        double enter = (box.lower[axis] - from) / along, leave = (box.upper[axis] - from) / along;
        if (along < 0) std::swap(enter, leave);
        enter -= std::abs(enter) * widen;
        leave += std::abs(leave) * widen;
        if (enter > first) first = enter;
        if (leave < last) last = leave;
    }
}

double farthest(const Box3& box, const Vec3& origin)
{
    return std::max((box.lower - origin).cwiseAbs().maxCoeff(),
                    (box.upper - origin).cwiseAbs().maxCoeff());
}

// The distance that nearly all boxes stay below.
double usual_distance(std::span<const Box3> boxes,
                      const std::vector<std::uint32_t>& ids,
                      const Vec3& origin)
{
    std::vector<double> distances;
    const std::size_t stride = std::max<std::size_t>(1, ids.size() / kSample);
    for (std::size_t i = 0; i < ids.size(); i += stride)
        distances.push_back(farthest(boxes[ids[i]], origin));
    const auto place = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() * 95 / 100);
    std::nth_element(distances.begin(), place, distances.end());
    return *place;
}

bool is_number(const Ray& ray)
{
    return ray.from.allFinite() && ray.along.allFinite() && ray.longest >= 0;
}

}  // namespace

bool may_meet(const Ray& ray, const Box3& box)
{
    if (!is_number(ray) || meets_nothing(box)) return false;
    double first = 0, last = ray.longest;
    clip(ray, box, first, last);
    return first <= last;
}

void ListedBoxes::meet_rays(std::span<const Ray> rays, Candidates& candidates) const
{
    candidates.begin.assign(1, 0);
    candidates.ids.clear();
    for (const Ray& ray : rays) {
        for (std::uint32_t id = 0; id < boxes_.size(); ++id)
            if (may_meet(ray, boxes_[id])) candidates.ids.push_back(id);
        candidates.begin.push_back(candidates.ids.size());
    }
}

void ListedBoxes::meet_boxes(std::span<const Box3> regions, Candidates& candidates) const
{
    candidates.begin.assign(1, 0);
    candidates.ids.clear();
    for (const Box3& region : regions) {
        for (std::uint32_t id = 0; id < boxes_.size(); ++id)
            if (overlaps(region, boxes_[id])) candidates.ids.push_back(id);
        candidates.begin.push_back(candidates.ids.size());
    }
}

void EmbreeRays::build(std::span<const Box3> boxes)
{
    boxes_.assign(boxes.begin(), boxes.end());
    ids_.clear();
    aside_.clear();
    for (std::uint32_t id = 0; id < boxes.size(); ++id) {
        if (meets_nothing(boxes[id])) continue;
        const bool finite = farthest(boxes[id], Vec3::Zero()) < kFarthest;
        (finite ? ids_ : aside_).push_back(id);
    }
    bounds_ = Box3();
    radius_ = 0;
    in_tree_.clear();
    if (!ids_.empty()) {
        origin_ = middle_of(boxes, ids_);
        const double limit = kFarOut * usual_distance(boxes, ids_, origin_);
        std::erase_if(ids_, [&](std::uint32_t id) {
            const bool far_out = farthest(boxes[id], origin_) > limit;
            if (far_out) aside_.push_back(id);
            return far_out;
        });
        for (const std::uint32_t id : ids_) {
            in_tree_.push_back(boxes[id]);
            radius_ = std::max(radius_, farthest(boxes[id], origin_));
            bounds_ = joined(bounds_, boxes[id]);
        }
    }
    const double margin = kMargin * radius_;
    bounds_.lower.array() -= margin;
    bounds_.upper.array() += margin;
    tree_.build(in_tree_, origin_, margin);
}

void EmbreeRays::meet_ray(const Ray& ray, std::vector<std::uint32_t>& ids) const
{
    if (!is_number(ray)) return;
    for (const std::uint32_t id : aside_)
        if (may_meet(ray, boxes_[id])) ids.push_back(id);

    // The part near the tree, told in floats from where that part begins.
    double first = 0, last = ray.longest;
    clip(ray, bounds_, first, last);
    if (!(first <= last)) return;
    const double speed = ray.along.cwiseAbs().maxCoeff();
    const Vec3 from = ray.from + ray.along * first;
    const double distance = (ray.from - origin_).cwiseAbs().maxCoeff() + speed * first;
    const double length = (last - first) * speed * (1 + 10 * kMargin) + 10 * kMargin * radius_;
    // From too far away even doubles lose the way; a ray that goes nowhere has none.
    const bool certain = speed > 1e-300 && std::isfinite(1 / speed) && length < kFarthest
        && distance + origin_.cwiseAbs().maxCoeff() < 1e8 * radius_;
    if (!certain) {
        for (const std::uint32_t id : ids_)
            if (may_meet(ray, boxes_[id])) ids.push_back(id);
        return;
    }
    const std::size_t before = ids.size();
    tree_.along(from, ray.along / speed, length, ids);
    const auto tail = ids.begin() + static_cast<std::ptrdiff_t>(before);
    std::transform(tail, ids.end(), tail, [&](std::uint32_t place) { return ids_[place]; });
    ids.erase(std::remove_if(tail, ids.end(),
                             [&](std::uint32_t id) { return !may_meet(ray, boxes_[id]); }),
              ids.end());
}

void EmbreeRays::meet_rays(std::span<const Ray> rays, Candidates& candidates)
{
    counts_.assign(rays.size(), 0);
    lists_.start(block_count(rays.size(), kRayGrain));
    for_each_block(rays.size(), kRayGrain, [&](auto begin, auto end, auto block) {
        std::vector<std::uint32_t>& ids = lists_[block];
        for (std::size_t i = begin; i < end; ++i) {
            const auto before = static_cast<std::ptrdiff_t>(ids.size());
            meet_ray(rays[i], ids);
            std::sort(ids.begin() + before, ids.end());
            counts_[i] = ids.size() - static_cast<std::size_t>(before);
        }
    });
    candidates.ids.clear();
    lists_.append_to(candidates.ids);
    candidates.begin.assign(1, 0);
    candidates.begin.resize(rays.size() + 1);
    std::partial_sum(counts_.begin(), counts_.end(), candidates.begin.begin() + 1);
}

void EmbreeRays::meet_boxes(std::span<const Box3> regions, Candidates& candidates)
{
    // Questions and answers as keys: question above, id below.
    keys_.clear();
    std::vector<Box3> asked;
    std::vector<std::uint32_t> questions;
    for (std::uint32_t q = 0; q < regions.size(); ++q) {
        if (meets_nothing(regions[q])) continue;
        const bool fits = farthest(regions[q], origin_) < kFarthest;
        const auto compare = [&](const std::vector<std::uint32_t>& ids) {
            for (const std::uint32_t id : ids)
                if (overlaps(regions[q], boxes_[id])) keys_.push_back(PairKey{q} << 32 | id);
        };
        compare(aside_);
        if (!fits) compare(ids_);
        if (!fits) continue;
        asked.push_back(regions[q]);
        questions.push_back(q);
    }
    regions_.build(asked, origin_, 0);
    const auto accept = [&](std::uint32_t at, std::uint32_t place, PairKey& key) {
        key = PairKey{questions[at]} << 32 | ids_[place];
        return overlaps(asked[at], in_tree_[place]);
    };
    regions_.collide(tree_, accept, keys_);
    sort_keys(keys_, scratch_);

    candidates.begin.assign(regions.size() + 1, 0);
    candidates.ids.clear();
    for (const PairKey key : keys_) {
        candidates.ids.push_back(second_of(key));
        ++candidates.begin[first_of(key) + 1];
    }
    std::partial_sum(candidates.begin.begin(), candidates.begin.end(), candidates.begin.begin());
}

}  // namespace throng
