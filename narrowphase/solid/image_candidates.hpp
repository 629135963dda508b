// Image candidates: where a solid touches another shape, seen along rays.
//
// Both are drawn three times, along each axis of the solid's frame; where surfaces of the two face
// one another along a ray, over a shared part of it or a small gap, is a touch. A ray along a
// surface sees nothing of worth, so of each touch the view counts that its normal faces most, or
// nearly so, within 60 degrees; where two do, it is told twice. Where two views see one shared
// place the one that sees much less depth counts, for that is the way out of a thin overlap.
//
// What is thinner than a pixel in all three views may be missed. Depths are those of the rays: of a
// smooth surface wrong by a pixel squared over its radius, and where the normal leans by the depth
// squared over it; of a corner, which comes to its point between them, up to a pixel too little.
//
// Source: Faure, Barbier, Allard, Falipou, Image-based collision detection and response between
//         arbitrary volume objects (2008), which this follows in taking contacts from the ends of
//         shared intervals.
#pragma once

#include "kernels/data/shapes.hpp"
#include "narrowphase/convex/pair_input.hpp"
#include "narrowphase/manifold/contact_patches.hpp"

namespace throng {

/// Appends a touch for each ray and layer along which a solid and another shape share something or
/// come within the margin of one another along their normal, in the solid's frame, view by view and
/// ray by ray.
///
///   in  a: solid; b: of any kind but a triangle or a solid without triangles, a mesh by its front
///       faces
///
/// The rays stay where they are in the solid's frame, whatever the other does: a pixel is the
/// longest side of the smaller shape's own box over Solid::rays, the greater of two. `feature`
/// names view, ray and layer. Never throws but for want of memory; allocates until it has met its
/// largest pair, once a thread.
void find_image_candidates(const PairInput<double>& in, std::vector<ContactCandidate>& candidates);

}  // namespace throng
