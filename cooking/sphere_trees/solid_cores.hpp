// Solid cores: balls within a solid, strewn over all of it.
#pragma once

#include "kernels/data/solids.hpp"

namespace throng {

/// Balls within a closed mesh, no more than 16, each touching its surface: the thickest first, then
/// always the one that is furthest from those before it, up to where each is within another. None
/// is thinner than a third of the mesh's smallest half extent; empty where all are. Needs vertex
/// normals (see mesh_distance.hpp).
///
///   points  of the surface, each of which a ball is grown at
///
/// Source: Ma, Bae and Choi, 3D medial axis point approximation using nearest neighbors and the
///         normal field (2012), section 3, for balls that shrink until they are within; Gonzalez,
///         Clustering to minimize the maximum intercluster distance (1985), for the order.
std::vector<SolidCore> build_solid_cores(const Mesh& mesh, const SurfacePoints& points);

}  // namespace throng
