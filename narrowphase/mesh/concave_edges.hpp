// Concave edges: a triangle that rises ahead of a shape is met in its plane.
//
// Where a mesh bends up, what rolls or slides towards the bend is over the next triangle only once
// it is half in it: a whole step of its way too late for a small body or a fine mesh, and the
// height it is then pushed up by is energy that nobody gave. From the place that a point is over up
// to the concave edge, nothing of the mesh is beyond the plane of the triangle behind that edge, so
// the plane may be told of before.
#pragma once

#include "kernels/data/manifolds.hpp"
#include "narrowphase/mesh/triangle_contacts.hpp"

#include <span>

namespace throng {

/// Adds the points of a shape that the triangle rises ahead of, with the triangle's normal.
///
///   points  mesh axes, m: what of the shape is nearest to the triangle's plane, four at most
///   radius  m, of the shape round each of them
///   out     empty before
void add_points_ahead(const MeshTriangle& triangle,
                      std::span<const Vec3> points,
                      double radius,
                      double speculative_margin,
                      LocalManifold<double>& out);

}  // namespace throng
