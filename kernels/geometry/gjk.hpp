// GJK: the distance of two convex shapes, by walking the Minkowski difference.
//
// Works on cores (kernels/geometry/support.hpp) and leaves rounding to the caller, so that round
// shapes are exact. Always in double: one pair at a time that costs what float would, and float
// stops short of the accuracy that contacts need (below 1e-6 of the size, progress is noise).
#pragma once

#include "kernels/geometry/support.hpp"

namespace throng {

class HillClimbingSupports;

/// Two cores, b placed in a's frame.
struct ConvexCorePair {
    ConvexCore<double> a, b;
    Vec3 b_position = Vec3::Zero();
    Mat3 b_turn = Mat3::Identity();
    double size = 0;  // what tolerances are relative to

    ConvexCorePair(const Shapes& shapes, ShapeRef shape_a, ShapeRef shape_b, const Pose& b_in_a);
    ConvexCorePair(const ConvexCore<double>& core_a,
                   const ConvexCore<double>& core_b,
                   const Pose& b_in_a);
};

/// A point of a minus a point of b, in a's frame, and the features that these are of
/// (SupportPoint).
struct MinkowskiVertex {
    Vec3 point, on_a, on_b;
    std::uint32_t feature_a, feature_b;
};

/// The furthest difference along a direction of any length.
MinkowskiVertex minkowski_support(const ConvexCorePair& pair, const Vec3& direction);

/// How far apart the cores lie along a unit direction from a to b, m; below 0 where they overlap.
/// No direction gives more than their distance, and minus the result is always enough to part them.
double separation_along(const ConvexCorePair& pair, const Vec3& direction);

/// Up to four differences and the weights that make the one nearest to 0.
struct Simplex {
    std::array<MinkowskiVertex, 4> corners;
    std::array<double, 4> weights = {};
    int count = 0;
};

/// GJK's bound; only where it comes to that are its iterations more.
inline constexpr int kMostRounds = 128;

/// What GJK found.
///
///   apart      the cores have a positive distance; else only `simplex` is of use
///   distance   m, of the cores; where `beyond` a lower bound of it
///   beyond     stopped early: further apart than was asked about
///   stalled    stopped as lengths showed no gain any more, which says that the distance is right
///              but the normal only to the root of rounding
///   normal     unit, from a to b
struct Distance {
    bool apart = false;
    bool beyond = false;
    bool stalled = false;
    double distance = 0;
    Vec3 normal = Vec3::UnitZ();
    Vec3 on_a = Vec3::Zero(), on_b = Vec3::Zero();
    Simplex simplex;
    int iterations = 0;
};

/// Distance of two cores.
///
/// Ends on a repeated support point (exact for polytopes), once the bounds from both sides agree to
/// 1e-14 of the size, when nothing improves any more, or after kMostRounds. The nearest point of a
/// simplex is sought by region, from its newest corner, and degenerate simplices fall back to their
/// edges.
///
///   limit      m, distances beyond it need not be measured
///
/// Source: Gilbert, Johnson, Keerthi (1988); van den Bergen, Collision Detection in Interactive 3D
///         Environments (2003), section 4.3.
Distance gjk(const ConvexCorePair& pair, double limit);

/// The same with supports of one's own, begun with a simplex of differences that need not be the
/// furthest along anything; of count 0 for the usual beginning, the direction from center to
/// center, which is then asked at once whether it shows more room than the limit.
Distance gjk(const ConvexCorePair& pair,
             double limit,
             HillClimbingSupports& supports,
             const Simplex& beginning);

/// What GJK found of a core that is passed by another.
///
///   nearest  as of gjk(), of a and of all that b sweeps over; on_b is where b was then
///   at       while apart: how far b had gone, 0 to 1 of its motion; one moment of those as near
struct SweptDistance {
    Distance nearest;
    double at = 0;
};

/// Distance of a to b on its way, while b moves along a straight line and does not turn: not apart
/// where b passes through a, however thin a is.
///
///   motion  m, of b against a, in a's frame
///
/// Source: van den Bergen (2003), section 4.3, on the sum of a shape and a segment.
SweptDistance swept_gjk(const ConvexCorePair& pair, const Vec3& motion, double limit);

}  // namespace throng
