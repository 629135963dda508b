// Mesh pairs: a convex shape against the triangles of a mesh that are near it.
#pragma once

#include "kernels/data/manifolds.hpp"
#include "kernels/data/shapes.hpp"
#include "narrowphase/convex/pair_input.hpp"

#include <vector>

namespace throng {

/// One triangle of a mesh that a convex shape touches.
template <class Real>
struct TriangleManifold {
    std::uint32_t triangle = 0;
    LocalManifold<Real> manifold;  // in the mesh's frame, normal from the mesh to the shape
};
template <class Real>
using TriangleManifolds = std::vector<TriangleManifold<Real>>;

/// Where a convex shape touches a static triangle mesh: one manifold a triangle, in order of
/// triangle, contacts on internal edges turned to the surface so that sliding meets no bumps.
///
///   in   a: mesh, or a solid, which is its triangles here; b: the convex shape
///   out  appended to
template <class Real>
void collide_mesh(const PairInput<Real>& in, TriangleManifolds<Real>& out);

}  // namespace throng
