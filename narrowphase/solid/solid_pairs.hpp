// Solid pairs: a solid against whatever else there is, as a few manifolds.
#pragma once

#include "kernels/data/shapes.hpp"
#include "narrowphase/convex/pair_input.hpp"
#include "narrowphase/manifold/contact_patches.hpp"

namespace throng {

/// What else is told of a pair.
///
///   left_out  touches that overlap and that no manifold had room for (see make_patches())
///   apart     m, where there is no touch: none will be within the margin before points of the two
///             have come closer by what this is more than the speculative margin. At most their
///             distance
struct SolidAnswer {
    std::size_t left_out = 0;
    double apart = 0;
};

/// m, how far what stands for a shape in contact may be off its triangles: 0 of all but solids.
double shape_error(const Shapes& shapes, ShapeRef shape);

/// Where a solid touches another shape of any kind, out to the margin: manifolds in the solid's
/// frame, normals from the solid to the other, in order of patch.
///
///   in   a: solid; b: sphere, capsule, cylinder, box, hull, plane, mesh (its front faces) or solid
///   out  appended to
///   pressed_in  m, how deep the solid is in the mesh at least, as what was found before says: no
///               mesh tells how thick it is, so what is much deeper counts as beyond it
///
/// Two solids go by depth images where either asks for them, else by the spheres of those that are
/// spheres, else by voxels both ways. Never throws.
SolidAnswer
collide_solid(const PairInput<double>& in, std::vector<PartManifold>& out, double pressed_in = 0);

}  // namespace throng
