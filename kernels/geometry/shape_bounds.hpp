// Shape bounds: how far a shape reaches, placed and turned, outward and inward.
#pragma once

#include "kernels/data/bounds.hpp"
#include "kernels/data/shapes.hpp"

namespace throng {

/// The smallest box in world axes round the shape; for a mesh, round its own box. All of space for
/// a plane.
Box3 shape_bounds(const Shapes& shapes, ShapeRef shape, const Pose& pose);

/// Greatest distance of a point of the shape from the origin of its frame; infinite for a plane.
double outer_radius(const Shapes& shapes, ShapeRef shape);

/// How far the shape may move before it can jump through something: its smallest half-extent.
/// Infinite for a plane; 0 for a mesh, which is a surface.
double inner_extent(const Shapes& shapes, ShapeRef shape);

}  // namespace throng
