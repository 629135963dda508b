// Live boxes: boxes that are asked about while some of them move, without a tree built anew each
// time.
//
// Who moves is held with room to move in and is not touched again as long as it stays there. What
// leaves its room goes to a short list, and lists that grow long become trees; a tree of which much
// has left, or that is no larger than what is to become one beside it, is built into that. So each
// box is built into a new tree few times on the whole, and a question meets few trees.
//
// Source: Bentley and Saxe, Decomposable searching problems I, Journal of Algorithms 1 (1980).
#pragma once

#include "broadphase/box_queries.hpp"

namespace throng {

class LiveBoxes {
public:
    /// Ids are below this.
    void resize(std::size_t count);
    /// Where a box is now. An empty one is met by nothing.
    ///
    ///   ahead  m, how far it is thought to go soon, and besides in any direction
    void put(std::uint32_t id, const Box3& box, const Vec3& ahead, double around);
    /// Whether a box is held, and this one stays within the room that it has.
    bool stays(std::uint32_t id, const Box3& box) const
    {
        return held_by_[id] != kNowhere && boxes_[id].contains(box);
    }
    /// Once all are where they are, before anybody asks.
    void settle();

    /// Boxes that a question might meet, as of EmbreeRays, in no order.
    void meet_rays(std::span<const Ray> rays, Candidates& candidates);
    void meet_boxes(std::span<const Box3> regions, Candidates& candidates);

    /// As it is held, with room to move in.
    const Box3& held(std::uint32_t id) const { return boxes_[id]; }
    /// Of all that were put, or more.
    const Box3& bounds() const { return bounds_; }
    /// m, of a box, by the longest side.
    double usual_size() const { return usual_size_; }

private:
    static constexpr std::uint16_t kNowhere = 0xffff, kLoose = 0xfffe;
    struct Tree {
        EmbreeRays boxes;
        std::vector<std::uint32_t> ids;  // by place
        std::size_t left = 0;            // of those, that are held elsewhere by now
    };

    void leave(std::uint32_t id);
    bool any_half_empty() const;
    void grow_tree();
    void measure(std::span<const std::uint32_t> all);
    template <class Questions, class Ask, class Meets>
    void find_met(const Questions& questions, const Ask& ask, const Meets& meets, Candidates& all);

    std::vector<Box3> boxes_;
    std::vector<std::uint16_t> held_by_;  // place among the trees, kLoose or kNowhere
    std::vector<std::uint32_t> loose_;    // until settle() with some that are held elsewhere
    std::vector<Tree> trees_;             // each of fewer boxes than the one before
    Box3 bounds_;
    double usual_size_ = 0;

    // Of the questions asked last.
    std::vector<Candidates> parts_;  // by tree
    BlockLists<std::uint32_t> lists_;
};

}  // namespace throng
