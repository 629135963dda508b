// Narrow phase: pairs of shapes in, manifolds out.
#pragma once

#include "narrowphase/convex/pair_functions.hpp"
#include "narrowphase/mesh/mesh_pairs.hpp"

namespace throng {

/// Where shapes a and b touch, whatever their kinds (no mesh: see collide_mesh). Picks the pair
/// function from the shape-by-shape table, turning the pair round where the table wants it so;
/// the answer is in a's frame either way.
template <class Real>
void collide(const PairInput<Real>& in, PairCache& cache, LocalManifold<Real>& out);

/// The pose of shape b in a's frame, in double, as pair functions want it.
///
/// A plane's origin is slid along the plane to where a is: the same plane, and numbers that stay
/// small however far a has gone, so that float will do. Put the plane second for that.
Pose pose_seen_from_a(const Shapes& shapes, ShapeRef b, const Pose& pose_a, const Pose& pose_b);

/// How deep two convex shapes overlap: the least distance by which one must be moved for them to
/// part, m; 0 when they do not overlap. In double, from the geometry alone.
double penetration_depth(const Shapes& shapes, ShapeRef a, ShapeRef b, const Pose& b_in_a);

}  // namespace throng
