// Touching: whether two shapes share a point, and nothing more.
#pragma once

#include "kernels/data/shapes.hpp"

namespace throng {

/// Whether a convex shape of finite size shares a point with a shape of any kind.
///
/// Closed sets: shapes that touch share a point, as well as numbers can tell (1e-14 of their size).
/// A plane is solid below; a mesh is its triangles, with nothing inside.
///
///   shapes_a, a  sphere, capsule, cylinder, box or hull
///   b_in_a       pose of b in a's frame
bool touching(
    const Shapes& shapes_a, ShapeRef a, const Shapes& shapes_b, ShapeRef b, const Pose& b_in_a);

}  // namespace throng
