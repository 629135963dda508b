// Box kernels: the three steps of colliding boxes, written over the width of the machine's
// registers.
//
// Plain numbers only: the sources behind this are compiled once for each instruction set.
#pragma once

#include <cstddef>
#include <cstdint>

namespace throng {

/// A pair of boxes, in two lines of eight numbers.
///
///   place  position of b in a's frame, m (3), reach, orientation of b in a's frame x, y, z, w
///   size   half extents of a, m (3), 0, of b (3), 0
struct BoxPair {
    alignas(64) float place[8];
    float size[8];
};

/// What the search for a separating axis found for a pair that may touch; eight numbers.
///
///   pair        place among the pairs
///   face        0-2 a's faces, 3-5 b's: the one that leads
///   edge        6 + 3i + j: a's edge i across b's edge j; 15 where no edge is better than a face
///   alike       1 where the edges' normal is all but the face's
///   separation  m along the face's normal, and along the edges'
struct BoxAxes {
    std::int32_t pair, face, edge, alike;
    float face_separation, edge_separation, spare[2];
};

inline constexpr std::int32_t kNoEdge = 15;

/// Pairs to be looked at further; room for as many as there are pairs.
struct BoxList {
    BoxAxes* at;
    std::int32_t count;
};

/// How many numbers of four bytes a manifold holds: normal (3), four points of position (3),
/// separation and feature, then the number of points.
inline constexpr int kManifoldNumbers = 24;

/// The kernels of one width. Manifolds are written as numbers, kManifoldNumbers a pair; those of
/// pairs that are apart stay as they are.
///
///   part   finds each pair's best axes; appends what may touch to the list of the step that is
///   next clip   one box's face against the other's; what turns out to touch at an edge goes to
///   `edges` cross  the place where two edges cross
///
/// Source: Gottschalk, Lin, Manocha, OBBTree (1996) for the fifteen axes; Sutherland, Hodgman,
///         Reentrant Polygon Clipping (1974).
struct BoxKernels {
    const char* name;
    int lanes;
    void (*part)(const BoxPair* pairs, std::int32_t count, BoxList& faces, BoxList& edges);
    void (*clip)(const BoxPair* pairs, const BoxList& faces, BoxList& edges, float* manifolds);
    void (*cross)(const BoxPair* pairs, const BoxList& edges, float* manifolds);
};

/// The kernels of one width: "scalar", "avx2" or "avx512"; none where the machine has not got it.
const BoxKernels* box_kernels_of(const char* width);

/// Those of the width that the solver's kernels have.
const BoxKernels& box_kernels();

}  // namespace throng
