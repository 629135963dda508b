// Mesh cells: how deep below the surface of a mesh places may be, for one who asks about very many.
#pragma once

#include "kernels/data/bounds.hpp"
#include "kernels/data/mesh.hpp"

namespace throng {

/// Cubes over the bounds of a closed mesh. How deep the middle of one is gets worked out when
/// somebody first asks about a place in it. Not for two threads at once.
class MeshCells {
public:
    /// Keep the mesh, which has triangles and vertex normals, while the cells are in use.
    explicit MeshCells(const Mesh& mesh);

    const Mesh& mesh() const { return mesh_; }

    /// No less than -signed_distance() of a place: that of its cell's middle, and the way there.
    double depth_bound(const Vec3& place);

private:
    const Mesh& mesh_;
    Box3 box_;
    double side_ = 0;
    std::array<std::size_t, 3> count_{};
    std::vector<double> depths_;  // of the middles, infinite where nobody has asked
};

}  // namespace throng
