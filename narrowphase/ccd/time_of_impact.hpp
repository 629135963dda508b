// Time of impact: when two shapes that move and turn first touch.
//
// Every method asks the same things: how far apart the two are now and along which direction (GJK
// on cores, in double), and how far apart they are along that very direction at another time (a
// furthest point of each). What they are apart along a fixed direction is never more than their
// distance, so a time up to which that stays above 0 has been passed by no impact, however fast the
// two turn. Then the direction is found afresh. An impact is never told late: the two are apart, or
// touch within the tolerance, at the time that is told and at all times before.
#pragma once

#include "kernels/geometry/support.hpp"
#include "narrowphase/ccd/first_crossing.hpp"
#include "narrowphase/ccd/rigid_trajectory.hpp"

namespace throng {

/// A shape on its way.
///
///   ball     m, above 0: a ball of this radius about the origin of `local` stands for the shape
///   scale    of a sphere, capsule, cylinder or box, about its middle
///   pieces   a solid that has spheres is these, and not its triangles; of two meshes both are
///            triangles, and neither is a ball
struct MovingShape {
    ShapeRef shape;
    RigidTrajectory trajectory;  // of its body
    Pose local;                  // of the shape, in the body's frame
    double ball = 0;
    double scale = 1;
    bool pieces = false;
};

enum class ToiState : std::uint8_t {
    separated,          // they do not come within `close`
    hit,                // at `time` for the first time
    touching_at_start,  // they are within `close` or overlap as it begins
};

/// What was found.
///
///   time         0 to 1: they have come no nearer than `level` until then. At the start of the
///   time
///                looked at where they touch already, at its end where they do not meet
///   distance     m, then, no more than it is; 0 where they overlap
///   normal       unit, from a to b; of no use where they overlap
///   evaluations  distances and separations asked for
///   cut_short    the search came to its bound, and told a meeting early
struct Impact {
    ToiState state = ToiState::separated;
    double time = 1;
    double distance = 0;
    Vec3 normal = Vec3::UnitZ();
    int evaluations = 0;
    bool cut_short = false;
};

/// The length that tolerances are relative to: the smallest half extent of the two, of those that
/// have one; the radius of the smaller where neither has.
double impact_size(const Shapes& shapes, ShapeRef a, ShapeRef b);

/// The rule for a tolerance, m: at the time told the two are between half of it and all of it
/// apart. Two that pass within it may be told to meet.
ImpactRule impact_rule(ToiMethod method, double tolerance);

/// When two shapes first touch between two times of their sweeps.
///
/// Spheres, capsules, cylinders, boxes and hulls, at most one plane, and meshes, which are their
/// triangles, as are solids; of two meshes one is taken by its triangles and the other as the ball
/// within it, but where they are to be taken by their pieces. Never throws; allocates nothing but
/// for the mesh whose triangles are looked at.
///
/// Source: Mirtich, Impulse-based Dynamic Simulation (1996), section 2.3, for `conservative`;
/// Catto,
///         Continuous Collision (GDC 2013), for a separation along the axis of closest features.
Impact time_of_impact(const Shapes& shapes,
                      const MovingShape& a,
                      const MovingShape& b,
                      double begin,
                      double end,
                      const ImpactRule& rule);

}  // namespace throng
