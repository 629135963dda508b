// Cut mesh: a closed mesh cut by planes into pieces that know their corners.
#pragma once

#include "kernels/data/shapes.hpp"

namespace throng {

/// What is of a closed mesh within a cell of half spaces.
///
///   points    m, corners of the surface: those of the mesh, where its edges pass through the
///             cell's planes, and where its faces meet two of them
///   surface   triangles of the mesh, cut; into points
///   corners   m, of the cell, inside the mesh. The hull of these and the points is that of the
///             piece, faces along the cuts included
///   cell      half spaces; none for the whole mesh
struct MeshPiece {
    std::vector<Vec3> points;
    std::vector<std::array<std::uint32_t, 3>> surface;
    std::vector<Vec3> corners;
    std::vector<Plane> cell;
};

/// Both sides of a cut: [0] is where the plane is solid, [1] is beyond it.
template <class Side>
using Sides = std::array<Side, 2>;

MeshPiece whole_piece(const Mesh& mesh);

/// All points and corners that the two pieces would have, without making them. Some may be there
/// more than once.
///
///   slack  m, points as near to the plane count as on it
Sides<std::vector<Vec3>>
look_at_cut(const Mesh& mesh, const MeshPiece& piece, const Plane& plane, double slack);

/// Cuts a piece in two. Faces in the plane are of neither piece: their corners are corners of other
/// faces too. Needs a closed mesh with vertex normals.
Sides<MeshPiece>
cut_piece(const Mesh& mesh, const MeshPiece& piece, const Plane& plane, double slack);

}  // namespace throng
