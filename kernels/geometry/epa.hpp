// EPA: how deep two convex shapes overlap, by growing a polytope inside the set of differences.
//
// On cores, like gjk.hpp. Fixed room, no allocation; out of room it returns the best so far.
#pragma once

#include "kernels/geometry/gjk.hpp"

namespace throng {

/// What EPA found.
///
///   depth     m, by which b must be moved along normal for the cores to part: always enough, and
///             the least possible within 1e-13 of the size for polytopes and 1e-6 for cylinders;
///             below 0 by rounding, or where the cores are a hair apart
///   normal    unit, from a to b
///   on_a, on_b  points of the two surfaces, depth apart along the normal
///   face        differences whose face has that normal, where `has_face`
struct PenetrationDepth {
    double depth = 0;
    Vec3 normal = Vec3::UnitZ();
    Vec3 on_a = Vec3::Zero(), on_b = Vec3::Zero();
    int iterations = 0;
    bool cut_short = false;  // out of room: the best so far
    bool has_face = false;
    std::array<MinkowskiVertex, 3> face;
};

/// Depth of two cores that overlap or touch.
///
/// Starts from a tetrahedron of extreme differences, which need not contain 0: faces are ordered by
/// signed distance, so that a start beside 0 grows over it. Two cores whose differences all lie in
/// one plane have no depth, and that plane's normal.
///
/// Source: van den Bergen, Proximity Queries and Penetration Depth Computation on 3D Game Objects
///         (2001).
PenetrationDepth epa(const ConvexCorePair& pair);

/// The same with supports of one's own, and room for four times as many corners: round shapes one
/// within the other have as many directions that are nearly the best.
///
///   beginning   where GJK ended: four corners that enclose a volume spare the search for some
PenetrationDepth
epa(const ConvexCorePair& pair, HillClimbingSupports& supports, const Simplex& beginning);

}  // namespace throng
