// Voxel pairs: where a solid that goes by voxels touches another shape.
#pragma once

#include "kernels/data/shapes.hpp"
#include "narrowphase/solids/contact_patches.hpp"

#include <vector>

namespace throng {

/// Appends the touches of solid a with another shape, out to `reach`, in a's frame: points of a's
/// surface by the other's distance, and what sticks out of the other by a's field.
///
///   other  solid    its points by a's field; a's by its field (each where it has them)
///          sphere, capsule, cylinder, box, hull
///                   its corners, points along its edges a voxel apart, and balls that fill what is
///                   round, so that none falls through between the points of a
///          plane    nothing of its own
///          mesh     its corners and edges; front faces only
///
/// Depths are exact where the surfaces are flat and the deepest place is a point or sticks out.
/// Else they are off by what the surfaces bend away within the spacing of the points and by what
/// a cell cuts off edges: less than half a voxel where points are a voxel apart and the surface
/// curves by radii of two voxels or more; for smooth surfaces a quarter of that with half the voxel
/// (and the spacing with it).
void touch_by_voxels(const Shapes& shapes,
                     const Solid& a,
                     ShapeRef other,
                     const Pose& other_in_a,
                     double reach,
                     std::vector<SurfaceTouch>& out);

}  // namespace throng
