// Nearest point: the point of a shape nearest to another, in the shape's own frame.
#pragma once

#include "kernels/data/shapes.hpp"

#include <limits>

namespace throng {

/// distance: m; 0 where the point asked about lies inside a solid, and is then its own nearest.
/// Infinite where nothing was found.
struct NearestPoint {
    double distance = std::numeric_limits<double>::infinity();
    Vec3 point = Vec3::Zero();
};

/// The nearest point of a shape. A plane is solid below; a mesh is its triangles.
///
///   limit  m, what lies further away need not be found
NearestPoint nearest_point(const Shapes& shapes, ShapeRef shape, const Vec3& point, double limit);

}  // namespace throng
