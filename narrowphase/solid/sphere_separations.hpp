// Sphere separations: how near the spheres of a solid are to another shape, each for itself.
//
// find_sphere_candidates() tells each sphere's deepest partner and no other, for contacts that let
// bodies overlap. Bodies that may not are held wherever they are near, and the distances are exact:
// spheres are what such a solid is.
#pragma once

#include "kernels/data/manifolds.hpp"
#include "kernels/data/shapes.hpp"
#include "narrowphase/convex/pair_input.hpp"

#include <vector>

namespace throng {

/// The nearest places of this many pairs of spheres, or of a sphere and the other shape, are told.
/// Bodies that do not overlap have a few within a ten-thousandth of their size.
inline constexpr std::size_t kMostSphereSeparations = 64;

/// Appends a manifold of one point for each sphere of the solid's last level that is within
/// the margin of the other shape, or for each two of a pair of solids; in the solid's
/// frame, normals from it to the other. Where there are more than kMostSphereSeparations, the
/// nearest. Never throws.
///
///   in  a: solid with spheres; b: solid (by its spheres, else the front of its triangles), sphere,
///       capsule, cylinder, box, hull, plane, or mesh (its front)
void find_sphere_separations(const PairInput<double>& in, std::vector<LocalManifold<double>>& out);

/// m, how far the place, in the shape's frame, is from it at least: from a mesh or a solid that of
/// the nearest triangle, or infinity where that is more than `limit`; of others below 0 inside.
double distance_from(const Shapes& shapes, ShapeRef shape, const Vec3& place, double limit);

}  // namespace throng
