// Ray passage: the part of a line that lies in a convex shape, in closed form.
#pragma once

#include "kernels/geometry/ray_cast.hpp"

namespace throng {

/// The part of a ray's whole line that lies in a convex shape, from its start on, in m; infinite at
/// an end where the shape has none.
///
///   enter_normal, leave_normal  out of the surface there, of any length; 0 where there is no end
struct RayPassage {
    double enter = -std::numeric_limits<double>::infinity();
    double leave = std::numeric_limits<double>::infinity();
    Vec3 enter_normal = Vec3::Zero(), leave_normal = Vec3::Zero();

    bool empty() const { return !(enter <= leave); }
};

/// The part of the ray's line in the shape; `longest` is not looked at.
///
/// Needs: a sphere, capsule, cylinder, box, hull or plane (solid below); of others it is empty.
RayPassage pass_through(const Shapes& shapes, ShapeRef shape, const LocalRay& ray);

}  // namespace throng
