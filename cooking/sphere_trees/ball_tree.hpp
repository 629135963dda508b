// Ball tree: which of many balls come near a place.
#pragma once

#include "kernels/geometry/ball.hpp"

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

namespace throng {

/// The two balls nearest to a place: which is nearest, the first of several, and how far off it and
/// the next one are.
struct NearestBalls {
    std::uint32_t by = 0;
    double separation = std::numeric_limits<double>::infinity();
    double next = std::numeric_limits<double>::infinity();

    void offer(std::uint32_t which, double distance)
    {
        if (distance < separation || (distance == separation && which < by)) {
            next = separation;
            separation = distance;
            by = which;
        } else {
            next = std::min(next, distance);
        }
    }
};

/// Balls sorted into a tree. What it answers is what a look at every ball would, to the last bit.
class BallTree {
public:
    /// Keep the balls, as they are, while the tree is in use.
    explicit BallTree(std::span<const Ball> balls);

    /// The gap to the nearest ball, infinite where there are none; that of another ball with a gap
    /// below `enough` will do.
    double least_separation(const Vec3& place,
                            double enough = -std::numeric_limits<double>::infinity()) const;

    /// Of the balls that are not marked as gone.
    NearestBalls nearest(const Vec3& place, std::span<const std::uint8_t> gone = {}) const;

    /// Appends those with a gap no greater than this, in ascending order.
    void find_within(const Vec3& place, double separation, std::vector<std::uint32_t>& found) const;

private:
    struct Node {
        Vec3 center = Vec3::Zero();
        double outer_radius = 0;  // about center, of all its balls
        std::uint32_t first = 0;  // leaf: first in order_; inner: left child, right is left + 1
        std::uint32_t count = 0;  // leaf: balls; inner: 0
    };

    void build(std::uint32_t node, std::uint32_t begin, std::uint32_t end);
    double least_of(const Node& node, const Vec3& place) const;
    template <class Limit, class Visitor>
    void visit(const Vec3& place, Limit limit, Visitor visit) const;

    std::span<const Ball> balls_;
    std::vector<Node> nodes_;
    std::vector<std::uint32_t> order_;
};

}  // namespace throng
