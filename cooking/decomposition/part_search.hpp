// Part search: where a piece of a mesh is best cut, for convex parts.
#pragma once

#include "cooking/decomposition/cutting_planes.hpp"

namespace throng {

/// A point of the mesh's surface that stands for some of it.
struct SurfaceSample {
    Vec3 point = Vec3::Zero(), normal = Vec3::Zero();
    double area = 0;  // m^2
};

/// Points on a mesh, each for as much of it.
std::vector<SurfaceSample> sample_surface(const Mesh& mesh);

/// A piece, the hull of it and how far that reaches outside.
struct MeshPart {
    MeshPiece piece;
    std::vector<SurfaceSample> samples;
    HullMesh hull;
    Overhang over;
    bool sure = false;   // `over` is as good as it gets
    bool whole = false;  // no cut helps
};

/// What a search needs to know of the whole mesh.
///
///   extent  m, its longest side
///   error   m, how far outside hulls may reach
///   edges   see inward_edges()
struct PartSearch {
    const Mesh& mesh;
    double extent, error;
    std::vector<InwardEdge> edges;

    /// m, points as near to a plane are on it.
    double slack() const;
    /// A quick look, which may miss some.
    Overhang overhang(const HullMesh& hull) const;
    /// With looks enough to tell whether there is more than the error.
    Overhang sure_overhang(const HullMesh& hull) const;
};

/// Cuts a part in two where that leaves least between the mesh and the hulls, by how far these
/// reach outside and by how hollow they are. Its upper half goes to the end. False, and nothing
/// done, where no cut leaves something on both sides.
bool split(const PartSearch& search, std::size_t which, std::vector<MeshPart>& parts);

}  // namespace throng
