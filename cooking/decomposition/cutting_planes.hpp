// Cutting planes: where it may pay to cut a piece of a mesh.
#pragma once

#include "cooking/decomposition/cut_mesh.hpp"
#include "cooking/decomposition/hull_mesh.hpp"

namespace throng {

/// An edge of a mesh at which its surface turns inward.
struct InwardEdge {
    Vec3 from = Vec3::Zero(), to = Vec3::Zero();  // the face of `normal` is to the left
    Vec3 middle = Vec3::Zero();
    Vec3 normal = Vec3::Zero(), other = Vec3::Zero();  // of the faces beside it
};

std::vector<InwardEdge> inward_edges(const Mesh& mesh);

/// The directions of the axes, then those halfway between two and three of them; of each opposite
/// two one. Unit.
std::vector<Vec3> cutting_directions();

/// Planes to try on a piece, each once: evenly spaced ones across the axes, and fewer across the
/// diagonals; and through the inward edges that lie deepest inside of the piece's hull, weighed by
/// how sharply they turn, along both faces, along what halves the angle between them, and across.
std::vector<Plane>
cutting_planes(const MeshPiece& piece, const HullMesh& hull, const std::vector<InwardEdge>& edges);

}  // namespace throng
