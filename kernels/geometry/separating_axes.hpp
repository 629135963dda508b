// Separating axes: every axis that could part two polytopes, looked at one by one.
#pragma once

#include "kernels/geometry/polytope.hpp"

namespace throng {

/// How far apart two polytopes are along the best of all face normals and edge-by-edge normals:
/// above 0 a gap along that axis (no more than the distance), below 0 minus the least distance by
/// which one must be moved for them to part.
///
///   normal   unit, from a to b, in a's frame; may be null
///
/// Looks at every vertex for every face, and of pairs of edges at those whose arcs cross on the
/// Gauss map: the others are no face of the Minkowski difference.
double
polytope_separation(const PolytopeView& a, const PolytopeView& b, const Pose& b_in_a, Vec3* normal);

}  // namespace throng
