// Voxel probes: what sticks out of a shape, looked up in the field of a solid.
#pragma once

#include "kernels/data/shapes.hpp"
#include "narrowphase/manifold/contact_patches.hpp"

#include <vector>

namespace throng {

/// Appends the candidates of a's field with what sticks out of a convex shape: corners, points
/// along edges, and balls that fill its round parts. Points are about a voxel apart, but around the
/// rim of a cylinder never more than 256.
void probe_convex(const Shapes& shapes,
                  const Solid& a,
                  ShapeRef other,
                  const Pose& other_in_a,
                  double speculative_margin,
                  std::vector<ContactCandidate>& out);

/// The same of the corners and edges of a mesh, where they are on its front.
void probe_mesh(const Solid& a,
                const Mesh& mesh,
                const Pose& mesh_in_a,
                double speculative_margin,
                std::vector<ContactCandidate>& out);

}  // namespace throng
