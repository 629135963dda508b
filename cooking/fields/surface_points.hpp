// Surface points: a mesh's surface as points, close enough together to stand for it in contact.
#pragma once

#include "kernels/data/solids.hpp"

namespace throng {

/// Points of a closed mesh such that nothing of its surface is further than `spacing` from one, and
/// their tree. Needs vertex normals (see mesh_distance.hpp).
///
/// Corners and edges that stick out come first, then all other vertices: what touches flat things
/// touches with these. The rest is thinned: two points that look the same way, within 60 degrees,
/// are no nearer than four fifths of the spacing (vertices half of that), so that a fine mesh does
/// not give ever more points. The two sides of a thin wall have points each. The order hangs on the
/// mesh alone.
///
/// Source: the greedy dart throwing of Cook, Stochastic Sampling in Computer Graphics (1986), with
///         darts in a fixed order.
SurfacePoints build_surface_points(const Mesh& mesh, double spacing);

}  // namespace throng
