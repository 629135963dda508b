// Convex parts: a closed mesh split into a few convex hulls, or put into one.
//
// A piece is cut where that leaves least of what its hulls fill beyond it, the worst piece first;
// pieces whose joint hull fills little are then put together again. Hulls of pieces that were not
// put together lie in cells with planes between them, so they share faces and no volume. What is a
// few dozen of convex shapes put together is taken as these, which do (convex_cover.hpp).
//
// Source: the search for cuts after Wei, Liu, Ling, Su, Approximate Convex Decomposition for 3D
//         Meshes with Collision-Aware Concavity and Tree Search (2022), without its tree; cutting
//         the worst and merging after Mamou and Ghorbel, A Simple and Efficient Approach for 3D
//         Mesh Approximate Convex Decomposition (2009).
#pragma once

#include "kernels/data/shapes.hpp"

#include <string>

namespace throng {

/// What is wanted of a split. Of two parts or more, fewer where the error is reached with them.
///
///   max_parts  0: as many as the shape calls for, 16 or, where it is a few dozen of convex shapes
///              put together, up to 64
///   error      m, that a hull may fill beyond the mesh; 0 for 2.5 % of the mesh's longest side
struct PartsWanted {
    int max_parts = 0;
    double error = 0;
};

/// No hull of a split has more: what hulls of triangles alone may have in the wide kernels.
inline constexpr std::size_t kMostPartVertices = 87;

/// A mesh as hulls, in the mesh's axes.
///
///   points        [hulls] m, what build_hull() made each of, so that it may be made again
///   error         m, no hull's surface is further outside of the mesh, and no point of the mesh is
///                 further outside of all hulls
///   outside       m, that far outside of the mesh there is a point of a hull's surface: the first
///                 of the two is between this and `error`
///   uncovered     m, the second of the two
///   volume_error  volume of all hulls against that of the mesh, less 1. Where hulls overlap it is
///                 more than what they fill together
///   trouble       empty, or why there are no hulls, and what is wanted
///   warnings      what a user may want to know, in words
struct ConvexParts {
    std::vector<Hull> hulls;
    std::vector<std::vector<Vec3>> points;
    double error = 0;
    double outside = 0;
    double uncovered = 0;
    double volume_error = 0;
    std::string trouble;
    std::vector<std::string> warnings;
};

/// Splits a mesh. The same mesh gives the same bits. Needs vertex normals where it is closed.
///
/// Trouble reads on from the name of the mesh: "has a rim of 3 edges; give a closed mesh".
ConvexParts split_into_parts(const Mesh& mesh, const PartsWanted& wanted);

/// One hull of all vertices. It fills hollows and holes; a warning says by how much.
ConvexParts put_into_hull(const Mesh& mesh);

}  // namespace throng
