// Voxel pairs: where a solid that goes by voxels touches another shape.
#pragma once

#include "kernels/data/shapes.hpp"
#include "narrowphase/manifold/contact_patches.hpp"

#include <vector>

namespace throng {

/// Appends the candidates of solid a with another shape, out to `speculative_margin`, in a's frame:
/// points of a's surface by the other's distance, and what sticks out of the other by a's field.
///
///   other  solid    its points by a's field; a's by its field (each where it has them)
///          sphere, capsule, cylinder, box, hull
///                   its corners, points along its edges a voxel apart, and balls that fill what is
///                   round, so that none falls through between the points of a
///          plane    nothing of its own
///          mesh     its corners and edges; front faces only, and nothing that lies further behind
///                   them than `pressed_in`, m, and half of the solid or four spacings of its
///                   points
///
/// Depths are exact, to the field's rounding, where a corner or a point of one meets a flat face of
/// the other. Else they are off by what the surfaces bend away from one another within the spacing
/// of the points: with points a voxel apart less than a tenth of one for radii of six voxels and
/// more, and a quarter of that with half the voxel. Two edges that cross are told the way out of
/// each other's faces, 0.7 of what is the least, and half a voxel less where no point is at the
/// crossing.
///
/// Balls that fill what is round are looked up out to the field's band less the diagonal of a
/// cell; larger ones are left to the points of a. The band should be the speculative margin and two
/// voxels.
///
/// Answers a distance: where nothing is told, nothing will be before points of the two have come
/// closer by what it is more than the speculative margin.
double find_voxel_candidates(const Shapes& shapes,
                             const Solid& a,
                             ShapeRef other,
                             const Pose& other_in_a,
                             double speculative_margin,
                             double pressed_in,
                             std::vector<ContactCandidate>& out);

}  // namespace throng
