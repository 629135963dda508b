// Mesh pairs: a convex shape against the triangles of a mesh that are near it.
#pragma once

#include "kernels/data/manifolds.hpp"
#include "kernels/data/shapes.hpp"
#include "narrowphase/convex/pair_input.hpp"

#include <vector>

namespace throng {

/// Where a convex shape touches a static triangle mesh: one manifold a triangle, in order of
/// triangle, contacts on internal edges turned to the surface so that sliding meets no bumps.
/// Double alone: a landscape reaches further from its origin than single tells places apart.
///
///   in   a: mesh, or a solid, which is its triangles here; b: the convex shape
///   out  appended to: in the mesh's frame, normals from the mesh to the shape
void collide_mesh(const PairInput<double>& in, std::vector<PartManifold>& out);

}  // namespace throng
