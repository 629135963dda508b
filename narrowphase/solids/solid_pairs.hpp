// Solid pairs: a solid against whatever else there is, as a few manifolds.
#pragma once

#include "kernels/data/shapes.hpp"
#include "narrowphase/solids/contact_patches.hpp"

namespace throng {

/// Where a solid touches another shape of any kind, out to `reach`: manifolds in the solid's frame,
/// normals from the solid to the other, in order of patch.
///
///   other      sphere, capsule, cylinder, box, hull, plane, mesh (its front faces) or solid
///   other_in_solid  its pose in the solid's frame
///   out        appended to
///
/// Two solids go by depth images where either asks for them, else by the spheres of those that are
/// spheres, else by voxels both ways. Never throws; touches left out are answered (see
/// make_patches()).
std::size_t collide_solid(const Shapes& shapes,
                          ShapeRef solid,
                          ShapeRef other,
                          const Pose& other_in_solid,
                          double reach,
                          std::vector<PatchManifold>& out);

}  // namespace throng
