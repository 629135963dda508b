// Clip volume: what two polytopes share, by cutting the one by the planes of the other.
#pragma once

#include "narrowphase/alternatives/convex_methods.hpp"

namespace throng {

/// Touch and volume of two polytopes: volume, surface (the area of its whole boundary), center, and
/// for a normal the areas of that part of the boundary that lies on a, each along its outward
/// normal, added up: the direction in which pressure inside would push b off a.
///
/// Pairs that merely touch share no volume; their center lies in what they share, and where that
/// has no area either the normal is that of the face that comes nearest to parting them. So it is
/// where one lies inside the other. Surfaces of the two that lie in one another count half for
/// either. Of what is apart nothing else is told; its normal is of a plane that parts the two only
/// where a face's plane does.
///
/// Volumes are exact to the rounding of the positions, some 1e-15 of the lesser size. A hull is the
/// hull of its vertices: faces that are not quite flat are split.
///
///   cached  begins with the face that parted the two the last time
///   cold    with the likely one of either; then cuts the lesser, or of two of a size the one of
///           more faces, by the planes that reach it, first the one that cuts off most
///   plain   cuts a by all the planes of b, in the order of its faces
///
/// Allocates until it has met its largest pair, once a thread.
MethodAnswer query_clip_volume(const ConvexPair& pair,
                               double speculative_margin,
                               MethodStart start,
                               MethodMemory& memory);

/// m, by which b must be moved along a unit direction from a to b for the two to part: along the
/// normal of query_clip_volume() a depth to go with the volume, and no less than the least depth.
double depth_along(const ConvexPair& pair, const Vec3& direction);

}  // namespace throng
