// Hill climbing: the furthest vertex of a hull by walking up its edges.
//
// The vertex is the one that looking at all of them gives, to the last bit and with the same choice
// among equals. Climbing alone does not promise that: on a nearly flat face rounding hides which
// way is up, and corners of a face need not lie in one plane at all. So a walk ends on a vertex
// only when its neighbors are lower by more than such errors (HullGuide::slack); else all that lie
// about as high are looked at, which hang together over edges.
#pragma once

#include "kernels/geometry/gjk.hpp"
#include "kernels/geometry/polytope.hpp"

#include <cstdint>

namespace throng {

/// What climbing took, added up.
///
///   supports  vertices asked for
///   steps     vertices stood on to look round, the last included
///   looked    heights measured
struct HillClimbingCount {
    std::int64_t supports = 0, steps = 0, looked = 0;

    HillClimbingCount& operator+=(const HillClimbingCount& other)
    {
        supports += other.supports;
        steps += other.steps;
        looked += other.looked;
        return *this;
    }
};

/// What a hull is climbed by; it lives as long as the hull.
struct HillClimbingShape {
    HillClimbingShape() = default;
    explicit HillClimbingShape(const Hull& hull);
    explicit HillClimbingShape(const PolytopeView& shape);

    const Vec3* vertices = nullptr;
    std::uint32_t count = 0;
    const HullGuide* guide = nullptr;  // null: every vertex is looked at
    const std::uint32_t* begin = nullptr;
    const std::uint16_t* links = nullptr;
};

/// The furthest vertex along a direction of any length; the first of those that tie.
///
/// Begins at the vertex that the guide names for the direction. Of a few vertices all are looked
/// at.
std::uint16_t
furthest_vertex(const HillClimbingShape& shape, const Vec3& direction, HillClimbingCount& count);

/// The same, begun at a vertex that is near the one asked for, as the last of a like direction is.
std::uint16_t furthest_vertex(const HillClimbingShape& shape,
                              const Vec3& direction,
                              std::uint16_t start,
                              HillClimbingCount& count);

/// The same, begun at that vertex or at the one that the guide names, whichever is higher.
std::uint16_t furthest_vertex_near(const HillClimbingShape& shape,
                                   const Vec3& direction,
                                   std::uint16_t start,
                                   HillClimbingCount& count);

/// Finds the furthest vertices of the Minkowski difference of two cores, each from where the last
/// was found.
class HillClimbingSupports {
public:
    /// With `climbs` false every vertex is looked at: the answer sheet.
    explicit HillClimbingSupports(const ConvexCorePair& pair, bool climbs = true);

    /// As minkowski_support() of gjk.hpp, to the last bit.
    MinkowskiVertex operator()(const Vec3& direction);

    /// Begins the next search at these features of the two, if they have them, and nowhere else.
    void start_at(std::uint32_t feature_a, std::uint32_t feature_b);

    const HillClimbingCount& count() const { return count_; }

private:
    struct Side {
        Side(const ConvexCore<double>& of, bool climbs);
        SupportPoint<double> furthest(const Vec3& direction, HillClimbingCount& count);
        void start_at(std::uint32_t feature);

        const ConvexCore<double>& core;
        HillClimbingShape shape;
        std::uint32_t last;    // none: no vertex is known yet
        bool is_near = false;  // the last is known to be the place to begin
    };

    const ConvexCorePair& pair_;
    Side a_, b_;
    HillClimbingCount count_;
};

}  // namespace throng
