// Box queries: which colliders a ray, or a region, might meet.
//
// Candidates by their boxes alone: whoever asks tests the shapes. A candidate may be too many,
// never one too few. ListedBoxes is the plain answer sheet for EmbreeRays; the two give the same
// lists.
#pragma once

#include "broadphase/embree_tree.hpp"
#include "kernels/parallel/compact.hpp"

namespace throng {

/// The points from + along * t, 0 <= t <= longest. `along` may have any length, even none;
/// `longest` may be infinite. A ray that is not a number meets nothing.
struct Ray {
    Vec3 from = Vec3::Zero();
    Vec3 along = Vec3::UnitZ();
    double longest = std::numeric_limits<double>::infinity();
};

/// True unless the ray surely misses the box: rounding is always taken for a hit.
bool may_meet(const Ray& ray, const Box3& box);

/// The answers to a list of questions: ids, ascending, for each.
struct Candidates {
    std::vector<std::size_t> begin = {0};  // [questions + 1] into ids
    std::vector<std::uint32_t> ids;

    std::size_t questions() const { return begin.size() - 1; }
    std::span<const std::uint32_t> of(std::size_t question) const
    {
        return std::span(ids).subspan(begin[question], begin[question + 1] - begin[question]);
    }
};

/// Every box against every question.
class ListedBoxes {
public:
    /// Copies the boxes; a collider's id is its place.
    void build(std::span<const Box3> boxes) { boxes_.assign(boxes.begin(), boxes.end()); }
    void meet_rays(std::span<const Ray> rays, Candidates& candidates) const;
    void meet_boxes(std::span<const Box3> regions, Candidates& candidates) const;

private:
    std::vector<Box3> boxes_;
};

/// The same with a tree. Build once per step at most, then ask in batches.
class EmbreeRays {
public:
    void build(std::span<const Box3> boxes);
    void meet_rays(std::span<const Ray> rays, Candidates& candidates);
    void meet_boxes(std::span<const Box3> regions, Candidates& candidates);

private:
    void meet_ray(const Ray& ray, std::vector<std::uint32_t>& ids) const;

    EmbreeBoxes tree_;
    std::vector<Box3> boxes_;           // by id
    std::vector<Box3> in_tree_;         // by place in the tree
    std::vector<std::uint32_t> ids_;    // by place in the tree
    std::vector<std::uint32_t> aside_;  // infinite, or far from all others: compared one by one
    Vec3 origin_ = Vec3::Zero();
    double radius_ = 0;  // m, of a cube about the origin that holds the tree
    Box3 bounds_;        // of the tree, margin included

    BlockLists<std::uint32_t> lists_;
    std::vector<std::size_t> counts_;
    EmbreeBoxes regions_;
    std::vector<PairKey> keys_, scratch_;
};

}  // namespace throng
