// Exact volume: what two closed polyhedra share, whatever their shape.
#pragma once

#include "narrowphase/alternatives/shared_volume.hpp"

namespace throng {

/// Boxes, hulls, solids and closed meshes: volume and center. The plain, slow answer sheet for the
/// others: both are sums of tetrahedra from a point in the middle to each triangle, counted below
/// zero where the triangle faces that point, and each of the one is cut by each of the other.
/// Exact to rounding, some 1e-13 of the size cubed. Parts that a mesh goes round twice count
/// twice.
///
/// Allocates. Two hulls or boxes go by query_clip_volume() in much less time.
SharedVolume shared_exactly(const VolumePair& pair);

/// How many pairs of triangles that takes, at most: a microsecond or two for each that is near.
double exact_cost(const VolumePair& pair);

}  // namespace throng
