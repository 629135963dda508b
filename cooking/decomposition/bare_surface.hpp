// Bare surface: what of a mesh's surface is outside of the hulls that are to cover it.
#pragma once

#include "cooking/decomposition/hull_mesh.hpp"

namespace throng {

/// The surface furthest outside of all hulls.
///
///   bound   m, no point of the surface is further outside
///   where   near where that is, and what its triangle turns outward; where `bound` is more than
///           enough
struct BareSurface {
    double bound = 0;
    Vec3 where = Vec3::Zero(), normal = Vec3::Zero();
};

/// Looks for it by cutting triangles in two that no single hull covers.
///
///   enough  m, what is no further outside need not be looked into
BareSurface find_bare_surface(const Mesh& mesh, const std::vector<HullMesh>& hulls, double enough);

}  // namespace throng
