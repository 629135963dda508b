// Direction cone: the directions that no pair of points seen so far speaks against.
//
// A direction parts two shapes only if it leads from every point of the one towards every point of
// the other. Each difference of two points therefore cuts the sphere of directions in half, and
// once nothing of it is left the shapes share a point.
#pragma once

#include "throng/math.hpp"

#include <array>

namespace throng {

/// The directions s with s . r > 0 for every difference r added, as a convex polygon on the sphere.
class DirectionCone {
public:
    /// Differences there is room for; further ones are not heeded.
    static constexpr int kCapacity = 96;

    /// Cuts by the half-space of a difference. False once no direction is left, within rounding:
    /// then add nothing more.
    ///
    ///   difference   unit, of a point of a to a point of b
    bool add(const Vec3& difference);

    int count() const { return count_; }
    /// Whether the direction lies inside.
    bool holds(const Vec3& direction) const;
    /// A unit direction well inside. Needs: one difference at least, and directions left.
    Vec3 middle() const;

    /// Which of the differences, by the order they were added in, leave no direction by themselves:
    /// up to four, the last one of them.
    struct Witness {
        std::array<int, 4> differences = {};
        int count = 0;
    };
    /// Needs: add() has said that no direction is left.
    Witness witness() const;

private:
    static constexpr int kCorners = kCapacity + 8;

    bool open(const Vec3& difference);
    bool cut(const Vec3& difference);
    void insert(int index, int side, const Vec3& corner);

    std::array<Vec3, kCapacity> differences_;
    int count_ = 0;
    // Side i is that from corner i to the next, on the plane across the difference of that index.
    std::array<Vec3, kCorners> corners_;
    std::array<int, kCorners> sides_;
    int sides_count_ = 0;  // 0 while all differences point one way: still half a sphere
};

}  // namespace throng
