// Embree tree: a bounding volume hierarchy, built and collided with itself by Embree.
//
// Does not care how large one box is beside another: for scenes from dust to buildings, and for
// rays.
#pragma once

#include "broadphase/overlap_query.hpp"

#include <functional>
#include <memory>

namespace throng {

/// Boxes in a scene of Embree: the only door to Embree, which no other file sees.
///
/// A box is known by its place in the list it came from. Embree sees floats about the origin given,
/// rounded outward, so that it may report too much and never too little.
class EmbreeBoxes {
public:
    EmbreeBoxes();
    ~EmbreeBoxes();
    EmbreeBoxes(EmbreeBoxes&&) noexcept;
    EmbreeBoxes& operator=(EmbreeBoxes&&) noexcept;

    /// Forgets all, then holds these boxes, each wider by `margin` (m) on every side.
    ///
    /// Needs:  boxes that are not empty, no side further than some 1e18 m from the origin.
    void build(std::span<const Box3> boxes, const Vec3& origin, double margin);
    bool empty() const;

    /// Says whether the box at place a and the other's at place b are wanted, and under which key.
    /// Called on several threads at once.
    using Accept = std::function<bool(std::uint32_t a, std::uint32_t b, PairKey& key)>;

    /// Appends the keys of wanted pairs, in no order, each pair once. The other may be this one,
    /// and else has the same origin.
    void collide(const EmbreeBoxes& other, const Accept& accept, std::vector<PairKey>& keys);

    /// Appends the places of boxes near `from + direction * t`, 0 <= t <= length, in no order.
    /// Floats make the ray uncertain: margins must be wide enough for that. May run on several
    /// threads.
    void along(const Vec3& from,
               const Vec3& direction,
               double length,
               std::vector<std::uint32_t>& places) const;

private:
    struct Inside;
    std::unique_ptr<Inside> inside_;
};

/// The finder.
class EmbreeTree {
public:
    EmbreeTree();
    ~EmbreeTree();
    EmbreeTree(EmbreeTree&&) noexcept;
    EmbreeTree& operator=(EmbreeTree&&) noexcept;

    void find(const OverlapQuery& query, std::vector<PairKey>& pairs);

private:
    struct Inside;
    std::unique_ptr<Inside> inside_;
};

}  // namespace throng
