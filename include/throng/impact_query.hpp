// Impact query: asks when two shapes that move and turn first touch.
//
// Apart from any world: for cases and tools that measure the methods, and for users with ways of
// their own. An answer is never late: see narrowphase/ccd/time_of_impact.hpp.
#pragma once

#include "throng/scene.hpp"
#include "throng/settings.hpp"

#include <array>
#include <memory>
#include <string>

namespace throng {

/// How a shape moves: from a pose, at constant velocities, m/s and rad/s in world axes, turning
/// about the origin of its own frame.
struct ShapeMotion {
    Pose pose;
    Vec3 velocity = Vec3::Zero(), angular_velocity = Vec3::Zero();
};

/// When two first touch.
///
///   trouble      why there is no answer; empty where there is one
///   meets        they come within the tolerance, if at all for the first time at `time`
///   touching     they do so from the start, or overlap: the time is 0
///   time         s (of linear paths: 0 to 1), before which they were further apart than half the
///                tolerance; the end where they do not meet
///   distance     m, at that time; 0 where they overlap
///   normal       unit, from a to b, then
///   evaluations  distances and separations asked for
///   cut_short    a graze that was not settled within the bound of the search, told as a meeting
struct ImpactAnswer {
    std::string trouble;
    bool meets = false, touching = false;
    double time = 0;
    double distance = 0;
    Vec3 normal = Vec3::UnitZ();
    int evaluations = 0;
    bool cut_short = false;
};

/// Two shapes to ask about, as often as one likes. One thread at a time.
class ImpactQuery {
public:
    /// Spheres, capsules, cylinders, boxes, hulls, planes and meshes, as a scene states them; not
    /// two planes, nor two meshes. Of others trouble() says what is wrong.
    ImpactQuery(const ShapeDescription& a, const ShapeDescription& b);
    ~ImpactQuery();
    ImpactQuery(ImpactQuery&&) noexcept;
    ImpactQuery& operator=(ImpactQuery&&) noexcept;

    const std::string& trouble() const;
    /// The length that a tolerance is relative to, m: the smallest half extent of the two.
    double size() const;

    /// Never throws for what it is asked: a pose, velocity or duration that is not finite, and a
    /// tolerance out of range, are refused.
    ///
    ///   duration   s, above 0
    ///   tolerance  of size(); as the dial toi_tolerance
    ImpactAnswer ask(const ShapeMotion& a,
                     const ShapeMotion& b,
                     double duration,
                     ToiMethod method = ToiMethod::newton,
                     double tolerance = 1e-4) const;

private:
    struct Inside;
    std::unique_ptr<Inside> inside_;
};

/// Four points on straight lines from time 0 to time 1: of a vertex and a triangle, or of two
/// edges.
struct LinearQuestion {
    bool edges = false;
    std::array<Vec3, 4> from, to;
};

/// When the two first touch, if they do. What touches by exact arithmetic is always told to;
/// what comes within the tolerance may be.
///
///   tolerance   m; raised to what rounding asks for
ImpactAnswer ask_linear_paths(const LinearQuestion& question, ToiMethod method, double tolerance);

}  // namespace throng
