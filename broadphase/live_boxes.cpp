#include "broadphase/live_boxes.hpp"

#include "broadphase/layers.hpp"
#include "kernels/parallel/compact.hpp"

#include <algorithm>
#include <numeric>

namespace throng {
namespace {

// So many are looked at one by one with each question.
constexpr std::size_t kFewLoose = 128;
constexpr std::size_t kGrain = 64;  // questions a block

double size_of(const Box3& box) { return (box.upper - box.lower).maxCoeff(); }

}  // namespace

void LiveBoxes::resize(std::size_t count)
{
    boxes_.resize(count);
    held_by_.resize(count, kNowhere);
}

void LiveBoxes::leave(std::uint32_t id)
{
    const std::uint16_t by = held_by_[id];
    if (by < trees_.size()) ++trees_[by].left;
    held_by_[id] = kNowhere;
}

void LiveBoxes::put(std::uint32_t id, const Box3& box, const Vec3& ahead, double around)
{
    if (meets_nothing(box)) {
        leave(id);
        boxes_[id] = {};
        return;
    }
    if (stays(id, box)) return;
    if (held_by_[id] != kLoose) {
        leave(id);
        held_by_[id] = kLoose;
        loose_.push_back(id);
    }
    Box3& held = boxes_[id];
    held.lower = (box.lower + ahead).cwiseMin(box.lower).array() - around;
    held.upper = (box.upper + ahead).cwiseMax(box.upper).array() + around;
    bounds_ = joined(bounds_, held);
}

void LiveBoxes::settle()
{
    // Who went away and came back was listed twice.
    keep_each_once(loose_);
    std::erase_if(loose_, [&](std::uint32_t id) { return held_by_[id] != kLoose; });
    if (loose_.size() > kFewLoose || any_half_empty())
        grow_tree();
    else if (trees_.empty())
        measure(loose_);
}

bool LiveBoxes::any_half_empty() const
{
    const auto half_empty = [](const Tree& tree) { return 2 * tree.left > tree.ids.size(); };
    return std::any_of(trees_.begin(), trees_.end(), half_empty);
}

// Of all that is loose, of what half empty trees hold, and of the trees that are hardly larger.
void LiveBoxes::grow_tree()
{
    std::vector<std::uint32_t> ids;
    ids.swap(loose_);
    const auto kept = [&] {
        if (any_half_empty()) return false;
        return trees_.empty() || trees_.back().ids.size() - trees_.back().left > 2 * ids.size();
    };
    while (!kept()) {
        const std::size_t place = trees_.size() - 1;
        for (const std::uint32_t id : trees_.back().ids)
            if (held_by_[id] == place) ids.push_back(id);
        trees_.pop_back();
    }
    std::sort(ids.begin(), ids.end());
    std::vector<Box3> boxes;
    boxes.reserve(ids.size());
    for (const std::uint32_t id : ids) {
        boxes.push_back(boxes_[id]);
        held_by_[id] = static_cast<std::uint16_t>(trees_.size());
    }
    Tree& tree = trees_.emplace_back();
    tree.boxes.build(boxes);
    tree.ids = std::move(ids);
    if (trees_.size() == 1) measure(tree.ids);
}

// What questions go by, anew.
void LiveBoxes::measure(std::span<const std::uint32_t> all)
{
    bounds_ = {};
    usual_size_ = 0;
    if (all.empty()) return;
    std::vector<double> sizes;
    sizes.reserve(all.size());
    for (const std::uint32_t id : all) {
        bounds_ = joined(bounds_, boxes_[id]);
        sizes.push_back(size_of(boxes_[id]));
    }
    const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
    std::nth_element(sizes.begin(), middle, sizes.end());
    usual_size_ = *middle;
}

template <class Questions, class Ask, class Meets>
void LiveBoxes::find_met(const Questions& questions,
                         const Ask& ask,
                         const Meets& meets,
                         Candidates& all)
{
    const std::size_t count = questions.size();
    parts_.resize(trees_.size());
    for (std::size_t k = 0; k < trees_.size(); ++k) ask(trees_[k].boxes, parts_[k]);
    all.begin.assign(count + 1, 0);
    lists_.start(block_count(count, kGrain));
    for_each_block(count, kGrain, [&](std::size_t begin, std::size_t end, std::size_t block) {
        std::vector<std::uint32_t>& ids = lists_[block];
        for (std::size_t i = begin; i < end; ++i) {
            const std::size_t before = ids.size();
            for (std::size_t k = 0; k < trees_.size(); ++k)
                for (const std::uint32_t place : parts_[k].of(i))
                    if (const std::uint32_t id = trees_[k].ids[place]; held_by_[id] == k)
                        ids.push_back(id);
            for (const std::uint32_t id : loose_)
                if (meets(questions[i], boxes_[id])) ids.push_back(id);
            all.begin[i + 1] = ids.size() - before;
        }
    });
    all.ids.clear();
    lists_.append_to(all.ids);
    std::partial_sum(all.begin.begin(), all.begin.end(), all.begin.begin());
}

void LiveBoxes::meet_rays(std::span<const Ray> rays, Candidates& candidates)
{
    find_met(
        rays, [&](EmbreeRays& tree, Candidates& part) { tree.meet_rays(rays, part); },
        [](const Ray& ray, const Box3& box) { return may_meet(ray, box); }, candidates);
}

void LiveBoxes::meet_boxes(std::span<const Box3> regions, Candidates& candidates)
{
    find_met(
        regions, [&](EmbreeRays& tree, Candidates& part) { tree.meet_boxes(regions, part); },
        [](const Box3& region, const Box3& box) { return region.overlaps(box); }, candidates);
}

}  // namespace throng
