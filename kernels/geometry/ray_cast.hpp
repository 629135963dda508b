// Ray cast: where a ray first meets a shape, in the shape's own frame, in closed form.
#pragma once

#include "kernels/data/shapes.hpp"

#include <limits>

namespace throng {

/// The points from + along * t, 0 <= t <= longest. `along` is of unit length.
struct LocalRay {
    Vec3 from = Vec3::Zero();
    Vec3 along = Vec3::UnitZ();
    double longest = std::numeric_limits<double>::infinity();  // m
};

/// The first point that a ray shares with a shape.
///
///   distance  m, from where the ray begins; infinite where they do not meet
///   normal    unit, out of the surface; minus `along` where the ray begins inside a solid
struct LocalRayHit {
    double distance = std::numeric_limits<double>::infinity();
    Vec3 normal = Vec3::Zero();

    bool found() const { return distance < std::numeric_limits<double>::infinity(); }
};

/// Where the ray first meets the shape.
///
/// Solids include their surface: a ray that begins inside one, or on its way out of the surface,
/// meets it at distance 0. A plane is solid below. A mesh is its triangles, met from both sides,
/// with the normal of the side that the ray comes from and no gaps along shared edges; a ray that
/// lies in a triangle's plane does not meet it. Of triangles met at the same distance the first
/// counts.
LocalRayHit cast_ray(const Shapes& shapes, ShapeRef shape, const LocalRay& ray);

}  // namespace throng
