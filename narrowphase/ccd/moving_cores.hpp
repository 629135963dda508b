// Moving cores: two convex shapes on their ways, and how far apart they are at a time.
#pragma once

#include "kernels/geometry/gjk.hpp"
#include "narrowphase/ccd/time_of_impact.hpp"

#include <functional>

namespace throng {

/// The core of a shape on its way, its places counted from some point near by.
class MovingCore {
public:
    MovingCore(const ConvexCore<double>& core, const MovingShape& moving, const Vec3& from);

    const ConvexCore<double>& core() const { return core_; }
    Pose placed_at(double time) const { return trajectory_.at(time) * local_; }
    const RigidTrajectory& trajectory() const { return trajectory_; }
    Vec3 furthest_along(const Vec3& direction, double time) const;
    /// m a unit of time, of a point of the body that is here then.
    Vec3 speed_of(const Vec3& point, double time) const;
    /// m, of a point of the core from where its body turns about, at most.
    double outer_radius() const { return outer_radius_; }

    /// How far the core reaches along a unit direction, and how that changes with time.
    SeparationRate extent(const Vec3& direction, double time) const;
    /// How much of that its turning can change at most.
    SeparationLimits turning_limits(const Vec3& direction) const;

private:
    ConvexCore<double> core_;
    RigidTrajectory trajectory_;
    Pose local_;
    double outer_radius_ = 0;
    double spin_radius_ = 0;  // m, of a point of the core from the axis that its body spins about
};

/// The core of a convex shape or of the ball that stands for it; of a mesh, of its corners.
ConvexCore<double> moving_core(const Shapes& shapes, const MovingShape& moving);

/// How two cores are apart: along the unit direction, in world axes, from a to b. The separation
/// along it is a lower bound of their distance; 0 where they overlap.
struct Apart {
    SeparationRate separation;
    Vec3 normal = Vec3::UnitZ();
};

class MovingCores {
public:
    MovingCores(const ConvexCore<double>& core_a,
                const MovingShape& a,
                const ConvexCore<double>& core_b,
                const MovingShape& b);

    Apart distance_at(double time) const;
    /// How far apart the two are along a unit direction, rounding of the cores included.
    SeparationRate separation_rate(const Vec3& normal, double time) const;
    SeparationLimits limits_along(const Vec3& normal) const;

private:
    Vec3 from_;  // what places are counted from
    MovingCore a_, b_;
    double round_;     // m, by which the two are rounded
    double rounding_;  // m, that arithmetic may be off by
};

/// The impact of two cores, as time_of_impact() has it.
Impact impact_of_cores(const MovingCores& cores, double begin, double end, const ImpactRule& rule);

/// A shape over a plane; a mesh is its corners.
class OverPlane {
public:
    OverPlane(const Shapes& shapes, const MovingShape& plane, const MovingShape& other);

    // As MovingCores has them. Whatever direction is asked for, it is the plane's own, which turns
    // with its body.
    Apart distance_at(double time) const;
    SeparationRate separation_rate(const Vec3& normal, double time) const;
    SeparationLimits limits_along(const Vec3& normal) const;

private:
    Vec3 normal_at(double time) const;

    Plane plane_;
    Vec3 from_;                   // what places are counted from
    RigidTrajectory trajectory_;  // of the plane
    Pose local_;                  // of the plane
    MovingCore other_;
    double rounding_;
};

/// Part of a step, and how near counts as near.
struct Approach {
    double begin = 0, end = 0, margin = 0;
};

/// Visits the triangles of a mesh that a core may come near while the two are on their ways, in the
/// order of the tree.
void visit_triangles_in_way(const Mesh& mesh,
                            const MovingShape& on,
                            const ConvexCore<double>& core,
                            const MovingShape& other,
                            const Approach& approach,
                            const std::function<void(std::uint32_t)>& visit);

}  // namespace throng
